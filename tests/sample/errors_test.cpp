#include "evaluate/errors.h"

#include <gtest/gtest.h>

#include <cmath>

namespace alcove::sample {
namespace {

TEST(Errors, ErrorSummaryMatchesKnownDifferencesOfTwoImages) {
  Image<float> truth(4, 1, 0.5f), result = truth;
  result.pixels = {0.6f, 0.4f, 0.5f, 9.0f};
  Mask mask(4, 1, 1);
  mask.pixels[3] = 0;
  const ErrorSummary error = compare_images(result, truth, mask);
  EXPECT_EQ(error.count, 3u);
  EXPECT_NEAR(error.rmse, std::sqrt(0.02 / 3.0), 1e-6);
  EXPECT_NEAR(error.bias, 0.0, 1e-6);
  EXPECT_NEAR(error.max_absolute, 0.1, 1e-6);
}

TEST(Errors, NaNPixelCountsAsAnErrorOfOne) {
  const ErrorSummary error =
      compare_images(Image<float>(1, 1, NAN), Image<float>(1, 1, 0.5f), Mask(1, 1, 1));
  EXPECT_EQ(error.rmse, 1.0);
}

TEST(Errors, AngleErrorIgnoresLengthsAndCountsAZeroVectorAs90Degrees) {
  Image<glm::vec3> truth(2, 1, glm::vec3(0, 1, 0)), result(2, 1);
  result.pixels = {glm::vec3(0, 3, 3), glm::vec3(0)};
  const AngleSummary angles = compare_directions(result, truth, Mask(2, 1, 1));
  EXPECT_NEAR(angles.mean_degrees, 0.5 * (45.0 + 90.0), 1e-4);
}

TEST(Errors, SummaryOfOpenSurfacesCoversPixelsWhoseTruthIsUnoccluded) {
  Image<float> truth(3, 1), result(3, 1);
  truth.pixels = {1.0f, 1.0f, 0.9f};
  result.pixels = {0.9f, 1.0f, 0.0f};
  const OpenSurfaceSummary open = open_surfaces(result, truth, Mask(3, 1, 1));
  EXPECT_EQ(open.count, 2u);
  EXPECT_NEAR(open.mean_visibility, 0.95, 1e-6);
  EXPECT_EQ(open.fraction_below_95, 0.5);
}

TEST(Errors, EmptyMaskGivesAnErrorSummaryOfZeroPixels) {
  EXPECT_EQ(compare_images(Image<float>(1, 1), Image<float>(1, 1), Mask(1, 1)).count, 0u);
}

}  // namespace
}  // namespace alcove::sample
