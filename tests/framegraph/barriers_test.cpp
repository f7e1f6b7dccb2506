// The number of barrier commands, against an exhaustive search over where they could be.
#include <gtest/gtest.h>

#include <bit>
#include <iostream>

#include "alcove/framegraph/compile.h"
#include "alcove/framegraph/print.h"
#include "alcove/framegraph/verify.h"
#include "barrier_search.h"
#include "deferred_frame.h"
#include "random_graph.h"

namespace alcove::framegraph {
namespace {

// Without transient buffers: what those must wait for in the frame before could now and then be met
// by a command of that frame, and compile meets it in this one.
TEST(Barriers, NoPlacementOfFewerCommandsIsRight) {
  Graph graph;
  std::uint32_t tried = 0;
  RandomOptions options;
  options.most_passes = 7;
  options.transient_buffers = false;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    graph.reset();
    graph.reset_histories();
    Dice dice(seed);
    declare_random(graph, dice, options);
    const auto plan = compile(graph);
    ASSERT_TRUE(plan) << to_string(plan.error());
    const auto used = static_cast<int>(plan->batches.size());
    for (std::uint32_t mask = 0; mask < 2u << plan->passes.size(); ++mask) {
      if (std::popcount(mask) >= used) continue;
      ++tried;
      EXPECT_FALSE(verify(graph.description(), {}, with_barriers_at(*plan, mask)))
          << "seed " << seed << ": " << used << " commands, but " << std::popcount(mask)
          << " would do, before positions " << mask;
    }
  }
  EXPECT_GT(tried, 1000u);
  std::cerr << tried << " placements of fewer commands refused\n";
}

TEST(Barriers, ReadsAfterReadsCostNothing) {
  Graph graph;
  Texture texture = graph.create_texture("t", {VK_FORMAT_R8_UNORM, Extent::absolute(8, 8)});
  PassBuilder writer = graph.add_pass("writer");
  texture = writer.write(texture, access::storage_write_compute);
  for (int i = 0; i < 5; ++i) {
    PassBuilder reader = graph.add_pass("reader");
    reader.read(texture, i % 2 ? access::sampled_fragment : access::sampled_compute);
    reader.side_effect();
  }
  const auto plan = compile(graph);
  ASSERT_TRUE(plan);
  // One for the first use, one for all the readers, of both stages.
  EXPECT_EQ(plan->transitions.size(), 2u);
  EXPECT_EQ(plan->transitions[1].dst_stages,
            VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT);
}

TEST(Barriers, NeighbouringMipsThatChangeAlikeAreOneBarrier) {
  Graph graph;
  Texture texture = graph.create_texture("t", {VK_FORMAT_R8_UNORM, Extent::absolute(64, 64), 5, 3});
  PassBuilder writer = graph.add_pass("writer");
  texture = writer.write(texture, access::storage_write_compute);
  PassBuilder reader = graph.add_pass("reader");
  reader.read(texture, access::sampled_compute);
  reader.side_effect();
  const auto plan = compile(graph);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->transitions.size(), 2u);
}

TEST(Barriers, TheDeferredFrameCannotDoWithACommandFewer) {
  Graph graph;
  declare_deferred_frame(graph, 1920, 1080);
  Limits limits;
  limits.memory.query = paged_requirements;
  const auto plan = compile(graph, limits);
  ASSERT_TRUE(plan) << to_string(plan.error());
  expect_no_command_too_many("deferred frame", graph.description(), limits, *plan);
}

TEST(Barriers, AWriteAfterReadsThatSawTheLastWriteMakesNothingVisible) {
  Graph graph;
  Texture texture = graph.create_texture("t", {VK_FORMAT_R8_UNORM, Extent::absolute(8, 8)});
  PassBuilder writer = graph.add_pass("writer");
  texture = writer.write(texture, access::storage_write_compute);
  PassBuilder reader = graph.add_pass("reader");
  reader.read(texture, access::storage_read_compute);
  reader.side_effect();
  PassBuilder updater = graph.add_pass("updater");
  texture = updater.write(texture, access::storage_read_write_compute);
  graph.output(texture);
  const auto plan = compile(graph);
  ASSERT_TRUE(plan);
  ASSERT_EQ(plan->transitions.size(), 3u);
  EXPECT_EQ(plan->transitions[2].src_access, VK_ACCESS_2_NONE);
  EXPECT_EQ(plan->transitions[2].dst_access, VK_ACCESS_2_NONE);
}

// With as few commands as this, little is left to split: each waits for the pass before it, as a
// rule.
TEST(Barriers, FewCommandsHaveWorkBetween) {
  Graph graph;
  Limits limits;
  limits.split_barriers = true;
  declare_deferred_frame(graph, 1920, 1080);
  const auto deferred = compile(graph, limits);
  ASSERT_TRUE(deferred);
  std::cerr << "deferred frame: " << deferred->sets.size() << " of " << deferred->batches.size()
            << " barrier commands are split";
  std::size_t split = 0;
  std::size_t all = 0;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    graph.reset();
    graph.reset_histories();
    Dice dice(seed);
    declare_random(graph, dice);
    const auto plan = compile(graph, limits);
    ASSERT_TRUE(plan);
    EXPECT_TRUE(verify(graph.description(), limits, *plan));
    split += plan->sets.size();
    all += plan->batches.size();
  }
  std::cerr << "; of 1,000 random graphs " << split << " of " << all << "\n";
  EXPECT_GT(split, 0u);
}

TEST(Barriers, AnEventLetsThePassesBetweenRunOn) {
  Graph graph;
  const auto make = [&](const char* name, Texture from) {
    Texture to = graph.create_texture(name, {VK_FORMAT_R8_UNORM, Extent::absolute(8, 8)});
    PassBuilder pass = graph.add_pass(name);
    if (from) pass.read(from, access::sampled_compute);
    pass.side_effect();
    return pass.write(to, access::storage_write_compute);
  };
  const Texture first = make("first", {});
  (void)make("between", {});
  (void)make("last", first);
  Limits limits;
  limits.split_barriers = true;
  limits.ordering = Ordering::program;
  limits.alias = false;
  const auto plan = compile(graph, limits);
  ASSERT_TRUE(plan);
  EXPECT_TRUE(verify(graph.description(), limits, *plan));
  ASSERT_EQ(plan->sets.size(), 1u);
  EXPECT_EQ(plan->passes[0].set_count, 1u);
  EXPECT_EQ(plan->batches[plan->passes[2].first_batch].event, 0u);
  EXPECT_NE(print_text(graph.description(), *plan).find("event set after 0: compute -> compute"),
            std::string::npos);
}

}  // namespace
}  // namespace alcove::framegraph
