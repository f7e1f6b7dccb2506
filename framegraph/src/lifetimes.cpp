// Lifetimes: finds for each resource the positions of its first and its last use, between which no
// other resource may use a transient's memory, and the usage flags with which it is created. An
// attachment whose contents nobody needs can lie in lazily allocated memory.
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

// Marks the attachments whose contents no later pass needs. They can do without memory.
void find_transient_attachments(const GraphDescription& graph, const Workspace& workspace,
                                Plan& plan) {
  constexpr VkFlags kAttachmentUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                       VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                       VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT;
  for (const std::uint32_t r : workspace.transients) {
    VkFlags& usage = plan.placements[r].usage;
    if (graph.resources[r].kind == ResourceKind::texture && (usage & ~kAttachmentUsage) == 0)
      usage |= VK_IMAGE_USAGE_TRANSIENT_ATTACHMENT_BIT;
  }
  for (std::size_t i = 0; i < graph.accesses.size(); ++i)
    if (plan.contents[i] & kIsNeeded)
      plan.placements[graph.accesses[i].resource].usage &=
          ~VkFlags{VK_IMAGE_USAGE_TRANSIENT_ATTACHMENT_BIT};
}

}  // namespace

void lifetimes(const GraphDescription& graph, const Limits& limits, Workspace& workspace,
               Plan& plan) {
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
  if (limits.has_lazy_memory) find_transient_attachments(graph, workspace, plan);
}

}  // namespace alcove::framegraph
