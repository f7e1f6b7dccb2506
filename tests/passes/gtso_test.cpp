#include "alcove/passes/gtso.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "drawing.h"
#include "gtso_table.h"
#include "maths/gtso.h"
#include "maths/gtso_table.h"
#include "maths/make_projection.h"
#include "maths/slice.h"
#include "random_input.h"
#include "views.h"

namespace alcove::passes {
namespace {

using framegraph::Graph;
using framegraph::Texture;
using glm::vec3;

constexpr std::uint32_t kWidth = 45;
constexpr std::uint32_t kHeight = 31;
constexpr float kSky = 1e12f;

OcclusionSettings settings_of(float roughness = 0.5f, std::uint32_t channel = 0) {
  OcclusionSettings settings;
  settings.specular = Specular::table;
  settings.roughness = roughness;
  settings.roughness_channel = channel;
  settings.precision = Precision::float32;
  return settings;
}

struct Inputs {
  HostImage visibility{kWidth, kHeight, {}, 1};
  HostImage bent{kWidth, kHeight, {}, 4};
  HostImage normals{kWidth, kHeight, {}, 4};
  HostImage depth{kWidth, kHeight, {}, 1};
  HostImage surface{kWidth, kHeight, {}, 4};  // roughness in the last channel
};

void append(HostImage& image, vec3 v, float w) {
  image.texels.insert(image.texels.end(), {v.x, v.y, v.z, w});
}

vec3 direction(const HostImage& image, std::uint32_t x, std::uint32_t y) {
  return glm::normalize(vec3(image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)));
}

// Returns random surfaces that face the eye. Every seventh pixel is sky.
Inputs random_inputs() {
  maths_test::RandomInput random;
  Inputs inputs;
  for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
    const vec3 normal = random.facing(vec3(0, 0, 1));
    append(inputs.normals, normal, 0.0f);
    append(inputs.bent, random.facing(normal), 0.0f);
    append(inputs.surface, vec3(0.25f), random.uniform(0.05f, 1.0f));
    inputs.visibility.texels.push_back(random.uniform(0.0f, 1.0f));
    inputs.depth.texels.push_back(i % 7 == 6 ? kSky : random.uniform(1.0f, 9.0f));
  }
  return inputs;
}

Texture add(const Frame& frame, const GtsoInputs& inputs, const OcclusionSettings& settings) {
  const auto result = add_gtso(frame, inputs, settings);
  EXPECT_TRUE(result) << result.error().message;
  return result.value_or(Texture{});
}

class GtsoPass : public PassTest {
 protected:
  void run_pass(const View& view, const Inputs& inputs) {
    run([&](Graph& graph) {
      const Frame frame{graph, gpu().kernels(), view, 0};
      read_back(graph, add(frame,
                           {.visibility = upload(graph, inputs.visibility),
                            .bent_normal = upload(graph, inputs.bent),
                            .normals = upload(graph, inputs.normals),
                            .depth = upload(graph, inputs.depth),
                            .roughness = upload(graph, inputs.surface),
                            .normal_convention = {.in_view_space = true}},
                           settings_of(0.5f, 3)));
    });
  }
};

maths::Projection projection_of(const View& view) {
  maths::mat4 clip_from_view;
  std::memcpy(&clip_from_view[0][0], view.clip_from_view.data(), sizeof(clip_from_view));
  return maths::make_projection(clip_from_view, kWidth, kHeight).value();
}

// Returns the value that the pass should write at a pixel.
float expected(const Inputs& inputs, const maths::Projection& projection, std::uint32_t x,
               std::uint32_t y) {
  const float depth = inputs.depth.at(x, y);
  if (depth == kSky) return 1.0f;
  const maths::vec2 uv = maths::pixel_centre_uv(projection, {x, y});
  const vec3 view = maths::view_direction(projection, maths::position_vs(projection, uv, depth));
  const vec3 normal = maths::facing_normal(direction(inputs.normals, x, y), view);
  const float visibility = maths::converged_visibility(inputs.visibility.at(x, y));
  const vec3 bent = maths::raised_bent_normal(direction(inputs.bent, x, y), normal, visibility);
  const vec3 mirror = maths::mirror_direction(normal, view);
  static const std::vector<std::uint32_t> table = gtso_table();
  return look_up_gtso(table, visibility, maths::visibility_cone(visibility),
                      maths::angle_between(bent, mirror), maths::angle_between(normal, mirror),
                      inputs.surface.at(x, y, 3));
}

