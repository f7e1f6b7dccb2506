#include "cli/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "cli/option_groups.h"
#include "cli/option_value.h"

namespace alcove::sample {
namespace {

// Each of these functions adds the options of one command.
void add_output(CLI::App& app, Options& options) {
  add_out(app, options, "folder for images and report.json. Default: out");
  add_device(app, options);
}

// `render` and `graph` accept --spp without effect, so that the arguments of a `compare` command
// can be reused with them.
void add_render(CLI::App& app, Options& options) {
  add_scene(app, options.scene);
  add_materials(app, options.materials);
  add_view(app, options.view);
  add_course(app, options.view, "number of frames to render; the last one is written. Default: 1");
  add_occlusion(app, options.occlusion);
  add_rays(app, options.occlusion);
  add_roughness(app, options.occlusion);
  add_light(app, options);
  add_output(app, options);
}

void add_compare(CLI::App& app, Options& options) {
  add_render(app, options);
  add_split(app, options.split);
  add_lit(app, options.lit, options.lit_points);
  add_no_cache(app, options.use_cache);
}

void add_motion_command(CLI::App& app, Options& options) {
  add_scene(app, options.scene);
  add_materials(app, options.materials);
  add_motion(app, options);
  add_view(app, options.view);
  add_occlusion(app, options.occlusion);
  add_rays(app, options.occlusion);
  add_output(app, options);
  add_no_cache(app, options.use_cache);
}

// Adds the options for comparing a static camera with its truth.
void add_comparison(CLI::App& app, Options& options) {
  add_view(app, options.view);
  add_standing(app, options.view);
  add_occlusion(app, options.occlusion);
  add_rays(app, options.occlusion);
  add_no_cache(app, options.use_cache);
}

void add_ablate(CLI::App& app, Options& options) {
  add_scene(app, options.scene);
  add_materials(app, options.materials);
  add_clock(app, options.clock);
  add_comparison(app, options);
  add_output(app, options);
}

void add_bench(CLI::App& app, Options& options) {
  add_scenes(app, options.scenes);
  add_grid(app, options.grid);
  add_clock(app, options.clock);
  add_materials(app, options.materials);
  add_comparison(app, options);
  add_output(app, options);
}

void add_recommend(CLI::App& app, Options& options) {
  options.view.width = 480;
  options.view.height = 270;
  options.occlusion.spp = 64;
  add_scene(app, options.scene);
  add_materials(app, options.materials);
  add_limits(app, options);
  add_target(app, options);
  add_clock(app, options.clock);
  add_comparison(app, options);
  add_device(app, options);
}

void add_cost_command(CLI::App& app, Options& options) {
  options.view.width = 1920;
  options.view.height = 1080;
  add_cost(app, options);
  add_occlusion(app, options.occlusion);
}

void add_report(CLI::App& app, Options& options) {
  options.view.width = 480;
  options.view.height = 270;
  add_scenes(app, options.scenes);
  add_materials(app, options.materials);
  add_target(app, options);
  add_comparison(app, options);
  add_output(app, options);
}

void add_measure(CLI::App& app, Options& options) {
  options.view.frames = 200;
  add_scene(app, options.scene);
  add_materials(app, options.materials);
  add_sizes(app, options);
  add_view(app, options.view);
  add_occlusion(app, options.occlusion);
  add_output(app, options);
}

void add_graph(CLI::App& app, Options& options) {
  add_scene(app, options.scene);
  add_materials(app, options.materials);
  add_view(app, options.view);
  add_occlusion(app, options.occlusion);
  add_rays(app, options.occlusion);
  add_roughness(app, options.occlusion);
  add_format(app, options.graph_format);
  add_device(app, options);
}

void add_window(CLI::App& app, Options& options) {
  options.view.frames = 0;
  options.out.clear();
  add_scene(app, options.scene);
  add_materials(app, options.materials);
  add_view(app, options.view);
  add_course(app, options.view,
             "number of frames after which the window closes. Default: it stays open");
  add_occlusion(app, options.occlusion);
  add_roughness(app, options.occlusion);
  add_light(app, options);
  add_out(
      app, options,
      "folder for screenshots. Default: the current folder. If given, the last frame of --frames "
      "is written there too");
  add_device(app, options);
}

void add_doctor_command(CLI::App& app, Options& options) {
  options.view.width = 320;
  options.view.height = 180;
  add_scene(app, options.scene);
  add_materials(app, options.materials);
  add_doctor(app, options);
  add_view(app, options.view);
  add_device(app, options);
}

constexpr const char* kUse = "Commands";
constexpr const char* kLaboratory = "Laboratory, for measurements";

struct Entry {
  Command command;
  const char* group;
  const char* name;
  const char* help;
  void (*add_options)(CLI::App& app, Options& options);
};
constexpr std::array<Entry, 12> kCommands{{
    {Command::render, kUse, "render", "render a scene to occlusion images and print timings",
     add_render},
    {Command::view, kUse, "view",
     "open a window to orbit a scene, change settings and see their cost", add_window},
    {Command::compare, kUse, "compare",
     "render a scene and print the errors against ray-traced and height-field truth", add_compare},
    {Command::recommend, kUse, "recommend",
     "find the most accurate setting within a time, or the fastest within an error", add_recommend},
    {Command::graph, kUse, "graph", "print the compiled plan of a frame: passes, barriers, memory",
     add_graph},
    {Command::doctor, kUse, "doctor",
     "list the Vulkan devices and the features that they lack, or check a scene with "
     "alcoveDiagnose",
     add_doctor_command},
    {Command::motion, kLaboratory, "motion",
     "measure errors and flicker while the camera or an object moves", add_motion_command},
    {Command::ablate, kLaboratory, "ablate",
     "change one part of the occlusion at a time and print its cost and error", add_ablate},
    {Command::bench, kLaboratory, "bench",
     "measure time and error of many settings, and write a table, a plot and JSON", add_bench},
    {Command::cost, kLaboratory, "cost",
     "print registers, instructions and modelled time of the passes on two GPUs; needs no GPU",
     add_cost_command},
    {Command::measure, kLaboratory, "measure",
     "time each pass on the device, beside the times that the model of `cost` predicts",
     add_measure},
    {Command::report, kLaboratory, "report",
     "write a web page: error against time, pictures beside the truth, and what a scene requires",
     add_report},
}};

// Joins the lines of a message of CLI11.
std::string one_line(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

// Returns the help of the command for which it was requested, or an empty text if none was.
std::string help_of_command(const CLI::App& app) {
  for (const CLI::App* sub : app.get_subcommands())
    if (sub->count("--help") != 0) return sub->help(app.get_name());
  return "";
}

Stop no_command(const std::string& what) { return {2, what + "; see alcove --help"}; }

// Converts an error of CLI11 to a sentence that also names the --help to read.
Stop mistake_of(const CLI::App& app, const CLI::ParseError& error) {
  const auto commands = app.get_subcommands();
  if (commands.empty()) return no_command("name a command first");
  return {2, one_line(error.what()) + "; see alcove " + commands.front()->get_name() + " --help"};
}

bool is_command(const std::string& word) {
  return std::ranges::find(kCommands, word, &Entry::name) != kCommands.end();
}

}  // namespace

tl::expected<Options, Stop> parse_options(int argc, const char* const* argv) {
  CLI::App app(
      "Ambient occlusion of a scene, and how far it is from the truth.\n"
      "  alcove render scene.gltf --camera hall --out out\n"
      "  alcove compare groove:60 --radius 1\n"
      "  alcove motion scene.gltf --path strafe\n"
      "  alcove ablate scene.gltf --quality high\n"
      "  alcove recommend scene.gltf --tolerance 0.05\n"
      "  alcove render --eye -6,0.55,-4.6 --target 0,0.75,-2.9 --quality high",
      "alcove");
  std::array<Options, kCommands.size()> options;
  for (std::size_t i = 0; i < kCommands.size(); ++i) {
    options[i].command = kCommands[i].command;
    CLI::App& command = *app.add_subcommand(kCommands[i].name, kCommands[i].help);
    kCommands[i].add_options(*command.group(kCommands[i].group), options[i]);
  }
  app.require_subcommand(1);
  app.set_version_flag("--version", "alcove " ALCOVE_VERSION_TEXT);
  app.footer("`alcove COMMAND --help` lists the options of a command.");
  if (argc < 2) return tl::unexpected(no_command("name a command"));
  if (argv[1][0] != '-' && !is_command(argv[1]))
    return tl::unexpected(no_command("there is no command " + std::string(argv[1])));
  try {
    app.parse(argc, argv);
    for (std::size_t i = 0; i < kCommands.size(); ++i) {
      if (!app.got_subcommand(kCommands[i].name)) continue;
      check_together(options[i]);
      return options[i];
    }
  } catch (const CLI::CallForHelp&) {
    const std::string help = help_of_command(app);
    return tl::unexpected(Stop{0, help.empty() ? app.help() : help});
  } catch (const CLI::CallForVersion& version) {
    return tl::unexpected(Stop{0, version.what()});
  } catch (const CLI::ParseError& error) {
    return tl::unexpected(mistake_of(app, error));
  } catch (const Mistake& mistake) {
    const std::string help = help_of_command(app);
    if (!help.empty()) return tl::unexpected(Stop{0, help});
    return tl::unexpected(Stop{2, mistake.text});
  }
  return tl::unexpected(no_command("name a command"));
}

}  // namespace alcove::sample
