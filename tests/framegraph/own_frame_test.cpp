// Tests the plan of Alcove's own frame: its memory peak equals the lower bound, and it has no
// superfluous barrier command.
#include <gtest/gtest.h>

#include "alcove/passes/graph.h"
#include "barrier_search.h"
#include "gpu.h"

namespace alcove::framegraph {
namespace {

// Declares the frame of an engine that provides depth and reads visibility and bent normals.
void declare(Graph& graph, passes::Pipelines& pipelines, VkImage image, AlcoveQuality quality) {
  const ImportedTexture engine_depth{
      .image = image,
      .desc = {VK_FORMAT_R32_SFLOAT, Extent::absolute(960, 540)},
      .usage = VK_IMAGE_USAGE_SAMPLED_BIT,
      .initial_state = {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                        VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                        VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL}};
  AlcoveSettings settings{.struct_size = sizeof settings};
  ASSERT_EQ(alcoveGetSettings(quality, 0.5f, &settings), ALCOVE_SUCCESS);
  AlcoveViewInfo view{.settings = &settings};
  for (int i = 0; i < 4; ++i)
    view.camera.clip_from_view[5 * i] = view.camera.view_from_world[5 * i] = 1.0f;
  passes::ViewTextures textures{graph.import_texture("depth", engine_depth)};
  textures[ALCOVE_IMAGE_VISIBILITY] =
      graph.create_texture("visibility", {VK_FORMAT_R8_UNORM, engine_depth.desc.extent});
  textures[ALCOVE_IMAGE_BENT_NORMAL] =
      graph.create_texture("bent normal", {VK_FORMAT_R8G8B8A8_SNORM, engine_depth.desc.extent});
  const auto added = passes::add_view(graph, pipelines, view, 0, textures);
  ASSERT_TRUE(added) << added.error().message;
  PassBuilder light = graph.add_pass("lighting");
  light.read(textures[ALCOVE_IMAGE_VISIBILITY], access::sampled_fragment);
  light.read(textures[ALCOVE_IMAGE_BENT_NORMAL], access::sampled_fragment);
  light.side_effect();
  light.record([](RecordContext&) {});
}

TEST(OcclusionFrame, PlanHasTheFewestBarrierCommandsAndTheLeastPeakMemory) {
  Gpu gpu;
  ASSERT_EQ(gpu.problem(), "");
  auto pipelines = passes::Pipelines::create(gpu.handles(), 1);
  ASSERT_TRUE(pipelines) << pipelines.error().message;
  const VkImage image = gpu.make_image({VK_FORMAT_R32_SFLOAT, Extent::absolute(960, 540)},
                                       VK_IMAGE_USAGE_SAMPLED_BIT);
  for (const auto quality : {ALCOVE_QUALITY_MEDIUM, ALCOVE_QUALITY_HIGH}) {
    Graph graph;
    declare(graph, *pipelines, image, quality);
    const auto plan = compile(graph.description());
    ASSERT_TRUE(plan) << to_string(plan.error());
    EXPECT_GT(expect_no_command_too_many(graph.description(), {}, *plan), 0u);
    for (const Heap& heap : plan->heaps) EXPECT_EQ(heap.size, heap.lower_bound);
  }
}

}  // namespace
}  // namespace alcove::framegraph
