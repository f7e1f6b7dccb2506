#pragma once

#include "alcove/passes/occlusion.h"

namespace alcove::sample {

// A widget for each setting, by the name that --set has for it, with its range and what it does.
// What has no effect beside the others is dimmed. Numbers that are typed (control and click) are
// not held to the range: the passes refuse what they cannot do. `radius` is the scene's usual one.
void lay_out_settings(passes::OcclusionSettings& settings, float radius);

}  // namespace alcove::sample
