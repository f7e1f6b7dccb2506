#include "cli/option_groups.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
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
  // Adds an option with a value. --help calls the value `type`. `read` receives the value, and the
  // last one if the option is given several times.
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
  void add_flag(const std::string& option, const std::string& help, bool& flag,
                bool meaning = true) const {
    app_.add_flag_callback(
            option, [&flag, meaning] { flag = meaning; }, help)
        ->group(heading_);
  }

  void add_optional_flag(const std::string& option, const std::string& help,
                         std::optional<bool>& flag, bool meaning) const {
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
  constexpr std::int64_t kMost = 100000;
  group.add("--frames", "N", help, [&view, fewest](const OptionValue& given) {
    const std::string wanted =
        "a number from " + std::to_string(fewest) + " to " + std::to_string(kMost);
    view.frames = static_cast<std::uint32_t>(given.whole_number(fewest, kMost, wanted));
  });
}

// Reports a plane at the eye or behind it, which only an orthographic view may have.
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
  if (view.near_plane && view.far_plane && !(*view.near_plane < *view.far_plane)) {
    throw Mistake{"--near " + shown(*view.near_plane) + ": give a length below --far"};
  }
  if (view.ortho_height && view.fov_y) {
    throw Mistake{"--ortho-height and --fov-y: give one, an orthographic view has no angle"};
  }
  if (view.ortho_height && view.far_plane && std::isinf(*view.far_plane)) {
    throw Mistake{"--far inf: an orthographic view needs a finite --far"};
  }
}

}  // namespace

void add_scene(CLI::App& app, std::string& scene) {
  app.add_option("SCENE", scene,
                 "a .gltf or .glb file, or one that is made: builtin (the default), plane:60, "
                 "groove:90, corner, sphere, pit, step")
      ->type_name("");
}

void add_scenes(CLI::App& app, std::vector<std::string>& scenes) {
  app.add_option("SCENE", scenes, "any number of scenes, each seen by its own camera")
      ->type_name("");
}

void add_view(CLI::App& app, ViewOptions& view) {
  const Group group(app, "View");
  group.add("--camera", "NAME",
            "a camera of the scene, by name; else its first, else a view of all of it",
            [&](const OptionValue& given) { view.camera = given.text; });
  group.add("--eye", "X,Y,Z", "where the camera stands, scene units",
            [&](const OptionValue& given) { view.eye = given.vector(); });
  group.add("--target", "X,Y,Z", "what it looks at",
            [&](const OptionValue& given) { view.target = given.vector(); });
  group.add("--up", "X,Y,Z", "what is up; 0,1,0", [&](const OptionValue& given) {
    view.up_ws = given.vector();
    if (*view.up_ws == glm::vec3(0.0f)) given.refuse("a direction, not zero");
  });
  group.add(
      "--fov-y", "DEGREES", "vertical angle of view; the camera's", [&](const OptionValue& given) {
        // The range of a camera in a scene file.
        view.fov_y = glm::radians(static_cast<float>(
            given.number(0.001, 178.0, "the vertical angle of view in degrees, 0.001 to 178")));
      });
  group.add("--ortho-height", "LENGTH", "orthographic, so many units high",
            [&](const OptionValue& given) { view.ortho_height = given.length(); });
  constexpr double kLargest = std::numeric_limits<float>::max();
  group.add("--near", "LENGTH",
            "near plane; that of the scene's camera, or fitted to the geometry in view. That of an "
            "orthographic view may lie behind the eye",
            [&](const OptionValue& given) {
              view.near_plane = static_cast<float>(
                  given.number(-kLargest, kLargest, "a length above 0, in the scene's units"));
            });
  group.add("--far", "LENGTH", "far plane, or inf; as --near", [&](const OptionValue& given) {
    const bool infinite = given.text == "inf" || given.text == "infinity";
    view.far_plane =
        infinite
            ? std::numeric_limits<float>::infinity()
            : static_cast<float>(given.number(-kLargest, kLargest, "a length above 0, or inf"));
  });
  group.add_optional_flag("--reversed-z",
                          "near plane at depth 1, far plane at 0; the default in perspective",
                          view.reversed_z, true);
  group.add_optional_flag(
      "--standard-z", "near plane at depth 0, far plane at 1; the default in orthographic views",
      view.reversed_z, false);
  group.add("--size", "WxH", "of the image in pixels; 960x540",
            [&](const OptionValue& given) { std::tie(view.width, view.height) = given.size(); });
}

