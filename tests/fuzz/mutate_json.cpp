#include "mutate_json.h"

#include <iterator>

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
  static const json kValues = json::array({0,
                                           1,
                                           -1,
                                           2,
                                           3,
                                           4,
                                           255,
                                           256,
                                           65535,
                                           65536,
                                           2147483647,
                                           2147483648u,
                                           4294967295u,
                                           4294967296,
                                           9007199254740992,
                                           18446744073709551615u,
                                           0.5,
                                           4.0,
                                           -0.0,
                                           1e-300,
                                           1e38,
                                           1e300,
                                           true,
                                           false,
                                           nullptr,
                                           "",
                                           "0",
                                           "VEC3",
                                           "SCALAR",
                                           "MASK",
                                           "BLEND",
                                           json::array(),
                                           json::object(),
                                           5120,
                                           5121,
                                           5123,
                                           5125,
                                           5126,
                                           "data:,",
                                           "data:;base64,AAAA",
                                           "..",
                                           "a%00b"});
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
  if (below(2, random) == 0) {
    value.erase(std::next(value.begin(), at));
  } else if (value.is_array() && value.size() < 64) {
    value.push_back(json(value[static_cast<size_t>(at)]));
  }
}

}  // namespace

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
      if (value.is_structured()) {
        change_container(value, random);
      } else if (value.is_number()) {
        change_number(value, random);
      } else {
        value = interesting_value(random);
      }
  }
}

}  // namespace alcove::sample
