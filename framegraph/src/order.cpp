// Ordering: program order of the live passes.
#include "workspace.h"

namespace alcove::framegraph {

void order(const GraphDescription& graph, const Limits& limits, Workspace& workspace, Plan& plan) {
  workspace.order.clear();
  for (std::uint32_t pass = 0; pass < graph.passes.size(); ++pass) {
    if (workspace.pass_live[pass]) workspace.order.push_back(pass);
  }
  plan.passes.resize(workspace.order.size());
  for (std::uint32_t position = 0; position < workspace.order.size(); ++position) {
    PlannedPass& planned = plan.passes[position];
    planned = {};
    planned.pass = workspace.order[position];
    const QueueClass queue = graph.passes[planned.pass].queue;
    const bool own = limits.queue_families[static_cast<std::size_t>(queue)] != kNone;
    planned.queue = own ? queue : QueueClass::graphics;
  }
}

}  // namespace alcove::framegraph
