#include "alcove/passes/apply.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "alcove/passes/environment.h"
#include "alcove/passes/occlusion.h"
#include "environment_lookup.h"
#include "kept.h"
#include "maths/gtso.h"
#include "maths/make_projection.h"
#include "maths/multi_bounce.h"
#include "maths/packing.h"
#include "maths/spherical_harmonics.h"
#include "maths/split_sum.h"
#include "pass_fixture.h"
#include "random_input.h"
#include "tables.h"
#include "views.h"

namespace alcove::passes {
namespace {

using framegraph::Graph;
using framegraph::Texture;
using glm::vec2;
using glm::vec3;
using testing::HasSubstr;

constexpr std::uint32_t kWidth = 37;
constexpr std::uint32_t kHeight = 23;
constexpr std::uint32_t kMapSize = 8;
constexpr float kSky = 1e12f;

struct Inputs {
  HostImage depth{kWidth, kHeight, {}, 1};
  HostImage normals{kWidth, kHeight, {}, 4};
  HostImage bent{kWidth, kHeight, {}, 4};
  HostImage albedo{kWidth, kHeight, {}, 4};  // roughness in the last channel
  HostImage light{kWidth, kHeight, {}, 4};   // metallic in the last channel
  HostImage visibility{kWidth, kHeight, {}, 1};
  HostImage specular_occlusion{kWidth, kHeight, {}, 1};
  HostImage harmonics{maths::kHarmonics, 1, {}, 4};
  HostImage map{kMapSize, kMapSize, {}, 4};
};

void append(HostImage& image, vec3 v, float w) {
  image.texels.insert(image.texels.end(), {v.x, v.y, v.z, w});
}

// Surfaces that face the eye, in view space, with every seventh pixel sky.
Inputs random_inputs() {
  maths_test::RandomInput random;
  const auto colour = [&](float most) {
    return vec3(random.uniform(0, most), random.uniform(0, most), random.uniform(0, most));
  };
  Inputs inputs;
  for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
    const vec3 normal = random.facing(vec3(0, 0, 1));
    append(inputs.normals, normal, 0.0f);
    append(inputs.bent, random.facing(normal), 0.0f);
    append(inputs.albedo, colour(1.0f), random.uniform(0.0f, 1.0f));
    append(inputs.light, colour(9.0f), random.uniform(0.0f, 1.0f));
    inputs.visibility.texels.push_back(random.uniform(0.0f, 1.0f));
    inputs.specular_occlusion.texels.push_back(random.uniform(0.0f, 1.0f));
    inputs.depth.texels.push_back(i % 7 == 6 ? kSky : random.uniform(1.0f, 9.0f));
  }
  for (std::uint32_t i = 0; i < maths::kHarmonics; ++i) {
    append(inputs.harmonics, i == 0 ? vec3(9, 8, 7) : colour(1.0f), 0.0f);
  }
  for (std::uint32_t i = 0; i < kMapSize * kMapSize; ++i) {
    append(inputs.map, colour(4.0f), 0.0f);
  }
  return inputs;
}

// White light from everywhere.
void make_white(Inputs& inputs) {
  inputs.harmonics.texels.assign(inputs.harmonics.texels.size(), 0.0f);
  for (int c = 0; c < 3; ++c) {
    inputs.harmonics.texels[c] = 1.0f / maths::harmonic(0, vec3(0, 1, 0));
  }
  inputs.map.texels.assign(inputs.map.texels.size(), 1.0f);
}

maths::mat4 to_mat4(const Matrix& matrix) {
  maths::mat4 result;
  std::memcpy(&result[0][0], matrix.data(), sizeof(result));
  return result;
}

vec3 irradiance(const HostImage& harmonics, vec3 direction) {
  vec3 sum(0);
  for (std::uint32_t i = 0; i < maths::kHarmonics; ++i) {
    sum += rgb(harmonics, i, 0) * (maths::harmonic(i, direction) * maths::harmonic_irradiance(i));
  }
  return max(sum, vec3(0));
}

vec2 reflectance(float n_dot_v, float roughness) {
  static const std::vector<std::uint32_t> table = reflectance_table();
  const vec2 at = maths::reflectance_coordinates(n_dot_v, roughness);
  const glm::uvec2 low = min(glm::uvec2(at), glm::uvec2(maths::kReflectanceTable - 2));
  const vec2 t = at - vec2(low);
  const auto entry = [&](unsigned x, unsigned y) {
    const std::uint32_t word = table[(low.y + y) * maths::kReflectanceTable + low.x + x];
    return vec2(maths::unpack_unorm(word, 16), maths::unpack_unorm(word >> 16, 16));
  };
  return mix(mix(entry(0, 0), entry(1, 0), t.x), mix(entry(0, 1), entry(1, 1), t.x), t.y);
}

struct Light {
  vec3 diffuse{0};
  vec3 specular{0};
};

// What the pass should write at a pixel, all inputs given, normals in view space.
Light expected(const Inputs& inputs, const View& view, std::uint32_t x, std::uint32_t y) {
  const float depth = inputs.depth.at(x, y);
  if (depth == kSky) {
    return {};
  }
  const auto projection =
      maths::make_projection(to_mat4(view.clip_from_view), kWidth, kHeight).value();
  const maths::mat3 world_from_view = transpose(maths::mat3(to_mat4(view.view_from_world)));
  const vec2 uv = maths::pixel_centre_uv(projection, {x, y});
  const vec3 towards =
      world_from_view * maths::view_vector(projection, maths::position_vs(projection, uv, depth));
  const vec3 normal = normalize(world_from_view * rgb(inputs.normals, x, y));
  const vec3 bent =
      maths::raised_bent_normal(normalize(world_from_view * rgb(inputs.bent, x, y)), normal,
                                maths::settled_visibility(inputs.visibility.at(x, y)));
  const vec3 base = rgb(inputs.albedo, x, y);
  const float roughness = inputs.albedo.at(x, y, 3);
  const float metallic = inputs.light.at(x, y, 3);
  const vec3 reflected = maths::specular_reflectance(maths::normal_reflectance(base, metallic),
                                                     reflectance(dot(normal, towards), roughness));
  const vec3 visible = maths::multi_bounce(inputs.visibility.at(x, y), base);
  const vec3 mirrored = look_up(
      inputs.map,
      maths::dominant_direction(normal, maths::mirror_direction(normal, towards), roughness));
  const vec3 spread = visible * irradiance(inputs.harmonics, bent);
  const float open = inputs.specular_occlusion.at(x, y);
  return {maths::diffuse_albedo(base, metallic) * (1.0f - reflected) * spread,
          reflected * (mirrored * open + spread * base * (1.0f - open))};
}

View turned(View view) {
  const maths::mat4 turn(0.8f, 0, -0.6f, 0, 0, 1, 0, 0, 0.6f, 0, 0.8f, 0, 0, 0, 0, 1);
  std::memcpy(view.view_from_world.data(), &turn[0][0], sizeof(turn));
  return view;
}

void expect_close(const HostImage& image, std::uint32_t x, std::uint32_t y, vec3 wanted) {
  for (std::uint32_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(image.at(x, y, c), wanted[static_cast<int>(c)],
                2e-4f + 2e-4f * wanted[static_cast<int>(c)])
        << x << "," << y;
  }
}

class ApplyPass : public PassTest {
 protected:
  // What every surface needs, uploaded: purely diffuse ones under unoccluded light.
  ApplyInputs surfaces(Graph& graph, const Inputs& inputs) {
    return {.depth = upload(graph, inputs.depth),
            .normals = upload(graph, inputs.normals),
            .albedo = upload(graph, inputs.albedo),
            .harmonics = upload(graph, inputs.harmonics)};
  }
};

TEST_F(ApplyPass, AgreesWithTheFormulasInEveryView) {
  const Inputs inputs = random_inputs();
  for (const TestView& test_view : test_views()) {
    SCOPED_TRACE(test_view.name);
    const View view = turned(test_view.view);
    run([&](Graph& graph) {
      const Frame frame{graph, gpu().kernels(), view, 0};
      const Texture albedo = upload(graph, inputs.albedo);
      const Texture light = upload(graph, inputs.light);
      const auto lit = add_apply(frame,
                                 {.depth = upload(graph, inputs.depth),
                                  .normals = upload(graph, inputs.normals),
                                  .albedo = albedo,
                                  .roughness = albedo,
                                  .metallic = light,
                                  .visibility = upload(graph, inputs.visibility),
                                  .bent_normal = upload(graph, inputs.bent),
                                  .specular_occlusion = upload(graph, inputs.specular_occlusion),
                                  .light = light,
                                  .harmonics = upload(graph, inputs.harmonics),
                                  .map = upload(graph, inputs.map),
                                  .normals_in_view_space = true},
                                 {.roughness_channel = 3,
                                  .metallic_channel = 3,
                                  .parts = true,
                                  .precision = Precision::float32});
      ASSERT_TRUE(lit) << lit.error().message;
      read_back(graph, lit->lit);
      read_back(graph, lit->diffuse);
      read_back(graph, lit->specular);
    });
    for (std::uint32_t y = 0; y < kHeight; ++y) {
      for (std::uint32_t x = 0; x < kWidth; ++x) {
        const Light wanted = expected(inputs, view, x, y);
        expect_close(result(0), x, y, wanted.diffuse + wanted.specular + rgb(inputs.light, x, y));
        expect_close(result(1), x, y, wanted.diffuse);
        expect_close(result(2), x, y, wanted.specular);
      }
    }
  }
}

TEST_F(ApplyPass, WhiteFurnaceGivesBackNoMoreThanItGotAndAllOfItToWhiteDielectrics) {
  Inputs inputs = random_inputs();
  make_white(inputs);
  inputs.albedo.texels.assign(inputs.albedo.texels.size(), 1.0f);
  for (const float roughness : {0.0f, 0.1f, 0.3f, 0.6f, 1.0f}) {
    for (const float metallic : {0.0f, 0.5f, 1.0f}) {
      SCOPED_TRACE(testing::Message() << "roughness " << roughness << ", metallic " << metallic);
      run([&](Graph& graph) {
        const Frame frame{graph, gpu().kernels(), test_views().front().view, 0};
        ApplyInputs given = surfaces(graph, inputs);
        given.map = upload(graph, inputs.map);
        given.normals_in_view_space = true;
        const auto lit = add_apply(
            frame, given,
            {.roughness = roughness, .metallic = metallic, .precision = Precision::float32});
        ASSERT_TRUE(lit) << lit.error().message;
        read_back(graph, lit->lit);
      });
      for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
        if (inputs.depth.texels[i] != kSky) {
          const float out = result().at(i % kWidth, i / kWidth);
          EXPECT_LE(out, 1.0f + 1e-5f);
          EXPECT_GE(out, metallic == 0.0f ? 1.0f - 1e-5f : 0.25f);
        }
      }
    }
  }
}

