#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/options.h"

namespace CLI {
class App;
}  // namespace CLI

// Each function adds some options to a command: their names, what --help says of them, what they
// take, and where that goes. A value that does not fit throws a Mistake while CLI11 parses. The
// second argument outlives the parsing; what it has before is what stays where nothing is typed.
namespace alcove::sample {

void add_scene(CLI::App& app, std::string& scene);
void add_scenes(CLI::App& app, std::vector<std::string>& scenes);
void add_view(CLI::App& app, ViewOptions& view);
// Frames of a camera that may turn.
void add_course(CLI::App& app, ViewOptions& view, const std::string& frames_help);
// How many frames a camera that stands is drawn.
void add_standing(CLI::App& app, ViewOptions& view);
void add_motion(CLI::App& app, Options& options);
// With the settings that --set knows at the end of the help.
void add_occlusion(CLI::App& app, OcclusionOptions& occlusion);
// For commands that draw specular occlusion.
void add_roughness(CLI::App& app, OcclusionOptions& occlusion);
// For commands that trace a truth.
void add_rays(CLI::App& app, OcclusionOptions& occlusion);
void add_no_cache(CLI::App& app, bool& use_cache);
// What `recommend` keeps to.
void add_limits(CLI::App& app, Options& options);
// For `cost`: which GPU, which image, and where to write.
void add_cost(CLI::App& app, Options& options);
// For `bench`: the table of steps and slices.
void add_grid(CLI::App& app, bool& grid);
// For `doctor`: planted mistakes and their pictures.
void add_doctor(CLI::App& app, Options& options);
void add_light(CLI::App& app, Options& options);
void add_materials(CLI::App& app, MaterialTreatment& materials);
void add_lit(CLI::App& app, bool& lit, std::uint32_t& points);
void add_format(CLI::App& app, GraphFormat& format);
void add_device(CLI::App& app, Options& options);
void add_out(CLI::App& app, Options& options, const std::string& help);

// Throws a Mistake where options that are fine alone are not beside each other.
void check_together(const Options& options);

}  // namespace alcove::sample
