#include "cli/option_table.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <tuple>
#include <utility>

#include "alcove/passes/setting_table.h"
#include "cli/settings.h"

namespace alcove::sample {
namespace {

using O = Options;
using V = OptionValue;

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

constexpr const char* kOptions = "Options";
constexpr const char* kViewing = "View";
constexpr const char* kOcclusion = "Occlusion";
constexpr const char* kCostModel = "Cost";

constexpr double kTiny = std::numeric_limits<float>::denorm_min();
constexpr double kHuge = std::numeric_limits<float>::max();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Reads a number of frames.
void read_frames(O& o, const V& v, std::int64_t fewest = 1) {
  o.view.frames = static_cast<std::uint32_t>(
      v.whole_number(fewest, 100'000, fmt::format("a number from {} to 100000", fewest)));
}

float plane(const V& v, const char* wanted) {
  return static_cast<float>(v.number(-kHuge, kHuge, wanted));
}

void read_out(O& o, const V& v) {
  if (v.text.empty()) v.refuse("the name of a folder, such as out");
  o.out = v.text;
}

void read_setting(O& o, const V& v) {
  const std::size_t equals = v.text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == v.text.size())
    v.refuse("name=value, such as slices=2");
  const std::string name = v.text.substr(0, equals);
  const std::string value = v.text.substr(equals + 1);
  if (const auto wanted = wanted_instead(name, value)) v.refuse(*wanted);
  o.occlusion.set.emplace_back(name, value);
}

void read_settings_file(O& o, const V& v) {
  auto read = read_settings(v.text);
  if (!read) throw Mistake{"--settings: " + read.error()};
  o.occlusion.file = std::move(*read);
}

void read_roughness(O& o, const V& v) {
  const char* wanted = "up to 16 numbers from 0 to 1, no two alike, such as 0.1,0.3,0.6";
  const std::vector<double> values = v.numbers(1, 16, 0.0, 1.0, wanted);
  o.occlusion.roughness.assign(values.begin(), values.end());
  // Names of output files contain the first six digits of the roughness, which must therefore
  // differ.
  std::vector<float> sorted = o.occlusion.roughness;
  std::ranges::sort(sorted);
  const auto alike = [](float a, float b) { return b - a < 1e-5f; };
  if (std::ranges::adjacent_find(sorted, alike) != sorted.end()) v.refuse(wanted);
}

// The names of the modelled GPUs.
constexpr std::array<std::string_view, 3> kGpuNames{kGpuParts[0].name, kGpuParts[1].name,
                                                    kGpuParts[2].name};

// Throws a Mistake if a near or far plane is at the eye or behind it. Only orthographic views may
// have such planes.
void check_plane(const std::string& option, const std::optional<float>& distance,
                 const ViewOptions& view) {
  if (distance && !(*distance > 0.0f) && !view.ortho_height) {
    throw Mistake{option + " " + number_text(*distance) +
                  ": give a length above 0, in the scene's units, or --ortho-height too"};
  }
}

}  // namespace

std::span<const OptionRow> option_rows() {
  static const OptionRow rows[] = {
      {kOnDevice, kOptions, "--cut-blends", nullptr,
       "render alpha-blended materials as masks with a cutoff of 0.5, which suits foliage. "
       "Default: "
       "they are rendered opaque",
       [](O& o, const V&) { o.materials.cut_blends = true; }},
      {kOnDevice, kOptions, "--both-sides", nullptr,
       "draw the back faces of single-sided materials. Default: they are culled, as glTF specifies",
       [](O& o, const V&) { o.materials.both_sides = true; }},
      {kRecommend, kOptions, "--budget-ms", "MS",
       "find the setting with the smallest error whose occlusion passes take at most this time",
       [](O& o, const V& v) {
         o.budget_ms = v.number(kTiny, kHuge, "a time above 0 in milliseconds");
       }},
      {kRecommend, kOptions, "--tolerance", "E",
       "find the fastest setting whose RMSE of visibility is at most this error",
       [](O& o, const V& v) { o.tolerance = v.number(kTiny, kHuge, "an error above 0"); }},
      {kRecommend, kOptions, "--situation", "NAME",
       "the situation whose error and time count: first (frame), moving (camera), standing "
       "(camera) "
       "or mix. Default: mix, in which the moving camera counts 60 %, the standing 30 % and the "
       "first frame 10 %",
       [](O& o, const V& v) { o.situation = v.one_of_or<Situation>(kSituationNames, "mix"); }},
      {kRecommend, kOptions, "--out", "FILE", "also write the settings, for --settings",
       [](O& o, const V& v) { o.settings_out = v.text; }},
      {kRecommend | kReport, kOptions, "--target-size", "WxH",
       "size of the image whose time counts; errors are measured at --size. Default: 1920x1080",
       [](O& o, const V& v) { std::tie(o.target_width, o.target_height) = v.size(); }},
      {kStatic, kOptions, "--gpu", "NAME",
       "the GPU whose time is modelled: ps4, ps5 or rx6800xt. Default: ps5",
       [](O& o, const V& v) { o.gpu = &kGpuParts[v.one_of(kGpuNames)]; }},
      {kStatic, kOptions, "--clock", "NAME",
       "which time counts: modelled (time on --gpu by the cost model, the same in every run), "
       "timestamps (GPU time of the device) or processor (time of all threads). Default: modelled",
       [](O& o, const V& v) { o.clock = static_cast<Clock>(v.one_of(kClockNames)); }},
      {kMeasure, kOptions, "--sizes", "WxH,...",
       "sizes of the image in pixels. Default: 1920x1080,3840x2160,7680x4320",
       [](O& o, const V& v) {
         o.sizes.clear();
         for (const V& size : v.parts()) o.sizes.push_back(size.size());
       }},
      {kMeasure, kOptions, "--frames", "N", "number of frames that are timed. Default: 200",
       [](O& o, const V& v) { read_frames(o, v); }},
      {kCompare, kOptions, "--split", nullptr,
       "also render the view without each cause of the error, and print and draw the part of the "
       "squared error that is noise, filter and tiles, hidden surfaces, unknown thickness, "
       "occluders outside the image, and the rest",
       [](O& o, const V&) { o.split = true; }},
      {kCompare, kOptions, "--lit", nullptr,
       "also path trace the scene lit by the environment, and print the error of the lit picture "
       "without occlusion and with each part of the occlusion. Takes minutes",
       [](O& o, const V&) { o.lit = true; }},
      {kCompare, kOptions, "--lit-points", "N",
       "approximate number of pixels at which multi-bounce, specular occlusion and the lit picture "
       "are traced, one per square block of the image. Default: 32000",
       [](O& o, const V& v) {
         o.lit_points =
             static_cast<std::uint32_t>(v.whole_number(1, 100'000'000, "pixels, 1 to 100000000"));
       }},
      {kGraph, kOptions, "--format", "NAME",
       "text, dot (Graphviz), or work (the work as data). Default: text",
       [](O& o, const V& v) {
         o.graph_format = static_cast<GraphFormat>(v.one_of(kGraphFormatNames));
       }},
      {kWithTruth, kOptions, "--no-cache", nullptr,
       "compute the truths again instead of reading them from the cache on disk",
       [](O& o, const V&) { o.use_cache = false; }},
      {kRender | kCompare | kMotion | kMeasure | kReport, kOptions, "--out", "DIR",
       "folder for images and report.json. Default: out", read_out},
      {kView, kOptions, "--out", "DIR",
       "folder for screenshots. Default: the current folder. If given, the last frame of --frames "
       "is written there too",
       read_out},
      {kOnDevice, kOptions, "--device", "N",
       "number of the Vulkan device in the list of `alcove doctor`. Default: the first discrete "
       "GPU, else the first integrated GPU, else any device",
       [](O& o, const V& v) {
         o.device = static_cast<int>(v.whole_number(0, 255, "a number from 0 to 255"));
       }},
      {kOnDevice, kOptions, "--validation", nullptr,
       "run under the Khronos validation layers and the graph's own checks, and fail on any "
       "message",
       [](O& o, const V&) { o.validation = true; }},

      {kMotion, "Motion", "--path", "NAME",
       "orbit (around the middle of the view), dolly (towards it), object (static camera, a block "
       "slides over the ground), cut (the camera jumps to another place) or all. Default: all",
       [](O& o, const V& v) { o.path = v.one_of_or<MotionKind>(kMotionKindNames, "all"); }},
      {kMotion, "Motion", "--frames", "N",
       "number of frames of each path, which begins at the given view. Three of them are compared "
       "with the ray-traced truth. Default: 48",
       // Surfaces of the first compared frame are followed over the four frames before it.
       [](O& o, const V& v) { read_frames(o, v, 15); }},

      {kOnDevice, kViewing, "--camera", "NAME",
       "name of a camera of the scene. Default: the first one, or a view of the whole scene if the "
       "scene has no camera",
       [](O& o, const V& v) { o.view.camera = v.text; }},
      {kOnDevice, kViewing, "--eye", "X,Y,Z", "position of the camera, scene units",
       [](O& o, const V& v) { o.view.eye = v.vector(); }},
      {kOnDevice, kViewing, "--target", "X,Y,Z", "point that the camera looks at, scene units",
       [](O& o, const V& v) { o.view.target = v.vector(); }},
      {kOnDevice, kViewing, "--up", "X,Y,Z",
       "direction that is upwards in the image. Default: 0,1,0",
       [](O& o, const V& v) {
         o.view.up_ws = v.vector();
         if (*o.view.up_ws == glm::vec3(0.0f)) v.refuse("a direction, not zero");
       }},
      {kOnDevice, kViewing, "--fov-y", "DEGREES",
       "vertical angle of view. Default: that of the camera",
       [](O& o, const V& v) {
         // Cameras of scene files may have the same angles.
         o.view.fov_y = glm::radians(static_cast<float>(
             v.number(0.001, 178.0, "the vertical angle of view in degrees, 0.001 to 178")));
       }},
      {kOnDevice, kViewing, "--ortho-height", "LENGTH",
       "makes the view orthographic, with an image of this height in scene units",
       [](O& o, const V& v) { o.view.ortho_height = v.length(); }},
      {kOnDevice, kViewing, "--near", "LENGTH",
       "distance of the near plane. Default: that of the scene's camera, or fitted to the geometry "
       "in view. In an orthographic view it may be negative (behind the eye)",
       [](O& o, const V& v) {
         o.view.near_plane = plane(v, "a length above 0, in the scene's units");
       }},
      {kOnDevice, kViewing, "--far", "LENGTH",
       "distance of the far plane, or inf. Default: as for --near",
       [](O& o, const V& v) {
         const bool infinite = v.text == "inf" || v.text == "infinity";
         o.view.far_plane = infinite ? kInfinity : plane(v, "a length above 0, or inf");
       }},
      {kOnDevice, kViewing, "--reversed-z", nullptr,
       "near plane at depth 1, far plane at 0. Default in perspective views",
       [](O& o, const V&) { o.view.reversed_z = true; }},
      {kOnDevice, kViewing, "--standard-z", nullptr,
       "near plane at depth 0, far plane at 1. Default in orthographic views",
       [](O& o, const V&) { o.view.reversed_z = false; }},
      {kAll, kViewing, "--size", "WxH", "size of the image in pixels. Default: {size}",
       [](O& o, const V& v) { std::tie(o.view.width, o.view.height) = v.size(); }},
      {kRender | kCompare, kViewing, "--frames", "N",
       "number of frames to render; the last one is written. Default: 1",
       [](O& o, const V& v) { read_frames(o, v); }},
      {kView, kViewing, "--frames", "N",
       "number of frames after which the window closes. Default: it stays open",
       [](O& o, const V& v) { read_frames(o, v); }},
      {kStatic, kViewing, "--frames", "N",
       "number of frames of a static camera that are rendered with each setting; the last one is "
       "compared. Default: 32",
       [](O& o, const V& v) { read_frames(o, v); }},
      {kRender | kCompare | kView, kViewing, "--orbit", "DEGREES",
       "angle by which the camera orbits its target from frame to frame. Default: 0",
       [](O& o, const V& v) {
         o.view.orbit = glm::radians(
             static_cast<float>(v.number(-360.0, 360.0, "an angle in degrees, -360 to 360")));
       }},

      {kAll, kOcclusion, "--quality", "NAME",
       "preset: console, low, medium, high, ultra or reference. Default: medium",
       [](O& o, const V& v) {
         o.occlusion.quality = static_cast<AlcoveQuality>(v.one_of(passes::kQualityNames));
         o.occlusion.quality_given = true;
       }},
      {kAll, kOcclusion, "--radius", "LENGTH",
       "distance up to which occluders count, scene units. Default: from the geometry that the "
       "view "
       "shows; the program prints it and why",
       [](O& o, const V& v) { o.occlusion.radius = v.length(); }},
      {kAll, kOcclusion, "--settings", "FILE",
       "settings that `alcove recommend --out` wrote. --set changes them further",
       read_settings_file},
      {kAll, kOcclusion, "--set", "NAME=VALUE",
       "changes one setting of the preset; the settings are listed below. May be repeated",
       read_setting, true},
      {kAll, kOcclusion, "--normals", "NAME",
       "normals that the occlusion pass and the truths use: shading (from vertices and normal "
       "maps), geometric (of the triangles) or depth (reconstructed from the depth buffer). "
       "Default: shading",
       [](O& o, const V& v) {
         o.occlusion.normals = static_cast<NormalSource>(v.one_of(kNormalSourceNames));
       }},
      // `render` and `graph` accept --spp without effect, so that the arguments of a `compare`
      // command can be reused with them.
      {kWithTruth | kRender | kGraph, kOcclusion, "--spp", "N",
       "rays per pixel of the ray-traced truth. No effect on commands without a truth. Default: "
       "{spp}",
       [](O& o, const V& v) {
         o.occlusion.spp =
             static_cast<std::uint32_t>(v.whole_number(1, 65536, "rays per pixel, 1 to 65536"));
       }},
      {kRender | kCompare | kView | kGraph, kOcclusion, "--roughness", "R,...",
       "perceptual roughness for specular occlusion, instead of that of the materials. Each of "
       "several values gives an image of its own",
       read_roughness},
      {kRender | kCompare | kView, "Light", "--environment", "FILE",
       "equirectangular image of the light, .exr. Default: a generated sky",
       [](O& o, const V& v) { o.environment = v.text; }},

      {kCost, kCostModel, "--gpu", "NAME", "modelled GPU: ps4, ps5 or rx6800xt. Default: all",
       [](O& o, const V& v) { o.gpu = &kGpuParts[v.one_of(kGpuNames)]; }},
      {kCost, kCostModel, "--motion-vectors", nullptr,
       "model the passes with motion vectors as an input, which moving objects need",
       [](O& o, const V&) { o.cost.inputs.motion = true; }},
      {kCost, kCostModel, "--area", nullptr,
       "model the passes for images that are read and written in part",
       [](O& o, const V&) { o.cost.inputs.area = true; }},
      {kCost, kCostModel, "--mask", nullptr, "model the passes with a mask of surfaces",
       [](O& o, const V&) { o.cost.inputs.mask = true; }},
      {kCost, kCostModel, "--samples", nullptr,
       "model the passes with depth of four samples per pixel",
       [](O& o, const V&) { o.cost.inputs.samples = true; }},
      {kCost, kCostModel, "--range", nullptr,
       "also print the time of a moving frame under other assumptions about the caches, of which "
       "the model is least sure",
       [](O& o, const V&) { o.cost.range = true; }},
      {kCost, kCostModel, "--json", "FILE", "also write all figures as JSON",
       [](O& o, const V& v) { o.cost.json = v.text; }},
      {kCost, kCostModel, "--write-budget", "FILE",
       "only write the costs of all presets into the file of limits that the tests check",
       [](O& o, const V& v) { o.cost.budget = v.text; }},
  };
  return rows;
}

void check_together(const Options& options) {
  const ViewOptions& view = options.view;
  check_plane("--near", view.near_plane, view);
  check_plane("--far", view.far_plane, view);
  if (view.near_plane && view.far_plane && !(*view.near_plane < *view.far_plane))
    throw Mistake{"--near " + number_text(*view.near_plane) + ": give a length below --far"};
  if (view.ortho_height && view.fov_y)
    throw Mistake{"--ortho-height and --fov-y: give one, an orthographic view has no angle"};
  if (view.ortho_height && view.far_plane && std::isinf(*view.far_plane))
    throw Mistake{"--far inf: an orthographic view needs a finite --far"};
  if (options.split && view.orbit != 0.0f)
    throw Mistake{"--split and --orbit: give one, the error is split for a static camera"};
  if (options.command == Command::recommend &&
      options.budget_ms.has_value() == options.tolerance.has_value())
    throw Mistake{"recommend: give either --budget-ms or --tolerance"};
}

}  // namespace alcove::sample
