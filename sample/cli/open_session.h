// From command-line options to what the other folders of the sample take.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "cli/options.h"
#include "evaluate/truths.h"
#include "evaluate/variant.h"
#include "render/rendering.h"
#include "render/session.h"

namespace alcove::sample {

// Loads the scene and finds camera and settings. Notes about the scene go to stderr, and so does
// progress where loading takes long. The session has no device.
[[nodiscard]] tl::expected<Session, std::string> load_session(const Options& options);

// Loads the scene, finds camera and settings and opens the device, in this order, so that the
// mistake that is found fastest is reported first. `surface_extensions` are the instance extensions
// of a window to present to.
[[nodiscard]] tl::expected<Session, std::string> open_session(
    const Options& options, const std::vector<const char*>& surface_extensions = {});

// The session that the options describe, drawn and read back.
[[nodiscard]] tl::expected<Rendering, std::string> render(const Options& options);

// The static view that the options describe, seen from `camera`.
[[nodiscard]] StaticSetup static_setup(const Options& options, const Camera& camera);

[[nodiscard]] TruthOptions truth_options(const Options& options);

}  // namespace alcove::sample
