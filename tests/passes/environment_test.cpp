#include "alcove/passes/environment.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

#include "environment_lookup.h"
#include "equirectangular.h"
#include "maths/ggx.h"
#include "maths/spherical_harmonics.h"
#include "random_input.h"

namespace alcove::passes {
namespace {

using framegraph::Graph;
using glm::vec2;
using glm::vec3;
using testing::HasSubstr;

class EnvironmentPass : public PassTest {
 protected:
  // Runs add_environment(). Its results are the levels of the map and then the harmonics.
  void run_environment(const HostImage& equirectangular, const EnvironmentSettings& settings) {
    run([&](Graph& graph) {
      const auto light = add_environment({graph, gpu().kernels(), {}, 0},
                                         upload(graph, equirectangular), settings);
      ASSERT_TRUE(light) << light.error().message;
      for (std::uint32_t level = 0; level < settings.levels; ++level)
        read_back(graph, light->map, level);
      read_back(graph, light->harmonics);
    });
  }
};

constexpr std::uint32_t kSize = 256;
constexpr std::uint32_t kLevels = 6;

// Returns the radiance of a sky with a bright patch of 20 degrees above dark ground.
vec3 sky(vec3 direction) {
  const vec3 sun = normalize(vec3(0.5f, 0.6f, -0.4f));
  const float glow = std::exp(30.0f * (dot(direction, sun) - 1.0f));
  const float up = 0.5f + 0.5f * std::tanh(4.0f * direction.y);
  return mix(vec3(0.2f, 0.15f, 0.1f), vec3(0.5f, 0.8f, 1.2f), up) + glow * vec3(20, 16, 10);
}

template <typename Light>
HostImage equirectangular(std::uint32_t width, const Light& light) {
  HostImage image{width, width / 2, {}, 4};
  for (std::uint32_t y = 0; y < image.height; ++y) {
    for (std::uint32_t x = 0; x < image.width; ++x) {
      const vec2 uv = (vec2(x, y) + 0.5f) / vec2(image.width, image.height);
      const vec3 c = light(maths_test::equirectangular_direction(uv));
      image.texels.insert(image.texels.end(), {c.x, c.y, c.z, 1.0f});
    }
  }
  return image;
}

// Returns the sum of f(direction, solid angle) over a fine grid of directions.
template <typename Function>
void over_sphere(const Function& f) {
  constexpr int kRows = 200;
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < 2 * kRows; ++x) {
      const vec2 uv = (vec2(x, y) + 0.5f) / vec2(2 * kRows, kRows);
      const float top = std::cos(float(y) / kRows * maths::kPi);
      const float bottom = std::cos(float(y + 1) / kRows * maths::kPi);
      f(maths_test::equirectangular_direction(uv), (top - bottom) * maths::kPi / kRows);
    }
  }
}

// Returns the mean radiance of the environment `sky` over the GGX lobe around `normal`, seen along
// the normal, by quadrature over the sphere.
vec3 prefilter(vec3 normal, float alpha) {
  glm::dvec3 sum(0);
  double weights = 0.0;
  over_sphere([&](vec3 light, float angle) {
    const float n_dot_l = dot(normal, light);
    if (n_dot_l > 0.0f) {
      const float n_dot_h = std::sqrt(0.5f + 0.5f * n_dot_l);
      const double weight =
          double(maths::ggx_distribution(std::min(n_dot_h, 1.0f), alpha)) * n_dot_l * angle;
      sum += weight * glm::dvec3(sky(light));
      weights += weight;
    }
  });
  return vec3(sum / weights);
}

TEST_F(EnvironmentPass, SphericalHarmonicsOfAnEnvironmentMapAgreeWithQuadrature) {
  const HostImage source = equirectangular(512, sky);
  run_environment(source, {.size = kSize, .levels = kLevels});
  for (std::uint32_t i = 0; i < maths::kHarmonics; ++i) {
    vec3 expected(0);
    over_sphere([&](vec3 d, float angle) { expected += sky(d) * (maths::harmonic(i, d) * angle); });
    EXPECT_LT(distance(rgb(result(kLevels), i, 0), expected), 0.02f)
        << i << "th coefficient; the largest is about 8";
  }
}

