// Reconstructs every pixel from the traced ones: spatial filter, upsampling and temporal
// accumulation in one pass (Jimenez et al. 2016, sections 4.4 and 4.5, with other weights).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "alcove/passes/frame.h"
#include "alcove/passes/gtao.h"

namespace alcove::passes {

struct FilterSettings {
  // Filter radius in tiles for pixels with fewer than two frames of history, 0 to 3. Pixels with
  // more history use 1. 0 turns the spatial filter off.
  std::uint32_t filter_radius = 2;
  // Distance from the tangent plane, in pixels, at which a neighbour's weight falls to 0.25. Above
  // 0. This is the value for one slice and no history; it shrinks as samples accumulate.
  float filter_tolerance_px = 1.5f;
  // Frames that are averaged, 0 to 127; from 16 static frames on, 127. 0 keeps no history and
  // allocates none, for engines with a temporal filter of their own.
  std::uint32_t history_frames = 0;
  // The history is clamped to this many standard deviations around the mean of this frame's
  // neighbourhood. 0 turns clamping off.
  float clamp_width = 0.0f;
  // Filters and accumulates texels of 2x2 pixels, and makes pixels from them by edge-aware
  // upsampling: less time, a quarter of the history's memory, and a larger error (passes/README.md
  // has figures). Needs a tile_size of 2 or 4.
  bool half_resolution = false;

  friend bool operator==(const FilterSettings&, const FilterSettings&) = default;
};

struct ReconstructSettings : FilterSettings {
  // Also writes visibility. Turn it off where only bent normals or specular occlusion are wanted.
  bool visibility = true;
  float roughness = 0.5f;  // As GtaoSettings::roughness; read where the raw occlusion has a lobe.
  std::uint32_t roughness_channel = 0;
  Precision precision = Precision::unorm8;
  float power = 1.0f;      // as OcclusionSettings has it
  float intensity = 1.0f;  // the same
};

// The convention of motion vectors: uv in this frame's image minus uv in the last frame's, y down,
// is scale * vector + offset. Vectors in pixels have a scale of 1 / size, those in normalised
// device coordinates 0.5 (y of Vulkan down), those from this frame to the last -1. Vectors that
// were drawn without jitter have an offset: this frame's jitter minus the last frame's, in uv.
struct MotionConvention {
  std::array<float, 2> scale{1.0f, 1.0f};
  std::array<float, 2> offset{0.0f, 0.0f};
};

struct Occlusion {
  // One channel, [0,1], 1 is open, of the depth's size. Null where it is not wanted.
  framegraph::Texture visibility;
  // Unit vectors in xyz, in the space of the normals. Null without bent normals.
  framegraph::Texture bent_normal;
  // One channel, the visible fraction of the GGX lobe, [0,1], 1 is open. Null without a lobe.
  framegraph::Texture specular;
};

struct ReconstructInputs {
  RawOcclusionTextures raw_occlusion;  // From add_gtao, with the same Frame::index.
  framegraph::Texture inverse_depth;   // From add_inverse_depth.
  framegraph::Texture normals;         // As GtaoInputs::normals.
  bool normals_in_view_space = false;
  // xy: how each surface moved on the image, in the units of `motion_convention`. Null: only the
  // camera moves. Where motion is given, occluders may move too, and with them the visibility of
  // surfaces that stand still: history is held to what the last few frames say.
  framegraph::Texture motion;
  framegraph::Texture roughness;  // as GtaoInputs::roughness
  // Textures of the depth's size, of the caller's, that results are written to, whole; null: a
  // transient of ReconstructSettings::precision. Read only where the result is wanted.
  Occlusion into;
  NormalEncoding normal_encoding = NormalEncoding::signed_xyz;
  bool normals_forward_z = false;  // as OcclusionInputs has it
  MotionConvention motion_convention;
};

// Adds the reconstruction. Each view of a graph needs a `history_name` of its own. A history starts
// anew when the size or the contents of the raw occlusion change, when history or bent normals were
// off in the previous frame, and after Graph::reset_history(history_name).
//
// Errors: an input that is missing or whose size differs from the inverse depth's, raw occlusion
// with another number of tiles, a view or previous view that cannot be used, sizes above the
// largest, a setting out of range, nothing to write.
[[nodiscard]] tl::expected<Occlusion, Error> add_reconstruct(
    const Frame& frame, const ReconstructInputs& inputs, const ReconstructSettings& settings,
    std::string_view history_name = "occlusion");

// Frees the histories of this name that the current or last declared frame does not use, once the
// device has finished with them: see Graph::drop_history.
void drop_reconstruct_history(framegraph::Graph& graph, std::string_view history_name);

}  // namespace alcove::passes
