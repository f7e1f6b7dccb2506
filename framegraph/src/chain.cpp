// Chains: lists the uses of each subresource in the order of the passes, in groups that need not
// wait for each other. The states before and after the frame are uses too. All later phases go
// along these chains. On the way, finds for each resource the positions of its first and its last
// use and the usage with which it is created.
#include <algorithm>

#include "workspace.h"

namespace alcove::framegraph {
namespace {

class Chainer {
 public:
  Chainer(const GraphDescription& graph, const Limits& limits, Workspace& workspace, Plan& plan)
      : graph_(graph), limits_(limits), workspace_(workspace), plan_(plan) {}

  void run() {
    s_.uses.clear();
    s_.tails.assign(workspace_.first_sub.back(), kNone);
    plan_.passes.clear();
    plan_.placements.assign(graph_.resources.size(), Placement{});
    workspace_.transients.clear();
    workspace_.several_queues = false;
    add_initial_states();
    s_.first_use.clear();
    for (std::uint32_t pass = 0; pass < graph_.passes.size(); ++pass)
      if (plan_.cull_reasons[pass].is_live()) add_pass(pass);
    s_.first_use.push_back(static_cast<std::uint32_t>(s_.uses.size()));
    add_final_states();
    s_.first_move = static_cast<std::uint32_t>(s_.uses.size());
  }

 private:
  // Adds a pass on the queue of its class, or on the graphics queue if the device has no queue of
  // that class.
  void add_pass(std::uint32_t pass) {
    const auto position = static_cast<std::uint32_t>(plan_.passes.size());
    const QueueClass queue = queue_of(limits_, graph_.passes[pass].queue);
    plan_.passes.push_back({pass, queue});
    workspace_.several_queues |= queue != QueueClass::graphics;
    s_.first_use.push_back(static_cast<std::uint32_t>(s_.uses.size()));
    for (const AccessRecord& access : graph_.pass_accesses(pass)) {
      Placement& placement = plan_.placements[access.resource];
      placement.usage |= access.usage;
      placement.last = position;
      if (placement.first == kNone) begin(access.resource, placement, position);
      add_access(access, position, queue);
    }
  }

  void begin(std::uint32_t r, Placement& placement, std::uint32_t position) {
    placement.first = position;
    const ResourceRecord& resource = graph_.resources[r];
    if (resource.kind == ResourceKind::buffer) placement.usage |= resource.create_flags;
    if (resource.origin == Origin::transient) workspace_.transients.push_back(r);
    // A frame on the graphics queue may use a resource that was last used on another one.
    if (resource.external != kNone)
      workspace_.several_queues |=
          queue_of(limits_, graph_.externals[resource.external].queue) != QueueClass::graphics;
  }

  void add_access(const AccessRecord& access, std::uint32_t position, QueueClass queue) {
    const std::uint32_t* const subs = workspace_.first_sub.data() + access.resource;
    const bool single = subs[1] == subs[0] + 1;
    const Range range = single ? Range{0, 1, 0, 1} : access.range;
    const std::uint32_t mips = single ? 1 : graph_.resources[access.resource].mips;
    for (std::uint32_t layer = range.base_layer; layer < range.base_layer + range.layers; ++layer)
      for (std::uint32_t mip = range.base_mip; mip < range.base_mip + range.mips; ++mip)
        add(subs[0] + layer * mips + mip, access, position, queue);
  }

