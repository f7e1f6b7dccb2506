// Tests scenes from files with the parts of the program that use them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/open_session.h"
#include "cli/options.h"
#include "gltf_maker.h"
#include "reference/truth.h"
#include "temporary_folder.h"

namespace alcove::sample {
namespace {

using testing::HasSubstr;

TEST(SceneNotes, OnlyTheFirstTwentyNotesOnASceneArePrinted) {
  GltfMaker maker = GltfMaker::triangle();
  for (int i = 100; i < 150; ++i)
    maker.json["extensionsUsed"].push_back("EXT_" + std::to_string(i));
  const TemporaryFolder folder;
  Options options;
  options.scene = folder.write("notes.gltf", maker.gltf());
  options.view.eye = {0.3, 0.3, 0.5};  // where the triangle fills the view, which needs no advice
  options.view.target = {0.3, 0.3, 0.0};
  testing::internal::CaptureStderr();
  EXPECT_TRUE(load_session(options));
  const std::string printed = testing::internal::GetCapturedStderr();
  EXPECT_THAT(printed, HasSubstr("EXT_119"));
  EXPECT_THAT(printed, testing::Not(HasSubstr("EXT_120")));
  EXPECT_THAT(printed, HasSubstr("note: There are 30 more notes on this scene.\n"));
}

TEST(LoadScene, UnknownNameListsTheScenesThatNeedNoFile) {
  for (const char* name : {"spere", "sphere/", "no/terain"})
    EXPECT_THAT(load_scene(name).error(), HasSubstr("fence, terrain, plane:60, groove:90"));
}

// A masked triangle with vertex colours, and whether a ray meets it near its first corner.
bool is_hit(const std::vector<uint8_t>& colors) {
  GltfMaker maker = GltfMaker::triangle();
  maker.primitive()["attributes"]["COLOR_0"] = maker.add("VEC4", colors, true);
  maker.json["materials"] = {{{"alphaMode", "MASK"}}};
  maker.primitive()["material"] = 0;
  const Scene scene = parsed(maker.gltf());
  const auto rays = RayScene::create(scene);
  EXPECT_TRUE(rays);
  Camera camera;
  camera.eye_ws = {0.1f, 0.1f, 1.0f};
  camera.target_ws = {0.1f, 0.1f, 0.0f};
  return cast_gbuffer(*rays, camera, 1, 1).material.pixels[0] == 0;
}

TEST(GltfMaterial, AlphaOfVertexColoursCutsHolesIntoMaskedMaterials) {
  EXPECT_TRUE(is_hit({9, 9, 9, 255, 9, 9, 9, 255, 9, 9, 9, 255}));
  EXPECT_FALSE(is_hit({9, 9, 9, 0, 9, 9, 9, 0, 9, 9, 9, 0}));
  EXPECT_TRUE(is_hit({9, 9, 9, 255, 9, 9, 9, 0, 9, 9, 9, 0}));
}

}  // namespace
}  // namespace alcove::sample