TEST_F(GtsoPass, SpecularOcclusionAgreesWithTheFormulasOnTheCpuInEveryKindOfView) {
  const Inputs inputs = random_inputs();
  for (const TestView& view : test_views()) {
    SCOPED_TRACE(view.name);
    run_pass(view.view, inputs);
    const maths::Projection projection = projection_of(view.view);
    for (std::uint32_t y = 0; y < kHeight; ++y)
      for (std::uint32_t x = 0; x < kWidth; ++x)
        EXPECT_NEAR(result().at(x, y), expected(inputs, projection, x, y), 2e-3f);
  }
}

// At each pixel one or several of the inputs are invalid.
TEST_F(GtsoPass, InvalidTexelsInAnyInputGiveSpecularOcclusionInRange) {
  constexpr std::array kWrong{kNaN, std::numeric_limits<float>::infinity(), 0.0f, -1e30f};
  Inputs inputs = random_inputs();
  for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
    const std::array<HostImage*, 5> images{&inputs.visibility, &inputs.bent, &inputs.normals,
                                           &inputs.surface, &inputs.depth};
    HostImage& image = *images.at(i % images.size());
    std::fill_n(image.texels.begin() + std::ptrdiff_t{i} * image.channels, image.channels,
                kWrong.at(i / images.size() % kWrong.size()));
  }
  run_pass(test_views()[2].view, inputs);
  EXPECT_THAT(result().texels, testing::Each(testing::AllOf(testing::Ge(0.0f), testing::Le(1.0f))));
}

// Returns visibility and bent normals of an unoccluded plane, with noise as after the filter.
Inputs open_inputs(const Drawing& plane) {
  maths_test::RandomInput random;
  Inputs inputs;
  for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
    const vec3 normal = direction(plane.normal_vs, i % kWidth, i / kWidth);
    inputs.visibility.texels.push_back(random.uniform(127.0f / 128.0f, 1.0f));
    append(inputs.bent, glm::normalize(normal + 0.1f * random.unit_vector()), 0.0f);
  }
  return inputs;
}

// Returns the smallest value over the pixels of a plane whose view direction is within 85 degrees
// of the normal.
float lowest(const HostImage& image, const Drawing& plane) {
  const maths::Projection projection = projection_of(plane.view);
  float least = 1.0f;
  for (std::uint32_t y = 0; y < kHeight; ++y) {
    for (std::uint32_t x = 0; x < kWidth; ++x) {
      const maths::vec2 uv = maths::pixel_centre_uv(projection, {x, y});
      const float depth = maths::linear_depth(projection, plane.depth_ndc.at(x, y));
      const vec3 towards =
          maths::view_direction(projection, maths::position_vs(projection, uv, depth));
      if (glm::dot(towards, direction(plane.normal_vs, x, y)) >= std::cos(glm::radians(85.0f)))
        least = std::min(least, image.at(x, y));
    }
  }
  return least;
}

TEST_F(GtsoPass, UnoccludedSurfaceHasSpecularVisibilityOneAtAnyRoughness) {
  const std::array roughness{0.0f, 0.1f, 0.3f, 0.6f, 1.0f};
  for (const TestView& view : test_views()) {
    for (const double degrees : {0.0, 30.0, 60.0, 84.0}) {
      const Drawing plane = draw(view, kWidth, kHeight, {tilted_plane(degrees, 4.0)});
      const Inputs open = open_inputs(plane);
      run([&](Graph& graph) {
        const Frame frame{graph, gpu().kernels(), view.view, 0};
        const auto depth = add_linear_depth(frame, upload(graph, plane.depth_ndc));
        ASSERT_TRUE(depth) << depth.error().message;
        const GtsoInputs inputs{.visibility = upload(graph, open.visibility),
                                .bent_normal = upload(graph, open.bent),
                                .normals = upload(graph, plane.normal_vs),
                                .depth = *depth,
                                .normal_convention = {.in_view_space = true}};
        for (const float r : roughness) read_back(graph, add(frame, inputs, settings_of(r)));
      });
      for (std::size_t image = 0; image < roughness.size(); ++image) {
        EXPECT_GE(lowest(result(image), plane), 0.99f)
            << view.name << " tilted " << degrees << " degrees, roughness " << roughness[image];
      }
    }
  }
}

