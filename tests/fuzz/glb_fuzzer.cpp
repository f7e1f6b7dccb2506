// Fuzzes the reading of binary glTF files with libFuzzer. Most mutations change the JSON so that it
// stays valid JSON, or the binary data, and rewrite the header so that it matches the chunks. One
// mutation in eight changes arbitrary bytes of the file, so that headers are tested too.
#include <cstring>
#include <iterator>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "check_scene.h"
#include "glb_file.h"
#include "scene/gltf_container.h"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);

namespace alcove::sample {
namespace {

using nlohmann::json;

size_t below(size_t bound, std::minstd_rand& random) { return (random() >> 3) % bound; }

// A place in the tree, by a walk that may end at any node on its way.
json& random_place(json& root, std::minstd_rand& random) {
  constexpr size_t kStopOneIn = 6;
  json* at = &root;
  while (at->is_structured() && !at->empty()) {
    if (at != &root && below(kStopOneIn, random) == 0) break;
    auto child = at->begin();
    std::advance(child, static_cast<ptrdiff_t>(below(at->size(), random)));
    at = &*child;
  }
  return *at;
}

json interesting_value(std::minstd_rand& random) {
  static const json kValues = json::parse(
      R"([0, 1, -1, 2, 3, 4, 255, 256, 65535, 65536, 2147483647, 2147483648, 4294967295, 4294967296,
          9007199254740992, 18446744073709551615, 0.5, 4.0, -0.0, 1e-300, 1e38, 1e300, true, false,
          null, "", "0", "VEC3", "SCALAR", "MASK", "BLEND", [], {}, 5120, 5121, 5123, 5125, 5126,
          "data:,", "data:;base64,AAAA", "..", "a%00b"])");
  return kValues[below(kValues.size(), random)];
}

void change_number(json& value, std::minstd_rand& random) {
  if (value.is_number_integer() && below(2, random) == 0) {
    value = value.get<int64_t>() + static_cast<int64_t>(below(5, random)) - 2;
  } else if (value.is_number()) {
    constexpr double kFactors[] = {-1.0, 0.0, 0.5, 2.0, 1e10, 1e-10};
    value = value.get<double>() * kFactors[below(std::size(kFactors), random)];
  }
}

void change_container(json& value, std::minstd_rand& random) {
  if (value.empty()) return;
  const auto at = static_cast<ptrdiff_t>(below(value.size(), random));
  if (below(2, random) == 0)
    value.erase(std::next(value.begin(), at));
  else if (value.is_array() && value.size() < 64)
    value.push_back(json(value[static_cast<size_t>(at)]));
}

// Changes a JSON tree in one place, so that it stays JSON and mostly stays glTF: a value is
// replaced by a close one, an extreme one or one of another type; a member or element is removed,
// repeated, or replaced by a copy from elsewhere in the tree.
void mutate_json(json& root, std::minstd_rand& random) {
  json& value = random_place(root, random);
  switch (below(4, random)) {
    case 0:
      value = interesting_value(random);
      break;
    case 1: {
      json copy = random_place(root, random);
      if (&value != &root) value = std::move(copy);
      break;
    }
    default:
      if (value.is_structured())
        change_container(value, random);
      else if (value.is_number())
        change_number(value, random);
      else
        value = interesting_value(random);
  }
}

// An empty result: the file is not one that can be taken apart.
std::vector<uint8_t> mutated(std::span<const uint8_t> file, std::minstd_rand& random) {
  const auto parts = split_gltf(file);
  if (!parts) return {};
  auto root = nlohmann::json::parse(parts->json.begin(), parts->json.end(), nullptr, false);
  if (!root.is_object()) return {};
  std::vector<uint8_t> binary(parts->binary.begin(), parts->binary.end());
  if (!binary.empty() && (random() >> 3) % 4 == 0)
    binary.resize(LLVMFuzzerMutate(binary.data(), binary.size(), binary.size()));
  else
    mutate_json(root, random);
  return glb_file(root.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), binary);
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
