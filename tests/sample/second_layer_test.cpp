// Which faces the second layer of depth is drawn of.
#include "gpu_test.h"
#include "render/frame_renderer.h"

namespace alcove::sample {
namespace {

constexpr std::uint32_t kSize = 64;

// A rectangle that faces +Z, or -Z where `away`.
Mesh sheet(float left, float right, float z, bool away) {
  Mesh mesh;
  for (const float x : {left, right}) {
    for (const float y : {-1.0f, 1.0f}) {
      mesh.positions_ws.emplace_back(x, y, z);
      mesh.normals_ws.emplace_back(0.0f, 0.0f, away ? -1.0f : 1.0f);
      mesh.uvs.emplace_back(0.0f);
    }
  }
  mesh.indices = {0, 2, 3, 0, 3, 1};
  if (away) std::swap(mesh.indices[1], mesh.indices[2]);
  if (away) std::swap(mesh.indices[4], mesh.indices[5]);
  return mesh;
}

class SecondLayerDrawing : public GpuTest {
 protected:
  // What a floor sees beside a sheet that hides another one, which faces away from the eye.
  double visibility(bool double_sided) {
    Scene scene;
    scene.materials.emplace_back();
    scene.materials[0].double_sided = double_sided;
    scene.meshes = {sheet(-1.0f, 1.0f, 0.0f, false), sheet(-1.0f, 0.0f, 0.3f, false),
                    sheet(-1.0f, -0.02f, 0.1f, true)};
    scene.bounds_ws = bounds_of(scene.meshes);
    auto renderer = FrameRenderer::create(gpu(), scene, {kSize, kSize}, NormalSource::kGeometric);
    EXPECT_TRUE(renderer) << renderer.error();
    Camera camera;
    camera.eye_ws = {0.0f, 0.0f, 3.0f};
    camera.target_ws = glm::vec3(0.0f);
    camera.orthographic = true;
    const CameraMatrices m = camera_matrices(camera, kSize, kSize);
    FrameRequest request{.view = {.view_from_world = m.view_from_world,
                                  .clip_from_view = m.clip_from_view,
                                  .previous_view_from_world = m.view_from_world,
                                  .previous_clip_from_view = m.clip_from_view},
                         .occlusion = passes::quality_settings(passes::Quality::ultra, 0.5f)};
    request.occlusion.depth_layers = 2;
    request.occlusion.fill = 0.0f;
    const auto images = (*renderer)->draw_and_read(request);
    EXPECT_TRUE(images) << images.error();
    double sum = 0.0;
    for (std::uint32_t y = kSize / 4; y < 3 * kSize / 4; ++y)
      sum += images ? images->visibility.at(kSize / 2 + 2, y) : 0.0;
    return 2.0 * sum / kSize;
  }
};

TEST_F(SecondLayerDrawing, BothSidesOfASheetOccludeWhereItsMaterialHasTwo) {
  const double one = visibility(false);
  const double two = visibility(true);
  EXPECT_LT(two, one - 0.02);
}

}  // namespace
}  // namespace alcove::sample
