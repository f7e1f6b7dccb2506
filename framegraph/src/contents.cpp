// Contents: finds for each access whether its range has earlier contents, and whether the contents
// that it leaves are needed later. The load and store operations of attachments follow from these
// two answers. An attachment that is neither loaded nor stored can lie in lazily allocated memory.
#include <algorithm>

#include "workspace.h"

namespace alcove::framegraph {
namespace {

constexpr VkFlags kAttachmentUsage =
    VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
    VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSIENT_ATTACHMENT_BIT;

bool draws(const GraphDescription& graph, const Plan& plan) {
  for (std::uint32_t r = 0; r < graph.resources.size(); ++r)
    if (graph.resources[r].kind == ResourceKind::texture &&
        (plan.placements[r].usage & kAttachmentUsage) != 0)
      return true;
  return false;
}

class ContentsFinder {
 public:
  ContentsFinder(const GraphDescription& graph, Workspace& workspace, Plan& plan)
      : graph_(graph), workspace_(workspace), plan_(plan), subs_(workspace.contents) {}

  void run() {
    subs_.assign(workspace_.first_sub.back(), 0);
    for_each_external([](const ExternalRecord& external) { return external.has_contents != 0; });
    for (const PlannedPass& planned : plan_.passes) {
      for_each_access(planned.pass, [&](const AccessRecord& access, std::uint8_t& flags) {
        if (!(access.flags & kDiscard) && any(access)) flags |= kHasContents;
        if (access.flags & kWrite) set(access, 1);
      });
    }
    std::fill(subs_.begin(), subs_.end(), std::uint8_t{0});
    for_each_external([](const ExternalRecord&) { return true; });
    for (const OutputRecord& output : graph_.outputs) fill(output.resource);
    for (std::size_t position = plan_.passes.size(); position-- > 0;) {
      const std::uint32_t pass = plan_.passes[position].pass;
      for_each_access(pass, [&](const AccessRecord& access, std::uint8_t& flags) {
        if (any(access)) flags |= kIsNeeded;
      });
      for_each_access(pass, [&](const AccessRecord& access, std::uint8_t&) {
        if (access.flags & kDiscard)
          set(access, 0);
        else if ((access.access & ~kWriteBits) != 0)
          set(access, 1);
      });
    }
  }

  // Marks attachments that no pass loads and nobody needs later. They can do without memory.
  void find_transient_attachments() {
    subs_.assign(graph_.resources.size(), 0);
    for (const PlannedPass& planned : plan_.passes) {
      for_each_access(planned.pass, [&](const AccessRecord& access, const std::uint8_t& flags) {
        if (flags != 0) subs_[access.resource] = 1;
      });
    }
    for (const std::uint32_t r : workspace_.transients) {
      VkFlags& usage = plan_.placements[r].usage;
      if (graph_.resources[r].kind == ResourceKind::texture && !subs_[r] &&
          (usage & ~kAttachmentUsage) == 0)
        usage |= VK_IMAGE_USAGE_TRANSIENT_ATTACHMENT_BIT;
    }
  }

 private:
  template <typename Function>
  void for_each_access(std::uint32_t pass, Function&& f) {
    std::uint32_t index = graph_.passes[pass].first_access;
    for (const AccessRecord& access : graph_.pass_accesses(pass)) {
      if (plan_.live_accesses[index]) f(access, plan_.contents[index]);
      ++index;
    }
  }
  template <typename Predicate>
  void for_each_external(const Predicate& has) {
    for (std::uint32_t r = 0; r < graph_.resources.size() && !graph_.externals.empty(); ++r) {
      const std::uint32_t external = graph_.resources[r].external;
      if (external != kNone && has(graph_.externals[external])) fill(r);
    }
  }
  void fill(std::uint32_t resource) {
    const auto& first = workspace_.first_sub;
    std::fill(subs_.begin() + first[resource], subs_.begin() + first[resource + 1],
              std::uint8_t{1});
  }
  bool any(const AccessRecord& access) const {
    bool found = false;
    for_each_sub(graph_, workspace_, access,
                 [&](std::uint32_t sub) { found = found || subs_[sub] != 0; });
    return found;
  }
  void set(const AccessRecord& access, std::uint8_t value) {
    for_each_sub(graph_, workspace_, access, [&](std::uint32_t sub) { subs_[sub] = value; });
  }

  const GraphDescription& graph_;
  const Workspace& workspace_;
  Plan& plan_;
  std::vector<std::uint8_t>& subs_;
};

}  // namespace

void find_contents(const GraphDescription& graph, const Limits& limits, Workspace& workspace,
                   Plan& plan) {
  plan.contents.assign(graph.accesses.size(), 0);
  // Load and store operations exist for attachments only.
  if (!draws(graph, plan)) return;
  ContentsFinder finder(graph, workspace, plan);
  finder.run();
  if (limits.has_lazy_memory) finder.find_transient_attachments();
}

}  // namespace alcove::framegraph