TEST_F(ApplyPass, WithoutAMapThereIsNoTableAndWithoutPartsNoTextureOfThem) {
  const Inputs inputs = random_inputs();
  const auto transients = [&](bool map, const ApplySettings& settings) {
    Kept kept;
    run([&](Graph& graph) {
      ApplyInputs given = surfaces(graph, inputs);
      given.map = map ? upload(graph, inputs.map) : Texture{};
      const Frame frame{graph, gpu().kernels(), test_views().front().view, 0};
      const auto lit = add_apply(frame, given, settings);
      ASSERT_TRUE(lit) << lit.error().message;
      read_back(graph, lit->lit);
      kept = kept_of(graph);
    });
    return kept.transients;
  };
  const Kernels& kernels = gpu().kernels();
  EXPECT_THAT(transients(false, {}), testing::ElementsAre("lit"));
  EXPECT_EQ(kernels.pipeline_count(), 1u);
  EXPECT_EQ(kernels.table_bytes(), 0u);
  EXPECT_THAT(transients(true, {}), testing::ElementsAre("lit"));
  EXPECT_EQ(kernels.table_bytes(), 4u * maths::kReflectanceTable * maths::kReflectanceTable);
  const std::size_t pipelines = kernels.pipeline_count();
  (void)transients(true, {.roughness = 0.2f});
  EXPECT_EQ(kernels.pipeline_count(), pipelines) << "numbers make no new pipeline";
}

