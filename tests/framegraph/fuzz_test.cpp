// Compiles random graphs and verifies their plans. rapidcheck prints the seed of the run, and
// RC_PARAMS="seed=..." replays it. RC_PARAMS="max_success=..." sets how often a property is tested;
// the soak tests use it.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <iostream>

#include "alcove/framegraph/compile.h"
#include "alcove/framegraph/verify.h"
#include "random_graph.h"

namespace alcove::framegraph {
namespace {

// rapidcheck runs a property 100 times, so that each property tests 10,000 graphs.
constexpr std::uint64_t kGraphsPerRun = 100;
constexpr std::uint64_t kProgress = 25'000;  // graphs between two lines of progress

// Returns a seed from the whole range of integers, because rapidcheck's own integers start with
// small values.
std::uint64_t any_seed() {
  return *rc::gen::noShrink(rc::gen::resize(rc::kNominalSize, rc::gen::arbitrary<std::uint64_t>()));
}

// Compiles and verifies a sequence of frames of one graph, whose histories continue from frame to
// frame.
void expect_verified(const RandomOptions& options, const Limits& limits) {
  static std::uint64_t graphs = 0;
  const std::uint64_t seed = any_seed();
  Graph graph;
  for (std::uint64_t i = 0; i < kGraphsPerRun; ++i) {
    const auto fail = [&](const Errors& errors) {
      RC_FAIL("graph " + std::to_string(i) + " of seed " + std::to_string(seed) + ": " +
              to_string(errors));
    };
    graph.reset();
    Dice dice(seed + i * 7919);
    declare_random(graph, dice, options);
    const auto plan = compile(graph.description(), limits);
    if (!plan) fail(plan.error());
    const auto verified = verify(graph.description(), limits, *plan);
    if (!verified) fail(verified.error());
    graph.leave_histories(plan->finals);
    if (++graphs % kProgress == 0) std::cout << graphs << " graphs verified" << std::endl;
  }
}

RC_GTEST_PROP(Fuzz, PlanOfAnyRandomValidGraphPassesTheVerifier, ()) { expect_verified({}, {}); }

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

RC_GTEST_PROP(Fuzz, PlanOfAnyRandomGraphOverThreeQueueFamiliesPassesTheVerifier, ()) {
  expect_verified(on_all_queues(), with_families(0, 1, 2));
}

RC_GTEST_PROP(Fuzz, PlanOfAnyRandomGraphOverThreeQueuesOfOneFamilyPassesTheVerifier, ()) {
  expect_verified(on_all_queues(), with_families(0, 0, 0));
}

RC_GTEST_PROP(Fuzz, PlanOfAnyRandomGraphForThreeQueuesPassesTheVerifierOnADeviceWithOneQueue, ()) {
  expect_verified(on_all_queues(), with_families(0, kNone, kNone));
}

// The options of these graphs give imports any initial and final states.
RC_GTEST_PROP(Fuzz, PlanOfAnyRandomGraphWithAnyFinalStatesPassesTheVerifier, ()) {
  expect_verified({.any_states = true}, {});
}

RC_GTEST_PROP(Fuzz, PlanOfAnyRandomGraphWithAnyFinalStatesOverTwoQueuesPassesTheVerifier, ()) {
  expect_verified({.queues = true, .any_states = true}, with_families(0, 0, kNone));
}

RC_GTEST_PROP(Fuzz, PlanOfAnyRandomGraphWithAnyFinalStatesOverFamiliesPassesTheVerifier, ()) {
  expect_verified({.queues = true, .any_states = true}, with_families(0, 1, 2));
}

RC_GTEST_PROP(Fuzz, PlanOfAnyRandomGraphPassesTheVerifierIfBufferImageGranularityIsCoarse, ()) {
  Limits limits;
  limits.buffer_image_granularity = 4096;
  expect_verified({}, limits);
}

}  // namespace
}  // namespace alcove::framegraph
