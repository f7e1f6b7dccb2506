// Settings that most users never change: alternative methods from the literature to compare with,
// filter tuning, and parts of the occlusion search that can be switched off to measure their
// effect. The defaults suit every scene.
#pragma once

#include <cstdint>

namespace alcove::passes {

// How the thickness of occluders is estimated: AlcoveEstimator (alcove_advanced.h). `bitmask` is
// that of Therrien et al. 2023, with exact cosine weights (shaders/maths/visibility_bitmask.h).
enum class Estimator : std::uint8_t { horizons, bitmask, connected };

// Returns whether the estimator gives occluders a finite thickness, and thus reads thickness,
// hidden_occlusion and depth_layers. The other estimators read AdvancedSettings::falloff instead.
[[nodiscard]] constexpr bool has_thickness(Estimator estimator) {
  return estimator == Estimator::bitmask || estimator == Estimator::connected;
}

// The unit of OcclusionSettings::thickness: AlcoveThicknessUnit (alcove_advanced.h). With
// `back_faces`, an occluder ends at the nearest back face on its view ray
// (OcclusionInputs::back_depth_ndc). For a closed solid, that is the point where the ray leaves it,
// unless another solid stands inside it. A card in front of a solid is assumed to extend to the
// solid's back, because two depths cannot distinguish this case.
enum class ThicknessUnit : std::uint8_t { radius, distance, back_faces };

// AlcoveAdvancedSettings (alcove_advanced.h) describes the fields, and setting_table.h has the
// ranges. A setting that the selected estimator or history does not use has no effect, but it must
// still be in range.
struct AdvancedSettings {
  Estimator estimator = Estimator::connected;
  ThicknessUnit thickness_unit = ThicknessUnit::radius;
  float falloff = 0.0f;
  std::uint32_t filter_radius = 2;
  float filter_tolerance_px = 1.5f;
  // Parts of the search that can be switched off to measure what they do.
  bool snap_to_texels = true;
  bool extrapolation = true;
  bool unobserved = true;  // see shaders/maths/unobserved.h

  friend bool operator==(const AdvancedSettings&, const AdvancedSettings&) = default;
};

}  // namespace alcove::passes