TEST_F(EnvironmentPass, PrefilteredMipLevelsAgreeWithQuadratureOfTheGgxLobe) {
  const HostImage source = equirectangular(512, sky);
  run_environment(source, {.size = kSize, .levels = kLevels});
  maths_test::RandomInput random(1);  // a fixed set, because the mean of so few directions varies
  for (std::uint32_t level = 0; level < kLevels; ++level) {
    const float roughness = maths::roughness_of_level(level, kLevels);
    const HostImage& map = result(level);
    ASSERT_EQ(map.width, kSize >> level);
    double squares = 0.0, wholes = 0.0, worst = 0.0;
    for (int i = 0; i < 60; ++i) {
      // Random directions also lie between texels.
      const vec3 normal = random.unit_vector();
      const vec3 expected = level == 0 ? sky(normal) : prefilter(normal, roughness * roughness);
      const vec3 error = look_up(map, normal) - expected;
      squares += dot(error, error);
      wholes += dot(expected, expected);
      worst = std::max(worst, double(length(error)));
    }
    const double relative = std::sqrt(squares / wholes);
    std::cout << "roughness " << roughness << ": relative RMSE " << relative << ", worst " << worst
              << "\n";
    EXPECT_LT(relative, 0.06) << roughness;
    EXPECT_LT(worst, 1.0) << roughness << ": radiance is at most about 25";
  }
}

TEST_F(EnvironmentPass, WhiteEnvironmentMapIsPrefilteredToWhiteInEveryTexel) {
  const HostImage source = equirectangular(64, [](vec3) { return vec3(1); });
  run_environment(source, {.size = 32, .levels = 4, .samples = 16});
  for (std::size_t level = 0; level < 4; ++level)
    EXPECT_THAT(result(level).texels, testing::Each(testing::FloatNear(1.0f, 2e-3f)));
  EXPECT_NEAR(result(4).at(0, 0), std::sqrt(4.0f * maths::kPi), 1e-2f);
  for (std::uint32_t i = 1; i < maths::kHarmonics; ++i)
    EXPECT_NEAR(result(4).at(i, 0), 0.0f, 1e-2f);
}

TEST_F(EnvironmentPass, InvalidRadianceIsReadAsBlackAndInfinityAsTheLargestHalfFloat) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const HostImage source = equirectangular(
      64, [&](vec3 d) { return d.x > 0.0f ? vec3(nan, -1.0f, infinity) : vec3(1); });
  run_environment(source, {.size = 16, .levels = 2, .samples = 4});
  for (std::size_t image = 0; image < 3; ++image) {
    EXPECT_THAT(result(image).texels,
                testing::Each(testing::ResultOf([](float x) { return std::isfinite(x); }, true)));
  }
  EXPECT_EQ(result(0).at(13, 8, 0), 0.0f);
  EXPECT_EQ(result(0).at(13, 8, 2), 65504.0f);
}

TEST_F(EnvironmentPass, EnvironmentPassIsCulledIfNobodyReadsItsOutput) {
  const HostImage source = equirectangular(32, sky);
  run([&](Graph& graph) {
    const auto light = upload(graph, source);
    ASSERT_TRUE(add_environment({graph, gpu().kernels(), {}, 0}, light, {}));
    read_back(graph, light);
  });
  for (const framegraph::PassTiming& timing : gpu().timings())
    EXPECT_THAT(std::string(timing.name), testing::Not(HasSubstr("environment")));
}

TEST_F(EnvironmentPass, InvalidInputOfTheEnvironmentPassIsReportedByName) {
  const HostImage source = equirectangular(32, sky);
  run([&](Graph& graph) {
    const Frame frame{graph, gpu().kernels(), {}, 0};
    const auto light = upload(graph, source);
    expect_error(add_environment(frame, {}, {}), "equirectangular light");
    expect_error(add_environment(frame, light, {.size = 100}), "power of two");
    expect_error(add_environment(frame, light, {.size = 4096}), "power of two");
    expect_error(add_environment(frame, light, {.levels = 1}), "levels");
    expect_error(add_environment(frame, light, {.size = 64, .levels = 6}), "2 to 5");
    expect_error(add_environment(frame, light, {.samples = 0}), "samples");
    read_back(graph, light);
  });
}

}  // namespace
}  // namespace alcove::passes