void add_course(CLI::App& app, ViewOptions& view, const std::string& frames_help) {
  const Group group(app, "View");
  add_frames(group, view, 1, frames_help);
  group.add("--orbit", "DEGREES", "turn about the target by so much per frame",
            [&](const OptionValue& given) {
              view.orbit = glm::radians(static_cast<float>(
                  given.number(-360.0, 360.0, "an angle in degrees, -360 to 360")));
            });
}

void add_standing(CLI::App& app, ViewOptions& view) {
  view.frames = 32;  // the number of frames that the history averages
  add_frames(Group(app, "View"), view, 1,
             "how many are drawn with each setting, the camera standing; the last is compared; 32");
}

void add_motion(CLI::App& app, Options& options) {
  const Group group(app, "Motion");
  group.add("--path", "NAME",
            "orbit (about the middle of the view), dolly (towards it), strafe (past a column that "
            "is put near the eye), object (the camera stands, a block slides over the ground), "
            "cut (to elsewhere) or all of them; all",
            [&](const OptionValue& given) {
              std::vector<std::string_view> names(kMotionKindNames.begin(), kMotionKindNames.end());
              names.emplace_back("all");
              const std::size_t which = given.one_of(names);
              options.path =
                  which < kMotionKinds.size() ? std::optional(kMotionKinds[which]) : std::nullopt;
            });
  constexpr std::int64_t kFewest = 12;  // with fewer frames there is nothing to compare
  options.view.frames = 48;
  add_frames(group, options.view, kFewest,
             "how long each path is, from the view given on; three of its frames are compared with "
             "the ray-traced truth; 48");
}

void add_occlusion(CLI::App& app, OcclusionOptions& occlusion) {
  const Group group(app, "Occlusion");
  group.add("--quality", "NAME", "console, low, medium, high or reference; medium",
            [&](const OptionValue& given) {
              occlusion.quality_given = true;
              occlusion.quality =
                  static_cast<passes::Quality>(given.one_of(passes::kNames<passes::Quality>));
            });
  group.add(
      "--radius", "LENGTH",
      "distance up to which occluders count, scene units; a twentieth of the scene's diagonal, "
      "without what only surrounds it",
      [&](const OptionValue& given) { occlusion.radius = given.length(); });
  group.add_repeatable(
      "--set", "NAME=VALUE", "one of the settings below over the preset; may be repeated",
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
            "that the pass is given, and the truth with it: shading (of vertices and normal maps), "
            "geometric (of the triangles) or depth (made from the depth buffer); shading",
            [&](const OptionValue& given) {
              occlusion.normals = static_cast<NormalSource>(given.one_of(kNormalSourceNames));
            });
  app.footer(settings_help());
}

void add_roughness(CLI::App& app, OcclusionOptions& occlusion) {
  Group(app, "Occlusion")
      .add("--roughness", "R,...",
           "perceptual roughness for specular occlusion over that of the materials; several give "
           "several images",
           [&](const OptionValue& given) {
             const std::string wanted =
                 "up to 16 numbers from 0 to 1, no two alike, such as 0.1,0.3,0.6";
             occlusion.roughness = given.numbers(16, 0.0f, 1.0f, wanted);
             // Output files are named by the first six digits of the roughness, which must
             // therefore differ.
             std::vector<float> sorted = occlusion.roughness;
             std::ranges::sort(sorted);
             const auto alike = [](float a, float b) { return b - a < 1e-5f; };
             if (std::ranges::adjacent_find(sorted, alike) != sorted.end()) given.refuse(wanted);
           });
}

void add_rays(CLI::App& app, OcclusionOptions& occlusion) {
  Group(app, "Occlusion")
      .add("--spp", "N", "rays per pixel of the truth; 256", [&](const OptionValue& given) {
        occlusion.spp =
            static_cast<std::uint32_t>(given.whole_number(1, 65536, "rays per pixel, 1 to 65536"));
      });
}

void add_no_cache(CLI::App& app, bool& use_cache) {
  Group(app).add_flag("--no-cache", "compute the truths anew", use_cache, false);
}

void add_limits(CLI::App& app, Options& options) {
  const Group group(app);
  group.add("--budget-ms", "MS",
            "the most GPU time that the occlusion passes may take: the least error in it",
            [&](const OptionValue& given) {
              options.budget_ms = given.positive("a time above 0 in milliseconds");
            });
  group.add(
      "--tolerance", "E", "the most error, RMSE of visibility: the least time for it",
      [&](const OptionValue& given) { options.tolerance = given.positive("an error above 0"); });
}

