// Converts command-line options into the inputs of the other folders of the sample.
#pragma once

#include <string>
#include <vector>

#include "cli/options.h"
#include "evaluate/situations.h"
#include "evaluate/truths.h"
#include "render/rendering.h"
#include "render/session.h"
#include "support/result.h"

namespace alcove::sample {

// Loads the scene and chooses camera and settings; the session has no device. Prints notes about
// the scene, and progress if loading takes long, on stderr.
[[nodiscard]] Result<Session> load_session(const Options& options);

// Loads the scene, chooses camera and settings and opens the device, in this order, so that errors
// that are quick to find are reported first. `surface_extensions` are the instance extensions for
// presenting to a window.
[[nodiscard]] Result<Session> open_session(const Options& options,
                                           const std::vector<const char*>& surface_extensions = {});

// Opens the session that the options describe, renders it and reads the images back.
[[nodiscard]] Result<Rendering> render(const Options& options);

// The times by the options' clock at the size for which they are wanted. Borrows the session.
[[nodiscard]] Result<SettingTimes> setting_times(const Options& options, const Session& session);

// Their clock, and the size of the images that are timed.
[[nodiscard]] std::string clock_text(const Options& options, const Session& session);

[[nodiscard]] TruthOptions truth_options(const Options& options);

}  // namespace alcove::sample
