// Compiles random graphs and verifies their plans. ALCOVE_RANDOM_GRAPHS sets how many graphs a test
// makes, and ALCOVE_TEST_SEED makes other graphs than those of every run; the soak tests use both.
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <optional>
#include <string>

#include "alcove/framegraph/compile.h"
#include "alcove/framegraph/verify.h"
#include "random_graph.h"

namespace alcove::framegraph {
namespace {

constexpr std::uint64_t kGraphsOfASequence = 100;
constexpr std::uint64_t kProgress = 25'000;  // graphs between two lines of progress

std::uint64_t environment_number(const char* name, std::uint64_t otherwise) {
  const char* const text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

// Compiles and verifies sequences of frames of one graph, whose histories continue from frame to
// frame of a sequence.
void expect_verified(const RandomOptions& options, const Limits& limits) {
  const std::uint64_t count = environment_number("ALCOVE_RANDOM_GRAPHS", 10'000);
  const std::uint64_t seed = environment_number("ALCOVE_TEST_SEED", 1);
  std::optional<Graph> graph;
  for (std::uint64_t i = 0; i < count; ++i) {
    SCOPED_TRACE("graph " + std::to_string(i) + " of seed " + std::to_string(seed));
    if (i % kGraphsOfASequence == 0) graph.emplace();
    graph->reset();
    Dice dice((seed << 32) + i);
    declare_random(*graph, dice, options);
    const auto plan = compile(*graph, limits);
    ASSERT_TRUE(plan) << to_string(plan.error());
    const auto verified = verify(graph->description(), limits, *plan);
    ASSERT_TRUE(verified) << to_string(verified.error());
    graph->leave_histories(plan->finals);
    if ((i + 1) % kProgress == 0) std::cout << i + 1 << " graphs verified" << std::endl;
  }
}

// The families of the three queue classes; kNone: the device has no such queue.
struct Families {
  std::uint32_t graphics = 0;
  std::uint32_t compute = kNone;
  std::uint32_t transfer = kNone;
};

Limits with_families(const Families& families) {
  Limits limits;
  limits.queue_families[0] = families.graphics;
  limits.queue_families[1] = families.compute;
  limits.queue_families[2] = families.transfer;
  return limits;
}

TEST(Fuzz, PlanOfAnyRandomValidGraphPassesTheVerifier) { expect_verified({}, {}); }

TEST(Fuzz, PlanOfAnyRandomGraphOnThreeQueuesPassesTheVerifierOnDevicesWithEachKindOfQueues) {
  for (const Families& families : {Families{0, 1, 2}, {0, 0, 0}, {0, kNone, kNone}})
    expect_verified({.queues = true}, with_families(families));
}

// The options of these graphs give imports any initial and final states.
TEST(Fuzz, PlanOfAnyRandomGraphWithAnyImportedStatesPassesTheVerifier) {
  expect_verified({.any_states = true}, {});
  for (const Families& families : {Families{0, 0, kNone}, {0, 1, 2}})
    expect_verified({.queues = true, .any_states = true}, with_families(families));
}

TEST(Fuzz, PlanOfAnyRandomGraphPassesTheVerifierIfBufferImageGranularityIsCoarse) {
  Limits limits;
  limits.buffer_image_granularity = 4096;
  expect_verified({}, limits);
}

}  // namespace
}  // namespace alcove::framegraph
