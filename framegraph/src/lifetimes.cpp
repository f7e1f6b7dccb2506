// Lifetimes: finds for each resource the positions of its first and its last use, between which no
// other resource may use a transient's memory, and the usage flags with which it is created.
#include <algorithm>

#include "workspace.h"

namespace alcove::framegraph {

namespace {

// Extends the lifetime of each resource to the last pass of another queue that may run at the same
// time as the resource's last use.
void lengthen(const GraphDescription& graph, const Workspace& workspace, Plan& plan) {
  for (std::uint32_t position = 0; position < plan.passes.size(); ++position) {
    const std::uint32_t until = workspace.queues.taken_until[position];
    for_each_live(graph, plan, plan.passes[position].pass, [&](const AccessRecord& access) {
      Placement& placement = plan.placements[access.resource];
      placement.last = std::max(placement.last, until);
    });
  }
}

}  // namespace

void lifetimes(const GraphDescription& graph, Workspace& workspace, Plan& plan) {
  plan.placements.assign(graph.resources.size(), Placement{});
  workspace.transients.clear();
  std::uint32_t position = 0;
  for (const PlannedPass& planned : plan.passes) {
    for_each_live(graph, plan, planned.pass, [&](const AccessRecord& access) {
      Placement& placement = plan.placements[access.resource];
      placement.usage |= access.usage;
      placement.last = position;
      if (placement.first != kNone) return;
      placement.first = position;
      const ResourceRecord& resource = graph.resources[access.resource];
      if (resource.kind == ResourceKind::buffer) placement.usage |= resource.create_flags;
      if (resource.origin == Origin::transient) workspace.transients.push_back(access.resource);
    });
    ++position;
  }
  if (workspace.several_queues) lengthen(graph, workspace, plan);
  // The memory of an output is in use until the end of the frame.
  for (const OutputRecord& output : graph.outputs) {
    Placement& placement = plan.placements[output.resource];
    if (placement.first != kNone)
      placement.last = static_cast<std::uint32_t>(plan.passes.size() - 1);
  }
}

}  // namespace alcove::framegraph
