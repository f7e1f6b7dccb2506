// Tests the plan of Alcove's own frame: its memory peak equals the lower bound, and it has no
// superfluous barrier command.
#include <gtest/gtest.h>

#include "alcove/passes/occlusion.h"
#include "barrier_search.h"
#include "gpu.h"

namespace alcove::framegraph {
namespace {

// Declares the frame of an engine that provides depth and reads visibility and bent normals.
void declare(Graph& graph, passes::Kernels& kernels, VkImage image, passes::Quality quality) {
  ImportedTexture engine_depth;
  engine_depth.image = image;
  engine_depth.desc = {VK_FORMAT_R32_SFLOAT, Extent::absolute(960, 540)};
  engine_depth.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  engine_depth.initial_state = {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                                VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  const passes::Frame frame{graph, kernels, {}};
  passes::OcclusionSettings settings = passes::quality_settings(quality, 0.5f);
  settings.bent_normal = true;
  const auto outputs = passes::add_occlusion(
      frame, {.depth_ndc = graph.import_texture("depth", engine_depth)}, settings);
  ASSERT_TRUE(outputs) << outputs.error().message;
  PassBuilder light = graph.add_pass("lighting");
  light.read(outputs->visibility, access::sampled_fragment);
  light.read(outputs->bent_normal, access::sampled_fragment);
  light.side_effect();
  light.record([](RecordContext&) {});
}

TEST(OcclusionFrame, PlanHasTheFewestBarrierCommandsAndTheLeastPeakMemory) {
  Gpu gpu;
  ASSERT_EQ(gpu.problem(), "");
  auto kernels = passes::Kernels::create(gpu.handles(), 1);
  ASSERT_TRUE(kernels) << kernels.error().message;
  const VkImage image = gpu.make_image({VK_FORMAT_R32_SFLOAT, Extent::absolute(960, 540)},
                                       VK_IMAGE_USAGE_SAMPLED_BIT);
  for (const auto quality : {passes::Quality::medium, passes::Quality::high}) {
    Graph graph;
    declare(graph, *kernels, image, quality);
    const auto plan = compile(graph.description());
    ASSERT_TRUE(plan) << to_string(plan.error());
    expect_no_command_too_many("own frame", graph.description(), {}, *plan);
    for (const Heap& heap : plan->heaps) EXPECT_EQ(heap.size, heap.lower_bound);
  }
}

}  // namespace
}  // namespace alcove::framegraph
