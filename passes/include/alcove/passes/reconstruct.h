// Reconstructs every pixel from the traced pixels: spatial filter, upsampling and temporal
// accumulation in one pass (Jimenez et al. 2016, sections 4.4 and 4.5, with other weights).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "alcove/passes/frame.h"
#include "alcove/passes/gtao.h"
#include "alcove/passes/settings.h"

namespace alcove::passes {

// Converts motion vectors as AlcoveView::motion (alcove.h) says.
struct MotionConvention {
  std::array<float, 2> scale{1.0f, 1.0f};
  std::array<float, 2> offset{0.0f, 0.0f};
};

struct Occlusion {
  // One channel, [0,1], 1 is open. Null if it was not requested.
  framegraph::Texture visibility;
  // Unit vectors in xyz, in the space of the normals. Null without bent normals.
  framegraph::Texture bent_normal;
  // One channel, the visible fraction of the GGX lobe, [0,1], 1 is open. Null without a lobe.
  framegraph::Texture specular;
};

struct ReconstructInputs {
  RawOcclusionTextures raw_occlusion;  // From add_gtao, with the same Frame::index.
  framegraph::Texture depth_ndc;       // See GtaoInputs::depth_ndc and depth_format.
  VkFormat depth_format = VK_FORMAT_UNDEFINED;
  framegraph::Texture normals;  // The same texture as GtaoInputs::normals.
  NormalConvention normal_convention;
  // Motion vectors in xy: how far each surface moved on the image, in the units of
  // `motion_convention`. If null, only the camera is assumed to move. With motion vectors,
  // occluders may move too, which changes the visibility of surfaces that do not move. The history
  // is then replaced where it differs from the mean of about the last four frames by more than
  // noise.
  framegraph::Texture motion;
  framegraph::Texture roughness;  // as GtaoInputs::roughness
  // Textures of the caller, of the results' size, to which the results are written completely. If a
  // texture is null, its result is a transient with OcclusionSettings::precision. A texture whose
  // result was not requested is ignored.
  Occlusion into;
  MotionConvention motion_convention;
  // The channel of `into.visibility` that is written; `all` if that is null.
  VisibilityChannel visibility_channel = VisibilityChannel::all;
  // Whether results have half the depth's size, rounded up, and are not upsampled. Needs
  // half_resolution. The texel at (x, y) belongs to one of the 2x2 pixels from (2x, 2y) on: to the
  // nearest of them if x + y is even, and otherwise to the farthest that is not the sky.
  bool half_size_results = false;
};

// Adds the reconstruction. Each view of a graph needs its own `history_name`. A history starts
// again from this frame when its size (Frame::largest_size) or half_resolution changes, when the
// raw occlusion has bent normals or a GGX lobe that the previous frame did not have, when the
// previous frame had no history, and after Graph::reset_history(history_name).
//
// Errors: an input that is missing or whose size differs from the depth's, raw occlusion whose size
// does not fit the number of tiles, a texture for visibility whose other channels cannot be kept,
// results of half size without half_resolution, a view or previous view that cannot be used, a size
// above Frame::largest_size, settings that validate() refuses, or no output that was requested.
[[nodiscard]] tl::expected<Occlusion, Error> add_reconstruct(
    const Frame& frame, const ReconstructInputs& inputs, const OcclusionSettings& settings,
    std::string_view history_name = "occlusion");

// Frees the histories of this name that the most recently declared frame does not use, after the
// device has finished with them: see Graph::drop_history.
void drop_reconstruct_history(framegraph::Graph& graph, std::string_view history_name);

}  // namespace alcove::passes
