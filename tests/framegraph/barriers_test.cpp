// Compares the number of barrier commands with an exhaustive search over their positions.
#include <gtest/gtest.h>

#include <string>

#include "barrier_search.h"
#include "deferred_frame.h"
#include "fake_handle.h"
#include "random_graph.h"
#include "small_frames.h"

namespace alcove::framegraph {
namespace {

// The graphs of this test have no transient buffers. A transient buffer's dependency on the
// previous frame could sometimes be met by a barrier of that frame, but the compiler always adds a
// barrier in the current frame.
TEST(Barriers, CompiledPlanHasTheFewestBarrierCommandsOfAllValidPlans) {
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
    const auto plan = compile(graph.description());
    ASSERT_TRUE(plan) << to_string(plan.error());
    SCOPED_TRACE("seed " + std::to_string(seed));
    tried += expect_no_command_too_many(graph.description(), {}, *plan);
  }
  EXPECT_GT(tried, 1000u);
}

// Each face of a cube, and each mip of a face, is written by a different pass. One barrier must be
// enough for the pass that reads the cube.
TEST(Barriers, LayersAndMipsWrittenByDifferentPassesShareOneBarrierBeforeTheirReader) {
  for (const std::uint32_t mips : {1u, 3u}) {
    Graph graph;
    Texture cube =
        graph.create_texture("cube", {VK_FORMAT_R8_UNORM, Extent::absolute(8, 8), mips, 6});
    for (std::uint32_t mip = 0; mip < mips; ++mip) {
      for (std::uint32_t face = 0; face < 6; ++face) {
        const Range range{static_cast<std::uint16_t>(mip), 1, static_cast<std::uint16_t>(face), 1};
        cube = graph.add_pass("face").write(cube, access::color_attachment, range);
      }
    }
    add_read(graph, cube, access::sampled_fragment);
    // This pass reads the cube in a later stage. It must not get a second barrier: the barrier
    // before the first reader is extended to this stage.
    add_read(graph, cube, access::sampled_compute);
    const Plan plan = compile_verified(graph);
    const PlannedPass& first = plan.passes[std::size_t{6} * mips];
    ASSERT_NE(first.batch, kNone);
    EXPECT_EQ(plan.batches[first.batch].count, 1u);
    EXPECT_EQ(plan.passes.back().batch, kNone);
  }
}

// Each mip is computed from the one before it. Only the last mip still needs a layout change before
// the reader. A memory barrier makes the other mips visible.
TEST(Barriers, ReaderOfAMipChainWrittenByOnePassPerMipNeedsAtMostTwoBarriers) {
  Graph graph;
  Texture chain = graph.create_texture("chain", {VK_FORMAT_R8_UNORM, Extent::absolute(64, 64), 5});
  chain = graph.add_pass("mip 0").write(chain, access::storage_write_compute, Range::mip(0),
                                        Contents::discard);
  for (std::uint32_t mip = 1; mip < 5; ++mip) {
    PassBuilder down = graph.add_pass("down");
    down.read(chain, access::sampled_compute, Range::mip(mip - 1));
    chain = down.write(chain, access::storage_write_compute, Range::mip(mip), Contents::discard);
  }
  add_read(graph, chain, access::sampled_fragment);
  const Plan plan = compile_verified(graph);
  ASSERT_NE(plan.passes[5].batch, kNone);
  EXPECT_LE(plan.batches[plan.passes[5].batch].count, 2u);
}

TEST(Barriers, ReadAfterReadNeedsNoBarrier) {
  Graph graph;
  const Texture texture = add_write(graph, graph.create_texture("t", kSmall));
  for (int i = 0; i < 5; ++i)
    add_read(graph, texture, i % 2 ? access::sampled_fragment : access::sampled_compute);
  const Plan plan = compile_verified(graph);
  // One transition is for the first use, and one for all readers in both stages.
  ASSERT_EQ(plan.transitions.size(), 2u);
  EXPECT_EQ(plan.transitions[1].dst_stages,
            VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT);
}

// A write has been made visible to access A of stage 1 and to access B of stage 2. Stage 1 then
// reads with access B, for which the write is not visible yet.
TEST(Barriers, WriteVisibleToOneAccessTypeNeedsABarrierBeforeAnotherAccessTypeOfTheSameStage) {
  Graph graph;
  Buffer data = graph.create_buffer("data", {64});
  Buffer other = graph.create_buffer("other", {64});
  data =
      graph.add_pass("writer").write(data, buffer_access::storage_write_compute, Contents::discard);
  add_read(graph, data, buffer_access::uniform(VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT));
  // The barrier before this pass comes between the write and the second reader. The second reader's
  // dependency is added to it.
  other = graph.add_pass("fill").write(other, buffer_access::fill, Contents::discard);
  PassBuilder mixed = graph.add_pass("mixed");
  mixed.read(other, buffer_access::storage_read_compute);
  mixed.read(data, buffer_access::storage_read_compute);
  mixed.side_effect();
  add_read(graph, data, buffer_access::uniform(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT));
  add_read(graph, data, buffer_access::storage_read_fragment);
  (void)compile_verified(graph);
}

State state_of(const Access& access) { return {access.stages, access.access, access.layout}; }

class InitialStates : public testing::Test {
 protected:
  Texture import(const State& initial_state, const State& final_state = {}) {
    return graph_.import_texture("import", {.image = fake_handle<VkImage>(),
                                            .desc = kSmall,
                                            .usage = ~VkImageUsageFlags{0},
                                            .initial_state = initial_state,
                                            .final_state = final_state});
  }
  Graph graph_;
};

TEST_F(InitialStates, ImportVisibleToOneStageGetsABarrierOnlyIfAnotherStageReadsIt) {
  for (const Access& initial_state : {access::sampled_compute, access::sampled_fragment}) {
    graph_.reset();
    add_read(graph_, import(state_of(initial_state)), access::sampled_fragment);
    const Plan plan = compile_verified(graph_);
    const bool same = initial_state.stages == access::sampled_fragment.stages;
    ASSERT_EQ(plan.transitions.size(), same ? 0u : 1u);
    if (same) continue;
    EXPECT_EQ(plan.transitions[0].src_stages, initial_state.stages);
    EXPECT_EQ(plan.transitions[0].dst_access, access::sampled_fragment.access);
  }
}

// The final state of one frame is the initial state of the next.
TEST_F(InitialStates, ImportLeftInTheStateThatTheNextFrameNeedsGetsNoFurtherBarrier) {
  const State between = state_of(access::sampled_fragment);
  add_write(graph_, import({}, between), access::color_attachment);
  EXPECT_EQ(compile_verified(graph_).transitions.size(), 2u);
  graph_.reset();
  add_read(graph_, import(between), access::sampled_fragment);
  EXPECT_EQ(compile_verified(graph_).transitions.size(), 0u);
}

TEST_F(InitialStates, ImportThatNoPassUsesGetsABarrierFromItsInitialToItsFinalState) {
  const State written{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                      VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
                      VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  import(written, state_of(access::sampled_fragment));
  const Plan plan = compile_verified(graph_);
  ASSERT_EQ(plan.transitions.size(), 1u);
  EXPECT_EQ(plan.transitions[0].src_access, written.access);
  EXPECT_EQ(plan.transitions[0].dst_stages, access::sampled_fragment.stages);
}

TEST_F(InitialStates,
       HistoryVisibleToComputeGetsABarrierBeforeAFragmentShaderReadsItInTheNextFrame) {
  const auto declare = [&](const Access& own, const Access& old) {
    graph_.reset();
    const TextureHistory history = graph_.create_texture_history("history", kSmall);
    add_read(graph_, history.previous(), old);
    add_read(graph_, add_write(graph_, history.current), own);
  };
  declare(access::sampled_compute, access::sampled_fragment);
  graph_.leave_histories(compile_verified(graph_).finals);
  declare(access::sampled_compute, access::sampled_fragment);
  const Plan plan = compile_verified(graph_);
  const PlannedPass& first = plan.passes[0];
  ASSERT_NE(first.batch, kNone) << "the last write was visible to compute shaders only";
  const Transition& seen = plan.transitions[plan.batches[first.batch].first];
  EXPECT_EQ(seen.src_stages, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
  EXPECT_EQ(seen.dst_stages, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT);
}

TEST_F(InitialStates, HistoryWithOnlyOneMipWrittenIsReportedAsPartlyWrittenInTheNextFrame) {
  const auto declare = [&](Range range) {
    graph_.reset();
    const TextureHistory history =
        graph_.create_texture_history("history", {VK_FORMAT_R8_UNORM, Extent::absolute(8, 8), 2});
    PassBuilder writer = graph_.add_pass("writer");
    (void)writer.write(history.current, access::storage_write_compute, range, Contents::discard);
    writer.side_effect();
    return history.validity;
  };
  declare(Range::mip(0));
  graph_.leave_histories(compile_verified(graph_).finals);
  EXPECT_EQ(declare({}), HistoryValidity::written_in_part);
  graph_.leave_histories(compile_verified(graph_).finals);
  EXPECT_EQ(declare({}), HistoryValidity::valid);
}

TEST(Barriers, AllMipsAndLayersWrittenByOnePassShareOneBarrierBeforeTheirReader) {
  Graph graph;
  const TextureDesc desc{VK_FORMAT_R8_UNORM, Extent::absolute(64, 64), 5, 3};
  add_read(graph, add_write(graph, graph.create_texture("t", desc)), access::sampled_compute);
  EXPECT_EQ(compile_verified(graph).transitions.size(), 2u);
}

TEST(Barriers, PlanOfADeferredRenderingFrameHasTheFewestPossibleBarrierCommands) {
  Graph graph;
  Limits limits;
  const auto plan = compile_deferred_frame(graph, limits);
  ASSERT_TRUE(plan) << to_string(plan.error());
  EXPECT_GT(expect_no_command_too_many(graph.description(), limits, *plan), 0u);
}

// The earlier write is available by the barrier before the read. It must become visible to the
// write, because the reads may have been of another part.
TEST(Barriers, WriteAfterReadsNeedsNothingMadeAvailable) {
  Graph graph;
  const Texture texture = add_write(graph, graph.create_texture("t", kSmall));
  add_read(graph, texture, access::storage_read_compute);
  graph.output(graph.add_pass("updater").write(texture, access::storage_read_write_compute));
  const Plan plan = compile_verified(graph);
  ASSERT_EQ(plan.transitions.size(), 3u);
  EXPECT_EQ(plan.transitions[2].src_access, VK_ACCESS_2_NONE);
  EXPECT_EQ(plan.transitions[2].dst_access, access::storage_read_write_compute.access);
}

// A final state that writes follows a read of the frame; and the reads of an import that no pass
// uses are ordered before a final state of fewer stages.
TEST_F(InitialStates, FinalStateThatWritesOrHasFewerStagesIsVerified) {
  const State read = state_of(access::sampled_fragment);
  State written = read;
  written.access |= VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
  add_read(graph_, import(read, written), access::sampled_fragment);
  (void)compile_verified(graph_);
  graph_.reset();
  import({VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT, read.layout}, read);
  (void)compile_verified(graph_);
}

// 2,048 layers with 12 mips each, which all change their layouts.
TEST(Barriers, ManySubresourcesWithDifferentStatesShareFewBarriers) {
  Graph graph;
  Texture texture =
      graph.create_texture("t", {VK_FORMAT_R8_UNORM, Extent::absolute(2048, 2048), 12, 2048});
  texture = add_write(graph, texture);
  texture = graph.add_pass("odd").write(texture, access::clear, Range::mip(1));
  add_read(graph, texture, access::sampled_compute);
  const auto plan = compile(graph.description());
  ASSERT_TRUE(plan) << to_string(plan.error());
  EXPECT_LE(plan->transitions.size(), 2u + 3u * 2048u);
}

}  // namespace
}  // namespace alcove::framegraph
