#include "cli/option_groups.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>
#include <tuple>
#include <utility>

#include "alcove/passes/setting_names.h"
#include "cli/option_value.h"
#include "cli/settings.h"

namespace alcove::sample {
namespace {

// Adds options under one heading of the help.
class Group {
 public:
  explicit Group(CLI::App& app, std::string heading = "Options")
      : app_(app), heading_(std::move(heading)) {}

  using Read = std::function<void(const OptionValue& given)>;
  // Adds an option with a value, which --help names `type`. `read` receives the value. If the
  // option is given several times, it receives the last value only.
  void add(const std::string& option, const std::string& type, const std::string& help,
           const Read& read) const {
    const auto typed = [option, read](const std::string& text) { read({option, text}); };
    app_.add_option_function<std::string>(option, typed, help)
        ->type_name(type)
        ->take_last()
        ->group(heading_);
  }
  // Adds an option that may be given several times. `read` receives every value.
  void add_repeatable(const std::string& option, const std::string& type, const std::string& help,
                      const Read& read) const {
    const auto typed = [option, read](const std::vector<std::string>& texts) {
      for (const std::string& text : texts) read({option, text});
    };
    app_.add_option_function<std::vector<std::string>>(option, typed, help)
        ->type_name(type)
        ->take_all()
        ->expected(1)
        ->group(heading_);
  }
  // Adds an option with the name of a file or folder.
  void add_path(const std::string& option, const std::string& type, const std::string& help,
                std::filesystem::path& path) const {
    add(option, type, help, [&path](const OptionValue& given) { path = given.text; });
  }
  // Adds an option with the size of an image.
  void add_size(const std::string& option, const std::string& help, std::uint32_t& width,
                std::uint32_t& height) const {
    add(option, "WxH", help,
        [&](const OptionValue& given) { std::tie(width, height) = given.size(); });
  }
  // Adds an option without a value, which sets `flag`, a bool or an optional one, to `meaning`.
  template <class Flag>
  void add_flag(const std::string& option, const std::string& help, Flag& flag,
                bool meaning = true) const {
    app_.add_flag_callback(
            option, [&flag, meaning] { flag = meaning; }, help)
        ->group(heading_);
  }

