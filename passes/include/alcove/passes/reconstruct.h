// Reconstructs every pixel from the traced ones: spatial filter, upsampling and temporal
// accumulation in one pass (Jimenez et al. 2016, sections 4.4 and 4.5, with other weights).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "alcove/passes/frame.h"
#include "alcove/passes/gtao.h"
#include "alcove/passes/settings.h"

namespace alcove::passes {

// The convention of motion vectors: uv in this frame's image minus uv in the last frame's, y down,
// is scale * vector + offset. Vectors in pixels have a scale of 1 / size, those in normalised
// device coordinates 0.5 (y of Vulkan down), those from this frame to the last -1. Vectors that
// were drawn without jitter have an offset: this frame's jitter minus the last frame's, in uv.
struct MotionConvention {
  std::array<float, 2> scale{1.0f, 1.0f};
  std::array<float, 2> offset{0.0f, 0.0f};
};

struct Occlusion {
  // One channel, [0,1], 1 is open. Null if it is not wanted.
  framegraph::Texture visibility;
  // Unit vectors in xyz, in the space of the normals. Null without bent normals.
  framegraph::Texture bent_normal;
  // One channel, the visible fraction of the GGX lobe, [0,1], 1 is open. Null without a lobe.
  framegraph::Texture specular;
};

struct ReconstructInputs {
  RawOcclusionTextures raw_occlusion;  // From add_gtao, with the same Frame::index.
  framegraph::Texture depth_ndc;       // See GtaoInputs::depth_ndc.
  framegraph::Texture normals;         // As GtaoInputs::normals.
  bool normals_in_view_space = false;
  // xy: how each surface moved on the image, in the units of `motion_convention`. Null: only the
  // camera moves. Where motion is given, occluders may move too, and with them the visibility of
  // surfaces that stand still: history is held to what the last few frames say.
  framegraph::Texture motion;
  framegraph::Texture roughness;  // as GtaoInputs::roughness
  // Textures of the caller's, of the results' size, that results are written to completely. If
  // null, the result is a transient of OcclusionSettings::precision. Read only if the result is
  // wanted.
  Occlusion into;
  NormalEncoding normal_encoding = NormalEncoding::signed_xyz;
  bool normals_forward_z = false;  // see OcclusionInputs
  MotionConvention motion_convention;
  // The channel of `into.visibility` that is written; `all` if that is null.
  VisibilityChannel visibility_channel = VisibilityChannel::all;
  // Results have half the depth's size, rounded up, and are not upsampled. Needs half_resolution.
  // The texel at (x, y) belongs to one of the 2x2 pixels from (2x, 2y) on: to the nearest of them
  // if x + y is even, and otherwise to the farthest that is not the sky.
  bool half_size_results = false;
};

// Adds the reconstruction. Each view of a graph needs a `history_name` of its own. A history starts
// anew when the size or the contents of the raw occlusion change, when history or bent normals were
// off in the previous frame, and after Graph::reset_history(history_name).
//
// Errors: an input that is missing or whose size is not the expected one, a texture for visibility
// whose other channels cannot be kept, results of half size without half_resolution, raw occlusion
// with another number of tiles, a view or previous view that cannot be used, sizes above the
// largest, settings that validate() refuses, nothing to write.
[[nodiscard]] tl::expected<Occlusion, Error> add_reconstruct(
    const Frame& frame, const ReconstructInputs& inputs, const OcclusionSettings& settings,
    std::string_view history_name = "occlusion");

// Frees the histories of this name that the current or last declared frame does not use, once the
// device has finished with them: see Graph::drop_history.
void drop_reconstruct_history(framegraph::Graph& graph, std::string_view history_name);

}  // namespace alcove::passes
