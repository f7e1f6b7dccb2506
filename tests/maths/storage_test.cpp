// Encodings of values that one pass writes and another reads: octahedral vectors and visibility.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "maths/half_texel.h"
#include "maths/octahedral.h"
#include "maths/packing.h"
#include "maths/quantised_normal.h"
#include "maths/raw_occlusion.h"
#include "random_input.h"

namespace alcove::maths_test {
namespace {

using glm::vec2;
using glm::vec3;
using glm::vec4;

maths::RawOcclusion raw_occlusion_of(float visible, float open) {
  maths::RawOcclusion raw_occlusion;
  raw_occlusion.visible = visible;
  raw_occlusion.open = open;
  return raw_occlusion;
}

TEST(RawOcclusion, RawOcclusionOfWeightZeroMeansVisibilityOne) {
  EXPECT_EQ(maths::mean_visibility(raw_occlusion_of(0.0f, 0.0f)), 1.0f);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(maths::mean_visibility(raw_occlusion_of(0.0f, nan)), 1.0f);
}

TEST(RawOcclusion, PackingKeepsVisibilityApproximatelyAndVisibilityOneExactly) {
  RandomInput random;
  for (int i = 0; i < 20000; ++i) {
    const float open = random.uniform(1e-3f, maths::kLargestOpen);
    const float ratio = i % 5 == 0 ? 1.0f : random.uniform(0.0f, 1.0f);
    const maths::RawOcclusion back = maths::unpack_raw_occlusion(
        maths::pack_raw_occlusion(raw_occlusion_of(ratio * open, open), 0xffu));
    EXPECT_NEAR(back.open, open, open / 120);
    EXPECT_NEAR(back.visible, ratio * back.open, 6.2e-5f * back.open);
    if (ratio == 1.0f) {
      EXPECT_EQ(back.visible, back.open);
    }
  }
}

TEST(RawOcclusion, PackingKeepsSpecularLobeSumsOfAnyMagnitude) {
  RandomInput random;
  for (int i = 0; i < 20000; ++i) {
    const float open = random.log_uniform(1e-20f, 1e20f);
    const float ratio = i % 5 == 0 ? 1.0f : random.uniform(0.0f, 1.0f);
    const maths::RawOcclusion back =
        maths::unpack_lobe(maths::pack_lobe(raw_occlusion_of(ratio * open, open)));
    EXPECT_NEAR(back.open / open, 1.0f, 1.0f / 256);
    EXPECT_NEAR(back.visible / back.open, ratio, 2e-5f);
    if (ratio == 1.0f) {
      EXPECT_EQ(back.visible, back.open);
    }
  }
  EXPECT_EQ(maths::unpack_lobe(maths::pack_lobe(raw_occlusion_of(0, 0))).open, 0.0f);
}

TEST(RawOcclusion, WeightOfANeighboursLobeFallsWithDifferenceOfNormalAndRoughness) {
  RandomInput random;
  const auto surface = [](vec3 normal, float roughness) {
    maths::LobeSurface lobe;
    lobe.normal = normal;
    lobe.roughness = roughness;
    return lobe;
  };
  for (int i = 0; i < 5000; ++i) {
    const vec3 normal = random.unit_vector();
    const float roughness = random.uniform(0.0f, 1.0f);
    const maths::LobeSurface own = surface(normal, roughness);
    const auto weight = [&](vec3 other, float other_roughness) {
      return maths::lobe_weight(own, maths::pack_lobe_surface(surface(other, other_roughness)));
    };
    // The tolerance is 32 times the quantisation error of a byte.
    EXPECT_NEAR(weight(normal, roughness), 1.0f, 0.3f);
    EXPECT_EQ(weight(-normal, roughness), 0.0f);
    EXPECT_EQ(weight(normal, roughness < 0.5f ? roughness + 0.25f : roughness - 0.25f), 0.0f);
    const vec3 across = normalize(cross(normal, vec3(0.3f, 0.5f, 0.8f)));
    EXPECT_NEAR(weight(normalize(normal + across * 0.21f), roughness), 0.5f, 0.2f);
    // A normal that is too long does not get a larger weight than a unit normal.
    EXPECT_LT(weight(normal * 1e3f, roughness), 1.5f);
  }
}

TEST(RawOcclusion, PackingKeepsBentNormalResidualsToTenBitPrecision) {
  RandomInput random;
  const auto round_trip = [](const vec3& residual) {
    return maths::unpack_residual(maths::pack_residual(residual));
  };
  for (int i = 0; i < 100000; ++i) {
    const float largest = maths::kLargestResidual;
    const vec3 residual{random.uniform(-largest, largest), random.uniform(-largest, largest),
                        random.uniform(-largest, largest)};
    const vec3 apart = glm::abs(round_trip(residual) - residual);
    EXPECT_LT(std::max({apart.x, apart.y, apart.z}), 0.0014f);
  }
  EXPECT_EQ(round_trip(vec3(0)), vec3(0)) << "unoccluded surfaces must stay exactly unoccluded";
  const float largest = round_trip(vec3(9)).x;
  EXPECT_FLOAT_EQ(largest, maths::kLargestResidual) << "clamped";
  EXPECT_EQ(round_trip(vec3(-9)), -vec3(largest));
}

TEST(Octahedral, EncodingThenDecodingKeepsEveryDirection) {
  RandomInput random;
  for (int i = 0; i < 100000; ++i) {
    const vec3 direction = random.unit_vector();
    const vec2 encoded = maths::octahedral_encode(direction);
    EXPECT_LE(std::max(std::abs(encoded.x), std::abs(encoded.y)), 1.0f + 1e-6f);
    EXPECT_LT(distance(maths::octahedral_decode(encoded), direction), 6e-7f);
  }
}

TEST(Octahedral, CoordinateAxesAreEncodedExactly) {
  for (const vec3 axis : {vec3(1, 0, 0), vec3(-1, 0, 0), vec3(0, 1, 0), vec3(0, -1, 0),
                          vec3(0, 0, 1), vec3(0, 0, -1)})
    EXPECT_EQ(maths::octahedral_decode(maths::octahedral_encode(axis)), axis);
}

TEST(Octahedral, EncodingIgnoresTheLengthOfAVectorAndAcceptsTheZeroVector) {
  EXPECT_LT(distance(maths::octahedral_encode(vec3(3, -4, 5)),
                     maths::octahedral_encode(vec3(3, -4, 5) * 1e-20f)),
            1e-6f);
  EXPECT_EQ(maths::octahedral_decode(maths::octahedral_encode(vec3(0))), vec3(0, 0, 1));
}

TEST(Octahedral, AnyPairOfCoordinatesIsDecodedToAUnitVector) {
  RandomInput random;
  for (int i = 0; i < 10000; ++i) {
    const vec2 point{random.uniform(-2, 2), random.uniform(-2, 2)};
    EXPECT_NEAR(length(maths::octahedral_decode(point)), 1.0f, 1e-5f);
  }
}

// Returns the unit normal with these stereographic coordinates.
vec3 normal_of(vec2 stereographic) {
  const float squared = dot(stereographic, stereographic);
  return vec3(2.0f * stereographic, 1.0f - squared) / (1.0f + squared);
}

// Returns a random unit normal in view space that faces the eye.
vec3 facing_normal(RandomInput& random) {
  vec3 normal = random.unit_vector();
  normal.z = std::abs(normal.z);
  return normal;
}

TEST(QuantisedNormal, NormalQuantisedTo8BitsIsDecodedWithin12Degrees) {
  RandomInput random;
  for (int i = 0; i < 100000; ++i) {
    const vec3 normal = facing_normal(random);
    const std::uint32_t bits = maths::quantise_normal(normal);
    EXPECT_LT(bits, 256u);
    EXPECT_EQ(
        maths::raw_occlusion_normal(maths::pack_raw_occlusion(raw_occlusion_of(0.3f, 0.7f), bits)),
        bits);
    EXPECT_GT(dot(normal_of(maths::stereographic_of_bits(bits)), normal),
              std::cos(glm::radians(12.0f)));
  }
  EXPECT_EQ(maths::stereographic_of_bits(maths::quantise_normal(vec3(0, 0, 1))), vec2(0));
  EXPECT_EQ(maths::stereographic_of_bits(maths::quantise_normal(vec3(0, -1, 0))), vec2(0, -1));
}

TEST(QuantisedNormal, SquaredAngleToAnotherNormalIsApproximatedForSmallAngles) {
  RandomInput random;
  for (int i = 0; i < 100000; ++i) {
    const vec3 own = facing_normal(random);
    const vec3 other = facing_normal(random);
    const auto angle_to = [&](const vec3& normal) {
      return maths::squared_angle({own.x, own.y, 1.0f + own.z},
                                  vec2(normal.x, normal.y) / (1.0f + normal.z));
    };
    EXPECT_NEAR(angle_to(own), 0.0f, 1e-12f);
    const float cosine = dot(own, other);
    const float angle = angle_to(other);
    if (cosine > 0.97f) {
      EXPECT_NEAR(angle, 2.0f - 2.0f * cosine, 0.3f * (2.0f - 2.0f * cosine) + 2e-5f);
    }
    if (cosine < 0.5f) {
      EXPECT_GT(angle, 0.5f);
    }
  }
}

TEST(Packing, PackingAsUnormRoundsToNearestAndKeepsZeroAndOneExactly) {
  for (const unsigned bits : {1u, 8u, 12u, 16u}) {
    const float step = 1.0f / float((1u << bits) - 1u);
    for (float x = 0.0f; x <= 1.0f; x += 0.001f)
      EXPECT_NEAR(maths::unpack_unorm(maths::pack_unorm(x, bits), bits), x, 0.5001f * step);
    EXPECT_EQ(maths::unpack_unorm(maths::pack_unorm(0.0f, bits), bits), 0.0f);
    EXPECT_EQ(maths::unpack_unorm(maths::pack_unorm(1.0f, bits), bits), 1.0f);
    EXPECT_EQ(maths::pack_unorm(-5.0f, bits), 0u);
    EXPECT_EQ(maths::pack_unorm(5.0f, bits), (1u << bits) - 1u);
  }
}

TEST(HalfTexel, NearestAndFarthestPixelsRepresentTexelsAlternately) {
  const glm::vec4 depths(0.3f, 0.7f, 0.2f, 0.5f);
  EXPECT_EQ(maths::representative_depth({2, 4}, depths, false), 0.2f) << "nearest";
  EXPECT_EQ(maths::representative_depth({3, 4}, depths, false), 0.7f) << "farthest";
  EXPECT_EQ(maths::representative_depth({3, 5}, depths, true), 0.7f) << "nearest";
  EXPECT_EQ(maths::representative_depth({2, 5}, depths, true), 0.2f) << "farthest";
}

TEST(HalfTexel, PixelOfTheSkyRepresentsATexelOnlyIfAllFourShowTheSky) {
  EXPECT_EQ(maths::representative_depth({1, 0}, {1.0f, 0.4f, 0.6f, 1.0f}, false), 0.4f);
  EXPECT_EQ(maths::representative_depth({1, 0}, {0.0f, 0.4f, 0.6f, 0.0f}, true), 0.6f);
  EXPECT_EQ(maths::representative_depth({1, 0}, glm::vec4(1.0f), false), 1.0f);
  EXPECT_EQ(maths::representative_depth({1, 0}, glm::vec4(0.0f), true), 0.0f);
}

}  // namespace
}  // namespace alcove::maths_test
