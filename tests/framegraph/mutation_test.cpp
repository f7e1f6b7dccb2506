// Spoilt plans: the verifier must refuse them. A mutant that it lets pass must be harmless, by the
// word of the path oracle, which searches for each ordering anew.
#include <gtest/gtest.h>

#include <iostream>
#include <map>
#include <string>

#include "alcove/framegraph/compile.h"
#include "alcove/framegraph/verify.h"
#include "mutate.h"
#include "path_oracle.h"
#include "random_graph.h"

namespace alcove::framegraph {
namespace {

struct Count {
  std::uint32_t killed = 0;
  std::uint32_t harmless = 0;
};
using Counts = std::map<std::string, Count>;

void print(const Counts& counts) {
  for (const auto& [kind, count] : counts)
    std::cerr << kind << ": " << count.killed << " killed, " << count.harmless << " harmless\n";
}

std::uint32_t killed(const Counts& counts) {
  std::uint32_t sum = 0;
  for (const auto& [kind, count] : counts) sum += count.killed;
  return sum;
}

TEST(Mutation, TheVerifierKillsEveryMutantThatDoesHarm) {
  Counts counts;
  Graph graph;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    graph.reset();
    graph.reset_histories();
    Dice dice(seed);
    declare_random(graph, dice);
    const GraphDescription& description = graph.description();
    const auto plan = compile(graph);
    ASSERT_TRUE(plan) << to_string(plan.error());
    ASSERT_TRUE(verify(description, {}, *plan));
    ASSERT_EQ(find_unordered_pair(description, *plan), "");
    for_each_mutant(description, *plan, [&](const std::string& kind, const Plan& mutant) {
      if (!verify(description, {}, mutant)) {
        ++counts[kind].killed;
        return;
      }
      ++counts[kind].harmless;
      // Only what another barrier does as well may go.
      EXPECT_TRUE(kind.starts_with("narrow") || kind == "drop a barrier") << kind;
      EXPECT_EQ(find_unordered_pair(description, mutant), "") << kind;
    });
  }
  print(counts);
  EXPECT_GE(killed(counts), 10'000u);
}

TEST(Mutation, QueueHandoversCannotBeSpoiled) {
  Counts counts;
  Graph graph;
  Limits limits;
  limits.queue_families[1] = 1;
  limits.queue_families[2] = 2;
  RandomOptions options;
  options.queues = true;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    graph.reset();
    graph.reset_histories();
    Dice dice(seed);
    declare_random(graph, dice, options);
    const auto plan = compile(graph, limits);
    ASSERT_TRUE(plan) << to_string(plan.error());
    for_each_mutant(graph.description(), *plan, [&](const std::string& kind, const Plan& mutant) {
      const bool passes = verify(graph.description(), limits, mutant).has_value();
      ++(passes ? counts[kind].harmless : counts[kind].killed);
    });
  }
  print(counts);
  for (const auto& [kind, count] : counts) {
    // A dependency may be met twice, by a barrier or by way of a third queue.
    if (kind.starts_with("narrow") || kind == "drop a barrier" || kind == "drop a semaphore")
      EXPECT_LT(count.harmless, (count.killed + count.harmless) / 10) << kind;
    else
      EXPECT_EQ(count.harmless, 0u) << kind;
  }
  EXPECT_GT(counts["skip an ownership transfer"].killed, 100u);
  EXPECT_GT(counts["drop a semaphore"].killed, 100u);
}

//        +-> b -> left  --+
//   a ---+                +--> end         b and c live together,
//        +-> c -> right --+                and so do left and right.
struct Diamond {
  Graph graph;
  Texture a, b, c, left, right, end;

  Diamond() {
    const TextureDesc desc{VK_FORMAT_R8G8B8A8_UNORM, Extent::absolute(64, 64)};
    a = make("a", desc, {});
    b = make("b", desc, {a});
    c = make("c", desc, {a});
    left = make("left", desc, {b});
    right = make("right", desc, {c});
    end = make("end", desc, {left, right});
    graph.output(end);
  }
  Texture make(const char* name, const TextureDesc& desc, std::initializer_list<Texture> from) {
    Texture texture = graph.create_texture(name, desc);
    PassBuilder pass = graph.add_pass(name);
    for (const Texture& read : from) pass.read(read, access::sampled_compute);
    return pass.write(texture, access::storage_write_compute);
  }
};

TEST(Mutation, InTheSixPassDiamondNothingThatLivesTogetherSharesMemory) {
  Diamond diamond;
  const GraphDescription& description = diamond.graph.description();
  const auto plan = compile(diamond.graph);
  ASSERT_TRUE(plan) << to_string(plan.error());
  EXPECT_TRUE(verify(description, {}, *plan));
  EXPECT_EQ(plan->passes.size(), 6u);
  // Three textures are live at once, and three is what is allocated.
  EXPECT_EQ(plan->heaps[0].size, 3u * 64 * 64 * 4);
  EXPECT_EQ(plan->heaps[0].size, plan->heaps[0].lower_bound);
  for (const auto& [one, other] :
       {std::pair{diamond.b, diamond.c}, std::pair{diamond.left, diamond.right},
        std::pair{diamond.c, diamond.left}}) {
    Plan wrong = *plan;
    wrong.placements[one.index].offset = wrong.placements[other.index].offset;
    EXPECT_FALSE(verify(description, {}, wrong));
    // Nor does it help to tell lies about the lifetimes.
    wrong.placements[one.index].last = wrong.placements[one.index].first;
    EXPECT_FALSE(verify(description, {}, wrong));
  }
}

}  // namespace
}  // namespace alcove::framegraph
