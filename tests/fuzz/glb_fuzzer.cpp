// Fuzzes the reading of binary glTF files with libFuzzer. Most mutations change the JSON so that it
// stays valid JSON, or the binary data, and rewrite the header so that it matches the chunks. One
// mutation in eight changes arbitrary bytes of the file, so that headers are tested too.
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "check_scene.h"
#include "mutate_json.h"
#include "scene/gltf_container.h"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);

namespace alcove::sample {
namespace {

void add_word(std::vector<uint8_t>& file, size_t value) {
  for (int shift = 0; shift < 32; shift += 8) file.push_back(static_cast<uint8_t>(value >> shift));
}

std::vector<uint8_t> glb_of(std::string json, std::vector<uint8_t> binary) {
  while (json.size() % 4) json += ' ';
  while (binary.size() % 4) binary.push_back(0);
  std::vector<uint8_t> file;
  add_word(file, 0x46546c67);
  add_word(file, 2);
  add_word(file, 28 + json.size() + binary.size());
  add_word(file, json.size());
  add_word(file, 0x4e4f534a);
  file.insert(file.end(), json.begin(), json.end());
  add_word(file, binary.size());
  add_word(file, 0x004e4942);
  file.insert(file.end(), binary.begin(), binary.end());
  return file;
}

// An empty result: the file is not one that can be taken apart.
std::vector<uint8_t> mutated(std::span<const uint8_t> file, std::minstd_rand& random) {
  const auto parts = split_gltf(file);
  if (!parts) return {};
  auto root = nlohmann::json::parse(parts->json.begin(), parts->json.end(), nullptr, false);
  if (!root.is_object()) return {};
  std::vector<uint8_t> binary(parts->binary.begin(), parts->binary.end());
  if (!binary.empty() && (random() >> 3) % 4 == 0) {
    binary.resize(LLVMFuzzerMutate(binary.data(), binary.size(), binary.size()));
  } else {
    mutate_json(root, random);
  }
  return glb_of(root.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), binary);
}

}  // namespace
}  // namespace alcove::sample

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size,
                                          unsigned seed) {
  std::minstd_rand random(seed);
  if ((random() >> 3) % 8 == 0) return LLVMFuzzerMutate(data, size, max_size);
  const std::vector<uint8_t> file = alcove::sample::mutated({data, size}, random);
  if (file.empty() || file.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
  std::memcpy(data, file.data(), file.size());
  return file.size();
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  alcove::sample::check_scene({data, size});
  return 0;
}
