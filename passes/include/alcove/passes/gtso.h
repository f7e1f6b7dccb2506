// Ground-truth specular occlusion: Jimenez, Wu, Pesce and Jarabo 2016, section 6, by cones or by
// its table.
#pragma once

#include <cstdint>

#include "alcove/passes/frame.h"
#include "alcove/passes/settings.h"

namespace alcove::passes {

// All of one size.
struct GtsoInputs {
  framegraph::Texture visibility;   // one channel, [0,1], 1 open
  framegraph::Texture bent_normal;  // xyz unit, in the space of the normals
  framegraph::Texture normals;      // xyz unit, in world space unless `normals_in_view_space`
  framegraph::Texture depth;        // linear, as add_linear_depth makes it
  framegraph::Texture roughness;    // perceptual, [0,1]; null: OcclusionSettings::roughness
  bool normals_in_view_space = false;
  NormalEncoding normal_encoding = NormalEncoding::signed_xyz;  // of `normals`
  bool normals_forward_z = false;                               // see OcclusionInputs
  framegraph::Texture
      into;  // to be written, whole; null: a transient of OcclusionSettings::precision
};

// Out: one channel, the visible share of the GGX lobe of each pixel, [0,1], 1 open, which
// multiplies specular probe light; 1 in the sky. Unorm8 is R8_UNORM, float16 R16_SFLOAT, float32
// R32_SFLOAT.
//
// An open surface stays open at any roughness and angle: a visibility within 1/128 of 1 counts as
// open, because a filtered one is no surer than that and a cone turns it into degrees. The paper
// divides by the whole lobe, also by what lies under the surface; here that is left out.
//
// Errors: an input that is missing or of another size than the rest, settings that validate()
// refuses or whose `specular` is neither `table` nor `cone`.
[[nodiscard]] tl::expected<framegraph::Texture, Error> add_gtso(const Frame& frame,
                                                                const GtsoInputs& inputs,
                                                                const OcclusionSettings& settings);

}  // namespace alcove::passes
