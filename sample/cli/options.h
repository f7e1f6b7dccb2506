#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "alcove/passes/setting_table.h"
#include "evaluate/motion_paths.h"
#include "evaluate/situations.h"
#include "gpu/occlusion.h"
#include "gpu_cost/frame_work.h"
#include "gpu_cost/gpu_part.h"
#include "render/session.h"
#include "scene/load_scene.h"
#include "support/glm.h"

namespace alcove::sample {

enum class Command {
  // For users.
  render,
  view,
  compare,
  recommend,
  report,
  graph,
  doctor,
  // The laboratory.
  motion,
  cost,
  measure
};
// Names are in the order of the enumerators.
enum class GraphFormat { text, dot, work };
inline constexpr std::array<std::string_view, 3> kGraphFormatNames{"text", "dot", "work"};

// The options of the view. Without frames, the command `view` runs until its window is closed.
// Optional members are empty if the option was not given: choose_camera()
// then takes the value from the scene's camera or derives it from the scene. Angles are in radians.
struct ViewOptions : ViewRequest {
  std::string camera;  // name of a scene's camera; empty: the default one
  // Positions in the space of the scene's file. Scene::origin is subtracted from them later.
  std::optional<glm::dvec3> eye, target;
  std::optional<glm::vec3> up_ws;
  std::optional<float> fov_y, ortho_height, near_plane, far_plane;
  // Whether the near plane has depth 1. If empty, depth is reversed in perspective views, where
  // that makes the relative precision of distances nearly constant, and not in orthographic views.
  std::optional<bool> reversed_z;
};

// A change of one setting by --set.
struct SettingChange {
  const passes::SettingInfo* setting = nullptr;  // null: OcclusionSettings::bent_normal
  uint32_t value = 0;                            // the bits of the field
};

struct OcclusionOptions {
  std::optional<AlcoveQuality> quality;   // none: that of OcclusionSettings
  std::optional<float> radius;            // scene units; none: ViewFinder::radius()
  std::optional<OcclusionSettings> file;  // --settings; a radius of 0 if it has none
  std::vector<SettingChange> set;         // in order
  std::vector<float> roughness;           // overrides the materials; perceptual
  uint32_t spp = 256;                     // rays per pixel of the truth
};

struct CostOptions {
  CostInputs inputs;             // without the settings
  bool range = false;            // also models a moving frame under other assumptions
  std::filesystem::path json;    // empty for none
  std::filesystem::path budget;  // file for the budget of the presets; empty for none
};

struct Options {
  Command command = Command::render;
  std::string scene;                // empty: the built-in one
  std::vector<std::string> scenes;  // report: any number, each as `scene`
  MaterialTreatment materials;
  std::filesystem::path environment;  // .exr; empty: the procedural sky
  bool split = false;                 // compare: also splits the error into its causes
  bool lit = false;                   // compare: also traces the lit picture
  uint32_t lit_points = 32'000;       // compare: approximate number of pixels with traced light
  ViewOptions view;
  OcclusionOptions occlusion;
  std::filesystem::path out = "out";  // empty for the command `view` without --out
  // The limits of the command `recommend`: GPU time in milliseconds, or RMSE of visibility. Exactly
  // one of them is given.
  std::optional<double> budget_ms, tolerance;
  // recommend: the time in which the host draws these depths; none: it does not draw them.
  std::optional<double> second_layer_ms, back_faces_ms;
  std::optional<Situation> situation;  // recommend: empty for a mix of all
  uint32_t target_width = 1920;        // recommend: of the image whose time counts, pixels
  uint32_t target_height = 1080;
  const GpuPart* gpu = nullptr;        // the modelled one; null for all (cost), or a PlayStation 5
  std::filesystem::path settings_out;  // recommend: empty for none
  Clock clock = Clock::modelled;       // recommend, report
  std::optional<MotionKind> path;      // motion: empty for all paths
  CostOptions cost;
  // measure: sizes of the image in pixels
  std::vector<std::pair<uint32_t, uint32_t>> sizes{{1920, 1080}, {3840, 2160}, {7680, 4320}};
  GraphFormat graph_format = GraphFormat::text;
  int device = -1;
  bool validation = false;
  bool no_cache = false;
};

// A command line that asks for no run: help (status 0, for stdout) or a mistake (status 2, one
// sentence for stderr).
struct Stop {
  int status = 0;
  std::string text;
};

// Parses the command line. It never exits and never prints. Each value is checked alone and against
// the other options; checks that need the scene are made by choose_camera().
[[nodiscard]] tl::expected<Options, Stop> parse_options(int argc, const char* const* argv);

}  // namespace alcove::sample
