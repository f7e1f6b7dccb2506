// Converts the settings of the C interface to those of the passes and back.
#pragma once

#include <cstdint>
#include <cstring>

#include "alcove/alcove.h"
#include "alcove/passes/settings.h"
#include "c/failure.h"

namespace alcove::passes {

// Returns the bits of an enum that C code wrote. Reading a value that the enum does not have would
// be undefined behaviour in C++.
template <typename Theirs>
[[nodiscard]] std::uint32_t number_of(const Theirs& value) {
  std::uint32_t number = 0;
  static_assert(sizeof value == sizeof number);
  std::memcpy(&number, &value, sizeof number);
  return number;
}

// Converts settings and checks them with validate(). `visibility` and `bent_normal` of the result
// have their defaults, and `specular` is the model of `given`, because only the images of a view
// say which outputs are requested. Returns a failure if `given` is null.
[[nodiscard]] tl::expected<OcclusionSettings, Failure> to_settings(const AlcoveSettings* given);

// Converts settings to those of the C interface.
[[nodiscard]] AlcoveSettings from_settings(const OcclusionSettings& settings);

}  // namespace alcove::passes
