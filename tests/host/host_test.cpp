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

#include "cli/open_session.h"
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

// The result of a program.
struct ProcessResult {
  int status = -1;
  std::string output;  // standard output and error
};

ProcessResult run(const std::string& command) {
  ProcessResult result;
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

// A view that both programs draw.
struct Shot {
  glm::vec3 eye = host::kEye;
  std::uint32_t width = host::kWidth;
  std::uint32_t height = host::kHeight;
};

// Writes the scene of the host as a glTF file with its vertices, in their order. `ten_bits` rounds
// normals as the host's image of normals does.
std::string write_scene(const TemporaryFolder& folder, bool ten_bits) {
  const std::vector<host::Vertex> vertices = host::make_scene();
  std::vector<float> positions, normals;
  glm::vec3 low = vertices.front().position, high = low;
  for (const host::Vertex& vertex : vertices) {
    positions.insert(positions.end(), {vertex.position.x, vertex.position.y, vertex.position.z});
    const glm::vec3 normal =
        glm::normalize(ten_bits ? host::in_ten_bits(vertex.normal) : vertex.normal);
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
  return model.write(folder, ten_bits ? "ten_bits" : "scene");
}

// Visibility by `alcove render` with the settings of the host, in steps of 8 bits.
std::vector<int> draw_by_alcove(const TemporaryFolder& folder, const Shot& shot, bool ten_bits) {
  Options options;
  options.scene = write_scene(folder, ten_bits);
  options.view.eye = shot.eye;
  options.view.target = host::kTarget;
  options.view.fov_y = glm::radians(host::kFovYDegrees);
  options.view.near_plane = host::kNear;
  options.view.far_plane = host::kFar;
  options.view.reversed_z = false;
  options.view.width = shot.width;
  options.view.height = shot.height;
  options.view.frames = host::kStillFrames;
  options.occlusion.radius = host::kRadius;
  const auto rendering = render(options);
  EXPECT_TRUE(rendering) << rendering.error();
  std::vector<int> steps;
  if (rendering)
    for (const float visibility : rendering->images.visibility.pixels)
      steps.push_back(static_cast<int>(std::lround(255.0f * visibility)));
  return steps;
}

// Visibility by the host program under the validation layers.
std::vector<int> draw_by_host(const TemporaryFolder& folder, const Shot& shot,
                              const std::string& arguments) {
  const std::string file = (folder.path / "host.pgm").string();
  const ProcessResult process = run(
      kValidation + std::string(ALCOVE_HOST " ") + file + " --size " + std::to_string(shot.width) +
      "x" + std::to_string(shot.height) + " --eye " + std::to_string(shot.eye.x) + "," +
      std::to_string(shot.eye.y) + "," + std::to_string(shot.eye.z) + " " + arguments);
  EXPECT_EQ(process.status, 0);
  EXPECT_EQ(process.output, "");
  const std::string contents = read_file(file);
  const std::size_t pixels = std::size_t{shot.width} * shot.height;
  std::vector<int> steps;
  for (std::size_t i = contents.size() - std::min(pixels, contents.size()); i < contents.size();
       ++i)
    steps.push_back(static_cast<unsigned char>(contents[i]));
  return steps;
}

// How two pictures differ.
struct Difference {
  int greatest = 0;          // steps of 8 bits
  std::size_t over_one = 0;  // pixels that differ by more than one step
  double rmse = 0.0;         // of visibility
};

Difference difference(const std::vector<int>& a, const std::vector<int>& b) {
  EXPECT_EQ(a.size(), b.size());
  Difference result;
  double sum = 0.0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    const int steps = std::abs(a[i] - b[i]);
    result.greatest = std::max(result.greatest, steps);
    result.over_one += steps > 1 ? 1 : 0;
    sum += steps * steps / (255.0 * 255.0);
  }
  result.rmse = std::sqrt(sum / static_cast<double>(std::max<std::size_t>(a.size(), 1)));
  return result;
}

std::string name_of(const Shot& shot) {
  return std::to_string(shot.width) + "x" + std::to_string(shot.height);
}

// Views of other sizes, among them odd ones, and from other sides.
const Shot kOtherShots[] = {{{0.3f, 3.1f, 4.4f}, 160, 201}, {{4.1f, 0.8f, -1.2f}, 96, 64}};

// The host program stores normals in ten bits per channel. The glTF file has its normals rounded in
// the same way, and `alcove render` stores them in 16-bit floats, which changes them very little.
TEST(HostProgram, HostProgramDrawsTheSameImageAsAlcoveRenderWithinOneStepOfEightBits) {
  const TemporaryFolder folder;
  const std::vector<int> found = draw_by_host(folder, {}, "");
  EXPECT_EQ(found, draw_by_host(folder, {}, "--async"));
  EXPECT_LE(difference(found, draw_by_alcove(folder, {}, true)).greatest, 1);
  EXPECT_LT(*std::ranges::min_element(found), 150);  // the picture has occlusion
}

// Both programs store normals in 16-bit floats. Their cameras differ by rounding errors, which
// changed two of 32,160 pixels by two steps of eight bits when this limit was set.
TEST(HostProgram, HostProgramDrawsTheSameImageAsAlcoveRenderFromOtherCamerasWithFloatNormals) {
  const TemporaryFolder folder;
  for (const Shot& shot : kOtherShots) {
    SCOPED_TRACE(name_of(shot));
    const Difference found = difference(draw_by_host(folder, shot, "--float-normals"),
                                        draw_by_alcove(folder, shot, false));
    EXPECT_LE(found.greatest, 2);
    EXPECT_LE(found.over_one, shot.width * shot.height / 10000);
    EXPECT_LT(found.rmse, 0.0003);
  }
}

// Storing normals in ten bits per channel instead of 16-bit floats rotates the tangent plane by up
// to 0.05 degrees, so that a few depth samples move from one side of the plane to the other. At
// most 27 of 32,160 pixels differed by more than one step of eight bits when this limit was set.
TEST(HostProgram, StoringNormalsInTenBitsChangesFewPixels) {
  const TemporaryFolder folder;
  for (const Shot& shot : kOtherShots) {
    SCOPED_TRACE(name_of(shot));
    const Difference lost =
        difference(draw_by_host(folder, shot, ""), draw_by_host(folder, shot, "--float-normals"));
    EXPECT_LE(lost.over_one, shot.width * shot.height / 300);
    EXPECT_LT(lost.rmse, 0.0015);
  }
}

}  // namespace
}  // namespace alcove::sample
