#pragma once

#include "drawing.h"
#include "pass_fixture.h"

// Helpers for tests of back faces and of the second depth layer, which show surfaces that the first
// layer hides.
namespace alcove::passes {

// Returns settings without hidden occlusion, so that only the given depths occlude.
inline OcclusionSettings without_hidden_occlusion(float radius) {
  OcclusionSettings settings(ALCOVE_QUALITY_HEIGHT_FIELD, radius);
  settings.estimator = ALCOVE_ESTIMATOR_CONNECTED;
  settings.slices = 16;
  settings.hidden_occlusion = 0.0f;
  return settings;
}

class HiddenDepthTest : public PassTest {
 protected:
  // `hidden` is the depth of back faces or of the second layer, whichever the settings read.
  HostImage visibility(const Drawing& drawing, const HostImage& hidden,
                       const OcclusionSettings& settings) {
    HostView view = make_view(drawing, settings);
    view.back_depth_ndc = view.second_depth_ndc = hidden;
    return run_occlusion(view).visibility;
  }
};

}  // namespace alcove::passes
