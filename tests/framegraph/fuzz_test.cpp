// Random graphs through compile and verify. rapidcheck prints the seed of the run, and the seed of
// a graph that fails; RC_PARAMS="seed=..." replays it.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include "alcove/framegraph/compile.h"
#include "alcove/framegraph/verify.h"
#include "random_graph.h"

namespace alcove::framegraph {
namespace {

// rapidcheck runs a property 100 times: 10,000 graphs a property.
constexpr std::uint64_t kGraphsPerRun = 100;

void expect_verified(std::uint64_t seed, const RandomOptions& options, const Limits& limits) {
  Graph graph;
  for (std::uint64_t i = 0; i < kGraphsPerRun; ++i) {
    graph.reset();
    Dice dice(seed + i * 7919);
    declare_random(graph, dice, options);
    const auto plan = compile(graph, limits);
    if (!plan) RC_FAIL("graph " + std::to_string(i) + ": " + to_string(plan.error()));
    const auto verified = verify(graph.description(), limits, *plan);
    if (!verified) RC_FAIL("graph " + std::to_string(i) + ": " + to_string(verified.error()));
    graph.leave_histories(plan->finals);
  }
}

RC_GTEST_PROP(Fuzz, EveryPlanOfARightGraphIsVerified, (std::uint64_t seed)) {
  expect_verified(seed, {}, {});
}

Limits with_families(std::uint32_t graphics, std::uint32_t compute, std::uint32_t transfer) {
  Limits limits;
  limits.queue_families[0] = graphics;
  limits.queue_families[1] = compute;
  limits.queue_families[2] = transfer;
  return limits;
}

RandomOptions on_all_queues() {
  RandomOptions options;
  options.queues = true;
  return options;
}

RC_GTEST_PROP(Fuzz, EveryPlanOverThreeQueueFamiliesIsVerified, (std::uint64_t seed)) {
  expect_verified(seed, on_all_queues(), with_families(0, 1, 2));
}

RC_GTEST_PROP(Fuzz, EveryPlanOverQueuesOfOneFamilyIsVerified, (std::uint64_t seed)) {
  expect_verified(seed, on_all_queues(), with_families(0, 0, 0));
}

RC_GTEST_PROP(Fuzz, GraphsForSeveralQueuesCollapseToOne, (std::uint64_t seed)) {
  expect_verified(seed, on_all_queues(), with_families(0, kNone, kNone));
}

RC_GTEST_PROP(Fuzz, EveryPlanWithCoarseGranularityIsVerified, (std::uint64_t seed)) {
  Limits limits;
  limits.buffer_image_granularity = 4096;
  expect_verified(seed, {}, limits);
}

RC_GTEST_PROP(Fuzz, EveryPlanWithSplitBarriersIsVerified, (std::uint64_t seed)) {
  Limits limits = with_families(0, 1, kNone);
  limits.split_barriers = true;
  expect_verified(seed, seed % 2 ? on_all_queues() : RandomOptions{}, limits);
}

}  // namespace
}  // namespace alcove::framegraph
