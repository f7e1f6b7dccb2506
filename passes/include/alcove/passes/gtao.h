// Ground-truth ambient occlusion: Jimenez, Wu, Pesce and Jarabo 2016, section 4.
#pragma once

#include <cstdint>

#include "alcove/passes/frame.h"
#include "alcove/passes/inputs.h"
#include "alcove/passes/settings.h"

namespace alcove::passes {

struct GtaoInputs : OcclusionInputs {
  // With a mask, the depth with sky in the place of surfaces that do not receive occlusion;
  // `depth_ndc` then has kNoOccluder in the place of those that do not occlude (add_occlusion()
  // makes both). Null: there is no mask.
  framegraph::Texture receiver_depth_ndc;
};

// The raw occlusion of a frame, one texel per tile: sums over slices, which reconstruction filters.
struct RawOcclusionTextures {
  // R32G32_UINT: the packed visible and unoccluded parts (shaders/maths/raw_occlusion.h), and the
  // bits of the traced pixel's inverse depth as a float. With specular occlusion (`lobe`) the
  // format is R32G32B32A32_UINT: also the packed parts of the GGX lobe, and the surface's normal
  // and roughness.
  framegraph::Texture raw_occlusion;
  // R32G32_UINT: two sums over the slices, in view space, with 10 bits per component
  // (shaders/maths/bent_normal.h). The first is the bent-normal residual, the second the residual
  // that is expected without occluders. Null if no bent normals are computed.
  framegraph::Texture bent;
  std::uint32_t tile_size = 1;  // Width of a tile in pixels.
  std::uint32_t slices = 1;     // Slices per traced pixel.
  bool lobe = false;            // Whether raw_occlusion holds a lobe.
};

// Adds the pass that searches for occluders. The raw occlusion has bent normals if
// needs_bent_normal(settings), and a GGX lobe if `specular` is Specular::slices.
//
// Errors: an input that is missing or whose size differs from the depth's, a view whose matrices
// cannot be used, or settings that validate() refuses.
[[nodiscard]] tl::expected<RawOcclusionTextures, Error> add_gtao(const Frame& frame,
                                                                 const GtaoInputs& inputs,
                                                                 const OcclusionSettings& settings);

}  // namespace alcove::passes