  // Appends a use to the chain of its subresource, or adds it to the last group. If the group needs
  // a barrier that changes the layout, the reads of a queue are one use, which the barrier covers.
  // If not, a read that earlier reads of its queue do not cover is a use of its own.
  void add(std::uint32_t sub, const AccessRecord& access, std::uint32_t position,
           QueueClass queue) {
    const VkImageLayout layout =
        access.kind() == ResourceKind::texture ? access.layout : VK_IMAGE_LAYOUT_UNDEFINED;
    const bool writes = (access.flags & kWrite) != 0;
    const std::uint32_t tail = s_.tails[sub];
    const bool joins =
        !writes && tail != kNone && !s_.uses[tail].writes && s_.uses[tail].layout == layout;
    const auto index = static_cast<std::uint32_t>(s_.uses.size());
    if (joins) {
      const std::uint32_t last = join(tail, access, position, queue);
      if (last == kNone) return;
      s_.uses[last].sibling = index;
    } else {
      s_.tails[sub] = index;
    }
    s_.uses.push_back({.stages = access.stages,
                       .access = access.access,
                       .layout = layout,
                       .resource = access.resource,
                       .sub = sub,
                       .first = position,
                       .last = position,
                       .head = joins ? tail : index,
                       .previous = joins ? kNone : tail,
                       .queue = queue,
                       .writes = writes,
                       .discards = (access.flags & kDiscard) != 0});
  }

  // Adds a read to the uses of its queue in a group. Returns kNone if they then cover it, and
  // otherwise the last use of the group. The state after the frame is always a use of its own.
  std::uint32_t join(std::uint32_t group, const AccessRecord& access, std::uint32_t position,
                     QueueClass queue) {
    const bool is_one_use = changes_layout(workspace_, s_.uses[group]);
    VkPipelineStageFlags2 left = access.stages;
    std::uint32_t last = group;
    for (; group != kNone; group = s_.uses[group].sibling) {
      Use& other = s_.uses[group];
      last = group;
      if (other.queue != queue || other.first == kNone) continue;
      if (is_one_use) {
        other.stages |= access.stages;
        other.access |= access.access;
        left = 0;
      } else if ((access.access & ~other.access) == 0) {
        left &= ~other.stages;
      }
      if (left != 0 || position == plan_.passes.size()) continue;
      other.last = position;
      return kNone;
    }
    return last;
  }

  void add_initial_states() {
    for_each_external(graph_, [this](std::uint32_t r, const auto&, const ExternalRecord& external) {
      AccessRecord state = state_use(r, external.initial_state);
      if (!external.has_contents) state.layout = VK_IMAGE_LAYOUT_UNDEFINED;
      add_access(state, kNone, queue_of(limits_, external.queue));
    });
  }

  void add_final_states() {
    const auto end = static_cast<std::uint32_t>(plan_.passes.size());
    const State any{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT,
                    VK_IMAGE_LAYOUT_GENERAL};
    for_each_external(graph_, [&](std::uint32_t r, const ResourceRecord& resource,
                                  const ExternalRecord& external) {
      if (external.has_final_state)
        add_access(state_use(r, external.final_state), end, QueueClass::graphics);
      else if (resource.origin == Origin::history && !is_left_in_one_layout(r))
        add_access(state_use(r, any), end, QueueClass::graphics);
    });
  }

  // Returns whether the frame leaves all subresources of a history slot in one layout.
  bool is_left_in_one_layout(std::uint32_t r) const {
    const auto& first = workspace_.first_sub;
    const auto layout = [&](std::uint32_t sub) { return s_.uses[s_.tails[sub]].layout; };
    for (std::uint32_t sub = first[r]; sub < first[r + 1]; ++sub)
      if (plan_.placements[r].first != kNone && layout(sub) != layout(first[r])) return false;
    return true;
  }

  AccessRecord state_use(std::uint32_t r, const State& state) const {
    AccessRecord access;
    access.stages = state.stages;
    access.access = state.access;
    access.layout = state.layout;
    access.resource = r;
    access.range = {0, static_cast<std::uint16_t>(graph_.resources[r].mips), 0,
                    static_cast<std::uint16_t>(graph_.resources[r].layers)};
    access.flags = (state.access & kWriteBits ? kWrite : 0u) |
                   (graph_.resources[r].kind == ResourceKind::buffer ? kOnBuffer : 0u);
    return access;
  }

  const GraphDescription& graph_;
  const Limits& limits_;
  Workspace& workspace_;
  Plan& plan_;
  Workspace::Chain& s_ = workspace_.chain;
};

}  // namespace

void chain(const GraphDescription& graph, const Limits& limits, Workspace& workspace, Plan& plan) {
  Chainer(graph, limits, workspace, plan).run();
}

}  // namespace alcove::framegraph
