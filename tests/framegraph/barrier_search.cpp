#include "barrier_search.h"

#include <gtest/gtest.h>

#include <bit>

#include "alcove/framegraph/verify.h"

namespace alcove::framegraph {
namespace {

using Changes = std::vector<std::vector<Transition>>;  // indexed by position

// Returns the plan's layout changes by position. Each change is moved to the last position whose
// bit is set in `mask` and that is not after the pass that needs the change.
Changes moved_changes(const Plan& plan, std::uint32_t mask) {
  Changes changes(plan.passes.size() + 1);
  const auto move = [&](std::uint32_t index, std::size_t position) {
    if (index == kNone) return;
    std::size_t to = position;
    while (to > 0 && !(mask & (1u << to))) --to;
    const Batch& batch = plan.batches[index];
    for (std::uint32_t t = batch.first; t < batch.first + batch.count; ++t)
      if (plan.transitions[t].resource != kNone) changes[to].push_back(plan.transitions[t]);
  };
  for (std::size_t p = 0; p < plan.passes.size(); ++p) move(plan.passes[p].batch, p);
  move(plan.final_batch, plan.passes.size());
  return changes;
}

// Appends a barrier over all stages and accesses, with these layout changes.
void append_full_barrier(Plan& plan, const std::vector<Transition>& changes) {
  Batch batch;
  batch.first = static_cast<std::uint32_t>(plan.transitions.size());
  batch.count = static_cast<std::uint32_t>(changes.size() + 1);
  Transition all;
  all.src_stages = all.dst_stages =
      VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT;
  all.src_access = VK_ACCESS_2_MEMORY_WRITE_BIT;
  all.dst_access = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  plan.transitions.push_back(all);
  for (Transition change : changes) {
    change.src_stages = all.src_stages;
    change.src_access = all.src_access;
    change.dst_stages = all.dst_stages;
    change.dst_access = all.dst_access;
    plan.transitions.push_back(change);
  }
  plan.batches.push_back(batch);
}

// Returns the plan with barriers over everything at the positions whose bits are set in `mask`, and
// at no others.
Plan with_barriers_at(const Plan& plan, std::uint32_t mask) {
  const Changes changes = moved_changes(plan, mask);
  Plan made = plan;
  made.batches.clear();
  made.transitions.clear();
  for (std::size_t p = 0; p <= plan.passes.size(); ++p) {
    std::uint32_t& batch = p == plan.passes.size() ? made.final_batch : made.passes[p].batch;
    batch = kNone;
    if (!(mask & (1u << p))) continue;
    batch = static_cast<std::uint32_t>(made.batches.size());
    append_full_barrier(made, changes[p]);
  }
  return made;
}

}  // namespace

std::uint32_t expect_no_command_too_many(const GraphDescription& graph, const Limits& limits,
                                         const Plan& plan) {
  const auto used = static_cast<int>(plan.batches.size());
  std::uint32_t tried = 0;
  for (std::uint32_t mask = 0; mask < 2u << plan.passes.size(); ++mask) {
    if (std::popcount(mask) != used - 1) continue;
    ++tried;
    EXPECT_FALSE(verify(graph, limits, with_barriers_at(plan, mask)))
        << used - 1 << " commands would be enough, before the positions of mask " << mask;
  }
  return tried;
}

}  // namespace alcove::framegraph