// A whole frame from depth to light without specular light: no bent normal, no pass of specular
// occlusion, no environment map and no table.
TEST_F(ApplyPass, AFrameWithoutSpecularLightHasNothingOfIt) {
  const PlaneScene plane = plane_scene(test_views()[2], kWidth, kHeight, 30.0f);
  const Inputs inputs = random_inputs();
  Kept kept;
  run([&](Graph& graph) {
    const Frame frame{graph, gpu().kernels(), test_views()[2].view, 0};
    const auto occlusion = add_occlusion(frame,
                                         {.depth_ndc = upload(graph, plane.depth_ndc),
                                          .normals = upload(graph, plane.normal_vs),
                                          .normals_in_view_space = true},
                                         quality_settings(Quality::medium, 0.5f));
    ASSERT_TRUE(occlusion) << occlusion.error().message;
    const auto probe = add_environment(frame, upload(graph, inputs.map), {.size = 16, .levels = 2});
    ASSERT_TRUE(probe) << probe.error().message;
    const auto lit = add_apply(frame,
                               {.depth = occlusion->linear_depth,
                                .normals = occlusion->normals,
                                .albedo = upload(graph, inputs.albedo),
                                .visibility = occlusion->visibility,
                                .harmonics = probe->harmonics,
                                .normals_in_view_space = true},
                               {});
    ASSERT_TRUE(lit) << lit.error().message;
    read_back(graph, lit->lit);
    kept = kept_of(graph);
  });
  EXPECT_THAT(kept.passes, testing::Contains("probe light"));
  for (const char* absent : {"specular occlusion", "environment prefilter"}) {
    EXPECT_THAT(kept.passes, testing::Not(testing::Contains(absent)));
  }
  for (const char* absent :
       {"specular occlusion", "bent normal", "environment map", "specular light", "multi-bounce"}) {
    EXPECT_THAT(kept.transients, testing::Not(testing::Contains(absent)));
  }
  EXPECT_EQ(gpu().kernels().table_bytes(), 0u);
}

