// The settings of the C interface and those of the passes.
#pragma once

#include "alcove/alcove.h"
#include "alcove/passes/occlusion.h"
#include "c_failure.h"

namespace alcove::passes {

// Settings without the outputs, which an engine asks for by giving images. The enums are checked;
// numbers are checked by the passes. Null is a failure.
struct GivenSettings {
  OcclusionSettings settings;          // with `specular` none
  Specular specular = Specular::none;  // the model, where one is asked for
};
[[nodiscard]] tl::expected<GivenSettings, Failure> to_settings(const AlcoveSettings* given);

[[nodiscard]] AlcoveSettings from_settings(const OcclusionSettings& settings);

}  // namespace alcove::passes
