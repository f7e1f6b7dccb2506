#pragma once

#include "alcove/passes/occlusion.h"

namespace alcove::sample {

// Lays out a widget for each setting, with its name in --set, its range, and its help as a tooltip.
// Settings that have no effect with the other settings are dimmed. Numbers that the user types
// (control and click) may be out of range; the passes refuse invalid ones. `radius` is the default
// radius of the scene, and scales the slider of the radius.
void lay_out_settings(passes::OcclusionSettings& settings, float radius);

}  // namespace alcove::sample
