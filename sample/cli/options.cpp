#include "cli/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "cli/option_table.h"
#include "cli/settings.h"
#include "support/printable.h"
#include "viewer/panel.h"

namespace alcove::sample {
namespace {

constexpr const char* kUse = "Commands";
constexpr const char* kLaboratory = "Laboratory, for measurements";

enum class Scenes { none, one, many };

// A command with those of its defaults that differ from Options.
struct CommandRow {
  Command command;
  const char* group;
  const char* name;
  const char* help;
  Scenes scenes = Scenes::one;
  std::uint32_t width = 960, height = 540, frames = 1, spp = 256;
};

constexpr std::uint32_t kHistory = 32;  // frames that the history averages
constexpr std::array<CommandRow, 10> kCommands{{
    {Command::render, kUse, "render", "render a scene to occlusion images and print timings"},
    {Command::view, kUse, "view",
     "open a window to orbit a scene, change settings and see their cost", Scenes::one, 960, 540,
     0},
    {Command::compare, kUse, "compare",
     "render a scene and print the errors against ray-traced and height-field truth"},
    {Command::recommend, kUse, "recommend",
     "find the most accurate setting within a time, or the fastest within an error", Scenes::one,
     256, 144, kHistory, 64},
    {Command::report, kUse, "report",
     "write a web page: error against time, pictures beside the truth, and what a scene requires",
     Scenes::many, 480, 270, kHistory},
    {Command::graph, kUse, "graph", "print the compiled plan of a frame: passes, barriers, memory"},
    {Command::doctor, kUse, "doctor", "list the Vulkan devices and the features that they lack",
     Scenes::none},
    {Command::motion, kLaboratory, "motion",
     "measure errors and flicker while the camera or an object moves", Scenes::one, 960, 540, 48},
    {Command::cost, kLaboratory, "cost",
     "print registers, instructions and modelled time of the passes on three GPUs; needs no GPU",
     Scenes::none, 1920, 1080},
    {Command::measure, kLaboratory, "measure",
     "time each pass on the device, beside the times that the model of `cost` predicts",
     Scenes::one, 960, 540, 200},
}};

void add_command(CLI::App& app, const CommandRow& row, Options& options, bool all) {
  options.command = row.command;
  options.view.width = row.width;
  options.view.height = row.height;
  options.view.frames = row.frames;
  options.occlusion.spp = row.spp;
  if (row.command == Command::view) options.out.clear();
  if (row.scenes == Scenes::one) {
    app.add_option("SCENE", options.scene,
                   "a .gltf or .glb file, or a generated scene: builtin (the default),\n"
                   "fence, terrain, plane:60, groove:90, corner, sphere, pit or step")
        ->type_name("");
  } else if (row.scenes == Scenes::many) {
    app.add_option("SCENE", options.scenes,
                   "any number of scenes; each is rendered with its own camera")
        ->type_name("");
  }
  add_options(app, options, all);
  if (row.command == Command::doctor) return;
  std::string footer = all ? settings_help()
                           : "`alcove " + std::string(row.name) +
                                 " --help-all` lists every option, and the settings of --set.";
  if (row.command == Command::view) footer += std::string("\n\nMouse and keys:\n") + kMouseAndKeys;
  app.footer(footer);
}

// Shortens a message of CLI11, which may repeat an argument, and joins its lines.
std::string one_line(const std::string& text) {
  constexpr std::size_t kLongest = 160;
  return shortened(text, kLongest);
}

// Returns the help of the command for which it was requested, or an empty text if none was.
std::string requested_help(const CLI::App& app) {
  for (const CLI::App* sub : app.get_subcommands())
    if (sub->count("--help") != 0) return sub->help(app.get_name());
  return "";
}

Stop no_command(const std::string& what) { return {2, what + "; see alcove --help"}; }

// Converts an error of CLI11 to a sentence that also names the --help to read.
Stop to_stop(const CLI::App& app, const CLI::ParseError& error) {
  const auto commands = app.get_subcommands();
  if (commands.empty()) return no_command("name a command first");
  return {2, one_line(error.what()) + "; see alcove " + commands.front()->get_name() + " --help"};
}

bool is_command(const std::string& word) {
  return std::ranges::find(kCommands, word, &CommandRow::name) != kCommands.end();
}

}  // namespace

tl::expected<Options, Stop> parse_options(int argc, const char* const* argv) {
  CLI::App app(
      "Ambient occlusion of a scene, and how far it is from the truth.\n"
      "  alcove render scene.gltf --camera hall --out out\n"
      "  alcove compare groove:60 --radius 1\n"
      "  alcove motion scene.gltf --path orbit\n"
      "  alcove recommend scene.gltf --tolerance 0.05\n"
      "  alcove render --eye -6,0.55,-4.6 --target 0,0.75,-2.9 --quality high",
      "alcove");
  std::vector<const char*> words(argv, argv + argc);
  const auto help_all = std::ranges::find(words, std::string_view("--help-all"));
  const bool all = help_all != words.end();
  if (all) *help_all = "--help";
  std::array<Options, kCommands.size()> options;
  for (std::size_t i = 0; i < kCommands.size(); ++i) {
    const CommandRow& row = kCommands[i];
    add_command(*app.add_subcommand(row.name, row.help)->group(row.group), row, options[i], all);
  }
  app.require_subcommand(1);
  app.set_version_flag("--version", "alcove " ALCOVE_VERSION_TEXT);
  app.footer("`alcove COMMAND --help` lists the options of a command.");
  if (argc < 2) return tl::unexpected(no_command("name a command"));
  if (argv[1][0] != '-' && !is_command(argv[1]))
    return tl::unexpected(no_command("there is no command " + std::string(argv[1])));
  try {
    app.parse(argc, words.data());
    for (std::size_t i = 0; i < kCommands.size(); ++i) {
      if (!app.got_subcommand(kCommands[i].name)) continue;
      check_together(options[i]);
      if (options[i].gpu == nullptr && options[i].command != Command::cost)
        options[i].gpu = &kGpuParts[1];
      return options[i];
    }
  } catch (const CLI::CallForHelp&) {
    const std::string help = requested_help(app);
    return tl::unexpected(Stop{0, help.empty() ? app.help() : help});
  } catch (const CLI::CallForVersion& version) {
    return tl::unexpected(Stop{0, version.what()});
  } catch (const CLI::ParseError& error) {
    return tl::unexpected(to_stop(app, error));
  } catch (const Mistake& mistake) {
    const std::string help = requested_help(app);
    if (!help.empty()) return tl::unexpected(Stop{0, help});
    return tl::unexpected(Stop{2, mistake.text});
  }
  return tl::unexpected(no_command("name a command"));
}

}  // namespace alcove::sample
