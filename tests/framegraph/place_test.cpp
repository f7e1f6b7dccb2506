// Compares placement with the lower bound, the most bytes that are live at the same time.
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "deferred_frame.h"
#include "fake_handle.h"
#include "random_graph.h"
#include "small_frames.h"

namespace alcove::framegraph {
namespace {

constexpr double kMebibyte = 1 << 20;

TEST(MemoryPlacement, PeakMemoryOfADeferredRenderingFrameEqualsItsLowerBound) {
  Graph graph;
  Limits limits;
  const auto plan = compile_deferred_frame(graph, limits);
  ASSERT_TRUE(plan) << to_string(plan.error());
  EXPECT_EQ(std::count_if(plan->placements.begin(), plan->placements.end(),
                          [](const Placement& p) { return p.heap != kNone; }),
            24);
  ASSERT_EQ(plan->heaps.size(), 1u);
  const Heap& heap = plan->heaps[0];
  EXPECT_EQ(heap.size, heap.lower_bound);
  EXPECT_EQ(heap.lower_bound, VkDeviceSize{80} << 20);
  EXPECT_NEAR(static_cast<double>(heap.unaliased) / kMebibyte, 112.4, 0.05);
  EXPECT_TRUE(verify(graph.description(), limits, *plan));
  std::cerr << "deferred frame: " << static_cast<double>(heap.size) / kMebibyte
            << " MiB, lower bound " << static_cast<double>(heap.lower_bound) / kMebibyte
            << ", without aliasing " << static_cast<double>(heap.unaliased) / kMebibyte << ", "
            << plan->batches.size() << " barrier commands, " << plan->transitions.size()
            << " barriers\n";
}

// Compares the memory peak with the lower bound for 1,000 random graphs of each size.
TEST(MemoryPlacement, PeakMemoryOfFramesWithTexturesOfManySizesIsCloseToTheLowerBound) {
  for (const std::uint32_t fewest : {20u, 40u, 100u}) {
    std::vector<double> ratios;
    Graph graph;
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
      graph.reset();
      Dice dice(seed);
      declare_sizes(graph, dice, fewest + dice.roll(fewest + 1));
      const auto plan = compile(graph.description());
      ASSERT_TRUE(plan) << to_string(plan.error());
      ratios.push_back(static_cast<double>(plan->heaps[0].size) /
                       static_cast<double>(plan->heaps[0].lower_bound));
    }
    std::sort(ratios.begin(), ratios.end());
    std::cerr << "peak over lower bound, " << fewest << " to " << 2 * fewest << " passes: median "
              << ratios[500] << ", 99th percentile " << ratios[990] << ", worst " << ratios[999]
              << "\n";
    EXPECT_LE(ratios[500], 1.03);
    EXPECT_LE(ratios[990], 1.23);
  }
}

TEST(MemoryPlacement, TransientsShareNoBytesIfAliasingIsOff) {
  Graph graph;
  declare_deferred_frame(graph, 640, 360);
  Limits limits;
  limits.alias = false;
  const Plan plan = compile_verified(graph, limits);
  EXPECT_EQ(plan.heaps[0].size, plan.heaps[0].unaliased);
}

TEST(MemoryPlacement, TransientsOfDifferentMemoryTypesGetSeparateHeaps) {
  Graph graph;
  declare_deferred_frame(graph, 640, 360);
  Limits limits;
  limits.memory.query = [](const void*, const ResourceRecord& record, VkFlags, bool) {
    MemoryRequirements needed = MemoryOracle{}(record, 0, false);
    needed.memory_types = record.format == VK_FORMAT_D32_SFLOAT ? 2u : 5u;
    needed.alignment = 65536;
    return needed;
  };
  EXPECT_EQ(compile_verified(graph, limits).heaps.size(), 2u);
}

// A device that fails to say how much memory a resource needs, or says what cannot be.
TEST(MemoryPlacement, FrameWhoseMemoryRequirementsCannotBeMetIsRefused) {
  constexpr VkDeviceSize kHuge = VkDeviceSize{1} << 63;
  static MemoryRequirements answer;
  const MemoryRequirements cases[] = {{0, 0, 0, VK_ERROR_OUT_OF_HOST_MEMORY},
                                      {0, 256, 1},
                                      {64, 0, 1},
                                      {64, 48, 1},
                                      {64, 256, 0},
                                      {kHuge, 256, 1},
                                      {64, kHuge, 1},
                                      {kHuge / 4, 256, 1}};  // three of them are too many
  for (const MemoryRequirements& needed : cases) {
    answer = needed;
    Graph graph;
    for (int i = 0; i < 3; ++i) {
      PassBuilder pass = graph.add_pass("pass");
      (void)pass.write(graph.create_buffer("b", {64}), buffer_access::fill, Contents::discard);
      pass.side_effect();
    }
    Limits limits;
    const auto right = compile(graph.description(), limits);
    ASSERT_TRUE(right);
    limits.memory.query = [](const void*, const ResourceRecord&, VkFlags, bool) { return answer; };
    const auto plan = compile(graph.description(), limits);
    ASSERT_FALSE(plan) << needed.size;
    EXPECT_EQ(plan.error()[0].code, ErrorCode::vulkan);
    EXPECT_EQ(plan.error()[0].result,
              needed.result != VK_SUCCESS ? needed.result : VK_ERROR_UNKNOWN);
    EXPECT_FALSE(verify(graph.description(), limits, *right));
  }
}

// Devices may report a granularity of 0.
TEST(MemoryPlacement, BuffersAndImagesArePlacedWithoutAGranularity) {
  Graph graph;
  declare_deferred_frame(graph, 640, 360);
  Limits limits;
  limits.buffer_image_granularity = 0;
  (void)compile_verified(graph, limits);
}

TEST(PassOrder, VerifierRefusesPassesWithSideEffectsOutOfTheirDeclaredOrder) {
  Graph graph;
  for (const char* name : {"first", "second"}) graph.add_pass(name).side_effect();
  Plan plan = compile_verified(graph);
  std::swap(plan.passes[0].pass, plan.passes[1].pass);
  EXPECT_FALSE(verify(graph.description(), {}, plan));
}

}  // namespace
}  // namespace alcove::framegraph
