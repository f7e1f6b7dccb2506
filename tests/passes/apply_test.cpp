#include "alcove/passes/apply.h"

#include <gmock/gmock.h>

#include <cstring>
#include <limits>
#include <vector>

#include "alcove/passes/environment.h"
#include "alcove/passes/occlusion.h"
#include "drawing.h"
#include "environment_lookup.h"
#include "frame_plan.h"
#include "maths/split_sum.h"
#include "reference_light.h"
#include "views.h"

namespace alcove::passes {
namespace {

using framegraph::Graph;
using framegraph::Texture;
using glm::vec3;
using testing::HasSubstr;

constexpr std::uint32_t kWidth = LitSurfaces::kWidth;
constexpr std::uint32_t kHeight = LitSurfaces::kHeight;
constexpr float kSky = LitSurfaces::kSky;

View rotate(View view) {
  const maths::mat4 turn(0.8f, 0, -0.6f, 0, 0, 1, 0, 0, 0.6f, 0, 0.8f, 0, 0, 0, 0, 1);
  std::memcpy(view.view_from_world.data(), &turn[0][0], sizeof(turn));
  return view;
}

void expect_close(const HostImage& image, std::uint32_t x, std::uint32_t y, vec3 expected) {
  for (std::uint32_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(image.at(x, y, c), expected[static_cast<int>(c)],
                2e-4f + 2e-4f * expected[static_cast<int>(c)])
        << x << "," << y;
  }
}

class LightingPass : public PassTest {
 protected:
  // Uploads the required inputs: diffuse surfaces under unoccluded light.
  ApplyInputs surfaces(Graph& graph, const LitSurfaces& inputs) {
    return {.depth = upload(graph, inputs.depth),
            .normals = upload(graph, inputs.normals),
            .albedo = upload(graph, inputs.albedo),
            .harmonics = upload(graph, inputs.harmonics)};
  }
};

TEST_F(LightingPass, LitImageAgreesWithTheFormulasOnTheCpuInEveryKindOfView) {
  const LitSurfaces inputs = random_surfaces();
  for (const TestView& test_view : test_views()) {
    SCOPED_TRACE(test_view.name);
    const View view = rotate(test_view.view);
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
        const Light expected = reference_light(inputs, view, x, y);
        expect_close(result(0), x, y,
                     expected.diffuse + expected.specular + rgb(inputs.light, x, y));
        expect_close(result(1), x, y, expected.diffuse);
        expect_close(result(2), x, y, expected.specular);
      }
    }
  }
}