void add_grid(CLI::App& app, bool& grid) {
  Group(app).add_flag(
      "--grid",
      "instead, a table of the error with 8 to 64 steps and 1 to 8 slices, all else "
      "as --quality and --set give it; nothing is timed",
      grid);
}

void add_cost(CLI::App& app, Options& options) {
  const Group group(app, "Cost");
  group.add("--family", "NAME", "the modelled GPU: bonaire (PS4-like) or navi21 (RDNA2); both",
            [&](const OptionValue& given) {
              constexpr std::array<std::string_view, 2> kFamilies{"bonaire", "navi21"};
              options.cost.family = kFamilies[given.one_of(kFamilies)];
            });
  group.add("--size", "WxH", "size of the image in pixels; 1920x1080",
            [&](const OptionValue& given) {
              std::tie(options.view.width, options.view.height) = given.size();
            });
  group.add_flag("--motion-vectors", "give the passes motion vectors, as a scene in motion does",
                 options.cost.motion_vectors);
  group.add_flag("--outputs",
                 "also model the settings with bent normals and with specular occlusion, and print "
                 "the ratio of each frame's time to its time without this output",
                 options.cost.outputs);
  group.add_flag("--loops",
                 "also print the instructions of a wave by kind, and the loops that the compiler "
                 "left with their iterations",
                 options.cost.loops);
  group.add("--json", "FILE", "also write all figures as JSON",
            [&](const OptionValue& given) { options.cost.json = given.text; });
  group.add("--write-budget", "FILE",
            "only write the costs of all presets, as the budget that the tests hold them to",
            [&](const OptionValue& given) { options.cost.budget = given.text; });
  group.add("--chart", "FILE", "also draw an SVG chart of where the time goes",
            [&](const OptionValue& given) { options.cost.chart = given.text; });
}

void add_doctor(CLI::App& app, Options& options) {
  const Group group(app);
  group.add_flag(
      "--mistakes",
      "plant each mistake of integration in frames of the built-in scene, and print what "
      "alcoveDiagnose says of it",
      options.mistakes);
  group.add("--pictures", "FOLDER", "write a picture without and with each mistake; as --mistakes",
            [&](const OptionValue& given) {
              options.pictures = given.text;
              options.mistakes = true;
            });
}

void add_light(CLI::App& app, Options& options) {
  Group(app, "Light")
      .add("--environment", "FILE",
           "light all around, an equirectangular .hdr or .exr; a sky that is made",
           [&](const OptionValue& given) { options.environment = given.text; });
}

void add_materials(CLI::App& app, MaterialTreatment& materials) {
  const Group group(app);
  group.add_flag("--cut-blends",
                 "cut alpha-blended materials out where their alpha is below a half, as foliage "
                 "needs it; without it they are rendered opaque",
                 materials.cut_blends);
  group.add_flag("--both-sides",
                 "draw single-sided materials from behind too; without it their back faces are "
                 "culled, as glTF asks for",
                 materials.both_sides);
}

void add_lit(CLI::App& app, bool& lit, std::uint32_t& points) {
  Group(app).add_flag("--lit",
                      "also path trace the picture lit by the environment, and print the error of "
                      "the lit picture without occlusion and with each part of it; takes minutes",
                      lit);
  Group(app).add("--lit-points", "N",
                 "pixels at which multi-bounce, specular occlusion and the lit picture are traced, "
                 "one in each square block; 32000",
                 [&](const OptionValue& given) {
                   points = static_cast<std::uint32_t>(
                       given.whole_number(1, 100'000'000, "pixels, 1 to 100000000"));
                 });
}

void add_format(CLI::App& app, GraphFormat& format) {
  Group(app).add("--format", "NAME", "text or dot (Graphviz); text", [&](const OptionValue& given) {
    format = static_cast<GraphFormat>(given.one_of(kGraphFormatNames));
  });
}

void add_device(CLI::App& app, Options& options) {
  const Group group(app);
  group.add("--device", "N", "which Vulkan device, as `alcove doctor` numbers them",
            [&](const OptionValue& given) {
              options.device =
                  static_cast<int>(given.whole_number(0, 255, "a number from 0 to 255"));
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
  if (options.command == Command::kRecommend &&
      options.budget_ms.has_value() == options.tolerance.has_value()) {
    throw Mistake{"recommend: give either --budget-ms or --tolerance"};
  }
}

}  // namespace alcove::sample