 private:
  CLI::App& app_;
  std::string heading_;
};

void add_frames(const Group& group, ViewOptions& view, std::int64_t fewest,
                const std::string& help) {
  group.add("--frames", "N", help, [&view, fewest](const OptionValue& given) {
    const std::string wanted = fmt::format("a number from {} to 100000", fewest);
    view.frames = static_cast<std::uint32_t>(given.whole_number(fewest, 100000, wanted));
  });
}

// Throws a Mistake if a near or far plane is at the eye or behind it. Only orthographic views may
// have such planes.
void check_plane(const std::string& option, const std::optional<float>& plane,
                 const ViewOptions& view) {
  if (plane && !(*plane > 0.0f) && !view.ortho_height) {
    throw Mistake{option + " " + shown(*plane) +
                  ": give a length above 0, in the scene's units, or --ortho-height too"};
  }
}

void check_view(const ViewOptions& view) {
  check_plane("--near", view.near_plane, view);
  check_plane("--far", view.far_plane, view);
  if (view.near_plane && view.far_plane && !(*view.near_plane < *view.far_plane))
    throw Mistake{"--near " + shown(*view.near_plane) + ": give a length below --far"};
  if (view.ortho_height && view.fov_y)
    throw Mistake{"--ortho-height and --fov-y: give one, an orthographic view has no angle"};
  if (view.ortho_height && view.far_plane && std::isinf(*view.far_plane))
    throw Mistake{"--far inf: an orthographic view needs a finite --far"};
}

void add_radius(const Group& group, OcclusionOptions& occlusion) {
  group.add(
      "--radius", "LENGTH",
      "distance up to which occluders count, scene units. Default: from the geometry that the view "
      "shows; the program prints it and why",
      [&](const OptionValue& given) { occlusion.radius = given.length(); });
}

}  // namespace

void add_scene(CLI::App& app, std::string& scene) {
  app.add_option(
         "SCENE", scene,
         "a .gltf or .glb file, or a scene that the program generates: builtin (the default), "
         "fence, terrain, plane:60, groove:90, corner, sphere, pit or step")
      ->type_name("");
}

void add_scenes(CLI::App& app, std::vector<std::string>& scenes) {
  app.add_option("SCENE", scenes, "any number of scenes; each is rendered with its own camera")
      ->type_name("");
}

void add_view(CLI::App& app, ViewOptions& view) {
  const Group group(app, "View");
  group.add(
      "--camera", "NAME",
      "name of a camera of the scene. Default: the first one, or a view of the whole scene if "
      "the scene has no camera",
      [&](const OptionValue& given) { view.camera = given.text; });
  group.add("--eye", "X,Y,Z", "position of the camera, scene units",
            [&](const OptionValue& given) { view.eye = given.vector(); });
  group.add("--target", "X,Y,Z", "point that the camera looks at, scene units",
            [&](const OptionValue& given) { view.target = given.vector(); });
  group.add("--up", "X,Y,Z", "direction that is upwards in the image. Default: 0,1,0",
            [&](const OptionValue& given) {
              view.up_ws = given.vector();
              if (*view.up_ws == glm::vec3(0.0f)) given.refuse("a direction, not zero");
            });
  group.add("--fov-y", "DEGREES", "vertical angle of view. Default: that of the camera",
            [&](const OptionValue& given) {
              // Cameras of scene files may have the same angles.
              view.fov_y = glm::radians(static_cast<float>(given.number(
                  0.001, 178.0, "the vertical angle of view in degrees, 0.001 to 178")));
            });
  group.add("--ortho-height", "LENGTH",
            "makes the view orthographic, with an image of this height in scene units",
            [&](const OptionValue& given) { view.ortho_height = given.length(); });
  constexpr double kLargest = std::numeric_limits<float>::max();
  group.add("--near", "LENGTH",
            "distance of the near plane. Default: that of the scene's camera, or fitted to the "
            "geometry in view. In an orthographic view it may be negative (behind the eye)",
            [&](const OptionValue& given) {
              view.near_plane = static_cast<float>(
                  given.number(-kLargest, kLargest, "a length above 0, in the scene's units"));
            });
  group.add("--far", "LENGTH", "distance of the far plane, or inf. Default: as for --near",
            [&](const OptionValue& given) {
              const bool infinite = given.text == "inf" || given.text == "infinity";
              view.far_plane = infinite ? std::numeric_limits<float>::infinity()
                                        : static_cast<float>(given.number(
                                              -kLargest, kLargest, "a length above 0, or inf"));
            });
  group.add_flag("--reversed-z",
                 "near plane at depth 1, far plane at 0. Default in perspective views",
                 view.reversed_z, true);
  group.add_flag("--standard-z",
                 "near plane at depth 0, far plane at 1. Default in orthographic views",
                 view.reversed_z, false);
  group.add_size(
      "--size", fmt::format("size of the image in pixels. Default: {}x{}", view.width, view.height),
      view.width, view.height);
}

void add_course(CLI::App& app, ViewOptions& view, const std::string& frames_help) {
  const Group group(app, "View");
  add_frames(group, view, 1, frames_help);
  group.add("--orbit", "DEGREES",
            "angle by which the camera orbits its target from frame to frame. Default: 0",
            [&](const OptionValue& given) {
              view.orbit = glm::radians(static_cast<float>(
                  given.number(-360.0, 360.0, "an angle in degrees, -360 to 360")));
            });
}

void add_standing(CLI::App& app, ViewOptions& view) {
  view.frames = 32;  // the number of frames that the history averages
  add_frames(
      Group(app, "View"), view, 1,
      "number of frames of a static camera that are rendered with each setting; the last one is "
      "compared. Default: 32");
}

void add_motion(CLI::App& app, Options& options) {
  const Group group(app, "Motion");
  group.add("--path", "NAME",
            "orbit (around the middle of the view), dolly (towards it), strafe (past a column that "
            "is added near the eye), object (static camera, a block slides over the ground), cut "
            "(the camera jumps to another place) or all. Default: all",
            [&](const OptionValue& given) {
              options.path = given.one_of_or<MotionKind>(kMotionKindNames, "all");
            });
  constexpr std::int64_t kFewest = 12;  // with fewer frames there is nothing to compare
  options.view.frames = 48;
  add_frames(group, options.view, kFewest,
             "number of frames of each path, which begins at the given view. Three of them are "
             "compared with the ray-traced truth. Default: 48");
}

void add_occlusion(CLI::App& app, OcclusionOptions& occlusion) {
  const Group group(app, "Occlusion");
  group.add("--quality", "NAME",
            "preset: " + passes::names_text<passes::Quality>() + ". Default: medium",
            [&](const OptionValue& given) {
              occlusion.quality_given = true;
              occlusion.quality =
                  static_cast<passes::Quality>(given.one_of(passes::kNames<passes::Quality>));
            });
  add_radius(group, occlusion);
  group.add("--settings", "FILE",
            "settings that `alcove recommend --out` wrote. --set changes them further",
            [&](const OptionValue& given) {
              auto read = read_settings(given.text);
              if (!read) throw Mistake{"--settings: " + read.error()};
              occlusion.file = std::move(*read);
            });
  group.add_repeatable(
      "--set", "NAME=VALUE",
      "changes one setting of the preset; the settings are listed below. May be repeated",
      [&](const OptionValue& given) {
        const std::size_t equals = given.text.find('=');
        if (equals == std::string::npos || equals == 0 || equals + 1 == given.text.size()) {
          given.refuse("name=value, such as slices=2");
        }
        const std::string name = given.text.substr(0, equals);
        const std::string value = given.text.substr(equals + 1);
        if (const auto wanted = wanted_instead(name, value)) given.refuse(*wanted);
        occlusion.set.emplace_back(name, value);
      });
  group.add("--normals", "NAME",
            "normals that the occlusion pass and the truths use: shading (from vertices and normal "
            "maps), geometric (of the triangles) or depth (reconstructed from the depth buffer). "
            "Default: shading",
            [&](const OptionValue& given) {
              occlusion.normals = static_cast<NormalSource>(given.one_of(kNormalSourceNames));
            });
  app.footer(settings_help());
}

void add_roughness(CLI::App& app, OcclusionOptions& occlusion) {
  Group(app, "Occlusion")
      .add("--roughness", "R,...",
           "perceptual roughness for specular occlusion, instead of that of the materials. Each of "
           "several values gives an image of its own",
           [&](const OptionValue& given) {
             const std::string wanted =
                 "up to 16 numbers from 0 to 1, no two alike, such as 0.1,0.3,0.6";
             occlusion.roughness = given.numbers(16, 0.0f, 1.0f, wanted);
             // Names of output files contain the first six digits of the roughness, which must
             // therefore differ.
             std::vector<float> sorted = occlusion.roughness;
             std::ranges::sort(sorted);
             const auto alike = [](float a, float b) { return b - a < 1e-5f; };
             if (std::ranges::adjacent_find(sorted, alike) != sorted.end()) given.refuse(wanted);
           });
}

void add_rays(CLI::App& app, OcclusionOptions& occlusion) {
  Group(app, "Occlusion")
      .add("--spp", "N",
           fmt::format("rays per pixel of the ray-traced truth. No effect on commands without a "
                       "truth. Default: {}",
                       occlusion.spp),
           [&](const OptionValue& given) {
             occlusion.spp = static_cast<std::uint32_t>(
                 given.whole_number(1, 65536, "rays per pixel, 1 to 65536"));
           });
}

void add_no_cache(CLI::App& app, bool& use_cache) {
  Group(app).add_flag("--no-cache",
                      "compute the truths again instead of reading them from the cache on disk",
                      use_cache, false);
}

void add_limits(CLI::App& app, Options& options) {
  const Group group(app);
  group.add(
      "--budget-ms", "MS",
      "find the setting with the smallest error whose occlusion passes take at most this time",
      [&](const OptionValue& given) {
        options.budget_ms = given.positive("a time above 0 in milliseconds");
      });
  group.add("--situation", "NAME",
            "the situation whose error and time count: first (frame), moving (camera), standing "
            "(camera) or mix. Default: mix, in which the moving camera counts 60 %, the standing "
            "30 % and the first frame 10 %",
            [&](const OptionValue& given) {
              options.situation = given.one_of_or<Situation>(kSituationNames, "mix");
            });
  group.add_flag("--exhaustive",
                 "also measure each number of samples with and without a second depth layer, and "
                 "compare the best of them with the result. Takes minutes",
                 options.exhaustive);
  group.add_path("--out", "FILE", "also write the settings, for --settings", options.settings_out);
  group.add(
      "--tolerance", "E", "find the fastest setting whose RMSE of visibility is at most this error",
      [&](const OptionValue& given) { options.tolerance = given.positive("an error above 0"); });
}

void add_target(CLI::App& app, Options& options) {
  const Group group(app);
  group.add_size("--target-size",
                 "size of the image whose time counts; errors are measured at --size. Default: "
                 "1920x1080",
                 options.target_width, options.target_height);
  group.add(
      "--gpu", "NAME", "the GPU whose time is modelled: ps4 or rdna2. Default: rdna2",
      [&](const OptionValue& given) {
        constexpr std::array<std::string_view, 2> kNames{kGpuParts[0].name, kGpuParts[1].name};
        options.gpu = &kGpuParts[given.one_of(kNames)];
      });
}

void add_grid(CLI::App& app, bool& grid) {
  Group(app).add_flag(
      "--grid",
      "instead of the usual table, print the errors with 8 to 64 steps and 1 to 8 slices. All "
      "other settings are those of --quality and --set. Times are not measured",
      grid);
}

void add_clock(CLI::App& app, std::optional<Clock>& clock) {
  Group(app).add(
      "--clock", "NAME",
      "which time is compared: modelled (GPU time of an RDNA2 part by the cost model, "
      "the same in every run), timestamps (GPU time of the device) or processor (time "
      "of all threads). Default: timestamps on a GPU; on a software device modelled, or processor "
      "if the driver for the model is not installed",
      [&](const OptionValue& given) { clock = static_cast<Clock>(given.one_of(kClockNames)); });
}

void add_cost(CLI::App& app, Options& options) {
  const Group group(app, "Cost");
  group.add("--family", "NAME", "modelled GPU: bonaire (PS4-like) or navi21 (RDNA2). Default: both",
            [&](const OptionValue& given) {
              constexpr std::array<std::string_view, 2> kFamilies{"bonaire", "navi21"};
              options.cost.family = kFamilies[given.one_of(kFamilies)];
            });
  group.add_size("--size", "size of the image in pixels. Default: 1920x1080", options.view.width,
                 options.view.height);
  group.add_flag("--motion-vectors",
                 "model the passes with motion vectors as an input, which moving objects need",
                 options.cost.motion_vectors);
  group.add_flag("--area", "model the passes for images that are read and written in part",
                 options.cost.area);
  group.add_flag("--mask", "model the passes with a mask of surfaces", options.cost.mask);
  group.add_flag("--samples", "model the passes with depth of four samples per pixel",
                 options.cost.samples);
  group.add_flag("--outputs",
                 "also model the settings with bent normals and with specular occlusion, and print "
                 "the ratio of each frame's time to its time without this output",
                 options.cost.outputs);
  group.add_flag(
      "--loops",
      "also print the instructions of a wave by kind, and each loop that the compiler did "
      "not unroll with its iterations",
      options.cost.loops);
  group.add_path("--json", "FILE", "also write all figures as JSON", options.cost.json);
  group.add_path("--write-budget", "FILE",
                 "only write the costs of all presets into the file of limits that the tests check",
                 options.cost.budget);
  group.add_path("--chart", "FILE", "also write an SVG chart of the time of each pass",
                 options.cost.chart);
}

void add_sizes(CLI::App& app, Options& options) {
  const Group group(app);
  group.add("--sizes", "WxH,...",
            "sizes of the image in pixels. Default: 1920x1080,3840x2160,7680x4320",
            [&](const OptionValue& given) {
              options.sizes.clear();
              std::istringstream all(given.text + ",");
              for (std::string one; std::getline(all, one, ',');)
                options.sizes.push_back(OptionValue{given.option, one}.size());
            });
  add_frames(group, options.view, 1, "number of frames that are timed. Default: 200");
}

void add_doctor(CLI::App& app, Options& options) {
  const Group group(app);
  group.add_flag(
      "--mistakes",
      "draw the built-in scene with each of the usual mistakes of integration, and print what "
      "alcoveDiagnose reports",
      options.mistakes);
  group.add("--pictures", "FOLDER",
            "implies --mistakes; write a picture without mistakes and one with each mistake",
            [&](const OptionValue& given) {
              options.pictures = given.text;
              options.mistakes = true;
            });
  add_radius(group, options.occlusion);
}

void add_light(CLI::App& app, Options& options) {
  Group(app, "Light")
      .add_path("--environment", "FILE",
                "equirectangular image of the light, .hdr or .exr. Default: a generated sky",
                options.environment);
}

void add_materials(CLI::App& app, MaterialTreatment& materials) {
  const Group group(app);
  group.add_flag(
      "--cut-blends",
      "render alpha-blended materials as masks with a cutoff of 0.5, which suits foliage. "
      "Default: they are rendered opaque",
      materials.cut_blends);
  group.add_flag("--both-sides",
                 "draw the back faces of single-sided materials. Default: they are culled, as glTF "
                 "specifies",
                 materials.both_sides);
}

void add_split(CLI::App& app, bool& split) {
  Group(app).add_flag(
      "--split",
      "also render the view without each cause of the error, and print and draw the part of the "
      "squared error that is noise, filter and tiles, hidden surfaces, unknown thickness, "
      "occluders outside the image, and the rest",
      split);
}

void add_lit(CLI::App& app, bool& lit, std::uint32_t& points) {
  Group(app).add_flag(
      "--lit",
      "also path trace the scene lit by the environment, and print the error of the lit "
      "picture without occlusion and with each part of the occlusion. Takes minutes",
      lit);
  Group(app).add(
      "--lit-points", "N",
      "approximate number of pixels at which multi-bounce, specular occlusion and the lit "
      "picture are traced, one per square block of the image. Default: 32000",
      [&](const OptionValue& given) {
        points = static_cast<std::uint32_t>(
            given.whole_number(1, 100'000'000, "pixels, 1 to 100000000"));
      });
}

void add_format(CLI::App& app, GraphFormat& format) {
  Group(app).add("--format", "NAME",
                 "text, dot (Graphviz), or work (the work as data). Default: text",
                 [&](const OptionValue& given) {
                   format = static_cast<GraphFormat>(given.one_of(kGraphFormatNames));
                 });
}

void add_device(CLI::App& app, Options& options) {
  const Group group(app);
  group.add(
      "--device", "N",
      "number of the Vulkan device in the list of `alcove doctor`. Default: the first discrete "
      "GPU, else the first integrated GPU, else any device",
      [&](const OptionValue& given) {
        options.device = static_cast<int>(given.whole_number(0, 255, "a number from 0 to 255"));
      });
  group.add_flag("--validation",
                 "run under the Khronos validation layers and the graph's own checks, and fail on "
                 "any message",
                 options.validation);
}

void add_out(CLI::App& app, Options& options, const std::string& help) {
  Group(app).add("--out", "DIR", help, [&](const OptionValue& given) {
    if (given.text.empty()) given.refuse("the name of a folder, such as out");
    options.out = given.text;
  });
}

void check_together(const Options& options) {
  check_view(options.view);
  if (options.split && options.view.orbit != 0.0f)
    throw Mistake{"--split and --orbit: give one, the error is split for a static camera"};
  if (options.command == Command::recommend &&
      options.budget_ms.has_value() == options.tolerance.has_value())
    throw Mistake{"recommend: give either --budget-ms or --tolerance"};
}

}  // namespace alcove::sample
