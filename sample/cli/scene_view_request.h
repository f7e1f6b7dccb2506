#pragma once

#include "cli/options.h"
#include "viewer/scene_view.h"

namespace alcove::sample {

// The request for the window that the options describe.
[[nodiscard]] SceneViewRequest scene_view_request(const Options& options);

}  // namespace alcove::sample
