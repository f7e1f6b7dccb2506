// Probe light on surfaces: diffuse and specular, each with its occlusion.
#pragma once

#include <cstdint>

#include "alcove/passes/frame.h"

namespace alcove::passes {

struct ApplySettings {
  // Occluders send light back, as of the surface's own albedo and lit as it is: the visibility of
  // the diffuse part is brightened as by add_multi_bounce, without a texture of it, and what
  // specular occlusion hides shows such an occluder instead of black.
  bool multi_bounce = true;
  float roughness = 0.5f;               // perceptual, [0,1], of every pixel where no texture has it
  float metallic = 0.0f;                // [0,1], the same
  std::uint32_t roughness_channel = 0;  // of the roughness texture, 0 to 3
  std::uint32_t metallic_channel = 0;   // of the metallic texture, 0 to 3
  bool parts = false;                   // also write the diffuse and the specular light alone
  Precision precision = Precision::float16;  // light is above 1: unorm8 is refused
};

// All of the size of the depth but the probe's own. What is null is left out of the shader.
struct ApplyInputs {
  framegraph::Texture depth;        // linear, as add_linear_depth makes it
  framegraph::Texture normals;      // xyz unit, in world space unless told otherwise
  framegraph::Texture albedo;       // base colour, linear RGB, [0,1]
  framegraph::Texture roughness;    // perceptual, [0,1]; null: ApplySettings::roughness
  framegraph::Texture metallic;     // [0,1]; null: ApplySettings::metallic
  framegraph::Texture visibility;   // one channel, [0,1]; null: diffuse light is not occluded
  framegraph::Texture bent_normal;  // as the normals; null: irradiance is along the normal
  framegraph::Texture specular_occlusion;  // one channel, [0,1], as add_gtso makes it; null: none
  // The light that goes to the eye besides the probe's, RGB: emission, direct light. It is added
  // untouched, in the sky too. Null: none.
  framegraph::Texture light;
  // The probe's light, world space with +Y up, in units of the caller's. Nine texels in a row, RGB:
  // coefficients of radiance by spherical harmonics (shaders/maths/spherical_harmonics.h).
  framegraph::Texture harmonics;
  // Prefiltered octahedral map, square, its mips by roughness (shaders/maths/environment_map.h).
  // Null: surfaces are purely diffuse, of their base colour.
  framegraph::Texture map;
  bool normals_in_view_space = false;  // and bent normals
};

// RGB radiance towards the eye, alpha 1: RGBA16_SFLOAT or RGBA32_SFLOAT. The sky is black but for
// ApplyInputs::light.
struct AppliedLight {
  framegraph::Texture lit;       // the sum of the parts and ApplyInputs::light
  framegraph::Texture diffuse;   // null without ApplySettings::parts
  framegraph::Texture specular;  // null without ApplySettings::parts or without a map
};

// Materials are those of glTF 2.0: dielectrics reflect 0.04 at normal incidence, metals their base
// colour. The specular part is the split sum's (shaders/maths/split_sum.h), the diffuse part gets
// what that leaves: no more light goes out than comes in.
//
// Errors: an input that is missing or of a wrong size, a setting out of range.
[[nodiscard]] tl::expected<AppliedLight, Error> add_apply(const Frame& frame,
                                                          const ApplyInputs& inputs,
                                                          const ApplySettings& settings);

}  // namespace alcove::passes
