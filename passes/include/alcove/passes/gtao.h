// Ground-truth ambient occlusion: Jimenez, Wu, Pesce and Jarabo 2016, section 4.
#pragma once

#include <cstdint>

#include "alcove/passes/frame.h"

namespace alcove::passes {

// What stands behind an occluder's front, which is all that a depth buffer shows.
enum class Estimator : std::uint8_t {
  // Everything: occluders are infinitely thick (the paper's horizons).
  horizons,
  // The same, but that each lower sample further out pulls the horizon down (the paper's thickness
  // heuristic).
  heuristic,
  // Every sample is an occluder of its own, of one thickness (the visibility bitmask of Therrien et
  // al. 2023, exactly weighted).
  bitmask,
  // The same where samples do not lie on one surface; those that do are joined into a segment
  // without
  // gaps (shaders/maths/connected_samples.h). Suits thin things and walls alike.
  connected,
};

// Whether its occluders have a thickness, and hide something; else they may have a falloff.
[[nodiscard]] constexpr bool has_thickness(Estimator estimator) {
  return estimator == Estimator::bitmask || estimator == Estimator::connected;
}

// What an occluder's thickness is measured in, for the estimators that have one.
enum class ThicknessUnit : std::uint8_t {
  radius,    // parts of the occlusion radius: one thickness in the scene
  distance,  // parts of the occluder's distance from the eye along the view axis: one in the image
  // By a second depth buffer, of back faces: each occluder ends where its view ray meets the
  // nearest of them, however far behind. Of a closed solid that is where the ray leaves it, unless
  // others stand in it. Where there is none behind the front (cards, planes, sky) as `radius` has
  // it; a card before a solid is taken to hidden_occlusion all the way to that one's back, which
  // two depths cannot tell.
  back_faces,
};

// Whether GtaoInputs::back_inverse_depth and OcclusionInputs::back_depth_ndc are read, and so
// whether an engine has to draw back faces at all.
[[nodiscard]] bool needs_back_depth(Estimator estimator, ThicknessUnit unit);

// The same of GtaoInputs::second_inverse_depth and OcclusionInputs::second_depth_ndc.
[[nodiscard]] bool needs_second_depth(Estimator estimator, std::uint32_t depth_layers);

// What a visible direction weighs.
enum class Weighting : std::uint8_t {
  cosine,   // of its angle to the normal: what diffuse surfaces reflect
  uniform,  // 1: the visible part of the hemisphere's solid angle (the paper's appendix A)
};

// How directions are spread over pixels and frames (shaders/maths/sampling.h).
enum class Pattern : std::uint8_t {
  golden,   // a 4x4 block in the order of ordered dithering, turned by the golden ratio each frame
  hilbert,  // Hilbert curve and R2 sequence
  paper,    // the paper's 4x4 block and six rotations
};

// Which searches a group of the device's threads makes together. The image is the same.
enum class Grouping : std::uint8_t {
  neighbours,  // of 8x8 blocks
  pattern,     // of every fourth block each way, which the 4x4 patterns give one direction
};

// Parts of a search that are there to be measured (`alcove ablate`): the defaults suit engines.
struct SearchParts {
  // Whether a sample lies where its texel does; else where it was asked for, so that tilted planes
  // occlude themselves.
  bool snap_to_texels = true;
  // Whether surfaces that leave the image go on beyond its border as they left (connected samples).
  bool extrapolation = true;
  // Whether what foregrounds and the image's border hide is left out of visibility, neither open
  // nor occluded (connected samples, shaders/maths/unobserved.h); else it counts as open.
  bool unobserved = true;
  Grouping grouping = Grouping::neighbours;