TEST_F(GtsoPass, WorldSpaceNormalsAreRotatedIntoViewSpace) {
  const Inputs inputs = random_inputs();
  const auto with = [&](View view, bool in_view_space) {
    run([&](Graph& graph) {
      read_back(graph, add({graph, gpu().kernels(), view, 0},
                           {.visibility = upload(graph, inputs.visibility),
                            .bent_normal = upload(graph, inputs.bent),
                            .normals = upload(graph, inputs.normals),
                            .depth = upload(graph, inputs.depth),
                            .normal_convention = {.in_view_space = in_view_space}},
                           settings_of(0.4f)));
    });
    return result();
  };
  View view = test_views().front().view;
  const HostImage in_view_space = with(view, true);
  EXPECT_EQ(in_view_space.texels, with(view, false).texels);
  // The camera is rotated by 180 degrees about the view axis.
  view.view_from_world[0] = view.view_from_world[5] = -1.0f;
  EXPECT_NE(in_view_space.texels, with(view, false).texels);
  EXPECT_EQ(in_view_space.texels, with(view, true).texels);
}

TEST_F(GtsoPass, SpecularOcclusionPassIsCulledIfNobodyReadsItsOutput) {
  const Inputs inputs = random_inputs();
  run([&](Graph& graph) {
    const Frame frame{graph, gpu().kernels(), test_views().front().view, 0};
    const Texture depth = upload(graph, inputs.depth);
    (void)add(frame,
              {.visibility = upload(graph, inputs.visibility),
               .bent_normal = upload(graph, inputs.bent),
               .normals = upload(graph, inputs.normals),
               .depth = depth},
              settings_of());
    read_back(graph, depth);
  });
  for (const framegraph::PassTiming& timing : gpu().timings())
    EXPECT_NE(timing.name, "specular occlusion");
}

TEST_F(GtsoPass, LookupTableIsCreatedWhenAPassReadsIt) {
  open_gpu();
  EXPECT_EQ(gpu().kernels().table_bytes(), 0u);
  run_pass(test_views().front().view, random_inputs());
  EXPECT_EQ(gpu().kernels().table_bytes(), maths::kGtsoEntries);
}

TEST_F(GtsoPass, InvalidInputOfTheSpecularOcclusionPassIsReportedByName) {
  const Inputs inputs = random_inputs();
  const HostImage small{2, 2, std::vector<float>(4), 1};
  run([&](Graph& graph) {
    const Frame frame{graph, gpu().kernels(), test_views().front().view, 0};
    const GtsoInputs good{.visibility = upload(graph, inputs.visibility),
                          .bent_normal = upload(graph, inputs.bent),
                          .normals = upload(graph, inputs.normals),
                          .depth = upload(graph, inputs.depth)};
    GtsoInputs without_bent = good;
    without_bent.bent_normal = {};
    expect_error(add_gtso(frame, without_bent, settings_of()), "bent normals");
    GtsoInputs unequal = good;
    unequal.depth = upload(graph, small);
    expect_error(add_gtso(frame, unequal, settings_of()), "2x2");
    expect_error(add_gtso(frame, good, settings_of(std::numeric_limits<float>::quiet_NaN())),
                 "0 to 1");
    expect_error(add_gtso(frame, good, settings_of(1.5f)), "0 to 1");
    expect_error(add_gtso(frame, good, settings_of(0.5f, 4)), "'roughness_channel' is 4");
    OcclusionSettings other = settings_of();
    other.specular = Specular::slices;
    expect_error(add_gtso(frame, good, other), "slices; it must be table");
    read_back(graph, add(frame, good, settings_of()));
  });
}

}  // namespace
}  // namespace alcove::passes
