// Tests that the verifier refuses mutants of valid plans.
#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "fake_handle.h"
#include "mutate.h"
#include "random_graph.h"
#include "small_frames.h"

namespace alcove::framegraph {
namespace {

// Numbers of mutants by kind.
struct Count {
  std::uint32_t killed = 0;
  std::uint32_t accepted = 0;
};
using Counts = std::map<std::string, Count>;

std::uint32_t killed(const Counts& counts) {
  std::uint32_t sum = 0;
  for (const auto& [kind, count] : counts) sum += count.killed;
  return sum;
}

// Tests the mutants of the plans of `graphs` random graphs, and prints their numbers.
Counts mutate_graphs(std::uint64_t graphs, const RandomOptions& options, const Limits& limits) {
  Counts counts;
  Graph graph;
  for (std::uint64_t seed = 0; seed < graphs; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    graph.reset();
    graph.reset_histories();
    Dice dice(seed);
    declare_random(graph, dice, options);
    const GraphDescription& description = graph.description();
    const Plan plan = compile_verified(graph, limits);
    for_each_mutant(description, plan, [&](const std::string& kind, const Plan& mutant) {
      ++(verify(description, limits, mutant) ? counts[kind].accepted : counts[kind].killed);
    });
  }
  for (const auto& [kind, count] : counts)
    std::cerr << kind << ": " << count.killed << " refused, " << count.accepted << " accepted\n";
  return counts;
}

// Fails the test if the verifier accepted a mutant of another kind than those in `kinds` and those
// that narrow a barrier. Mutants of these kinds may be accepted, because something else in the plan
// may meet the same dependency.
void expect_harmless_only(const Counts& counts, std::initializer_list<const char*> kinds) {
  for (const auto& [kind, count] : counts) {
    const bool may =
        kind.starts_with("narrow") || std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
    EXPECT_TRUE(may || count.accepted == 0) << kind;
    // Most mutants of every kind are harmful.
    EXPECT_GT(count.killed, count.accepted) << kind;
  }
}

TEST(Mutation, VerifierRefusesEveryHarmfulMutationOfAValidPlan) {
  const Counts counts = mutate_graphs(400, {}, {});
  // The plan stores what a pass writes to an import, even if a later pass discards it.
  expect_harmless_only(counts, {"drop a barrier", "leave out a store"});
  EXPECT_GE(killed(counts), 10'000u);
}

TEST(Mutation, VerifierRefusesHarmfulMutationsOfPlansOverSeveralQueues) {
  RandomOptions options;
  options.queues = true;
  for (const std::uint32_t family : {0u, 1u}) {
    Limits limits;
    limits.queue_families[1] = family;
    limits.queue_families[2] = 2 * family;
    const Counts counts = mutate_graphs(200, options, limits);
    // These mutants may be harmless, because a dependency may be met twice, for example by a
    // barrier and by way of a third queue.
    expect_harmless_only(counts, {"drop a barrier", "drop a batch", "drop a semaphore",
                                  "drop a wait for the frame before", "leave out a store"});
    EXPECT_GT(counts.at("drop a wait for the frame before").killed, 50u);
    EXPECT_GT(counts.at("drop a semaphore").killed, 100u);
  }
}

// Each of 1,000 passes reads some of the most recent textures. framegraph_benchmark prints how long
// the verifier takes for a plan of this size.
TEST(Mutation, VerifierAcceptsAPlanOfAThousandPassesAndRefusesItIfOnePassLacksItsBarriers) {
  Graph graph;
  std::vector<Texture> textures;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const Texture texture =
        graph.create_texture("texture", {VK_FORMAT_R8_UNORM, Extent::absolute(64, 64)});
    PassBuilder pass = graph.add_pass("pass");
    if (i > 0) pass.read(textures[i - 1], access::sampled_compute);
    if (i > 20) pass.read(textures[i - 2 - i % 20], access::sampled_compute);
    textures.push_back(pass.write(texture, access::storage_write_compute, {}, Contents::discard));
    pass.side_effect();
  }
  Plan plan = compile_verified(graph);
  plan.batches[plan.passes[900].batch].count = 0;
  EXPECT_FALSE(verify(graph.description(), {}, plan));
}

// No pass of this frame names a read access. The only one is that of the final state, which stands
// for all.
TEST(Mutation, VerifierRefusesAWriteThatNoBarrierMakesVisibleToAFinalStateOfAllReads) {
  Graph graph;
  const Buffer buffer = graph.import_buffer(
      "buffer",
      {.buffer = fake_handle<VkBuffer>(1),
       .desc = {16},
       .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
       .has_contents = false,
       .final_state = {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT}});
  (void)graph.add_pass("write").write(buffer, buffer_access::storage_write_compute,
                                      Contents::discard);
  Plan plan = compile_verified(graph);
  ASSERT_EQ(plan.transitions.size(), 1u);
  plan.transitions[0].dst_access = 0;
  EXPECT_FALSE(verify(graph.description(), {}, plan));
}

}  // namespace
}  // namespace alcove::framegraph
