// Tests that the verifier refuses mutants of valid plans. A mutant that it accepts must be harmless
// according to the path oracle (path_oracle.h), which searches for each ordering separately.
#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <iostream>
#include <map>
#include <string>

#include "alcove/framegraph/compile.h"
#include "alcove/framegraph/verify.h"
#include "fake_handle.h"
#include "mutate.h"
#include "path_oracle.h"
#include "random_graph.h"

namespace alcove::framegraph {
namespace {

struct Count {
  std::uint32_t killed = 0;
  std::uint32_t killed_by_both = 0;  // refused by the oracle too
  std::uint32_t harmless = 0;
};
using Counts = std::map<std::string, Count>;

void print(const Counts& counts) {
  for (const auto& [kind, count] : counts)
    std::cerr << kind << ": " << count.killed << " killed (" << count.killed_by_both
              << " by the oracle too), " << count.harmless << " harmless\n";
}

std::uint32_t killed(const Counts& counts) {
  std::uint32_t sum = 0;
  for (const auto& [kind, count] : counts) sum += count.killed;
  return sum;
}

// Tests the mutants of the plans of `graphs` random graphs. Each mutant that the verifier accepts
// must be harmless according to the oracle.
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
    const auto plan = compile(graph, limits);
    EXPECT_TRUE(plan) << to_string(plan.error());
    EXPECT_TRUE(verify(description, limits, *plan));
    EXPECT_EQ(find_unordered_pair(description, *plan), "");
    for_each_mutant(description, *plan, [&](const std::string& kind, const Plan& mutant) {
      if (!verify(description, limits, mutant)) {
        ++counts[kind].killed;
        // The oracle checks orderings only, which are what these kinds of mutants change.
        if (!kind.starts_with("narrow") && !kind.starts_with("drop")) return;
        if (!find_unordered_pair(description, mutant).empty()) ++counts[kind].killed_by_both;
        return;
      }
      ++counts[kind].harmless;
      EXPECT_EQ(find_unordered_pair(description, mutant), "") << kind;
    });
  }
  print(counts);
  return counts;
}

// Fails the test if the verifier accepted a mutant of another kind than those in `kinds` and those
// that narrow a barrier. Mutants of these kinds may be accepted, because something else in the plan
// may meet the same dependency.
void expect_harmless_only(const Counts& counts, std::initializer_list<const char*> kinds) {
  for (const auto& [kind, count] : counts) {
    const bool may =
        kind.starts_with("narrow") || std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
    EXPECT_TRUE(may || count.harmless == 0) << kind;
  }
}

// Checks that the oracle can find faults at all: it must refuse most of the mutants that the
// verifier refuses because of an ordering. Exceptions are mutants in which a whole transition was
// removed, because the oracle does not check layouts and owners.
void expect_agreement(const Counts& counts) {
  for (const auto& [kind, count] : counts) {
    if (!kind.starts_with("narrow")) continue;
    EXPECT_GT(count.killed_by_both, count.killed * 9 / 10) << kind;
  }
}

TEST(Mutation, VerifierRefusesEveryHarmfulMutationOfAValidPlan) {
  const Counts counts = mutate_graphs(400, {}, {});
  expect_harmless_only(counts, {"drop a barrier"});
  EXPECT_GE(killed(counts), 10'000u);
  expect_agreement(counts);
}

// Tests the mutants of graphs that use several queues, and returns their numbers.
Counts mutate_graphs_of_several_queues(const Limits& limits) {
  RandomOptions options;
  options.queues = true;
  const Counts counts = mutate_graphs(200, options, limits);
  // These mutants may be harmless, because a dependency may be met twice, for example by a barrier
  // and by way of a third queue.
  expect_harmless_only(counts, {"drop a barrier", "drop a batch", "drop a semaphore",
                                "drop a wait for the frame before"});
  EXPECT_GT(counts.at("drop a wait for the frame before").killed, 50u);
  EXPECT_GT(counts.at("drop a semaphore").killed, 100u);
  expect_agreement(counts);
  return counts;
}

TEST(Mutation, VerifierRefusesHarmfulMutationsOfPlansWithQueueOwnershipTransfers) {
  Limits limits;
  limits.queue_families[1] = 1;
  limits.queue_families[2] = 2;
  const Counts counts = mutate_graphs_of_several_queues(limits);
  EXPECT_GT(counts.at("skip an ownership transfer").killed, 100u);
}

TEST(Mutation, VerifierRefusesHarmfulMutationsOfPlansOverQueuesOfOneFamily) {
  Limits limits;
  limits.queue_families[1] = limits.queue_families[2] = 0;
  mutate_graphs_of_several_queues(limits);
}

// No pass of this frame names a read access. The only one is that of the final state, which stands
// for all.
TEST(Mutation, VerifierRefusesAWriteThatNoBarrierMakesVisibleToAFinalStateOfAllReads) {
  Graph graph;
  ImportedBuffer import;
  import.buffer = fake_handle<VkBuffer>(1);
  import.desc.size = 16;
  import.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  import.has_contents = false;
  import.final_state = {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT,
                        VK_IMAGE_LAYOUT_UNDEFINED};
  const Buffer buffer = graph.import_buffer("buffer", import);
  (void)graph.add_pass("write").write(buffer, buffer_access::storage_write_compute);
  auto plan = compile(graph);
  ASSERT_TRUE(plan) << to_string(plan.error());
  EXPECT_TRUE(verify(graph.description(), {}, *plan));
  ASSERT_EQ(plan->transitions.size(), 1u);
  plan->transitions[0].dst_access = 0;
  EXPECT_FALSE(verify(graph.description(), {}, *plan));
}

}  // namespace
}  // namespace alcove::framegraph
