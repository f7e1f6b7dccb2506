#pragma once

#include <string>

#include "cli/options.h"
#include "render/session.h"
#include "support/result.h"

namespace alcove::sample {

struct SceneViewRequest;

// The subcommands of `alcove`, a file each. They print to stdout; an error is one sentence.
[[nodiscard]] Result<void> run_render(const Options& options);
[[nodiscard]] Result<void> run_compare(const Options& options);
[[nodiscard]] Result<void> run_motion(const Options& options);
[[nodiscard]] Result<void> run_recommend(const Options& options);
[[nodiscard]] Result<void> run_cost(const Options& options);
[[nodiscard]] Result<void> run_measure(const Options& options);
[[nodiscard]] Result<void> run_report(const Options& options);

// Returns the compiled plan of a frame of the session as text.
[[nodiscard]] Result<std::string> plan_text(const Session& session, const Options& options);
[[nodiscard]] Result<void> run_graph(const Options& options);
// Returns the request for the window that the options describe.
[[nodiscard]] SceneViewRequest scene_view_request(const Options& options);
[[nodiscard]] Result<void> run_view(const Options& options);
[[nodiscard]] Result<void> run_doctor(const Options& options);

}  // namespace alcove::sample