TEST_F(ApplyPass, DiffuseSurfacesNeedNoMap) {
  Inputs inputs = random_inputs();
  make_white(inputs);
  run([&](Graph& graph) {
    const Frame frame{graph, gpu().kernels(), test_views().front().view, 0};
    const auto lit =
        add_apply(frame, surfaces(graph, inputs), {.parts = true, .precision = Precision::float32});
    ASSERT_TRUE(lit) << lit.error().message;
    EXPECT_FALSE(lit->specular);
    read_back(graph, lit->lit);
    read_back(graph, lit->diffuse);
  });
  for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
    const bool sky = inputs.depth.texels[i] == kSky;
    const vec3 albedo = rgb(inputs.albedo, i % kWidth, i / kWidth);
    expect_close(result(0), i % kWidth, i / kWidth, sky ? vec3(0) : albedo);
    expect_close(result(1), i % kWidth, i / kWidth, sky ? vec3(0) : albedo);
  }
}

TEST_F(ApplyPass, RefusesWhatItCannotUseAndNamesIt) {
  const Inputs inputs = random_inputs();
  const HostImage small{2, 3, std::vector<float>(24), 4};
  run([&](Graph& graph) {
    const Frame frame{graph, gpu().kernels(), test_views().front().view, 0};
    ApplyInputs good = surfaces(graph, inputs);
    good.map = upload(graph, inputs.map);
    const Texture wrong = upload(graph, small);
    const auto refused = [&](const ApplyInputs& given, const ApplySettings& settings,
                             const char* name) {
      const auto result = add_apply(frame, given, settings);
      ASSERT_FALSE(result) << name;
      EXPECT_THAT(result.error().message, HasSubstr(name));
    };
    const auto with = [&](Texture ApplyInputs::*input, Texture texture) {
      ApplyInputs given = good;
      given.*input = texture;
      return given;
    };
    refused(with(&ApplyInputs::albedo, {}), {}, "albedo");
    refused(with(&ApplyInputs::normals, wrong), {}, "normals of 2x3");
    refused(with(&ApplyInputs::visibility, wrong), {}, "visibility of 2x3");
    refused(with(&ApplyInputs::light, wrong), {}, "light of 2x3");
    refused(with(&ApplyInputs::harmonics, {}), {}, "harmonics");
    refused(with(&ApplyInputs::harmonics, wrong), {}, "9x1");
    refused(with(&ApplyInputs::map, wrong), {}, "square");
    refused(good, {.roughness = std::numeric_limits<float>::quiet_NaN()}, "roughness");
    refused(good, {.metallic = -0.5f}, "metallic");
    refused(good, {.roughness_channel = 4}, "channel 4");
    refused(good, {.metallic_channel = 9}, "channel 9");
    refused(good, {.precision = Precision::unorm8}, "8 bits");
    read_back(graph, good.depth);
  });
}

}  // namespace
}  // namespace alcove::passes
