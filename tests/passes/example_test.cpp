// Runs the C++ example of passes/README.md on the device. The text of the example is compiled
// unchanged.
#include <gtest/gtest.h>

#include <utility>

// The includes of the example come first, as in the README.
#include <alcove/passes/graph.h>

#include "c_interface_fixture.h"

using namespace alcove;

namespace {

// An engine of what the example uses.
struct Engine {
  framegraph::Graph graph;
  passes::Pipelines pipelines;
  framegraph::Executor executor;
  AlcoveSettings settings{};
  AlcoveCamera camera{};
  AlcoveCamera previous_camera{};
  std::uint32_t frame = 0;
  std::uint32_t slot = 0;
  framegraph::ImportedTexture depth;
  framegraph::ImportedTexture normals;
  framegraph::ImportedTexture visibility;
};

// At the start, with the engine's device and two frames in flight, the engine calls
// Executor::create(device, {.frames_in_flight = 2}) and Pipelines::create(device, 2). It calls this
// function once per frame, after the device has finished the previous frame with the same slot.
tl::expected<void, std::string> record_occlusion(Engine& engine, VkCommandBuffer commands) {
  framegraph::Graph& graph = engine.graph;
  graph.reset();
  engine.pipelines.begin_frame(engine.slot);
  passes::ViewTextures textures{};
  textures[ALCOVE_IMAGE_DEPTH] = graph.import_texture("depth", engine.depth);
  textures[ALCOVE_IMAGE_NORMALS] = graph.import_texture("normals", engine.normals);
  textures[ALCOVE_IMAGE_VISIBILITY] = graph.import_texture("visibility", engine.visibility);
  const AlcoveViewInfo view{.settings = &engine.settings,
                            .camera = engine.camera,
                            .previous_camera = engine.previous_camera};
  const auto added = passes::add_view(graph, engine.pipelines, view, engine.frame, textures);
  if (!added) return tl::unexpected(added.error().message);
  const auto report = engine.executor.record(graph, commands, {engine.slot});
  if (!report) return tl::unexpected(framegraph::to_string(report.error()));
  return {};
}

class Example : public passes::CInterface {
 protected:
  std::unique_ptr<Engine> start() {
    auto executor = framegraph::Executor::create(gpu().handles(), {.frames_in_flight = 2});
    auto pipelines = passes::Pipelines::create(gpu().handles(), 2);
    if (!executor || !pipelines) return nullptr;
    return std::unique_ptr<Engine>(new Engine{
        .graph = {}, .pipelines = std::move(*pipelines), .executor = std::move(*executor)});
  }
};

TEST_F(Example, ReadmeExampleDrawsTheSameImageAsTheCInterface) {
  passes::HostView from = passes::draw_view(40, 30);
  from.settings.precision = ALCOVE_PRECISION_UNORM8;
  from.normals_in_view_space = false;
  from.motion = from.roughness = from.albedo = {};
  const std::unique_ptr<Engine> example = start();
  ASSERT_NE(example, nullptr);
  const AlcoveView images = create_view(from);
  example->settings = from.settings;
  example->depth = passes::import_of(images.images[ALCOVE_IMAGE_DEPTH]);
  example->normals = passes::import_of(images.images[ALCOVE_IMAGE_NORMALS]);
  example->visibility = passes::import_of(images.images[ALCOVE_IMAGE_VISIBILITY]);
  for (std::uint32_t i = 0; i < 4; ++i) {
    from.previous_view = from.view;
    from.view.view_from_world[12] = 0.02f * static_cast<float>(i);
    example->camera = from.view;
    example->previous_camera = from.previous_view;
    example->frame = i;
    example->slot = i % 2;
    engine().submit(example->slot, [&](VkCommandBuffer commands) {
      const auto result = record_occlusion(*example, commands);
      EXPECT_TRUE(result) << result.error();
    });
    const passes::HostImage image = read(images.images[ALCOVE_IMAGE_VISIBILITY]);
    EXPECT_EQ(image.texels, run_views(context(), {&from, 1}, i)[0].visibility.texels) << i;
  }
  engine().wait();
}

}  // namespace
