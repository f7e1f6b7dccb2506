// Ground-truth ambient occlusion: Jimenez, Wu, Pesce and Jarabo 2016, section 4.
#pragma once

#include <cstdint>

#include "alcove/passes/frame.h"

namespace alcove::passes {

// How the thickness of occluders is estimated. A depth buffer shows only their fronts.
enum class Estimator : std::uint8_t {
  // Occluders are infinitely thick (the paper's horizons).
  horizons,
  // Occluders are infinitely thick, but each lower sample further out pulls the horizon down (the
  // paper's thickness heuristic).
  heuristic,
  // Every sample is a separate occluder of the thickness in the settings (the visibility bitmask of
  // Therrien et al. 2023, with exact cosine weights).
  bitmask,
  // As `bitmask`, but consecutive samples of one surface are connected without gaps
  // (shaders/maths/connected_samples.h). Suits both thin objects and walls.
  connected,
};

// Whether the estimator reads SearchSettings::thickness and hidden_occlusion. Other estimators read
// SearchSettings::falloff.
[[nodiscard]] constexpr bool has_thickness(Estimator estimator) {
  return estimator == Estimator::bitmask || estimator == Estimator::connected;
}

// The unit of SearchSettings::thickness, for estimators with has_thickness().
enum class ThicknessUnit : std::uint8_t {
  radius,    // The occlusion radius: the thickness is constant in the scene.
  distance,  // The occluder's distance along the view axis: the thickness is constant on the image.
  // A second depth buffer of back faces gives the thickness: each occluder ends at the nearest back
  // face on its view ray. For a closed solid that is where the ray leaves it, unless another solid
  // stands inside. Without a back face behind the front (cards, planes, sky) the unit is `radius`.
  // A card in front of a solid is taken to reach to the solid's back, because two depths cannot
  // distinguish that case.
  back_faces,
};

// Whether GtaoInputs::back_inverse_depth and OcclusionInputs::back_depth_ndc are read. If not, an
// engine need not draw back faces.
[[nodiscard]] bool needs_back_depth(Estimator estimator, ThicknessUnit unit);

// Whether GtaoInputs::second_inverse_depth and OcclusionInputs::second_depth_ndc are read.
[[nodiscard]] bool needs_second_depth(Estimator estimator, std::uint32_t depth_layers);

// The weight of a visible direction.
enum class Weighting : std::uint8_t {
  cosine,   // The cosine of its angle to the normal, as diffuse reflection needs it.
  uniform,  // 1: visibility is a fraction of the hemisphere's solid angle (the paper's appendix A).
};

// How slice directions and step offsets vary over pixels and frames (shaders/maths/sampling.h).
enum class Pattern : std::uint8_t {
  golden,   // Lattices without a period, rotated by the golden ratio each frame.
  hilbert,  // The R2 sequence along a Hilbert curve.
  paper,    // The paper's 4x4 pixels and six rotations.
};

// Which pixels a workgroup traces. It changes the cost and not the image.
enum class Grouping : std::uint8_t {
  neighbours,  // 8x8 adjacent tiles.
  pattern,     // Every fourth tile in x and y: with Pattern::paper these have one slice direction.
};

// Parts of the search that exist to be measured (`alcove ablate`). The defaults suit engines.
struct SearchParts {
  // Snaps samples to texel centres. Without it, tilted planes occlude themselves.
  bool snap_to_texels = true;
  // Extrapolates surfaces that leave the image beyond its border (`connected` only).
  bool extrapolation = true;
  // Excludes directions that foregrounds or the image's border hide from the average (`connected`
  // only, shaders/maths/unobserved.h). Without it they count as open.
  bool unobserved = true;
  Grouping grouping = Grouping::neighbours;

  friend bool operator==(const SearchParts&, const SearchParts&) = default;
};

// How occluders are searched and integrated.
struct SearchSettings {
  // Occluders beyond this distance do not count. Scene units, above 0.
  float radius = 0.5f;
  // Slices per traced pixel and frame, 1 to 64. More slices reduce noise.
  std::uint32_t slices = 1;
  // Depth samples per half-slice, 2 to 64. A traced pixel costs 2 * slices * steps depth fetches.
  std::uint32_t steps = 12;
  Estimator estimator = Estimator::connected;
  // The weighting of visibility. Bent normals always have the cosine.
  Weighting weighting = Weighting::cosine;
  // Thickness of occluders in `thickness_unit`, at least 0, for `bitmask` and `connected`. With
  // `connected`, an occluder at its leading edge is at most as thick as its visible width, so that
  // blades, bars and leaves are thin.
  float thickness = 0.15f;
  ThicknessUnit thickness_unit = ThicknessUnit::radius;
  // Fraction of the volume hidden behind occluders that counts as occluded, [0,1], in the mean. It
  // is larger behind occluders that are wide on the image (hidden_occlusion_behind() in
  // shaders/maths/visibility_bitmask.h). Raising it darkens corners behind foregrounds.
  float hidden_occlusion = 0.33f;
  // Depth layers that are searched: 1, or 2 with GtaoInputs::second_inverse_depth.
  std::uint32_t depth_layers = 1;
  // How far each lower sample pulls the horizon down, [0,1] (`heuristic` only).
  float blend = 0.05f;
  // Last fraction of the radius over which occluders fade, [0,1]; 0 turns fading off (`horizons`
  // and `heuristic`). It must be 0 with the other estimators.
  float falloff = 0.0f;
  // Width of a tile in pixels: 1, 2 or 4. One pixel per tile is traced in a frame; the interleave
  // offset moves it from frame to frame.
  std::uint32_t tile_size = 1;
  Pattern pattern = Pattern::golden;
  SearchParts parts;

  friend bool operator==(const SearchSettings&, const SearchSettings&) = default;
};

struct GtaoSettings : SearchSettings {
  // Also writes the mean visible direction.
  bool bent_normal = false;
  // Also writes the visible fraction of each surface's GGX lobe (shaders/maths/lobe_slice.h).
  bool lobe = false;
  // Perceptual roughness of every pixel, [0,1], where there is no roughness texture.
  float roughness = 0.5f;
  std::uint32_t roughness_channel = 0;  // Channel of the roughness texture, 0 to 3.
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

// Adds the search. Errors: an input that is missing or whose size differs from the inverse depth's,
// a view that cannot be used, a setting out of range, a falloff with an estimator that has none.
[[nodiscard]] tl::expected<RawOcclusionTextures, Error> add_gtao(const Frame& frame,
                                                                 const GtaoInputs& inputs,
                                                                 const GtaoSettings& settings);

}  // namespace alcove::passes
