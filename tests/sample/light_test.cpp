// Compares lit surfaces with the integral of their BRDF over the environment.
#include "render/light.h"

#include <cmath>

#include "gpu_test.h"
#include "maths/ggx.h"
#include "render/frame_renderer.h"
#include "scene/builtin_scene.h"

namespace alcove::sample {
namespace {

using LightTest = GpuTest;

// Returns the light that a surface reflects towards `view`, by quadrature over the sky's pixels.
glm::vec3 integral(const EnvironmentImage& sky, const glm::vec3& normal, const glm::vec3& view,
                   const glm::vec3& base, float roughness, float metallic) {
  const float alpha = roughness * roughness, n_dot_v = std::max(glm::dot(normal, view), 1e-3f);
  glm::vec3 diffuse(0.0f), specular(0.0f), reflectance(0.0f);
  for (std::uint32_t i = 0; i < sky.pixels.size(); ++i) {
    const glm::vec3 light = direction_at(sky, i);
    const float n_dot_l = glm::dot(normal, light);
    if (n_dot_l <= 0.0f) continue;
    const float angle = std::sqrt(1.0f - light.y * light.y) * 2.0f * maths::kPi * maths::kPi /
                        float(sky.pixels.size());
    const glm::vec3 half = glm::normalize(view + light);
    const glm::vec3 f0 = glm::mix(glm::vec3(0.04f), base, metallic);
    const glm::vec3 fresnel = glm::mix(f0, glm::vec3(1.0f), std::pow(1.0f - dot(view, half), 5.0f));
    const glm::vec3 lobe = fresnel * maths::ggx_distribution(glm::dot(normal, half), alpha) *
                           maths::ggx_shadowing(n_dot_v, n_dot_l, alpha) / (4.0f * n_dot_v);
    diffuse += n_dot_l * angle / maths::kPi * sky.pixels[i];
    specular += lobe * angle * sky.pixels[i];
    reflectance += lobe * angle;
  }
  return base * (1.0f - metallic) * diffuse * (1.0f - reflectance) + specular;
}

TEST_F(LightTest, UnoccludedLightAgreesWithTheIntegralOfTheBrdfOverTheSky) {
  const Scene scene = builtin_scene();
  const Camera& camera = scene.cameras.front();
  constexpr std::uint32_t kWidth = 16, kHeight = 9;
  const CameraMatrices matrices = camera_matrices(camera, kWidth, kHeight);
  EnvironmentImage sky(256, 128);
  for (std::uint32_t i = 0; i < sky.pixels.size(); ++i)
    sky.pixels[i] = glm::exp(3.0f * direction_at(sky, i));
  const auto renderer = FrameRenderer::create(gpu(), scene, {kWidth, kHeight}).value();
  for (const float roughness : {0.3f, 0.6f, 1.0f}) {
    const IndirectRequest light{{roughness}, sky, true};
    FrameRequest request{.view = gbuffer_view(camera, camera, {kWidth, kHeight}),
                         .occlusion = OcclusionSettings(ALCOVE_QUALITY_LOW, 0.2f),
                         .light = &light};
    request.occlusion.bent_normal = true;
    request.occlusion.specular = ALCOVE_SPECULAR_SLICES;
    const FrameImages images = renderer->draw_and_read(request).value();
    double squares = 0.0, sum = 0.0;
    for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
      if (images.depth_ndc.pixels[i] == 1.0f) continue;
      const glm::vec2 pixel = glm::vec2(glm::uvec2(i % kWidth, i / kWidth)) + 0.5f;
      const Ray ray = camera_ray(matrices, camera.orthographic, pixel, kWidth, kHeight);
      // Normals of 16 bits are shorter than 1 by up to 6e-4, which widens a lobe.
      const glm::vec3 truth =
          integral(sky, glm::normalize(images.normal_ws.pixels[i]), -ray.direction_ws,
                   images.albedo.pixels[i], roughness, images.metallic.pixels[i]);
      const glm::vec3 error = images.lit.unoccluded.pixels[i] - truth;
      squares += glm::dot(error, error);
      sum += glm::dot(truth, truth);
    }
    EXPECT_LT(std::sqrt(squares / sum), 0.015) << "roughness " << roughness;
  }
}

}  // namespace
}  // namespace alcove::sample
