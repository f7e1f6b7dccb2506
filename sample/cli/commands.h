#pragma once

#include <string>
#include <tl/expected.hpp>

#include "cli/options.h"
#include "render/session.h"

namespace alcove::sample {

// The subcommands of `alcove`, a file each. They print to stdout; an error is one sentence.
[[nodiscard]] tl::expected<void, std::string> run_render(const Options& options);
[[nodiscard]] tl::expected<void, std::string> run_compare(const Options& options);
[[nodiscard]] tl::expected<void, std::string> run_motion(const Options& options);
[[nodiscard]] tl::expected<void, std::string> run_ablate(const Options& options);
[[nodiscard]] tl::expected<void, std::string> run_bench(const Options& options);
[[nodiscard]] tl::expected<void, std::string> run_recommend(const Options& options);
[[nodiscard]] tl::expected<void, std::string> run_cost(const Options& options);
[[nodiscard]] tl::expected<void, std::string> run_measure(const Options& options);
[[nodiscard]] tl::expected<void, std::string> run_report(const Options& options);

// Returns the compiled plan of a frame of the session as text.
[[nodiscard]] tl::expected<std::string, std::string> plan_text(const Session& session,
                                                               const Options& options);
[[nodiscard]] tl::expected<void, std::string> run_graph(const Options& options);
[[nodiscard]] tl::expected<void, std::string> run_view(const Options& options);
[[nodiscard]] tl::expected<void, std::string> run_doctor(const Options& options);

}  // namespace alcove::sample
