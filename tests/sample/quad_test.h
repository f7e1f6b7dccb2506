#pragma once

#include <cstdint>
#include <utility>

#include "gpu_test.h"
#include "render/frame_renderer.h"

// A test fixture that renders a quad which fills the picture, and reads images back.
namespace alcove::sample {

// Returns a quad that faces +Z, with u to the right, v down and one material. It consists of a left
// and a right half, which share vertices.
inline Scene plain_quad() {
  Scene scene;
  scene.materials.emplace_back();
  scene.meshes.emplace_back();
  Mesh& mesh = scene.meshes[0];
  for (const float x : {-1.0f, 0.0f, 1.0f}) {
    for (const float y : {-1.0f, 1.0f}) {
      mesh.positions.emplace_back(x, y, 0.0f);
      mesh.normals.emplace_back(0.0f, 0.0f, 1.0f);
      mesh.uvs.emplace_back(0.5f * (x + 1.0f), 0.5f * (1.0f - y));
    }
  }
  mesh.indices = {0, 2, 3, 0, 3, 1, 2, 4, 5, 2, 5, 3};
  scene.bounds_ws = bounds_of(scene.meshes);
  return scene;
}

inline Camera camera_at(float z) {
  Camera camera;
  camera.eye_ws = {0.0f, 0.0f, z};
  camera.target_ws = glm::vec3(0.0f);
  camera.orthographic = true;
  return camera;
}

class QuadTest : public GpuTest {
 protected:
  FrameImages draw(const Scene& scene, std::uint32_t size, const Camera& camera = camera_at(3.0f),
                   NormalSource normals = NormalSource::shading) {
    auto renderer = FrameRenderer::create(gpu(), scene, {size, size, normals});
    EXPECT_TRUE(renderer) << renderer.error();
    const FrameRequest request{.view = gbuffer_view(camera, camera, {size, size}),
                               .occlusion = OcclusionSettings(ALCOVE_QUALITY_LOW, 0.2f)};
    auto images = (*renderer)->draw_and_read(request);
    EXPECT_TRUE(images) << images.error();
    return images ? std::move(*images) : FrameImages{};
  }
};

}  // namespace alcove::sample
