#include "maths/spherical_harmonics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "quadrature.h"

namespace alcove::maths_test {
namespace {

using glm::vec3;

template <typename Function>
double over_sphere(Function f) {
  return integrate(
      [&](double phi) {
        return integrate(
            [&](double theta) {
              const vec3 d(float(std::sin(theta) * std::cos(phi)), float(std::cos(theta)),
                           float(std::sin(theta) * std::sin(phi)));
              return double(f(d)) * std::sin(theta);
            },
            0.0, kPi, 8);
      },
      0.0, 2 * kPi, 8);
}

TEST(SphericalHarmonics, BasisIsOrthonormal) {
  for (unsigned i = 0; i < maths::kHarmonics; ++i) {
    for (unsigned j = 0; j <= i; ++j) {
      const double product =
          over_sphere([&](vec3 d) { return maths::harmonic(i, d) * maths::harmonic(j, d); });
      EXPECT_NEAR(product, i == j ? 1.0 : 0.0, 1e-6) << i << " " << j;
    }
  }
}

// The integral over the hemisphere of the cosine times a basis function is that function at the
// normal, times the factor of its band.
TEST(SphericalHarmonics, IrradianceOfEachBasisFunctionIsThatFunctionTimesTheFactorOfItsBand) {
  const vec3 normal = normalize(vec3(0.3f, 0.8f, -0.5f));
  for (unsigned i = 0; i < maths::kHarmonics; ++i) {
    const double irradiance = over_sphere([&](vec3 d) {
      return maths::harmonic(i, d) * std::max(dot(d, normal), 0.0f) / float(kPi);
    });
    EXPECT_NEAR(irradiance, maths::harmonic(i, normal) * maths::harmonic_irradiance(i), 2e-3) << i;
  }
}

}  // namespace
}  // namespace alcove::maths_test
