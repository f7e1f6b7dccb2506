#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "drawing.h"
#include "gtso_table.h"
#include "maths/gtso.h"
#include "maths/gtso_table.h"
#include "maths/projection.h"
#include "maths/slice.h"
#include "projection_truth.h"
#include "random_input.h"
#include "single_passes.h"
#include "views.h"
#include "work/rigid_transform.h"

namespace alcove::passes {
namespace {

using framegraph::Graph;
using framegraph::Texture;
using glm::vec3;

constexpr std::uint32_t kWidth = 45;
constexpr std::uint32_t kHeight = 31;

OcclusionSettings settings_of(float roughness = 0.5f, std::uint32_t channel = 0) {
  OcclusionSettings settings;
  settings.specular = ALCOVE_SPECULAR_TABLE;
  settings.roughness = roughness;
  settings.roughness_channel = channel;
  settings.precision = ALCOVE_PRECISION_FLOAT32;
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

// Returns a plane that faces the eye with random normals and lighting. Every seventh pixel is sky.
Inputs random_inputs() {
  maths_test::RandomInput random;
  Inputs inputs;
  for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
    const vec3 normal = random.facing(vec3(0, 0, 1));
    append(inputs.normals, normal, 0.0f);
    append(inputs.bent, random.facing(normal), 0.0f);
    append(inputs.surface, vec3(0.25f), random.uniform(0.05f, 1.0f));
    inputs.visibility.texels.push_back(random.uniform(0.0f, 1.0f));
    inputs.depth.texels.push_back(i % 7 == 6 ? kNaN : 0.7f);
  }
  return inputs;
}

class GtsoPass : public PassTest {
 protected:
  // Adds the pass with visibility and bent normals that were written before, and returns its
  // image.
  Texture add(Graph& graph, const AlcoveCamera& camera, ViewTextures textures,
              const OcclusionSettings& settings, bool normals_in_view_space = true) {
    textures[ALCOVE_IMAGE_SPECULAR] = graph.create_texture(
        "specular", {VK_FORMAT_R32_SFLOAT, sample::extent_of(graph, textures[ALCOVE_IMAGE_DEPTH])});
    add_passes(
        graph, gpu().pipelines(),
        {.settings = &settings,
         .camera = camera,
         .normals_in_view_space = normals_in_view_space ? 1u : 0u},
        0, textures, [](GraphAdapter&, const ViewInputs& view) {
          describe_gtso(
              view, view.image(ALCOVE_IMAGE_DEPTH),
              {view.image(ALCOVE_IMAGE_VISIBILITY), view.image(ALCOVE_IMAGE_BENT_NORMAL), {}});
        });
    return textures[ALCOVE_IMAGE_SPECULAR];
  }
  ViewTextures textures_of(Graph& graph, const Inputs& inputs) {
    ViewTextures textures{upload(graph, inputs.depth)};
    if (inputs.normals.width != 0) textures[ALCOVE_IMAGE_NORMALS] = upload(graph, inputs.normals);
    textures[ALCOVE_IMAGE_VISIBILITY] = upload(graph, inputs.visibility);
    textures[ALCOVE_IMAGE_BENT_NORMAL] = upload(graph, inputs.bent);
    return textures;
  }
  void run_pass(const AlcoveCamera& view, const Inputs& inputs) {
    run([&](Graph& graph) {
      ViewTextures textures = textures_of(graph, inputs);
      textures[ALCOVE_IMAGE_ROUGHNESS] = upload(graph, inputs.surface);
      read_back(graph, add(graph, view, textures, settings_of(0.5f, 3)));
    });
  }
};

maths::Projection projection_of(const AlcoveCamera& view) {
  return maths::make_projection(to_mat4(view.clip_from_view), kWidth, kHeight).value();
}

// Returns the value that the pass should write at a pixel.
float expected(const Inputs& inputs, const maths::Projection& projection, std::uint32_t x,
               std::uint32_t y) {
  if (std::isnan(inputs.depth.at(x, y))) return 1.0f;
  const vec3 view = maths_test::view_at(projection, glm::vec2(x, y) + 0.5f);
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

TEST_F(GtsoPass, WorldSpaceNormalsAreRotatedIntoViewSpace) {
  const Inputs inputs = random_inputs();
  const auto with = [&](AlcoveCamera view, bool in_view_space) {
    run([&](Graph& graph) {
      read_back(graph,
                add(graph, view, textures_of(graph, inputs), settings_of(0.4f), in_view_space));
    });
    return result();
  };
  AlcoveCamera view = test_views().front().view;
  const HostImage in_view_space = with(view, true);
  EXPECT_EQ(in_view_space.texels, with(view, false).texels);
  // The camera is rotated by 180 degrees about the view axis.
  view.view_from_world[0] = view.view_from_world[5] = -1.0f;
  EXPECT_NE(in_view_space.texels, with(view, false).texels);
  EXPECT_EQ(in_view_space.texels, with(view, true).texels);
}

TEST_F(GtsoPass, NormalsAreMadeFromDepthWithoutATextureAndAtTexelsWithoutANormal) {
  for (const TestView& view : test_views()) {
    SCOPED_TRACE(view.name);
    const Drawing drawing = draw(view, kWidth, kHeight, {tilted_plane(40.0, 4.0)});
    Inputs inputs = random_inputs();
    inputs.depth = drawing.depth_ndc;
    inputs.normals = drawing.normal_vs;
    run_pass(view.view, inputs);
    const HostImage given = result();
    std::ranges::fill(inputs.normals.texels, 0.0f);
    run_pass(view.view, inputs);
    EXPECT_THAT(result().texels, testing::Pointwise(testing::FloatNear(0.02f), given.texels));
    inputs.normals = {};
    run_pass(view.view, inputs);
    EXPECT_THAT(result().texels, testing::Pointwise(testing::FloatNear(0.02f), given.texels));
  }
}

TEST_F(GtsoPass, LookupTableIsCreatedWhenAPassReadsIt) {
  open_gpu();
  const VkDeviceSize without_table = gpu().pipelines().memory_bytes();
  run_pass(test_views().front().view, random_inputs());
  EXPECT_EQ(gpu().pipelines().memory_bytes() - without_table, maths::kGtsoEntries);
}

}  // namespace
}  // namespace alcove::passes
