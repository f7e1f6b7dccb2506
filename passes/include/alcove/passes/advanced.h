// Settings that most users never change: alternative methods from the literature to compare with,
// filter tuning, and parts of the occlusion search that can be switched off to measure their
// effect. The defaults suit every scene.
#pragma once

#include <cstdint>

namespace alcove::passes {

// How the thickness of occluders is estimated. A depth buffer shows only their fronts.
enum class Estimator : std::uint8_t {
  // Occluders are infinitely thick: the horizons of [Jimenez 2016].
  horizons,
  // Every sample is a separate occluder whose thickness is OcclusionSettings::thickness: the
  // visibility bitmask of Therrien et al. 2023, with exact cosine weights.
  bitmask,
  // Every sample is a separate occluder with a thickness, as with `bitmask`, but consecutive
  // samples of one surface are connected: the space between them is occluded too
  // (shaders/maths/connected_samples.h). It suits both thin objects and walls.
  connected,
};

// Returns whether the estimator gives occluders a finite thickness, and thus reads thickness,
// hidden_occlusion and depth_layers. The other estimators read AdvancedSettings::falloff instead.
[[nodiscard]] constexpr bool has_thickness(Estimator estimator) {
  return estimator == Estimator::bitmask || estimator == Estimator::connected;
}

// The unit of OcclusionSettings::thickness, for estimators with has_thickness().
enum class ThicknessUnit : std::uint8_t {
  radius,    // The occlusion radius: the thickness is constant in the scene.
  distance,  // The occluder's distance along the view axis: the thickness is constant on the image.
  // Each occluder ends at the nearest back face on its view ray, which a second depth buffer
  // (OcclusionInputs::back_depth_ndc) shows. For a closed solid, that is the point where the ray
  // leaves it, unless another solid stands inside it. If there is no back face behind the front
  // face (cards, planes, sky), the occluder has the thickness that the unit `radius` gives. A card
  // in front of a solid is assumed to extend to the solid's back, because two depths cannot
  // distinguish this case.
  back_faces,
};

// The type of OcclusionSettings::advanced. A setting that the selected estimator or history does
// not use has no effect, but it must still be in range. setting_table.h has the ranges.
struct AdvancedSettings {
  Estimator estimator = Estimator::connected;
  ThicknessUnit thickness_unit = ThicknessUnit::radius;
  // The outermost part of the radius, as a fraction of it, [0,1], over which occluders fade out. 0
  // turns fading off. It must be 0 with the estimators `bitmask` and `connected`, whose sectors are
  // either occluded or not.
  float falloff = 0.0f;
  // Filter radius in tiles for pixels with fewer than two frames of history, 0 to 3. Pixels with
  // more history use 1. 0 turns the spatial filter off.
  std::uint32_t filter_radius = 2;
  // Distance from the pixel's tangent plane, in pixels, at which the spatial filter gives a
  // neighbour the weight 0.25; above 0. This is the value for one slice and no history. The
  // distance shrinks as slices and frames accumulate.
  float filter_tolerance_px = 1.5f;

  // Parts of the search that can be switched off to measure what they do.

  // Whether each depth sample is moved to the centre of its texel. If not, tilted planes occlude
  // themselves.
  bool snap_to_texels = true;
  // Whether surfaces that leave the image are extrapolated beyond its border (`connected` only).
  bool extrapolation = true;
  // Whether directions that the depth buffer does not show (behind a foreground, or beyond the
  // image's border) are partly excluded from the average; see shaders/maths/unobserved.h. If not,
  // such directions count as unoccluded. Only the estimator `connected` reads it.
  bool unobserved = true;

  friend bool operator==(const AdvancedSettings&, const AdvancedSettings&) = default;
};

}  // namespace alcove::passes