  friend bool operator==(const SearchParts&, const SearchParts&) = default;
};

// How occluders are searched and what they count.
struct SearchSettings {
  float radius = 0.5f;       // scene units, over 0: occluders beyond it do not count
  std::uint32_t slices = 1;  // a pixel, 1 to 64; with the noise of a 4x4 block, 16 times as many
  std::uint32_t steps = 12;  // a side of a slice, 2 to 64: 2 * slices * steps depth fetches a pixel
  Estimator estimator = Estimator::connected;
  Weighting weighting = Weighting::cosine;  // of visibility; bent normals have the cosine always
  // Of occluders, for bitmask and connected samples, at least 0. With these a surface is where it
  // begins no thicker than it is sure to be wide: blades, bars and leaves are thin.
  float thickness = 0.15f;
  ThicknessUnit thickness_unit = ThicknessUnit::radius;
  // Part of what is hidden behind them that occludes too, [0,1]: 0 nothing, 1 all, between the more
  // the wider they are in the image (hidden_occlusion_behind(),
  // shaders/maths/visibility_bitmask.h).
  float hidden_occlusion = 0.33f;
  std::uint32_t depth_layers = 1;  // that are searched: 1, or 2 with what lies behind the first
  // For horizons and heuristic.
  float blend = 0.05f;  // of a horizon towards each lower sample, [0,1] (heuristic)
  // Last part of the radius, over which occluders fade, [0,1]; 0: none. Must be 0 for bitmask and
  // connected samples, whose sectors are occluded or not.
  float falloff = 0.0f;
  // One search a frame in a block of so many pixels a side: 1, 2 or 4. Which of them moves on from
  // frame to frame.
  std::uint32_t tile_size = 1;
  Pattern pattern = Pattern::golden;
  SearchParts parts;

  friend bool operator==(const SearchSettings&, const SearchSettings&) = default;
};

struct GtaoSettings : SearchSettings {
  bool bent_normal = false;  // also write the mean visible direction
  // Also write how much of each surface's GGX lobe its slices see (shaders/maths/lobe_slice.h).
  bool lobe = false;
  float roughness = 0.5f;               // perceptual, [0,1], of every pixel where no texture has it
  std::uint32_t roughness_channel = 0;  // of the roughness texture, 0 to 3
};

struct GtaoInputs {
  framegraph::Texture inverse_depth;  // as add_inverse_depth makes it
  // xyz unit, in world space unless `normals_in_view_space`. What AlcoveView::normals says of
  // normals that face away from the eye, or are missing, holds here too.
  framegraph::Texture normals;
  bool normals_in_view_space = false;
  framegraph::Texture roughness;  // perceptual, [0,1]; null: GtaoSettings::roughness
  // Of OcclusionInputs::back_depth_ndc, as add_inverse_depth makes it; only where
  // needs_back_depth().
  framegraph::Texture back_inverse_depth;
  // The same of OcclusionInputs::second_depth_ndc; only where needs_second_depth().
  framegraph::Texture second_inverse_depth;
  // Of the depth buffer that inverse_depth was made from. Its format and the projection tell the
  // step between the depths that it can hold. Samples within about one step of the surface's
  // tangent plane do not occlude, and visibility fades to open while the step grows from a quarter
  // of the radius to the radius. The step at a distance z is z^2 / near * 2^-24 with 32-bit floats
  // or 24 bits and depth that is not reversed, z^2 / near * 2^-16 with 16 bits, z * 2^-23 with
  // reversed floats.
  VkFormat depth_format = VK_FORMAT_D32_SFLOAT;
  NormalEncoding normal_encoding = NormalEncoding::signed_xyz;
  bool normals_forward_z = false;  // as OcclusionInputs has it
};

// What filters and history work on: sums over slices, one texel a block.
struct RawOcclusionTextures {
  // R32G32_UINT: the visible part of the slices and all of it (shaders/maths/raw_occlusion.h), and
  // the bits of a float that is linear along the image of any plane. With a lobe R32G32B32A32_UINT:
  // the same two of it, and the surface it belongs to.
  framegraph::Texture raw_occlusion;
  // R32G32_UINT: how far the mean visible direction, weighted by the cosine, bends from the normal,
  // and would if all were open, view space, 10 bits a component (shaders/maths/bent_normal.h); null
  // where none is wanted.
  framegraph::Texture bent;
  std::uint32_t tile_size = 1;  // pixels on a side of a block
  std::uint32_t slices = 1;     // that were searched in each
  bool lobe = false;
};

// Errors: an input that is missing or of another size than the inverse depth, a view that cannot be
// used, a setting out of range, a falloff that the estimator does not have.
[[nodiscard]] tl::expected<RawOcclusionTextures, Error> add_gtao(const Frame& frame,
                                                                 const GtaoInputs& inputs,
                                                                 const GtaoSettings& settings);

}  // namespace alcove::passes
