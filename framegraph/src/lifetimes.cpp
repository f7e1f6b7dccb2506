// Lifetimes: finds for each resource the positions of its first and its last use, between which no
// other resource may use a transient's memory, and how it is created: the usage flags, and whether
// several queue families share it.
#include <algorithm>

#include "workspace.h"

namespace alcove::framegraph {

namespace {

// Extends the lifetime of each resource to the last pass of another queue that may run at the same
// time as the resource's last use.
void lengthen(const GraphDescription& graph, const Workspace& workspace, Plan& plan) {
  for (std::uint32_t position = 0; position < plan.passes.size(); ++position) {
    const std::uint32_t until = workspace.queues.taken_until[position];
    for (const AccessRecord& access : graph.pass_accesses(plan.passes[position].pass)) {
      Placement& placement = plan.placements[access.resource];
      placement.last = std::max(placement.last, until);
    }
  }
}

// Marks the resources that passes of several queue families use.
void find_concurrent(const GraphDescription& graph, const Limits& limits, Plan& plan) {
  for (const PlannedPass& planned : plan.passes) {
    const auto family = [&](QueueClass queue) {
      return limits.queue_families[static_cast<std::size_t>(queue)];
    };
    for (const AccessRecord& access : graph.pass_accesses(planned.pass)) {
      Placement& placement = plan.placements[access.resource];
      placement.concurrent |= family(planned.queue) != family(plan.passes[placement.first].queue);
    }
  }
}

}  // namespace

void lifetimes(const GraphDescription& graph, const Limits& limits, Workspace& workspace,
               Plan& plan) {
  plan.placements.assign(graph.resources.size(), Placement{});
  workspace.transients.clear();
  std::uint32_t position = 0;
  for (const PlannedPass& planned : plan.passes) {
    for (const AccessRecord& access : graph.pass_accesses(planned.pass)) {
      Placement& placement = plan.placements[access.resource];
      placement.usage |= access.usage;
      placement.last = position;
      if (placement.first != kNone) continue;
      placement.first = position;
      const ResourceRecord& resource = graph.resources[access.resource];
      if (resource.kind == ResourceKind::buffer) placement.usage |= resource.create_flags;
      if (resource.origin == Origin::transient) workspace.transients.push_back(access.resource);
    }
    ++position;
  }
  if (workspace.several_queues) {
    lengthen(graph, workspace, plan);
    find_concurrent(graph, limits, plan);
  }
  // The memory of an output is in use until the end of the frame.
  for (const OutputRecord& output : graph.outputs) {
    Placement& placement = plan.placements[output.resource];
    if (placement.first != kNone)
      placement.last = static_cast<std::uint32_t>(plan.passes.size() - 1);
  }
}

}  // namespace alcove::framegraph
