// From traced pixels to every pixel: spatial filter, upsampling and history in one pass.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "alcove/passes/frame.h"
#include "alcove/passes/gtao.h"

namespace alcove::passes {

struct FilterSettings {
  // Searched pixels that a pixel looks at while it has less than two frames of history, or without
  // any: so many on each side, 0 to 3; then one. 0 filters nothing. They weigh in a window that is
  // the narrower the more slices were searched.
  std::uint32_t filter_radius = 2;
  // At this distance from the pixel's tangent plane a neighbour counts a quarter; in sizes of a
  // pixel there, over 0. That is in the first frame of one slice: the more slices and frames there
  // are, the nearer it has to be.
  float filter_tolerance_px = 1.5f;
  // Frames that are averaged, 0 to 127; once Frame::static_frames is 16, up to 127 in any case. 0
  // keeps no history and allocates none: for engines whose own temporal filter comes after.
  std::uint32_t history_frames = 0;
  // History is held to so many standard deviations of this frame's neighbourhood; 0 leaves it free.
  float clamp_width = 0.0f;

  friend bool operator==(const FilterSettings&, const FilterSettings&) = default;
};

struct ReconstructSettings : FilterSettings {
  bool visibility =
      true;  // also write it: off where only what else the raw_occlusion has is wanted
  float roughness = 0.5f;  // as GtaoSettings has them; read where the raw_occlusion has a lobe
  std::uint32_t roughness_channel = 0;
  Precision precision = Precision::unorm8;
  float power = 1.0f;      // as OcclusionSettings has it
  float intensity = 1.0f;  // the same
};

// What motion vectors mean: uv in this frame's image minus uv in the last frame's, y down, is
// scale * vector + offset. Vectors in pixels have a scale of 1 / size, those in normalised device
// coordinates 0.5 (y of Vulkan down), those from this frame to the last -1. Vectors that were drawn
// without jitter have an offset: this frame's jitter minus the last frame's, in uv.
struct MotionConvention {
  std::array<float, 2> scale{1.0f, 1.0f};
  std::array<float, 2> offset{0.0f, 0.0f};
};

struct Occlusion {
  // One channel, [0,1], 1 open, as large as the depth; null where none is wanted.
  framegraph::Texture visibility;
  framegraph::Texture bent_normal;  // xyz unit, in the space of the normals; null where the
                                    // raw_occlusion has none
  framegraph::Texture specular;  // one channel, the visible share of the GGX lobe, [0,1], 1 open;
                                 // null where the raw_occlusion has no lobe
};

struct ReconstructInputs {
  RawOcclusionTextures raw_occlusion;  // as add_gtao writes it, of this frame's index
  framegraph::Texture inverse_depth;   // as add_inverse_depth makes it
  framegraph::Texture normals;         // as GtaoInputs::normals
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

// `history_name` tells the histories of one graph apart: each view needs its own. A history begins
// anew where the size or the kind of the raw_occlusion changes, where history or bent normals were
// off in the frame before, and after Graph::reset_history(history_name).
//
// Errors: an input that is missing or of another size than the inverse depth, a raw_occlusion that
// is not of its blocks, a view that cannot be used, now or before, sizes that are not within the
// largest, a setting out of range, nothing to write.
[[nodiscard]] tl::expected<Occlusion, Error> add_reconstruct(
    const Frame& frame, const ReconstructInputs& inputs, const ReconstructSettings& settings,
    std::string_view history_name = "occlusion");

// Gives back the memory of the histories of this name that the frame being declared, or declared
// last, does not have, once the device is done with them: see Graph::drop_history.
void drop_reconstruct_history(framegraph::Graph& graph, std::string_view history_name);

}  // namespace alcove::passes
