#include "options.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <map>

namespace alcove::sample {
namespace {

using Values = std::vector<float>;

// What CLI11 fills in before the values are checked and converted.
struct Raw {
  Options options;
  std::string eye, target, up, size, far_plane, roughness;
  std::vector<std::string> set;
  double fov_y = 0, ortho_height = 0, near_plane = 0, radius = 0, orbit = 0;
  double budget_ms = 0, tolerance = 0;
  int64_t frames = 0, spp = 256;  // 0 frames: as many as the command draws by itself
  bool no_cache = false;
};

// Thrown within parse_options only, as CLI11's own errors are.
struct Mistake {
  std::string text;
};

[[noreturn]] void refuse(const std::string& option, const std::string& given,
                         const std::string& wanted) {
  throw Mistake{option + " " + given + ": give " + wanted};
}

bool number_of(const std::string& text, float& out) {
  size_t used = 0;
  try {
    out = std::stof(text, &used);
  } catch (const std::exception&) {
    return false;
  }
  return used == text.size() && !std::isnan(out);
}

// Numbers between commas; empty where any is malformed.
Values numbers_of(const std::string& text) {
  Values values;
  size_t start = 0;
  while (start <= text.size()) {
    const size_t comma = std::min(text.find(',', start), text.size());
    float value = 0;
    if (!number_of(text.substr(start, comma - start), value)) return {};
    values.push_back(value);
    start = comma + 1;
  }
  return values;
}

std::optional<glm::vec3> vector_of(const std::string& option, const std::string& text) {
  if (text.empty()) return std::nullopt;
  const Values v = numbers_of(text);
  if (v.size() != 3 || !std::isfinite(v[0] + v[1] + v[2])) {
    refuse(option, text, "three numbers, such as 0,1.5,-2");
  }
  return glm::vec3(v[0], v[1], v[2]);
}

void read_size(const std::string& text, ViewOptions& view) {
  if (text.empty()) return;
  constexpr unsigned long kLargest = 16384;
  unsigned long width = 0, height = 0;
  int used = 0;
  const bool fits = text.size() < 16 &&
                    text.find_first_not_of("0123456789x") == std::string::npos &&
                    std::sscanf(text.c_str(), "%lux%lu%n", &width, &height, &used) == 2 &&
                    static_cast<size_t>(used) == text.size();
  if (!fits || width < 1 || height < 1 || width > kLargest || height > kLargest) {
    refuse("--size", text, "WIDTHxHEIGHT in pixels, each from 1 to 16384, such as 960x540");
  }
  view.width = static_cast<uint32_t>(width);
  view.height = static_cast<uint32_t>(height);
}

constexpr int64_t kMostFrames = 100000;
// Of `alcove motion`: fewer leave nothing to compare.
constexpr uint32_t kFewestPathFrames = 12;
constexpr uint32_t kPathFrames = 48;
// Of the commands that compare settings: as many as the history averages.
constexpr uint32_t kComparedFrames = 32;

bool positive(double value) { return std::isfinite(value) && value > 0.0; }

std::string shown(double value) {
  std::string text = std::to_string(value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

// Where the option was given: its value if it is a positive length, else a mistake.
void read_length(const CLI::App& app, const std::string& option, double value,
                 std::optional<float>& out) {
  if (app.count(option) == 0) return;
  if (!positive(value) || !positive(static_cast<float>(value))) {
    refuse(option, shown(value), "a length above 0, in the scene's units");
  }
  out = static_cast<float>(value);
}

void read_far(const std::string& text, ViewOptions& view) {
  if (text.empty()) return;
  float value = INFINITY;
  const bool infinite = text == "inf" || text == "infinity";
  if (!infinite && (!number_of(text, value) || !positive(value))) {
    refuse("--far", text, "a length above 0, or inf");
  }
  view.far_plane = value;
}

void check_together(const ViewOptions& view) {
  if (view.near_plane && view.far_plane && !(*view.near_plane < *view.far_plane)) {
    refuse("--near", shown(*view.near_plane), "a length below --far");
  }
  if (view.ortho_height && view.fov_y) {
    throw Mistake{"--ortho-height and --fov-y: give one, an orthographic view has no angle"};
  }
  if (view.ortho_height && view.far_plane && std::isinf(*view.far_plane)) {
    throw Mistake{"--far inf: an orthographic view needs a finite --far"};
  }
}

uint32_t default_frames(Command command) {
  switch (command) {
    case Command::kMotion:
      return kPathFrames;
    case Command::kAblate:
    case Command::kBench:
    case Command::kRecommend:
      return kComparedFrames;
    case Command::kView:
      return 0;
    default:
      return 1;
  }
}

void read_frames(const CLI::App& app, const Raw& raw, Command command, ViewOptions& view) {
  const int64_t fewest = command == Command::kMotion ? kFewestPathFrames : 1;
  if (app.count("--frames") == 0) {
    view.frames = default_frames(command);
  } else if (raw.frames < fewest || raw.frames > kMostFrames) {
    refuse("--frames", std::to_string(raw.frames),
           "a number from " + std::to_string(fewest) + " to " + std::to_string(kMostFrames));
  } else {
    view.frames = static_cast<uint32_t>(raw.frames);
  }
}

void read_view(const CLI::App& app, const Raw& raw, ViewOptions& view) {
  view.eye_ws = vector_of("--eye", raw.eye);
  view.target_ws = vector_of("--target", raw.target);
  view.up_ws = vector_of("--up", raw.up);
  if (view.up_ws && *view.up_ws == glm::vec3(0.0f)) refuse("--up", raw.up, "a direction, not zero");
  read_size(raw.size, view);
  if (app.count("--fov-y")) {
    if (!(raw.fov_y >= 1.0 && raw.fov_y <= 170.0)) {
      refuse("--fov-y", shown(raw.fov_y), "the vertical angle of view in degrees, 1 to 170");
    }
    view.fov_y = glm::radians(static_cast<float>(raw.fov_y));
  }
  read_length(app, "--ortho-height", raw.ortho_height, view.ortho_height);
  read_length(app, "--near", raw.near_plane, view.near_plane);
  read_far(raw.far_plane, view);
  if (!std::isfinite(raw.orbit)) refuse("--orbit", "", "an angle in degrees");
  view.orbit = glm::radians(static_cast<float>(raw.orbit));
  check_together(view);
}

void read_occlusion(const CLI::App& app, const Raw& raw, OcclusionOptions& occlusion) {
  read_length(app, "--radius", raw.radius, occlusion.radius);
  for (const std::string& text : raw.set) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
      refuse("--set", text, "name=value, such as slices=2");
    }
    occlusion.set.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  if (raw.spp < 1 || raw.spp > 65536) {
    refuse("--spp", std::to_string(raw.spp), "rays per pixel, 1 to 65536");
  }
  occlusion.spp = static_cast<uint32_t>(raw.spp);
  if (raw.roughness.empty()) return;
  occlusion.roughness = numbers_of(raw.roughness);
  for (const float r : occlusion.roughness) {
    if (!(r >= 0.0f && r <= 1.0f)) occlusion.roughness.clear();
  }
  constexpr size_t kMost = 16;
  if (occlusion.roughness.empty() || occlusion.roughness.size() > kMost) {
    refuse("--roughness", raw.roughness, "up to 16 numbers from 0 to 1, such as 0.1,0.3,0.6");
  }
}

// An option that takes one of several names.
template <typename Choice>
CLI::Option* add_choice(CLI::App& app, const std::string& option, Choice& chosen,
                        const std::map<std::string, Choice>& by_name, const std::string& text) {
  const auto choose = [option, &chosen, by_name](const std::string& name) {
    const auto found = by_name.find(name);
    if (found != by_name.end()) {
      chosen = found->second;
      return;
    }
    std::string names;
    for (const auto& [known, meaning] : by_name) names += (names.empty() ? "" : ", ") + known;
    refuse(option, name, "one of " + names);
  };
  return app.add_option_function<std::string>(option, choose, text)->type_name("NAME");
}

void add_view(CLI::App& app, Raw& raw) {
  ViewOptions& view = raw.options.view;
  const std::string group = "View";
  app.add_option("--camera", view.camera, "a camera of the scene, by name; else its first")
      ->type_name("NAME")
      ->group(group);
  app.add_option("--eye", raw.eye, "where the camera stands, scene units")
      ->type_name("X,Y,Z")
      ->group(group);
  app.add_option("--target", raw.target, "what it looks at")->type_name("X,Y,Z")->group(group);
  app.add_option("--up", raw.up, "what is up; 0,1,0")->type_name("X,Y,Z")->group(group);
  app.add_option("--fov-y", raw.fov_y, "vertical angle of view; 60")
      ->type_name("DEGREES")
      ->group(group);
  app.add_option("--ortho-height", raw.ortho_height, "orthographic, so many units high")
      ->type_name("LENGTH")
      ->group(group);
  app.add_option("--near", raw.near_plane, "near plane")->type_name("LENGTH")->group(group);
  app.add_option("--far", raw.far_plane, "far plane, or inf")->type_name("LENGTH")->group(group);
  app.add_flag("--reversed-z", view.reversed_z, "near at depth 1, far at 0: finer far away")
      ->group(group);
  app.add_option("--size", raw.size, "of the image in pixels; 960x540")
      ->type_name("WxH")
      ->group(group);
}

void add_frames(CLI::App& app, Raw& raw, const std::string& group, const std::string& text) {
  app.add_option("--frames", raw.frames, text)->type_name("N")->group(group);
}

// Frames of a camera that may turn.
void add_course(CLI::App& app, Raw& raw, const std::string& text) {
  add_frames(app, raw, "View", text);
  app.add_option("--orbit", raw.orbit, "turn about the target by so much per frame")
      ->type_name("DEGREES")
      ->group("View");
}

void add_motion(CLI::App& app, Raw& raw) {
  static const std::map<std::string, std::optional<MotionKind>> kPaths = [] {
    std::map<std::string, std::optional<MotionKind>> paths{{"all", std::nullopt}};
    for (const MotionKind kind : kMotionKinds) paths[name_of(kind)] = kind;
    return paths;
  }();
  const std::string group = "Motion";
  add_choice(app, "--path", raw.options.path, kPaths,
             "orbit (about the middle of the view), dolly (towards it), strafe (past a column that "
             "is put near the eye), object (the camera stands, a block slides over the ground), "
             "cut (to elsewhere) or all of them; all")
      ->group(group);
  add_frames(app, raw, group,
             "how long each path is, from the view given on; three of its frames are compared with "
             "the ray-traced truth; 48");
}

void add_occlusion(CLI::App& app, Raw& raw) {
  OcclusionOptions& occlusion = raw.options.occlusion;
  static const std::map<std::string, Quality> kByName(kQualities.begin(), kQualities.end());
  static const std::map<std::string, NormalSource> kSources = {
      {"shading", NormalSource::kShading},
      {"geometric", NormalSource::kGeometric},
      {"depth", NormalSource::kDepth}};
  const std::string group = "Occlusion";
  add_choice(app, "--quality", occlusion.quality, kByName,
             "low, medium, high, ultra or reference; medium")
      ->group(group);
  app.add_option("--radius", raw.radius, "how far an occluder counts, scene units")
      ->type_name("LENGTH")
      ->group(group);
  app.add_option("--set", raw.set, "one parameter of the pass over the preset; may be repeated")
      ->type_name("NAME=VALUE")
      ->take_all()
      ->expected(1)
      ->group(group);
  add_choice(
      app, "--normals", occlusion.normals, kSources,
      "that the pass is given, and the truth with it: shading (of vertices and normal maps), "
      "geometric (of the triangles) or depth (made from the depth buffer); shading")
      ->group(group);
  app.add_option("--roughness", raw.roughness,
                 "perceptual roughness for specular occlusion over that of the materials; several "
                 "give several images")
      ->type_name("R,...")
      ->group(group);
  app.add_option("--spp", raw.spp, "rays per pixel of the truth; 256")
      ->type_name("N")
      ->group(group);
}

// The truth of a standing camera and what is compared with it.
void add_comparison(CLI::App& app, Raw& raw) {
  add_view(app, raw);
  add_frames(app, raw, "View",
             "how many are drawn with each setting, the camera standing; the last is compared; 32");
  add_occlusion(app, raw);
  app.add_flag("--no-cache", raw.no_cache, "compute the truths anew");
}

void add_limits(CLI::App& app, Raw& raw) {
  app.add_option("--budget-ms", raw.budget_ms,
                 "the most GPU time that the occlusion passes may take: the least error in it")
      ->type_name("MS");
  app.add_option("--tolerance", raw.tolerance,
                 "the most error, RMSE of visibility: the least time for it")
      ->type_name("E");
}

void read_limits(const CLI::App& app, const Raw& raw, Options& options) {
  if (app.count("--budget-ms") + app.count("--tolerance") != 1) {
    throw Mistake{"recommend: give either --budget-ms or --tolerance"};
  }
  if (app.count("--budget-ms") != 0) {
    if (!positive(raw.budget_ms)) {
      refuse("--budget-ms", shown(raw.budget_ms), "a time above 0 in milliseconds");
    }
    options.budget_ms = raw.budget_ms;
    return;
  }
  if (!positive(raw.tolerance)) refuse("--tolerance", shown(raw.tolerance), "an error above 0");
  options.tolerance = raw.tolerance;
}

void add_environment(CLI::App& app, Raw& raw) {
  app.add_option("--environment", raw.options.environment,
                 "light all around, an equirectangular .hdr or .exr; a sky that is made")
      ->type_name("FILE")
      ->group("Light");
}

void add_device(CLI::App& app, Raw& raw) {
  app.add_option("--device", raw.options.device,
                 "which Vulkan device, as `alcove doctor` numbers them")
      ->type_name("N")
      ->check(CLI::Range(0, 255).description(""));
  app.add_flag(
      "--validation", raw.options.validation,
      "run under the Khronos validation layers and the graph's own checks, and fail on any "
      "message");
}

void add_output(CLI::App& app, Raw& raw) {
  app.add_option("--out", raw.options.out, "folder for images and report.json; out")
      ->type_name("DIR");
  add_device(app, raw);
}

void add_scene(CLI::App& app, Raw& raw) {
  app.add_option("SCENE", raw.options.scene,
                 "a .gltf or .glb file, or one that is made: builtin (the default), plane:60, "
                 "groove:90, corner, sphere, pit, step")
      ->type_name("");
}

struct Subcommand {
  CLI::App* app;
  Command command;
};

std::vector<Subcommand> add_commands(CLI::App& app, Raw& raw) {
  static const std::map<std::string, GraphFormat> kFormats = {
      {"text", GraphFormat::kText}, {"json", GraphFormat::kJson}, {"dot", GraphFormat::kDot}};
  CLI::App* render = app.add_subcommand("render", "a scene to occlusion images and timings");
  CLI::App* compare = app.add_subcommand(
      "compare", "the same, and how far it is from the ray-traced and the height-field truth");
  for (CLI::App* sub : {render, compare}) {
    add_scene(*sub, raw);
    add_view(*sub, raw);
    add_course(*sub, raw, "how many to render; the last is written");
    add_occlusion(*sub, raw);
    add_environment(*sub, raw);
    add_output(*sub, raw);
  }
  compare->add_flag("--lit", raw.options.lit,
                    "path trace the picture lit by the environment too, and say how far it is off "
                    "without occlusion and with each part of it; takes minutes");
  compare->add_flag("--no-cache", raw.no_cache, "compute the truths anew");
  CLI::App* motion = app.add_subcommand(
      "motion", "how far it is from the truth while camera or things move, beside standing still");
  add_scene(*motion, raw);
  add_motion(*motion, raw);
  add_view(*motion, raw);
  add_occlusion(*motion, raw);
  add_output(*motion, raw);
  motion->add_flag("--no-cache", raw.no_cache, "compute the truths anew");
  CLI::App* ablate = app.add_subcommand(
      "ablate", "what each part of the occlusion costs and what it buys, one row for each");
  add_scene(*ablate, raw);
  add_comparison(*ablate, raw);
  add_output(*ablate, raw);
  CLI::App* bench = app.add_subcommand(
      "bench",
      "the trade of speed for accuracy: time and error of many settings, as a table, a plot "
      "and JSON");
  bench
      ->add_option("SCENE", raw.options.scenes, "any number of scenes, each seen by its own camera")
      ->type_name("");
  add_comparison(*bench, raw);
  add_output(*bench, raw);
  CLI::App* recommend = app.add_subcommand(
      "recommend", "the least settings that hold: within a time, or within an error");
  add_scene(*recommend, raw);
  add_limits(*recommend, raw);
  add_comparison(*recommend, raw);
  add_device(*recommend, raw);
  CLI::App* graph = app.add_subcommand("graph", "the compiled plan of a frame; needs no device");
  add_view(*graph, raw);
  add_course(*graph, raw, "how many to render; the last is written");
  add_occlusion(*graph, raw);
  add_choice(*graph, "--format", raw.options.graph_format, kFormats,
             "text, json or dot (Graphviz); text");
  CLI::App* view = app.add_subcommand(
      "view", "a window to orbit a scene in and see what each setting does and costs");
  add_scene(*view, raw);
  add_view(*view, raw);
  add_course(*view, raw, "how many to draw; else until the window is closed");
  add_occlusion(*view, raw);
  add_environment(*view, raw);
  view->add_option("--out", raw.options.out,
                   "folder for screenshots, else where alcove was started; with it, the last of "
                   "--frames is written too")
      ->type_name("DIR");
  add_device(*view, raw);
  CLI::App* doctor = app.add_subcommand("doctor", "the Vulkan devices here and what they lack");
  return {
      {render, Command::kRender}, {compare, Command::kCompare}, {motion, Command::kMotion},
      {ablate, Command::kAblate}, {bench, Command::kBench},     {recommend, Command::kRecommend},
      {graph, Command::kGraph},   {view, Command::kView},       {doctor, Command::kDoctor}};
}

Options finished(const CLI::App& app, const Raw& raw, Command command) {
  Options options = raw.options;
  options.command = command;
  options.use_cache = !raw.no_cache;
  if (command == Command::kDoctor) return options;
  if (command == Command::kView && app.count("--out") == 0) options.out.clear();
  read_view(app, raw, options.view);
  read_frames(app, raw, command, options.view);
  read_occlusion(app, raw, options.occlusion);
  if (command == Command::kRecommend) read_limits(app, raw, options);
  return options;
}

// CLI11's own words, as one line.
std::string one_line(std::string text) {
  for (char& c : text) {
    if (c == '\n') c = ' ';
  }
  return text;
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
      "  alcove render --eye -6,0.55,-4.6 --target 0,0.75,-2.9 --quality ultra",
      "alcove");
  Raw raw;
  const std::vector<Subcommand> commands = add_commands(app, raw);
  app.require_subcommand(1);
  app.footer("`alcove COMMAND --help` has the options of each.");
  try {
    app.parse(argc, argv);
    for (const auto& [sub, command] : commands) {
      if (sub->parsed()) return finished(*sub, raw, command);
    }
  } catch (const CLI::CallForHelp&) {
    for (const auto& [sub, command] : commands) {
      if (sub->count("--help")) return tl::unexpected(Stop{0, sub->help()});
    }
    return tl::unexpected(Stop{0, app.help()});
  } catch (const CLI::ParseError& error) {
    return tl::unexpected(Stop{2, one_line(error.what()) + "; see alcove --help"});
  } catch (const Mistake& mistake) {
    return tl::unexpected(Stop{2, mistake.text});
  }
  return tl::unexpected(Stop{2, "name a command; see alcove --help"});
}

tl::expected<Camera, std::string> camera_of(const ViewOptions& view, const Scene& scene) {
  const Camera* named = find_camera(scene, view.camera);
  if (!named && !view.camera.empty()) {
    std::string names;
    for (const Camera& camera : scene.cameras) names += " " + camera.name;
    return tl::unexpected("the scene has no camera " + view.camera + "; it has" +
                          (names.empty() ? " none: use --eye and --target" : ":" + names));
  }
  Camera camera = named ? *named : framing_camera(scene.bounds_ws);
  camera.eye_ws = view.eye_ws.value_or(camera.eye_ws);
  camera.target_ws = view.target_ws.value_or(camera.target_ws);
  camera.up_ws = view.up_ws.value_or(camera.up_ws);
  camera.near_plane = view.near_plane.value_or(camera.near_plane);
  camera.far_plane = view.far_plane.value_or(camera.far_plane);
  camera.reversed_z = camera.reversed_z || view.reversed_z;
  if (view.fov_y) {
    camera.orthographic = false;
    camera.fov_y = *view.fov_y;
  }
  if (view.ortho_height) {
    camera.orthographic = true;
    camera.ortho_height = *view.ortho_height;
    if (std::isinf(camera.far_plane)) camera.far_plane = 1000.0f * camera.ortho_height;
  }
  if (camera.eye_ws == camera.target_ws) {
    return tl::unexpected<std::string>("--eye and --target are one point: move one of them");
  }
  if (!(camera.near_plane < camera.far_plane)) {
    return tl::unexpected("the near plane (" + shown(camera.near_plane) +
                          ") is not before the far plane (" + shown(camera.far_plane) +
                          "): give --near and --far");
  }
  return camera;
}

}  // namespace alcove::sample
