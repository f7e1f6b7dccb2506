// The settings of the C interface and those of the passes.
#pragma once

#include <cstdint>
#include <cstring>

#include "alcove/alcove.h"
#include "alcove/passes/occlusion.h"
#include "c_failure.h"

namespace alcove::passes {

// The bits of an enum that C wrote: reading one that is no value is undefined in C++.
template <typename Theirs>
[[nodiscard]] std::uint32_t number_of(const Theirs& value) {
  std::uint32_t number = 0;
  static_assert(sizeof value == sizeof number);
  std::memcpy(&number, &value, sizeof number);
  return number;
}

// Settings without the outputs, which an engine asks for by giving images. The enums are checked;
// numbers are checked by the passes. Null is a failure.
struct GivenSettings {
  OcclusionSettings settings;          // with `specular` none
  Specular specular = Specular::none;  // the model, where one is asked for
};
[[nodiscard]] tl::expected<GivenSettings, Failure> to_settings(const AlcoveSettings* given);

[[nodiscard]] AlcoveSettings from_settings(const OcclusionSettings& settings);

}  // namespace alcove::passes
