// Ground-truth specular occlusion: Jimenez, Wu, Pesce and Jarabo 2016, section 6, by cones or by
// its table.
#pragma once

#include <cstdint>

#include "alcove/passes/frame.h"

namespace alcove::passes {

// How the part of a GGX lobe that a surface sees is found (shaders/maths/gtso.h).
enum class SpecularModel : std::uint8_t {
  // The exact intersection of the cone of visibility around the bent normal with the cone of the
  // lobe, in parts of the lobe above the surface.
  cone,
  // The same with the intersection by a smooth step: cheaper, and up to 0.16 off the exact one.
  smooth_cone,
  // Lagarde and de Rousiers 2014: from visibility and angle of view, without a bent normal.
  lagarde,
  // The paper's table: the lobe itself within the cone of visibility, for the angles between bent
  // normal, mirror direction and normal (shaders/maths/gtso_table.h). 54 KiB that no other model
  // has.
  table,
};

struct GtsoSettings {
  SpecularModel model = SpecularModel::table;
  float roughness = 0.5f;               // perceptual, [0,1], of every pixel where no texture has it
  std::uint32_t roughness_channel = 0;  // of the roughness texture, 0 to 3
  Precision precision = Precision::unorm8;
};

// All of one size.
struct GtsoInputs {
  framegraph::Texture visibility;   // one channel, [0,1], 1 open
  framegraph::Texture bent_normal;  // xyz unit, in the space of the normals; not read by lagarde
  framegraph::Texture normals;      // xyz unit, in world space unless `normals_in_view_space`
  framegraph::Texture depth;        // linear, as add_linear_depth makes it
  framegraph::Texture roughness;    // perceptual, [0,1]; null: GtsoSettings::roughness
  bool normals_in_view_space = false;
  NormalEncoding normal_encoding = NormalEncoding::signed_xyz;  // of `normals`
  bool normals_forward_z = false;                               // as OcclusionInputs has it
  framegraph::Texture into;  // to be written, whole; null: a transient of GtsoSettings::precision
};

// Out: one channel, the visible share of the GGX lobe of each pixel, [0,1], 1 open, which
// multiplies specular probe light; 1 in the sky. Unorm8 is R8_UNORM, float16 R16_SFLOAT, float32
// R32_SFLOAT.
//
// An open surface stays open at any roughness and angle: a visibility within 1/128 of 1 counts as
// open, because a filtered one is no surer than that and a cone turns it into degrees. The paper
// divides by the whole lobe, also by what lies under the surface; here that is left out.
//
// Errors: an input that is missing or of another size than the rest, a roughness or a channel out
// of range.
[[nodiscard]] tl::expected<framegraph::Texture, Error> add_gtso(const Frame& frame,
                                                                const GtsoInputs& inputs,
                                                                const GtsoSettings& settings);

}  // namespace alcove::passes
