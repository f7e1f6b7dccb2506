#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/options.h"

namespace CLI {
class App;
}  // namespace CLI

// Each function adds a group of options to a command, with their names, their help and the
// functions that convert their values. An invalid value throws a Mistake while CLI11 parses. The
// second argument receives the values and must outlive the parsing. It keeps its contents if an
// option is not given.
namespace alcove::sample {

void add_scene(CLI::App& app, std::string& scene);
void add_scenes(CLI::App& app, std::vector<std::string>& scenes);
void add_view(CLI::App& app, ViewOptions& view);
// Adds --frames and --orbit, for commands whose camera may orbit from frame to frame.
void add_course(CLI::App& app, ViewOptions& view, const std::string& frames_help);
// Adds --frames, for commands whose camera is static.
void add_standing(CLI::App& app, ViewOptions& view);
void add_motion(CLI::App& app, Options& options);
// Adds the options of the occlusion, and the list of settings for --set at the end of the help.
void add_occlusion(CLI::App& app, OcclusionOptions& occlusion);
// Adds the options of commands that render specular occlusion.
void add_roughness(CLI::App& app, OcclusionOptions& occlusion);
// Adds the options of commands that trace a truth.
void add_rays(CLI::App& app, OcclusionOptions& occlusion);
void add_no_cache(CLI::App& app, bool& use_cache);
// Adds the limits of the command `recommend`.
void add_limits(CLI::App& app, Options& options);
// Adds --clock, which selects the times that `bench` and `recommend` compare.
void add_clock(CLI::App& app, std::optional<Clock>& clock);
// Adds the options of `cost`: the GPU, the image size, and the output files.
void add_cost(CLI::App& app, Options& options);
// Adds --target-size and --gpu, for which times are modelled.
void add_target(CLI::App& app, Options& options);
// Adds --sizes and --frames of `measure`.
void add_sizes(CLI::App& app, Options& options);
// Adds the option of `bench` that measures the grid of steps and slices.
void add_grid(CLI::App& app, bool& grid);
// Adds the options of `doctor`: --mistakes and --pictures.
void add_doctor(CLI::App& app, Options& options);
void add_light(CLI::App& app, Options& options);
void add_materials(CLI::App& app, MaterialTreatment& materials);
void add_split(CLI::App& app, bool& split);
void add_lit(CLI::App& app, bool& lit, std::uint32_t& points);
void add_format(CLI::App& app, GraphFormat& format);
void add_device(CLI::App& app, Options& options);
void add_out(CLI::App& app, Options& options, const std::string& help);

// Throws a Mistake if options that are valid alone contradict each other.
void check_together(const Options& options);

}  // namespace alcove::sample
