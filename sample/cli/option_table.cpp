#include "cli/option_table.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>

#include "alcove/passes/setting_table.h"
#include "cli/settings.h"
#include "support/printable.h"

namespace alcove::sample {
namespace {

constexpr std::uint32_t bits(std::initializer_list<Command> commands) {
  std::uint32_t set = 0;
  for (const Command command : commands) set |= 1u << static_cast<std::uint32_t>(command);
  return set;
}

// Sets of commands.
constexpr std::uint32_t kRender = bits({Command::render});
constexpr std::uint32_t kView = bits({Command::view});
constexpr std::uint32_t kCompare = bits({Command::compare});
constexpr std::uint32_t kRecommend = bits({Command::recommend});
constexpr std::uint32_t kGraph = bits({Command::graph});
constexpr std::uint32_t kMotion = bits({Command::motion});
constexpr std::uint32_t kCost = bits({Command::cost});
constexpr std::uint32_t kMeasure = bits({Command::measure});
constexpr std::uint32_t kReport = bits({Command::report});
// All but `doctor`, which has no options.
constexpr std::uint32_t kAll =
    kRender | kView | kCompare | kRecommend | kGraph | kMotion | kCost | kMeasure | kReport;
constexpr std::uint32_t kOnDevice = kAll & ~kCost;
constexpr std::uint32_t kStatic = kRecommend | kReport;  // a static camera
constexpr std::uint32_t kWithTruth = kStatic | kCompare | kMotion;
// Added to a set: few users need the option, and only --help-all lists it.
constexpr std::uint32_t kRare = 1u << 31;

constexpr float kHuge = std::numeric_limits<float>::max();

// Converts the text of an option's value. The error completes the sentence "give ...".
template <typename Read>
struct Reader {
  const char* type;  // of the value, in the help
  Read read;
};
// clang 14 does not deduce the arguments of an aggregate without a guide.
template <typename Read>
Reader(const char*, Read) -> Reader<Read>;

// A number from `low` to `high`; the error is `wanted`.
template <typename Number>
auto number(const char* type, Number low, Number high, const std::string& wanted) {
  return Reader{type, [=](std::string_view text) -> Result<Number> {
                  Number value{};
                  const char* end = text.data() + text.size();
                  const auto [stop, error] = std::from_chars(text.data(), end, value);
                  if (error == std::errc() && stop == end && value >= low && value <= high)
                    return value;
                  return Failure(wanted);
                }};
}

// A number from `low` to `high` of this kind, such as "an angle in degrees".
template <typename Number>
auto within(const char* type, Number low, Number high, const char* kind) {
  return number(type, low, high, fmt::format("{}, {} to {}", kind, low, high));
}

// A number above 0.
template <typename Number>
auto positive(const char* type, const char* wanted,
              Number high = std::numeric_limits<Number>::max()) {
  return number(type, std::numeric_limits<Number>::denorm_min(), high, wanted);
}

auto length() { return positive<float>("LENGTH", "a length above 0, in the scene's units"); }

auto milliseconds() { return number("MS", 0.0, 1e9, "a time of 0 or more in milliseconds"); }

auto frames(std::uint32_t fewest) { return within("N", fewest, 100'000u, "a number"); }

// An angle in degrees, as radians.
auto degrees(float low, float high, const char* kind) {
  return Reader{"DEGREES", [read = within("", low, high, kind).read](std::string_view text) {
                  return read(text).transform([](float angle) { return glm::radians(angle); });
                }};
}

// A text that is not empty.
auto text(const char* type, const char* wanted) {
  return Reader{type, [=](std::string_view text) -> Result<std::string> {
                  if (text.empty()) return Failure(wanted);
                  return std::string(text);
                }};
}

auto folder() { return text("DIR", "the name of a folder, such as out"); }
auto file() { return text("FILE", "the name of a file"); }

// The enumerator of a name. With the further name `all` it is optional.
template <typename Choice>
auto one_of(std::span<const std::string_view> names) {
  return Reader{"NAME", [=](std::string_view text) -> Result<Choice> {
                  const auto name = std::ranges::find(names, text);
                  if (name != names.end()) return static_cast<Choice>(name - names.begin());
                  return Failure(fmt::format("one of {}", fmt::join(names, ", ")));
                }};
}
template <typename Choice>
auto one_of_or(std::span<const std::string_view> names, const char* all) {
  return Reader{"NAME", [=](std::string_view text) -> Result<std::optional<Choice>> {
                  if (text == all) return std::nullopt;
                  return one_of<Choice>(names).read(text).map_error([&](const std::string& wanted) {
                    return fmt::format("{}, {}", wanted, all);
                  });
                }};
}

// The values between commas.
template <typename Read>
auto list(const char* type, Read read) {
  using Value = typename std::invoke_result_t<Read, std::string_view>::value_type;
  return Reader{type, [read](std::string_view text) -> Result<std::vector<Value>> {
                  std::vector<Value> values;
                  for (std::size_t begin = 0; begin <= text.size();) {
                    const std::size_t comma = std::min(text.find(',', begin), text.size());
                    ALCOVE_TRY(values.emplace_back(), read(text.substr(begin, comma - begin)));
                    begin = comma + 1;
                  }
                  return values;
                }};
}

Result<glm::dvec3> read_vector(std::string_view text) {
  const std::string wanted = "three numbers, such as 0,1.5,-2";
  const auto coordinate = number<double>("", -kHuge, kHuge, wanted);
  ALCOVE_TRY(const auto v, list("", coordinate.read).read(text));
  if (v.size() != 3) return Failure(wanted);
  return glm::dvec3(v[0], v[1], v[2]);
}

Result<glm::vec3> read_direction(std::string_view text) {
  ALCOVE_TRY(const glm::vec3 direction, read_vector(text));
  if (direction == glm::vec3(0.0f)) return Failure("a direction, not zero");
  return direction;
}

Result<std::pair<std::uint32_t, std::uint32_t>> read_size(std::string_view text) {
  const auto side =
      number("", 1u, 16384u, "WIDTHxHEIGHT in pixels, each from 1 to 16384, such as 960x540");
  const std::size_t x = std::min(text.find('x'), text.size());
  ALCOVE_TRY(const std::uint32_t width, side.read(text.substr(0, x)));
  ALCOVE_TRY(const std::uint32_t height, side.read(text.substr(std::min(x + 1, text.size()))));
  return std::pair(width, height);
}

Result<const GpuPart*> read_gpu(std::string_view text) {
  constexpr std::array kNames{kGpuParts[0].name, kGpuParts[1].name, kGpuParts[2].name};
  return one_of<std::size_t>(kNames).read(text).transform(
      [](std::size_t i) { return &kGpuParts[i]; });
}

Result<float> read_far(std::string_view text) {
  if (text == "inf" || text == "infinity") return std::numeric_limits<float>::infinity();
  return number("", -kHuge, kHuge, "a length above 0, or inf").read(text);
}

Result<std::vector<float>> read_roughness(std::string_view text) {
  const std::string wanted = "up to 16 numbers from 0 to 1, no two alike, such as 0.1,0.3,0.6";
  ALCOVE_TRY(const auto values, list("", number("", 0.0f, 1.0f, wanted).read).read(text));
  // Names of output files contain the first six digits of the roughness, which must therefore
  // differ.
  std::vector<float> sorted = values;
  std::ranges::sort(sorted);
  const auto alike = [](float a, float b) { return b - a < 1e-5f; };
  if (values.size() > 16 || std::ranges::adjacent_find(sorted, alike) != sorted.end())
    return Failure(wanted);
  return values;
}

const Reader kVector{"X,Y,Z", read_vector};
const Reader kSize{"WxH", read_size};
const Reader kGpu{"NAME", read_gpu};

// Breaks a help text into lines that fit beside the names of the options.
std::string wrapped(const std::string& help) {
  constexpr std::size_t kWidth = 68;
  std::string lines = help;
  for (std::size_t begin = 0; lines.size() - begin > kWidth;) {
    const std::size_t space = lines.rfind(' ', begin + kWidth);
    if (space == std::string::npos || space <= begin) break;
    lines[space] = '\n';
    begin = space + 1;
  }
  return lines;
}

// Adds options to the parser of one command. Those that the command does not take are left out.
class Table {
 public:
  Table(CLI::App& app, Command command, bool all)
      : app_(app), command_(1u << static_cast<std::uint32_t>(command)), all_(all) {}

  void heading(const char* heading) { heading_ = heading; }

  // An option that stores its value in `target`, a reference or a tuple of references. Of several
  // occurrences the last one counts; a vector of values takes them all.
  template <typename Target, typename Read>
  void add(std::uint32_t commands, const char* name, Target&& target, Reader<Read> reader,
           const std::string& help) {
    if ((commands & command_) == 0) return;
    const auto store = [name, to = std::tuple<Target>(std::forward<Target>(target)),
                        read = reader.read](const std::vector<std::string>& texts) mutable {
      for (const std::string& text : texts) {
        auto value = read(text);
        if (!value) refuse(name, text, value.error());
        if constexpr (requires { std::get<0>(to) = std::move(*value); })
          std::get<0>(to) = std::move(*value);
        else
          std::get<0>(to).push_back(std::move(*value));
      }
    };
    using Texts = std::vector<std::string>;
    describe(app_.add_option_function<Texts>(name, store, wrapped(help))->take_all()->expected(1),
             commands, reader.type);
  }

  // An option without a value, which stores `value`.
  template <typename Target>
  void flag(std::uint32_t commands, const char* name, Target& target, const std::string& help,
            bool value = true) {
    if ((commands & command_) == 0) return;
    const auto store = [=, &target] {
      if constexpr (!std::is_same_v<Target, bool>)
        if (target == !value) throw Mistake{std::string(name) + ": give it or its opposite"};
      target = value;
    };
    describe(app_.add_flag_callback(name, store, wrapped(help)), commands, nullptr);
  }

 private:
  [[noreturn]] static void refuse(const char* name, const std::string& text,
                                  const std::string& wanted) {
    constexpr std::size_t kLongest = 80;  // bytes of an argument that a message repeats
    throw Mistake{fmt::format("{} {}: give {}", name,
                              text.empty() ? "''" : shortened(text, kLongest), wanted)};
  }

  void describe(CLI::Option* option, std::uint32_t commands, const char* type) const {
    if (type != nullptr) option->type_name(type);
    option->group(all_ || (commands & kRare) == 0 ? heading_ : "");
  }

  CLI::App& app_;
  std::uint32_t command_;
  bool all_;
  const char* heading_ = "Options";
};

void add_general(Table& table, Options& o) {
  table.add(kRender | kCompare | kMotion | kMeasure | kReport, "--out", o.out, folder(),
            "folder for images and report.json. Default: out");
  table.add(kView, "--out", o.out, folder(), "folder for screenshots. Default: the current folder");
  table.flag(kOnDevice, "--cut-blends", o.materials.cut_blends,
             "cut alpha-blended materials out at an alpha of 0.5, for foliage");
  table.flag(kOnDevice, "--both-sides", o.materials.both_sides,
             "draw the back faces of single-sided materials. Default: culled");
  table.add(kRecommend, "--budget-ms", o.budget_ms,
            positive<double>("MS", "a time above 0 in milliseconds"),
            "find the least error whose occlusion passes take at most this time");
  table.add(kRecommend, "--tolerance", o.tolerance,
            positive<double>("E", "an error above 0, at most 1", 1.0),
            "find the fastest setting whose RMSE of visibility is at most this");
  table.add(kRecommend, "--second-layer", o.second_layer_ms, milliseconds(),
            "time in which your engine draws a second depth layer, 0 if it does so anyway. "
            "Default: it has none");
  table.add(kRecommend, "--back-faces", o.back_faces_ms, milliseconds(),
            "time in which your engine draws depth of back faces, 0 if it does so anyway. "
            "Default: it has none");
  table.add(kRecommend, "--situation", o.situation, one_of_or<Situation>(kSituationNames, "mix"),
            "whose error and time count: first (frame), moving (camera), standing (camera) or mix "
            "of 10, 60 and 30 %. Default: mix");
  table.add(kRecommend, "--out", o.settings_out, file(), "also write the settings, for --settings");
  table.add(kRecommend | kReport, "--target-size", std::tie(o.target_width, o.target_height), kSize,
            "size of the image whose time counts; errors are measured at --size. Default: "
            "1920x1080");
  table.add(kStatic, "--gpu", o.gpu, kGpu, "the modelled GPU: ps4, ps5 or rx6800xt. Default: ps5");
  table.add(kStatic | kRare, "--clock", o.clock, one_of<Clock>(kClockNames),
            "which time counts: modelled (on --gpu), timestamps (of the device) or processor "
            "(of all threads). Default: modelled");
  table.add(kMeasure, "--sizes", o.sizes, list("WxH,...", read_size),
            "sizes of the image in pixels. Default: 1920x1080,3840x2160,7680x4320");
  table.flag(kCompare, "--split", o.split,
             "also print and draw the causes of the squared error: noise, filter and tiles, hidden "
             "surfaces, unknown thickness, occluders outside the image, the rest");
  table.flag(kCompare, "--lit", o.lit,
             "also path trace the lit scene, and print the error of the lit picture with each part "
             "of the occlusion. Takes minutes");
  table.add(kCompare | kRare, "--lit-points", o.lit_points, within("N", 1u, 100'000'000u, "pixels"),
            "approximate number of pixels at which multi-bounce, specular occlusion and the lit "
            "picture are traced, one per square block of the image. Default: 32000");
  table.add(kGraph, "--format", o.graph_format, one_of<GraphFormat>(kGraphFormatNames),
            "text, dot (Graphviz), or work (the work as data). Default: text");
  table.flag(kWithTruth | kRare, "--no-cache", o.no_cache,
             "compute the truths again instead of reading them from the cache on disk");
  table.add(kOnDevice | kRare, "--device", o.device, within("N", 0, 255, "a number"),
            "number of the Vulkan device in the list of `alcove doctor`. Default: the first "
            "discrete GPU, else the first integrated GPU, else any device");
  table.flag(kOnDevice | kRare, "--validation", o.validation,
             "run under the Khronos validation layers and the graph's own checks, and fail on any "
             "message");
  table.add(kMotion, "--path", o.path, one_of_or<MotionKind>(kMotionKindNames, "all"),
            "orbit (around the middle of the view), dolly (towards it), object (static camera, a "
            "block slides over the ground), cut (the camera jumps) or all. Default: all");
}

void add_view(Table& table, Options& o) {
  ViewOptions& view = o.view;
  table.heading("View");
  table.add(kOnDevice, "--camera", view.camera, text("NAME", "the name of a camera"),
            "name of a camera of the scene, or none for a view of everything. Default: the first "
            "one, or none if that shows nothing");
  table.add(kOnDevice, "--eye", view.eye, kVector, "position of the camera, scene units");
  table.add(kOnDevice, "--target", view.target, kVector,
            "point that the camera looks at, scene units");
  table.add(kOnDevice | kRare, "--up", view.up_ws, Reader{"X,Y,Z", read_direction},
            "direction that is upwards in the image. Default: 0,1,0");
  // Cameras of scene files may have the same angles.
  table.add(kOnDevice | kRare, "--fov-y", view.fov_y,
            degrees(0.001f, 178.0f, "the vertical angle of view in degrees"),
            "vertical angle of view. Default: that of the camera");
  table.add(kOnDevice | kRare, "--ortho-height", view.ortho_height, length(),
            "makes the view orthographic, with an image of this height in scene units");
  table.add(kOnDevice | kRare, "--near", view.near_plane,
            number("LENGTH", -kHuge, kHuge, "a length above 0, in the scene's units"),
            "distance of the near plane. Default: that of the scene's camera, or fitted to the "
            "geometry in view. In an orthographic view it may be negative (behind the eye)");
  table.add(kOnDevice | kRare, "--far", view.far_plane, Reader{"LENGTH", read_far},
            "distance of the far plane, or inf. Default: as for --near");
  table.flag(kOnDevice | kRare, "--reversed-z", view.reversed_z,
             "near plane at depth 1, far plane at 0. Default in perspective views");
  table.flag(kOnDevice | kRare, "--standard-z", view.reversed_z,
             "near plane at depth 0, far plane at 1. Default in orthographic views", false);
  table.add(kAll, "--size", std::tie(view.width, view.height), kSize,
            fmt::format("size of the image in pixels. Default: {}x{}", view.width, view.height));
  table.add(kRender | kCompare, "--frames", view.frames, frames(1),
            "number of frames to render; the last one is written. Default: 1");
  table.add(kView | kRare, "--frames", view.frames, frames(1),
            "number of frames after which the window closes; with --out the last one is written "
            "there. Default: it stays open");
  table.add(kStatic | kRare, "--frames", view.frames, frames(1),
            "number of frames of a static camera; the last one is compared. Default: 32");
  table.add(kMeasure, "--frames", view.frames, frames(1),
            "number of frames that are timed. Default: 200");
  // Surfaces of the first compared frame are followed over the four frames before it.
  table.add(kMotion, "--frames", view.frames, frames(15),
            "number of frames of each path, which begins at the given view. Three of them are "
            "compared with the ray-traced truth. Default: 48");
  table.add(kRender | kCompare | kView | kRare, "--orbit", view.orbit,
            degrees(-360.0f, 360.0f, "an angle in degrees"),
            "angle by which the camera orbits its target from frame to frame. Default: 0");
}

void add_occlusion(Table& table, Options& o) {
  OcclusionOptions& occlusion = o.occlusion;
  table.heading("Occlusion");
  table.add(kAll, "--quality", occlusion.quality, one_of<AlcoveQuality>(passes::kQualityNames),
            "console, low, medium (the default), high, ultra or height_field");
  table.add(kAll, "--radius", occlusion.radius, length(),
            "distance up to which occluders count, scene units. Default: from what the view "
            "shows; the program prints it and why");
  table.add(kAll, "--settings", occlusion.file, Reader{"FILE", read_settings},
            "settings that `alcove recommend --out` wrote, instead of --quality");
  table.add(kAll, "--set", occlusion.set, Reader{"NAME=VALUE", read_change},
            "changes one setting; --help-all lists them. May be repeated");
  table.add(kRender | kCompare | kMotion | kView | kRecommend, "--guard-band", o.view.guard_band,
            within("PERCENT", 0.0, 50.0, "a percentage of the image's height"),
            "also render this part of the height beyond each border, unseen, so that "
            "occluders just outside count. Default: 0");
  table.add(kAll, "--normals", o.view.normals, one_of<NormalSource>(kNormalSourceNames),
            "normals of the occlusion and the truths: shading (with normal maps, the default), "
            "geometric (of the triangles) or depth (from the depth buffer)");
  // `render` and `graph` accept --spp without effect, so that the arguments of a `compare`
  // command can be reused with them.
  table.add(kWithTruth | kRender | kGraph | kRare, "--spp", occlusion.spp,
            within("N", 1u, 65536u, "rays per pixel"),
            fmt::format("rays per pixel of the ray-traced truth. No effect on commands without a "
                        "truth. Default: {}",
                        occlusion.spp));
  table.add(kRender | kCompare | kView | kGraph | kRare, "--roughness", occlusion.roughness,
            Reader{"R,...", read_roughness},
            "perceptual roughness for specular occlusion, instead of that of the materials. Each "
            "of several values gives an image of its own");
  table.add(kRender | kCompare | kView, "--environment", o.environment,
            text("FILE", "the name of an .exr file"),
            "equirectangular image of the light, .exr. Default: a generated sky");
}

void add_cost_model(Table& table, Options& o) {
  table.heading("Cost");
  table.add(kCost, "--gpu", o.gpu, kGpu, "modelled GPU: ps4, ps5 or rx6800xt. Default: all");
  table.flag(kCost, "--motion-vectors", o.cost.inputs.motion,
             "model the passes with motion vectors as an input, which moving objects need");
  table.flag(kCost, "--area", o.cost.inputs.area,
             "model the passes for images that are read and written in part");
  table.flag(kCost, "--mask", o.cost.inputs.mask, "model the passes with a mask of surfaces");
  table.flag(kCost, "--samples", o.cost.inputs.samples,
             "model the passes with depth of four samples per pixel");
  table.flag(kCost, "--range", o.cost.range,
             "also print the time of a moving frame under other assumptions about the caches, of "
             "which the model is least sure");
  table.add(kCost, "--json", o.cost.json, file(), "also write all figures as JSON");
  table.add(kCost | kRare, "--write-budget", o.cost.budget, file(),
            "only write the costs of all presets into the file of limits that the tests check");
}

// Throws a Mistake if a near or far plane is at the eye or behind it. Only orthographic views may
// have such planes.
void check_plane(const char* option, const std::optional<float>& distance,
                 const ViewOptions& view) {
  if (distance && !(*distance > 0.0f) && !view.ortho_height) {
    throw Mistake{
        fmt::format("{} {}: give a length above 0, in the scene's units, or --ortho-height too",
                    option, *distance)};
  }
}

}  // namespace

void add_options(CLI::App& app, Options& options, bool all) {
  if (options.command == Command::doctor) return;
  Table table(app, options.command, all);
  add_general(table, options);
  add_view(table, options);
  add_occlusion(table, options);
  add_cost_model(table, options);
}

void check_together(const Options& options) {
  const ViewOptions& view = options.view;
  const OcclusionOptions& occlusion = options.occlusion;
  const auto refuse_if = [](bool both, const char* sentence) {
    if (both) throw Mistake{sentence};
  };
  check_plane("--near", view.near_plane, view);
  check_plane("--far", view.far_plane, view);
  if (view.near_plane && view.far_plane && !(*view.near_plane < *view.far_plane))
    throw Mistake{fmt::format("--near {}: give a length below --far", *view.near_plane)};
  refuse_if(view.ortho_height && view.fov_y,
            "--ortho-height and --fov-y: give one, an orthographic view has no angle");
  refuse_if(view.ortho_height && view.far_plane && std::isinf(*view.far_plane),
            "--far inf: an orthographic view needs a finite --far");
  refuse_if(!view.camera.empty() && view.camera != "none" && view.eye,
            "--camera and --eye: give one, a camera has a position of its own");
  refuse_if(occlusion.file && occlusion.quality,
            "--settings and --quality: give one, the file holds every setting of a preset");
  refuse_if(occlusion.radius && changes_radius(occlusion),
            "--radius and --set radius: give one of them");
  refuse_if(
      occlusion.roughness.size() > 1 &&
          (options.command == Command::view || options.command == Command::graph),
      "--roughness: give one value, only `render` and `compare` make an image of each of several");
  refuse_if(options.split && view.orbit != 0.0f,
            "--split and --orbit: give one, the error is split for a static camera");
  refuse_if(options.gpu != nullptr && options.clock != Clock::modelled,
            "--gpu and --clock: give one, only modelled times are those of --gpu");
  refuse_if(!options.cost.budget.empty() && !options.cost.json.empty(),
            "--write-budget and --json: give one");
  refuse_if(options.command == Command::recommend &&
                options.budget_ms.has_value() == options.tolerance.has_value(),
            "recommend: give either --budget-ms or --tolerance");
}

}  // namespace alcove::sample
