// Tests randomly generated extreme views: eyes in walls and far away, the narrowest and widest
// angles, near and far planes millions of units apart, tiny and huge radii. Every output must be
// finite and in range. An open ground must be open.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

#include "gpu_test.h"
#include "render/frame_renderer.h"
#include "scene/builtin_scene.h"
#include "scene/shapes.h"

namespace alcove::sample {
namespace {

// Returns the number of generated views: ALCOVE_VIEWS, or 24 if it is not set. The soak test sets
// 250.
std::uint32_t view_count() {
  const char* text = std::getenv("ALCOVE_VIEWS");
  return text != nullptr ? static_cast<std::uint32_t>(std::stoul(text)) : 24;
}

struct ExtremeView {
  Camera camera;
  OcclusionSettings settings;
};

class Generator {
 public:
  explicit Generator(std::uint32_t seed) : random_(seed) {}

  ExtremeView next(const Scene& scene) {
    const glm::vec3 size = scene.bounds_ws.high - scene.bounds_ws.low;
    ExtremeView view;
    Camera& camera = view.camera;
    // The eye is in the scene, on its edge, or up to 10^4 times its size away.
    const float away = pick({0.0f, 0.3f, 1.0f, 30.0f, 1e4f});
    camera.target_ws = scene.bounds_ws.low + size * vector(0.0f, 1.0f);
    camera.eye_ws = camera.target_ws + away * size * vector(-1.0f, 1.0f) + vector(-1e-3f, 1e-3f);
    camera.up_ws = pick({0.0f, 1.0f}) == 0.0f ? glm::vec3(0, 1, 0) : vector(-1.0f, 1.0f);
    if (glm::length(camera.up_ws) < 0.1f) camera.up_ws = {0, 0, 1};
    camera.orthographic = pick({0.0f, 0.0f, 1.0f}) == 1.0f;
    camera.fov_y = glm::radians(pick({0.01f, 1.0f, 60.0f, 120.0f, 170.0f, 177.0f}));
    camera.ortho_height = pick({1e-3f, 1.0f, 100.0f, 1e5f});
    camera.near_plane = pick({1e-6f, 1e-3f, 0.1f, 5.0f});
    camera.far_plane = camera.near_plane * pick({1.001f, 10.0f, 1e4f, 1e9f});
    if (!camera.orthographic && pick({0.0f, 1.0f, 2.0f}) == 0.0f) camera.far_plane = INFINITY;
    camera.reversed_z = pick({0.0f, 1.0f}) == 1.0f;
    camera.offset_ndc = pick({0.0f, 0.0f, 0.7f}) * glm::vec2(vector(-1.0f, 1.0f));
    const auto quality = static_cast<AlcoveQuality>(random_() % 4);
    view.settings = OcclusionSettings(quality, pick({1e-5f, 0.05f, 0.5f, 50.0f, 1e6f}));
    view.settings.bent_normal = true;
    view.settings.specular = ALCOVE_SPECULAR_SLICES;
    return view;
  }

 private:
  float pick(std::initializer_list<float> values) {
    return values.begin()[random_() % values.size()];
  }
  glm::vec3 vector(float low, float high) {
    std::uniform_real_distribution<float> uniform(low, high);
    const float x = uniform(random_), y = uniform(random_), z = uniform(random_);
    return {x, y, z};
  }
  std::mt19937 random_;
};

bool in_unit_range(const Image<float>& image) {
  return std::ranges::all_of(image.pixels, [](float v) { return v >= 0.0f && v <= 1.0f; });
}

TEST(ExtremeViews, OutputsOfRandomExtremeViewsAreFiniteAndInRange) {
  const ValidatedGpu gpu = open_validated();
  ASSERT_TRUE(gpu);
  const Scene scene = builtin_scene();
  const VkExtent2D size{48, 27};
  auto renderer = FrameRenderer::create(*gpu, scene, {size.width, size.height});
  ASSERT_TRUE(renderer) << renderer.error();
  for (std::uint32_t seed = 1; seed <= view_count(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const ExtremeView view = Generator(seed).next(scene);
    const IndirectRequest light{.roughness = {0.3f}};
    const FrameRequest request{.view = gbuffer_view(view.camera, view.camera, size),
                               .occlusion = view.settings,
                               .light = &light};
    const auto images = (*renderer)->draw_and_read(request);
    ASSERT_TRUE(images) << images.error();
    EXPECT_TRUE(in_unit_range(images->visibility));
    for (const Image<float>& specular : images->specular_occlusion)
      EXPECT_TRUE(in_unit_range(specular));
    for (const glm::vec3& bounce : images->multi_bounce.pixels) {
      ASSERT_TRUE(glm::all(glm::greaterThanEqual(bounce, glm::vec3(0.0f))));
      ASSERT_TRUE(glm::all(glm::lessThanEqual(bounce, glm::vec3(1.0f))));
    }
    for (const glm::vec3& normal : images->bent_normal_ws.pixels)
      ASSERT_TRUE(std::isfinite(glm::length(normal)) && glm::length(normal) < 1.01f);
  }
}

TEST(ExtremeViews, OpenGroundIsUnoccludedInANarrowViewOverALargeDepthRange) {
  const ValidatedGpu gpu = open_validated();
  ASSERT_TRUE(gpu);
  SceneBuilder builder;
  builder.add_material("ground", glm::vec3(0.5f), 0.5f);
  for (float z = -2000.0f; z < 2000.0f; z += 100.0f)
    for (float x = -2000.0f; x < 2000.0f; x += 100.0f)
      builder.quad({x, 0, z}, {x, 0, z + 100}, {x + 100, 0, z + 100}, {x + 100, 0, z});
  const Scene scene = builder.finish("ground");
  const VkExtent2D size{160, 90};
  auto renderer = FrameRenderer::create(*gpu, scene, {size.width, size.height});
  ASSERT_TRUE(renderer) << renderer.error();
  Camera camera = scene_camera("high", {0, 60, 0}, {0, 0, -500}, 3.0f, 5000.0f);
  camera.near_plane = 0.01f;
  for (const bool reversed : {true, false}) {
    camera.reversed_z = reversed;
    const FrameRequest request{.view = gbuffer_view(camera, camera, size),
                               .occlusion = OcclusionSettings(ALCOVE_QUALITY_MEDIUM, 1.0f)};
    const auto images = (*renderer)->draw_and_read(request);
    ASSERT_TRUE(images) << images.error();
    EXPECT_GT(std::ranges::min(images->visibility.pixels), 0.99f) << reversed;
    EXPECT_EQ(std::ranges::count(images->depth_ndc.pixels, reversed ? 0.0f : 1.0f), 0);
  }
}

}  // namespace
}  // namespace alcove::sample
