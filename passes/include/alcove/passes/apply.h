// Lights surfaces with a probe: diffuse and specular light, each with its occlusion.
#pragma once

#include <cstdint>

#include "alcove/passes/frame.h"

namespace alcove::passes {

struct ApplySettings {
  // Whether occluders reflect light. Occluders are assumed to have the albedo and the lighting of
  // the surface that they occlude. If true, the visibility of diffuse light is raised as in
  // add_multi_bounce(), and the occluded part of specular light shows this reflected light instead
  // of black.
  bool multi_bounce = true;
  float roughness = 0.5f;               // perceptual, [0,1]; used if there is no roughness texture
  float metallic = 0.0f;                // [0,1]; used if there is no metallic texture
  std::uint32_t roughness_channel = 0;  // of the roughness texture, 0 to 3
  std::uint32_t metallic_channel = 0;   // of the metallic texture, 0 to 3
  bool parts = false;                   // also writes diffuse and specular light separately
  Precision precision = Precision::float16;  // light is above 1: unorm8 is refused
};

// The textures that add_apply() reads. All except those of the probe must have the size of `depth`.
// If an optional texture is null, the parts of the shader that need it are compiled out.
struct ApplyInputs {
  framegraph::Texture depth;        // linear, as add_linear_depth makes it
  framegraph::Texture normals;      // xyz unit, in world space unless told otherwise
  framegraph::Texture albedo;       // base colour, linear RGB, [0,1]
  framegraph::Texture roughness;    // perceptual, [0,1]; null: ApplySettings::roughness
  framegraph::Texture metallic;     // [0,1]; null: ApplySettings::metallic
  framegraph::Texture visibility;   // one channel, [0,1]; null: diffuse light is not occluded
  framegraph::Texture bent_normal;  // in the space of the normals; null: the normal is used
  framegraph::Texture specular_occlusion;  // one channel, [0,1], as add_gtso makes it; null: none
  // RGB light that is added to the result unchanged, for example emission and direct light. It is
  // also added at pixels of the sky. Null: no light is added.
  framegraph::Texture light;
  // The probe's radiance in any unit, in world space with +Y up: 9x1 texels with the RGB
  // coefficients of its spherical harmonics (shaders/maths/spherical_harmonics.h).
  framegraph::Texture harmonics;
  // The probe's radiance as a square, prefiltered octahedral map whose mips have increasing
  // roughness (shaders/maths/environment_map.h). Null: surfaces reflect their base colour diffusely
  // and have no specular light.
  framegraph::Texture map;
  bool normals_in_view_space = false;  // whether normals and bent normals are in view space
};

// The results of add_apply(): radiance towards the eye in RGB, and 1 in alpha, in the format
// RGBA16_SFLOAT or RGBA32_SFLOAT. Pixels of the sky are black, apart from ApplyInputs::light.
struct AppliedLight {
  framegraph::Texture lit;       // the sum of the parts and ApplyInputs::light
  framegraph::Texture diffuse;   // null without ApplySettings::parts
  framegraph::Texture specular;  // null without ApplySettings::parts or without a map
};

// Adds a pass that lights the surfaces of a view with a probe. Materials are those of glTF 2.0:
// dielectrics reflect 0.04 at normal incidence, metals their base colour. Specular light is
// computed with the split-sum approximation (shaders/maths/split_sum.h). Diffuse light gets the
// energy that is not reflected specularly, so that a surface never reflects more light than it
// receives.
//
// Errors: a missing input, an input of the wrong size, or a setting out of range.
[[nodiscard]] tl::expected<AppliedLight, Error> add_apply(const Frame& frame,
                                                          const ApplyInputs& inputs,
                                                          const ApplySettings& settings);

}  // namespace alcove::passes
