#pragma once

#include <array>

#include "drawing.h"
#include "pass_fixture.h"

// For tests of the depths that tell what the first one hides.
namespace alcove::passes {

// That read them.
inline constexpr std::array kThickEstimators{Estimator::bitmask, Estimator::connected};

// Nothing is hidden but by what the depths show.
inline OcclusionSettings without_fill(Estimator estimator, float radius) {
  OcclusionSettings settings = quality_settings(Quality::reference, radius);
  settings.advanced.estimator = estimator;
  settings.slices = 16;
  settings.hidden_occlusion = 0.0f;
  settings.advanced.unobserved = false;
  return settings;
}

class HiddenDepthTest : public PassTest {
 protected:
  // `hidden`: back faces or the second layer, as the settings read it.
  HostImage visibility(const TestView& view, const Drawing& drawing, const HostImage& hidden,
                       const OcclusionSettings& settings) {
    return run_occlusion({.view = view.view,
                          .depth_ndc = drawing.depth_ndc,
                          .normal_vs = &drawing.normal_vs,
                          .back_depth_ndc = &hidden,
                          .second_depth_ndc = &hidden},
                         settings)
        .visibility;
  }
};

}  // namespace alcove::passes
