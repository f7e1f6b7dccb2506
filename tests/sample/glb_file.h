#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace alcove::sample {

inline std::vector<uint8_t> text_bytes(const std::string& text) {
  return {text.begin(), text.end()};
}

// Returns a binary glTF file of a JSON text and a binary chunk (glTF 2.0 section 4.4).
inline std::vector<uint8_t> glb_file(std::string json, std::vector<uint8_t> binary) {
  while (json.size() % 4) json += ' ';
  while (binary.size() % 4) binary.push_back(0);
  std::vector<uint8_t> file;
  const auto add_word = [&](size_t value) {
    for (int shift = 0; shift < 32; shift += 8)
      file.push_back(static_cast<uint8_t>(value >> shift));
  };
  add_word(0x46546c67);
  add_word(2);
  add_word(28 + json.size() + binary.size());
  add_word(json.size());
  add_word(0x4e4f534a);
  file.insert(file.end(), json.begin(), json.end());
  add_word(binary.size());
  add_word(0x004e4942);
  file.insert(file.end(), binary.begin(), binary.end());
  return file;
}

}  // namespace alcove::sample
