// Runs the host program under the validation layers and compares its picture with that of
// `alcove render`, which draws the same scene from a glTF file with the same camera.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "model_maker.h"
#include "scene.h"
#include "temporary_folder.h"

namespace alcove::sample {
namespace {

// Synchronisation validation is on, within and across submits.
constexpr const char* kValidation =
    "VK_INSTANCE_LAYERS=VK_LAYER_KHRONOS_validation "
    "VK_LAYER_ENABLES=VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT:"
    "VALIDATION_CHECK_ENABLE_SYNCHRONIZATION_VALIDATION_QUEUE_SUBMIT ";

struct Ended {
  int status = -1;
  std::string output;  // standard output and error
};

Ended run(const std::string& command) {
  Ended result;
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return result;
  std::array<char, 256> part{};
  while (std::fgets(part.data(), part.size(), pipe) != nullptr) result.output += part.data();
  result.status = pclose(pipe);
  return result;
}

std::string read_file(const std::string& name) {
  std::ifstream file(name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Writes the scene of the host as a glTF file with its vertices, in their order.
std::string write_scene(const TemporaryFolder& folder) {
  const std::vector<host::Vertex> vertices = host::make_scene();
  std::vector<float> positions, normals;
  glm::vec3 low = vertices.front().position, high = low;
  for (const host::Vertex& vertex : vertices) {
    positions.insert(positions.end(), {vertex.position.x, vertex.position.y, vertex.position.z});
    const glm::vec3 normal = glm::normalize(vertex.normal);
    normals.insert(normals.end(), {normal.x, normal.y, normal.z});
    low = glm::min(low, vertex.position);
    high = glm::max(high, vertex.position);
  }
  ModelMaker model;
  GltfMaker& gltf = model.gltf;
  const int position = gltf.accessor(gltf.view(positions), 5126, "VEC3", vertices.size());
  gltf.json["accessors"].back()["min"] = {low.x, low.y, low.z};
  gltf.json["accessors"].back()["max"] = {high.x, high.y, high.z};
  const int normal = gltf.accessor(gltf.view(normals), 5126, "VEC3", vertices.size());
  gltf.json["meshes"].push_back(
      {{"primitives", {{{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}}}}});
  model.node({{"mesh", 0}});
  return model.write(folder, "scene");
}

// Visibility by `alcove render` with the camera and the settings of the host.
Image<float> render_by_alcove(const TemporaryFolder& folder) {
  Options options;
  options.scene = write_scene(folder);
  options.view.eye = host::kEye;
  options.view.target = host::kTarget;
  options.view.fov_y = glm::radians(host::kFovYDegrees);
  options.view.near_plane = host::kNear;
  options.view.far_plane = host::kFar;
  options.view.reversed_z = false;
  options.view.width = host::kWidth;
  options.view.height = host::kHeight;
  options.view.frames = host::kStillFrames;
  options.occlusion.radius = host::kRadius;
  const auto rendering = render(options);
  EXPECT_TRUE(rendering) << rendering.error();
  return rendering ? rendering->images.visibility : Image<float>{};
}

TEST(Host, DrawsThePictureOfAlcoveRenderWithinOneStepOfEightBits) {
  const TemporaryFolder folder;
  const std::string one_queue = (folder.path / "one_queue.pgm").string();
  const std::string async = (folder.path / "async.pgm").string();
  for (const std::string& arguments : {one_queue, async + " --async"}) {
    const Ended ended = run(kValidation + std::string(ALCOVE_HOST " ") + arguments);
    EXPECT_EQ(ended.status, 0);
    EXPECT_EQ(ended.output, "");
  }
  const std::string picture = read_file(one_queue);
  EXPECT_EQ(picture, read_file(async));

  const Image<float> expected = render_by_alcove(folder);
  ASSERT_EQ(expected.pixels.size(), std::size_t{host::kWidth} * host::kHeight);
  ASSERT_GT(picture.size(), expected.pixels.size());
  const std::size_t first = picture.size() - expected.pixels.size();
  float greatest = 0.0f, darkest = 1.0f;
  for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
    const float found = static_cast<float>(static_cast<unsigned char>(picture[first + i])) / 255.0f;
    greatest = std::max(greatest, std::abs(found - expected.pixels[i]));
    darkest = std::min(darkest, found);
  }
  EXPECT_LE(greatest, 1.0f / 255.0f + 1e-6f);
  EXPECT_LT(darkest, 0.6f);  // the picture has occlusion
}

}  // namespace
}  // namespace alcove::sample
