// Ground-truth ambient occlusion: Jimenez, Wu, Pesce and Jarabo 2016, section 4.
#pragma once

#include <cstdint>

#include "alcove/passes/frame.h"
#include "alcove/passes/settings.h"

namespace alcove::passes {

struct GtaoInputs {
  // A depth texture (any depth or R32 float format) as the view's projection wrote it. Its format
  // and the projection tell the step between the depths that it can hold. Samples within about one
  // step of the surface's tangent plane do not occlude, and visibility fades to open while the step
  // grows from a quarter of the radius to the radius. The step at a distance z is z^2 / near *
  // 2^-24 with 32-bit floats or 24 bits and depth that is not reversed, z^2 / near * 2^-16 with 16
  // bits, z * 2^-23 with reversed floats.
  framegraph::Texture depth_ndc;
  // xyz unit, in world space unless `normals_in_view_space`. What AlcoveView::normals says of
  // normals that face away from the eye, or are missing, holds here too.
  framegraph::Texture normals;
  bool normals_in_view_space = false;
  framegraph::Texture roughness;  // perceptual, [0,1]; null: OcclusionSettings::roughness
  // See OcclusionInputs::back_depth_ndc. Needed only if needs_back_depth() returns true.
  framegraph::Texture back_depth_ndc;
  // See OcclusionInputs::second_depth_ndc. Needed only if needs_second_depth() returns true.
  framegraph::Texture second_depth_ndc;
  // The format whose depths `depth_ndc` holds, if they were copied from another texture. By default
  // it is that of `depth_ndc` itself.
  VkFormat depth_format = VK_FORMAT_UNDEFINED;
  NormalEncoding normal_encoding = NormalEncoding::signed_xyz;
  bool normals_forward_z = false;  // see OcclusionInputs
};

// The raw occlusion of a frame, one texel per tile: sums over slices, which reconstruction filters.
struct RawOcclusionTextures {
  // R32G32_UINT: the packed visible and unoccluded parts (shaders/maths/raw_occlusion.h), and the
  // bits of the traced pixel's inverse depth as a float. With a lobe R32G32B32A32_UINT: also the
  // packed parts of the lobe and the surface's normal and roughness.
  framegraph::Texture raw_occlusion;
  // R32G32_UINT: the bent-normal residual and its expectation when unoccluded, in view space, 10
  // bits per component (shaders/maths/bent_normal.h). Null without bent normals.
  framegraph::Texture bent;
  std::uint32_t tile_size = 1;  // Width of a tile in pixels.
  std::uint32_t slices = 1;     // Slices per traced pixel.
  bool lobe = false;            // Whether raw_occlusion holds a lobe.
};

// Adds the search. The raw occlusion has bent normals if needs_bent_normal(settings), and a lobe
// with Specular::slices. Errors: an input that is missing or whose size differs from the
// depth's, a view that cannot be used, settings that validate() refuses.
[[nodiscard]] tl::expected<RawOcclusionTextures, Error> add_gtao(const Frame& frame,
                                                                 const GtaoInputs& inputs,
                                                                 const OcclusionSettings& settings);

}  // namespace alcove::passes