TEST_F(LightingPass, SurfacesReflectNoMoreLightThanTheyReceiveAndWhiteDielectricsReflectAll) {
  LitSurfaces inputs = random_surfaces();
  make_white(inputs);
  inputs.albedo.texels.assign(inputs.albedo.texels.size(), 1.0f);
  for (const float roughness : {0.0f, 0.1f, 0.3f, 0.6f, 1.0f}) {
    for (const float metallic : {0.0f, 0.5f, 1.0f}) {
      SCOPED_TRACE(testing::Message() << "roughness " << roughness << ", metallic " << metallic);
      run([&](Graph& graph) {
        const Frame frame{graph, gpu().kernels(), test_views().front().view, 0};
        ApplyInputs images = surfaces(graph, inputs);
        images.map = upload(graph, inputs.map);
        images.normals_in_view_space = true;
        const auto lit = add_apply(
            frame, images,
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

TEST_F(LightingPass, ReflectanceTableIsCreatedOnlyIfAnEnvironmentMapIsGiven) {
  open_gpu();
  const LitSurfaces inputs = random_surfaces();
  const auto transients = [&](bool map, const ApplySettings& settings) {
    FramePlan plan;
    run([&](Graph& graph) {
      ApplyInputs images = surfaces(graph, inputs);
      images.map = map ? upload(graph, inputs.map) : Texture{};
      const Frame frame{graph, gpu().kernels(), test_views().front().view, 0};
      const auto lit = add_apply(frame, images, settings);
      ASSERT_TRUE(lit) << lit.error().message;
      read_back(graph, lit->lit);
      plan = plan_frame(graph);
    });
    return plan.transients;
  };
  const Kernels& kernels = gpu().kernels();
  EXPECT_THAT(transients(false, {}), testing::ElementsAre("lit"));
  EXPECT_EQ(kernels.pipeline_count(), 1u);
  EXPECT_EQ(kernels.table_bytes(), 0u);
  EXPECT_THAT(transients(true, {}), testing::ElementsAre("lit"));
  EXPECT_EQ(kernels.table_bytes(), 4u * maths::kReflectanceTable * maths::kReflectanceTable);
  const std::size_t pipelines = kernels.pipeline_count();
  (void)transients(true, {.roughness = 0.2f});
  EXPECT_EQ(kernels.pipeline_count(), pipelines) << "a changed number needs no new pipeline";
  (void)transients(true, {.roughness_channel = 1, .metallic_channel = 2});
  EXPECT_EQ(kernels.pipeline_count(), pipelines)
      << "a channel without a texture needs no new pipeline";
}

// A frame from depth to lit surfaces without specular light: it must have no bent normal, no
// specular occlusion pass, no environment map and no table.
TEST_F(LightingPass, FrameWithoutSpecularLightHasNoSpecularPassesTexturesOrTables) {
  open_gpu();
  const Drawing plane = draw(test_views()[2], kWidth, kHeight, {tilted_plane(30.0, 4.0)});
  const LitSurfaces inputs = random_surfaces();
  FramePlan plan;
  run([&](Graph& graph) {
    const Frame frame{graph, gpu().kernels(), test_views()[2].view, 0};
    OcclusionSettings settings = quality_settings(Quality::medium, 0.5f);
    settings.linear_depth = true;
    const auto occlusion = add_occlusion(frame,
                                         {.depth_ndc = upload(graph, plane.depth_ndc),
                                          .normals = upload(graph, plane.normal_vs),
                                          .normal_convention = {.in_view_space = true}},
                                         settings);
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
    plan = plan_frame(graph);
  });
  EXPECT_THAT(plan.passes, testing::Contains("probe light"));
  for (const char* absent : {"specular occlusion", "environment prefilter"})
    EXPECT_THAT(plan.passes, testing::Not(testing::Contains(absent)));
  for (const char* absent :
       {"specular occlusion", "bent normal", "environment map", "specular light", "multi-bounce"})
    EXPECT_THAT(plan.transients, testing::Not(testing::Contains(absent)));
  EXPECT_EQ(gpu().kernels().table_bytes(), 0u);
}

TEST_F(LightingPass, DiffuseLightingNeedsNoEnvironmentMap) {
  LitSurfaces inputs = random_surfaces();
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

TEST_F(LightingPass, InvalidInputOfTheLightingPassIsReportedByName) {
  const LitSurfaces inputs = random_surfaces();
  const HostImage small{2, 3, std::vector<float>(24), 4};
  run([&](Graph& graph) {
    const Frame frame{graph, gpu().kernels(), test_views().front().view, 0};
    ApplyInputs good = surfaces(graph, inputs);
    good.map = upload(graph, inputs.map);
    const Texture wrong = upload(graph, small);
    const auto with = [&](Texture ApplyInputs::*input, Texture texture) {
      ApplyInputs wrong_inputs = good;
      wrong_inputs.*input = texture;
      return add_apply(frame, wrong_inputs, {});
    };
    expect_error(with(&ApplyInputs::albedo, {}), "albedo");
    expect_error(with(&ApplyInputs::normals, wrong), "normals of 2x3");
    expect_error(with(&ApplyInputs::visibility, wrong), "visibility of 2x3");
    expect_error(with(&ApplyInputs::light, wrong), "light of 2x3");
    expect_error(with(&ApplyInputs::harmonics, {}), "harmonics");
    expect_error(with(&ApplyInputs::harmonics, wrong), "9x1");
    expect_error(with(&ApplyInputs::map, wrong), "square");
    expect_error(add_apply(frame, good, {.roughness = std::numeric_limits<float>::quiet_NaN()}),
                 "roughness");
    expect_error(add_apply(frame, good, {.metallic = -0.5f}), "metallic");
    expect_error(add_apply(frame, good, {.roughness_channel = 4}), "channel 4");
    expect_error(add_apply(frame, good, {.metallic_channel = 9}), "channel 9");
    expect_error(add_apply(frame, good, {.precision = Precision::unorm8}), "8 bits");
    read_back(graph, good.depth);
  });
}

}  // namespace
}  // namespace alcove::passes
