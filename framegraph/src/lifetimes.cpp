// Lifetimes: the positions between which a transient's memory is its own, and what it must be made
// with.
#include <algorithm>

#include "format_info.h"
#include "workspace.h"

namespace alcove::framegraph {

namespace {

// A pass of another queue that may run beside the last use must not have the memory.
void lengthen(const GraphDescription& graph, const Workspace& workspace, Plan& plan) {
  for (std::uint32_t position = 0; position < plan.passes.size(); ++position) {
    const std::uint32_t pass = plan.passes[position].pass;
    const auto accesses = graph.pass_accesses(pass);
    const std::uint8_t* live = plan.live_accesses.data() + graph.passes[pass].first_access;
    const std::uint32_t until = taken_until(workspace, plan, position);
    for (std::size_t i = 0; i < accesses.size(); ++i) {
      Placement& placement = plan.placements[accesses[i].resource];
      if (live[i]) placement.last = std::max(placement.last, until);
    }
  }
}

}  // namespace

void lifetimes(const GraphDescription& graph, const Limits& limits, Workspace& workspace,
               Plan& plan) {
  plan.placements.assign(graph.resources.size(), Placement{});
  workspace.transients.clear();
  for (std::uint32_t position = 0; position < plan.passes.size(); ++position) {
    const std::uint32_t pass = plan.passes[position].pass;
    const auto accesses = graph.pass_accesses(pass);
    const std::uint8_t* live = plan.live_accesses.data() + graph.passes[pass].first_access;
    for (std::size_t i = 0; i < accesses.size(); ++i) {
      if (!live[i]) continue;
      Placement& placement = plan.placements[accesses[i].resource];
      placement.usage |= accesses[i].usage;
      placement.last = position;
      if (placement.first != kNone) continue;
      placement.first = position;
      if (graph.resources[accesses[i].resource].origin == Origin::transient)
        workspace.transients.push_back(accesses[i].resource);
    }
  }
  if (workspace.several_queues) lengthen(graph, workspace, plan);
  // What is wanted after the frame keeps its memory to the end.
  for (const OutputRecord& output : graph.outputs) {
    Placement& placement = plan.placements[output.resource];
    if (placement.first != kNone)
      placement.last = static_cast<std::uint32_t>(plan.passes.size() - 1);
  }
  workspace.requirements.resize(graph.resources.size());
  for (std::uint32_t r : workspace.transients) {
    const ResourceRecord& record = graph.resources[r];
    const VkFlags usage = plan.placements[r].usage;
    workspace.requirements[r] = limits.memory.query
                                    ? limits.memory.query(limits.memory.context, record, usage)
                                    : estimate_requirements(record);
  }
}

}  // namespace alcove::framegraph
