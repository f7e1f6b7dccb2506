#include "maths/environment_map.h"

#include <gtest/gtest.h>

#include "equirectangular.h"
#include "random_input.h"

namespace alcove::maths_test {
namespace {

using glm::ivec2;
using glm::vec2;
using glm::vec3;

TEST(EnvironmentMap, DirectionsConvertToOctahedralAndEquirectangularCoordinatesAndBack) {
  RandomInput random;
  for (int i = 0; i < 20000; ++i) {
    const vec3 d = random.unit_vector();
    EXPECT_LT(distance(equirectangular_direction(maths::equirectangular_uv(d)), d), 2e-6f);
    EXPECT_LT(distance(maths::map_direction(maths::map_uv(d)), d), 2e-6f);
  }
  for (const vec3 pole : {vec3(0, 1, 0), vec3(0, -1, 0)}) {
    EXPECT_LT(distance(equirectangular_direction(maths::equirectangular_uv(pole)), pole), 1e-6f);
    EXPECT_LT(distance(maths::map_direction(maths::map_uv(pole)), pole), 1e-6f);
  }
}

TEST(EnvironmentMap, CoordinateAxesMapToTheirDocumentedPositionsInTheImage) {
  EXPECT_NEAR(maths::equirectangular_uv({0, 0, -1}).x, 0.0f, 1e-6f);
  EXPECT_NEAR(maths::equirectangular_uv({1, 0, 0}).x, 0.25f, 1e-6f);
  EXPECT_NEAR(maths::equirectangular_uv({0, 0, 1}).x, 0.5f, 1e-6f);
  EXPECT_NEAR(maths::equirectangular_uv({0, 1, 0}).y, 0.0f, 1e-6f);
  EXPECT_LT(distance(maths::map_uv({0, 1, 0}), vec2(0.5f)), 1e-6f);
}

// Checks that two neighbouring texels across an edge of the map are not farther apart in angle than
// neighbouring texels inside the map.
TEST(EnvironmentMap, TexelsBeyondAnEdgeOfTheOctahedralMapContinueItOnTheSphere) {
  constexpr int kSize = 16;
  const auto direction = [](ivec2 texel) {
    const ivec2 there = maths::map_texel(texel, kSize);
    EXPECT_TRUE(there.x >= 0 && there.x < kSize && there.y >= 0 && there.y < kSize);
    return maths::map_direction((vec2(there) + 0.5f) / float(kSize));
  };
  for (int i = 0; i < kSize; ++i) {
    EXPECT_LT(distance(direction({-1, i}), direction({0, i})), 0.26f) << i;
    EXPECT_LT(distance(direction({kSize, i}), direction({kSize - 1, i})), 0.26f) << i;
    EXPECT_LT(distance(direction({i, -1}), direction({i, 0})), 0.26f) << i;
    EXPECT_LT(distance(direction({i, kSize}), direction({i, kSize - 1})), 0.26f) << i;
    EXPECT_EQ(maths::map_texel({i, i}, kSize), ivec2(i, i));
  }
  // All four corners are the direction -Y.
  EXPECT_LT(distance(direction({-1, -1}), direction({0, 0})), 0.26f);
}

TEST(EnvironmentMap, SolidAnglesOfAllTexelsSumToFourPi) {
  for (const int size : {16, 64, 256}) {
    double sum = 0.0;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        sum += maths::map_texel_angle((vec2(x, y) + 0.5f) / float(size), float(size));
    EXPECT_NEAR(sum, 4.0 * 3.14159265, 12.0 / (size * size)) << size;
  }
}

TEST(EnvironmentMap, MipLevelsCoverRoughnessZeroToOneAndConvertBack) {
  EXPECT_EQ(maths::level_of_roughness(0.0f, 6), 0.0f);
  EXPECT_EQ(maths::level_of_roughness(2.0f, 6), 5.0f);
  EXPECT_EQ(maths::level_of_roughness(0.7f, 1), 0.0f);
  EXPECT_EQ(maths::roughness_of_level(0, 1), 0.0f);
  for (unsigned level = 0; level < 6; ++level) {
    EXPECT_NEAR(maths::level_of_roughness(maths::roughness_of_level(level, 6), 6), float(level),
                1e-6f);
  }
}

}  // namespace
}  // namespace alcove::maths_test
