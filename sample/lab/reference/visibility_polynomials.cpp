#include "reference/visibility_polynomials.h"

#include <algorithm>

namespace alcove::sample {

VisibilityPolynomials visibility_polynomials(const glm::vec3& direction) {
  constexpr float kRoot3 = 1.7320508f, kRoot5 = 2.2360680f, kRoot6 = 2.4494897f;
  constexpr float kRoot8 = 2.8284271f, kRoot10 = 3.1622777f;
  const float x = direction.x, y = direction.y;
  const float r2 = x * x + y * y;
  // Cosines and sines of 2, 3 and 4 times the azimuth, times as many powers of the radius.
  const float cos2 = x * x - y * y, sin2 = 2.0f * x * y;
  const float cos3 = x * cos2 - y * sin2, sin3 = x * sin2 + y * cos2;
  const float cos4 = cos2 * cos2 - sin2 * sin2, sin4 = 2.0f * cos2 * sin2;
  const float coma = kRoot8 * (3.0f * r2 - 2.0f);
  const float secondary = kRoot10 * (4.0f * r2 - 3.0f);
  return {1.0f,
          2.0f * x,
          2.0f * y,
          kRoot3 * (2.0f * r2 - 1.0f),
          kRoot6 * cos2,
          kRoot6 * sin2,
          coma * x,
          coma * y,
          kRoot8 * cos3,
          kRoot8 * sin3,
          kRoot5 * (6.0f * r2 * (r2 - 1.0f) + 1.0f),
          secondary * cos2,
          secondary * sin2,
          kRoot10 * cos4,
          kRoot10 * sin4};
}

void add_weighted(VisibilityPolynomials& sum, const VisibilityPolynomials& other, float weight) {
  for (std::size_t i = 0; i < sum.size(); ++i) {
    sum[i] += weight * other[i];
  }
}

float visible_share(const VisibilityPolynomials& hidden, const VisibilityPolynomials& lobe) {
  float share = 0.0f;
  for (std::size_t i = 0; i < hidden.size(); ++i) {
    share += hidden[i] * lobe[i];
  }
  return std::clamp(1.0f - share, 0.0f, 1.0f);
}

}  // namespace alcove::sample
