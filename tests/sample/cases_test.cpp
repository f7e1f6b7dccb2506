// Tests small files that an earlier version drew wrongly without a message. They are drawn as
// `alcove render` draws them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "cli/open_session.h"
#include "cli/options.h"
#include "image_maker.h"
#include "model_maker.h"

namespace alcove::sample {
namespace {

// Renders a file as `alcove render` does, at 160x90 under the validation layers. Any message fails
// the test.
tl::expected<Rendering, std::string> draw_file(const std::string& file, Options options) {
  options.scene = file;
  options.view.width = 160;
  options.view.height = 90;
  options.validation = true;
  auto rendering = render(options);
  EXPECT_TRUE(rendering) << rendering.error();
  return rendering;
}

// Fractions of the pixels of a picture, by their contents.
struct Shares {
  double sky = 0.0;       // pixels without a surface, of all
  double occluded = 0.0;  // pixels with a visibility below .9, of those with a surface
  double least = 1.0;     // the smallest visibility of a surface
};
Shares shares_of(const Rendering& rendering) {
  Shares shares;
  double surfaces = 0.0;
  const Image<float> depth = linear_depth(rendering);
  for (size_t i = 0; i < depth.pixels.size(); ++i) {
    if (std::isinf(depth.pixels[i])) continue;
    const float visibility = rendering.images.visibility.pixels[i];
    ++surfaces;
    if (visibility < 0.9f) ++shares.occluded;
    shares.least = std::min<double>(shares.least, visibility);
  }
  shares.sky = 1.0 - surfaces / static_cast<double>(depth.pixels.size());
  shares.occluded /= std::max(surfaces, 1.0);
  return shares;
}

// A floor, three walls and a box, within 6 m.
Triangles room() {
  Triangles room;
  room.add_box({-3, -0.1f, -3}, {3, 0, 3});
  room.add_box({-3, 0, -3.1f}, {3, 3, -3});
  room.add_box({-3, 0, -3}, {-2.9f, 3, 3});
  room.add_box({-0.5f, 0, -1.5f}, {0.5f, 1, -0.5f});
  return room;
}

Options view_from(glm::dvec3 eye, glm::dvec3 target) {
  Options options;
  options.view.eye = eye;
  options.view.target = target;
  return options;
}

float greatest_difference(const Image<float>& a, const Image<float>& b) {
  float greatest = 0.0f;
  for (size_t i = 0; i < a.pixels.size(); ++i)
    greatest = std::max(greatest, std::abs(a.pixels[i] - b.pixels[i]));
  return greatest;
}

double root_mean_square(const Image<float>& a, const Image<float>& b) {
  double sum = 0.0;
  for (size_t i = 0; i < a.pixels.size(); ++i)
    sum += std::pow(double{a.pixels[i]} - double{b.pixels[i]}, 2);
  return std::sqrt(sum / static_cast<double>(a.pixels.size()));
}

class RenderedFile : public testing::Test {
 protected:
  TemporaryFolder folder_;
};

TEST_F(RenderedFile, SkinnedMeshIsDrawnAtItsJointsAndNotAtItsNode) {
  Triangles cube, floor;
  cube.add_box({-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f});
  floor.add_box({-4, -0.1f, -4}, {4, 0, 4});
  ModelMaker expected;
  expected.add(floor);
  expected.node({{"mesh", expected.mesh(cube)}, {"translation", {0.5f, 0, 0}}});

  ModelMaker skinned;
  skinned.add(floor);
  const int mesh = skinned.mesh(cube);
  const size_t vertices = cube.positions.size();
  std::vector<float> weights;
  for (size_t i = 0; i < vertices; ++i) weights.insert(weights.end(), {1, 0, 0, 0});
  GltfMaker& gltf = skinned.gltf;
  auto& attributes = gltf.json["meshes"][static_cast<size_t>(mesh)]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = gltf.add("VEC4", std::vector<uint8_t>(4 * vertices, 0));
  attributes["WEIGHTS_0"] = gltf.add("VEC4", weights);
  const int joint = skinned.node({{"translation", {0.5f, 0, 0}}});
  gltf.json["skins"] = {{{"joints", {joint}}}};
  skinned.node({{"mesh", mesh}, {"skin", 0}, {"scale", {100, 100, 100}}});

  // The radius that suits the cube is about a pixel of this view.
  Options view = view_from({4, 3, 5}, {0, 0.5, 0});
  view.occlusion.radius = 0.5f;
  const auto drawn = draw_file(skinned.write(folder_, "skinned"), view);
  const auto right = draw_file(expected.write(folder_, "expected"), view);
  ASSERT_TRUE(drawn && right);
  EXPECT_LT(shares_of(*right).least, 0.8);
  EXPECT_LT(root_mean_square(drawn->images.visibility, right->images.visibility), 1e-3);
}

TEST_F(RenderedFile, SceneFarFromTheOriginIsDrawnLikeOneAtTheOrigin) {
  const auto drawn_at = [&](const glm::dvec3& offset) {
    ModelMaker maker;
    maker.node({{"mesh", maker.mesh(room())}, {"translation", {offset.x, offset.y, offset.z}}});
    Options options = view_from(offset + glm::dvec3(2, 2, 4.5), offset + glm::dvec3(0, 0.5, -1));
    options.occlusion.radius = 0.5f;
    options.view.frames = 8;
    return draw_file(maker.write(folder_, "room"), options);
  };
  const auto right = drawn_at(glm::dvec3(0.0));
  const auto drawn = drawn_at({1e5, 0, 1e5});
  ASSERT_TRUE(right && drawn);
  EXPECT_LT(root_mean_square(drawn->images.visibility, right->images.visibility), 1e-3);
  constexpr float kStep = 1.0f / 255.0f;  // visibility is stored in 8 bits
  EXPECT_LE(greatest_difference(drawn->images.visibility, right->images.visibility), 1.01f * kStep);
}

TEST_F(RenderedFile, OpenGroundIsUnoccludedInANarrowViewOverALargeDepthRange) {
  Triangles ground;
  constexpr int kCells = 40;
  for (int z = 0; z < kCells; ++z) {
    for (int x = 0; x < kCells; ++x) {
      const glm::vec3 at(100.0f * static_cast<float>(x) - 2000.0f, 0,
                         100.0f * static_cast<float>(z) - 2000.0f);
      ground.add_quad(at, at + glm::vec3(0, 0, 100), at + glm::vec3(100, 0, 100),
                      at + glm::vec3(100, 0, 0));
    }
  }
  ModelMaker maker;
  maker.add(ground);
  const std::string file = maker.write(folder_, "ground");
  Options options = view_from({0, 60, 0}, {0, 0, -500});
  options.view.fov_y = glm::radians(3.0f);
  options.view.near_plane = 0.01f;
  options.view.far_plane = 5000.0f;
  options.occlusion.radius = 1.0f;
  for (const bool reversed : {true, false}) {
    options.view.reversed_z = reversed;
    const auto drawn = draw_file(file, options);
    ASSERT_TRUE(drawn);
    EXPECT_EQ(shares_of(*drawn).sky, 0.0);
    EXPECT_GT(shares_of(*drawn).least, 0.99) << (reversed ? "reversed" : "standard");
  }
}

TEST_F(RenderedFile, RoomWithInwardFacesShowsItsInsideFromOutsideUnlessItIsDoubleSided) {
  const auto least = [&](bool double_sided, bool both_sides) {
    Triangles walls;
    walls.add_box({-3, 0, -2}, {3, 2.5f, 2}, true);
    walls.add_box({-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f});
    ModelMaker maker;
    maker.add(walls, {{"doubleSided", double_sided}});
    Options options = view_from({5, 6, 7}, {0, 0, 0});
    options.occlusion.radius = 0.5f;
    options.materials.both_sides = both_sides;
    const auto drawn = draw_file(maker.write(folder_, "inward"), options);
    return drawn ? shares_of(*drawn).least : -1.0;
  };
  EXPECT_LT(least(false, false), 0.8);  // the inside, with its corners and the box
  EXPECT_GT(least(true, false), 0.95);  // a closed box, seen from outside
  EXPECT_GT(least(false, true), 0.95);
}

TEST_F(RenderedFile, SpecularGlossinessTextureGivesColourAndCutsOutTransparentTexels) {
  // A card whose texture is red and opaque on the left, and transparent on the right.
  PngRecipe recipe{2, 1, PNG_COLOR_TYPE_RGB_ALPHA, 8, false};
  recipe.samples = {255, 0, 0, 255, 0, 255, 0, 0};
  Triangles card;
  card.add_quad({-1, 0, 0}, {1, 0, 0}, {1, 2, 0}, {-1, 2, 0});
  ModelMaker maker;
  GltfMaker& gltf = maker.gltf;
  maker.add(card,
            {{"alphaMode", "MASK"},
             {"extensions",
              {{"KHR_materials_pbrSpecularGlossiness", {{"diffuseTexture", {{"index", 0}}}}}}}});
  gltf.json["images"] = {{{"bufferView", gltf.view(make_png(recipe))}, {"mimeType", "image/png"}}};
  gltf.json["samplers"] = {{{"magFilter", 9728}, {"minFilter", 9728}}};
  gltf.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
  gltf.json["extensionsUsed"] = {"KHR_materials_pbrSpecularGlossiness"};
  gltf.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
      gltf.add<float>("VEC2", {0, 1, 1, 1, 1, 0, 0, 0});
  const auto drawn = draw_file(maker.write(folder_, "card"), view_from({0, 1, 4}, {0, 1, 0}));
  ASSERT_TRUE(drawn);
  const Image<float> depth = linear_depth(*drawn);
  const auto at = [&](uint32_t x) { return std::isfinite(depth.at(x, 45)); };
  EXPECT_TRUE(at(70));
  EXPECT_FALSE(at(90));
  EXPECT_LT(glm::distance(drawn->images.albedo.at(70, 45), glm::vec3(1, 0, 0)), 0.02f);
}

}  // namespace
}  // namespace alcove::sample
