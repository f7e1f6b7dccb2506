// Ground-truth specular occlusion by the table of Jimenez, Wu, Pesce and Jarabo 2016, section 6.
#pragma once

#include "alcove/passes/frame.h"
#include "alcove/passes/settings.h"

namespace alcove::passes {

// The inputs of add_gtso(). All textures must have the same size.
struct GtsoInputs {
  framegraph::Texture visibility;   // [0,1], 1 open
  framegraph::Texture bent_normal;  // xyz unit, in the space of the normals
  framegraph::Texture normals;      // unit vectors, as `normal_convention` says
  framegraph::Texture depth;        // linear, as add_linear_depth makes it
  framegraph::Texture roughness;    // perceptual, [0,1]; null: OcclusionSettings::roughness
  NormalConvention normal_convention;
  framegraph::Texture
      into;  // the texture to write completely; null: a transient of OcclusionSettings::precision
};

// Adds a pass that computes specular occlusion from visibility and bent normals. Returns a texture
// with one channel: the visible fraction of the GGX lobe of each pixel, [0,1], where 1 is open.
// Multiply specular probe light by it. The sky gets 1. The format is R8_UNORM, R16_SFLOAT or
// R32_SFLOAT, by OcclusionSettings::precision.
//
// An unoccluded surface gets 1 at any roughness and angle: a visibility within 1/128 of 1 counts as
// open, because a filtered visibility is not more accurate than that. The paper divides by the
// whole lobe; this pass leaves out the part of the lobe that lies below the surface.
//
// Errors: a missing input, inputs of different sizes, settings that validate() refuses, or a
// setting `specular` other than `table`.
[[nodiscard]] tl::expected<framegraph::Texture, Error> add_gtso(const Frame& frame,
                                                                const GtsoInputs& inputs,
                                                                const OcclusionSettings& settings);

}  // namespace alcove::passes
