// Compares placement with the lower bound, the most bytes that are live at the same time.
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "alcove/framegraph/compile.h"
#include "alcove/framegraph/verify.h"
#include "deferred_frame.h"
#include "fake_handle.h"
#include "random_graph.h"

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

// Declares a random number of passes between `fewest` and 2 * `fewest`. Each reads up to three
// textures and writes two new ones of random size.
void declare_sizes(Graph& graph, Dice& dice, std::uint32_t fewest = 20) {
  std::vector<Texture> textures;
  const std::uint32_t passes = fewest + dice.roll(fewest + 1);
  for (std::uint32_t i = 0; i < passes; ++i) {
    PassBuilder pass = graph.add_pass("pass");
    std::vector<std::uint32_t> used;
    for (std::uint32_t reads = dice.roll(4); reads > 0 && !textures.empty(); --reads) {
      const auto window = std::min<std::uint32_t>(static_cast<std::uint32_t>(textures.size()),
                                                  dice.chance(128) ? 4 : 16);
      const Texture& texture = textures[textures.size() - 1 - dice.roll(window)];
      if (std::find(used.begin(), used.end(), texture.index) != used.end()) continue;
      used.push_back(texture.index);
      pass.read(texture, access::sampled_compute);
    }
    for (std::uint32_t writes = 1 + dice.roll(2); writes > 0; --writes) {
      const Texture texture = graph.create_texture(
          "texture",
          {VK_FORMAT_R8_UNORM, Extent::absolute(1 + dice.roll(2048), 1 + dice.roll(1080))});
      textures.push_back(pass.write(texture, access::storage_write_compute));
    }
    // Each pass also writes its own import. No pass is therefore culled, and the imports do not
    // order the passes.
    const Buffer kept = graph.import_buffer("kept", {.buffer = fake_handle<VkBuffer>(i),
                                                     .desc = {4},
                                                     .usage = ~VkBufferUsageFlags{0},
                                                     .has_contents = false,
                                                     .final_state = buffer_access::host_read});
    (void)pass.write(kept, buffer_access::storage_write_compute, Contents::discard);
  }
}

// Computes the ratio of memory peak to lower bound for 1,000 random graphs. Checks that the median
// of the ratios is at most `median` and that their 99th percentile is at most `percentile`.
void expect_close_to_bound(std::uint32_t fewest_passes, double median, double percentile) {
  std::vector<double> ratios;
  Graph graph;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    graph.reset();
    Dice dice(seed);
    declare_sizes(graph, dice, fewest_passes);
    const auto plan = compile(graph.description());
    ASSERT_TRUE(plan) << to_string(plan.error());
    ratios.push_back(static_cast<double>(plan->heaps[0].size) /
                     static_cast<double>(plan->heaps[0].lower_bound));
  }
  std::sort(ratios.begin(), ratios.end());
  std::cerr << "peak over lower bound, " << fewest_passes << " to " << 2 * fewest_passes
            << " passes: median " << ratios[500] << ", 99th percentile " << ratios[990]
            << ", worst " << ratios[999] << "\n";
  EXPECT_LE(ratios[500], median);
  EXPECT_LE(ratios[990], percentile);
}

TEST(MemoryPlacement, PeakMemoryOfFramesOf20To40PassesIsCloseToTheLowerBound) {
  expect_close_to_bound(20, 1.02, 1.23);
}
TEST(MemoryPlacement, PeakMemoryOfFramesOf40To80PassesIsCloseToTheLowerBound) {
  expect_close_to_bound(40, 1.03, 1.23);
}
TEST(MemoryPlacement, PeakMemoryOfFramesOf100To200PassesIsCloseToTheLowerBound) {
  expect_close_to_bound(100, 1.03, 1.23);
}
TEST(MemoryPlacement, TransientsShareNoBytesIfAliasingIsOff) {
  Graph graph;
  declare_deferred_frame(graph, 640, 360);
  Limits limits;
  limits.alias = false;
  const auto plan = compile(graph.description(), limits);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->heaps[0].size, plan->heaps[0].unaliased);
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
  const auto plan = compile(graph.description(), limits);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->heaps.size(), 2u);
  EXPECT_TRUE(verify(graph.description(), limits, *plan));
}

TEST(PassOrder, VerifierRefusesPassesWithSideEffectsOutOfTheirDeclaredOrder) {
  Graph graph;
  for (const char* name : {"first", "second"}) graph.add_pass(name).side_effect();
  auto plan = compile(graph.description());
  ASSERT_TRUE(plan);
  EXPECT_TRUE(verify(graph.description(), {}, *plan));
  std::swap(plan->passes[0].pass, plan->passes[1].pass);
  EXPECT_FALSE(verify(graph.description(), {}, *plan));
}

}  // namespace
}  // namespace alcove::framegraph
