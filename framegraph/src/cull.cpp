// Culling: walks over the passes from the last to the first, and follows for each subresource
// whether its contents are needed by an output or by a later pass that runs. One walk is enough,
// because a pass can only read what earlier declared passes wrote. Histories are the exception:
// they keep their contents for later frames. If a pass that runs uses a history, or one of its
// older slots has no contents, the last contents of all its slots are needed. For each history that
// a walk finds to be used, the walk is repeated.
#include "workspace.h"

namespace alcove::framegraph {
namespace {

constexpr std::uint32_t kUnneeded = kNone;
constexpr std::uint32_t kByOutput = kNone - 1;
// This bit marks that a pass uses a history. The bits below it hold the pass.
constexpr std::uint32_t kHistoryBit = 0x4000'0000;
constexpr std::uint32_t kNoPass = kHistoryBit - 1;  // an older slot has no contents

class Culler {
 public:
  Culler(const GraphDescription& graph, Workspace& workspace, Plan& plan)
      : graph_(graph), workspace_(workspace), plan_(plan) {}

  void run() {
    workspace_.cull.history_user.assign(graph_.resources.size(), kNone);
    find_new_histories();
    do {
      found_history_ = false;
      for (std::uint8_t& contents : plan_.contents) contents &= kHasContents;
      walk();
    } while (found_history_);
  }

 private:
  // A frame may declare a read of an older slot only once the slot has contents. Its writers run
  // before, because no later frame would read it otherwise.
  void find_new_histories() {
    for_each_external(graph_, [this](std::uint32_t r, const ResourceRecord& resource,
                                     const ExternalRecord& external) {
      if (resource.slot != 0 && !external.has_contents)
        workspace_.cull.history_user[r - resource.slot] = kNoPass;
    });
  }

  void walk() {
    plan_.cull_reasons.resize(graph_.passes.size());
    workspace_.cull.needed_by.assign(workspace_.first_sub.back(), kUnneeded);
    seed();
    for (std::uint32_t pass = static_cast<std::uint32_t>(graph_.passes.size()); pass-- > 0;)
      plan_.cull_reasons[pass] = visit(pass);
  }

  void seed() {
    for (const OutputRecord& output : graph_.outputs) need_all(output.resource, kByOutput);
    for_each_external(graph_, [this](std::uint32_t r, const ResourceRecord& resource,
                                     const ExternalRecord& external) {
      if (resource.origin == Origin::imported && external.has_final_state) need_all(r, kByOutput);
      const std::uint32_t user = workspace_.cull.history_user[r - resource.slot];
      if (user != kNone) need_all(r, user | kHistoryBit);
    });
  }

  void need_all(std::uint32_t resource, std::uint32_t why) {
    for (std::uint32_t sub = workspace_.first_sub[resource];
         sub < workspace_.first_sub[resource + 1]; ++sub)
      workspace_.cull.needed_by[sub] = why;
  }

  PassCullReason visit(std::uint32_t pass) {
    const PassRecord& record = graph_.passes[pass];
    const auto accesses = graph_.pass_accesses(pass);
    bool pass_is_live = (record.flags & kSideEffect) != 0;
    bool writes = false;
    PassCullReason cull_reason{pass_is_live ? CullReason::side_effect : CullReason::unread, kNone,
                               kNone};
    for (const AccessRecord& access : accesses) {
      if (!(access.flags & kWrite)) continue;
      writes = true;
      const std::uint32_t why = first_need(access);
      if (why != kUnneeded || graph_.resources[access.resource].origin == Origin::imported)
        plan_.contents[static_cast<std::size_t>(&access - graph_.accesses.data())] |= kIsNeeded;
      if (why == kUnneeded) continue;
      if (!pass_is_live) cull_reason = explain(why, access.resource);
      pass_is_live = true;
    }
    if (!pass_is_live) {
      if (!writes) cull_reason.cull_reason = CullReason::writes_nothing;
      return cull_reason;
    }
    // The accesses of a pass are to different subresources, so that their order does not matter.
    for (const AccessRecord& access : accesses) {
      const bool writes_it = (access.flags & kWrite) != 0;
      // An access that both reads and writes needs the former contents.
      const bool reads_it = !writes_it || (access.access & ~kWriteBits) != 0;
      if (writes_it && (access.flags & kDiscard))
        end_need(access);
      else if (reads_it)
        begin_need(access, pass);
      find_history(access, pass);
    }
    return cull_reason;
  }

  std::uint32_t first_need(const AccessRecord& access) const {
    std::uint32_t why = kUnneeded;
    for_each_sub(graph_, workspace_, access, [&](std::uint32_t sub) {
      if (why == kUnneeded) why = workspace_.cull.needed_by[sub];
    });
    return why;
  }

  // A write that discards ends the need for earlier contents. A write that keeps them does not.
  void end_need(const AccessRecord& access) {
    for_each_sub(graph_, workspace_, access,
                 [&](std::uint32_t sub) { workspace_.cull.needed_by[sub] = kUnneeded; });
  }

  void begin_need(const AccessRecord& access, std::uint32_t pass) {
    for_each_sub(graph_, workspace_, access,
                 [&](std::uint32_t sub) { workspace_.cull.needed_by[sub] = pass; });
  }

  // Marks the contents of a history as needed, if the access of a live pass is to one of its slots.
  void find_history(const AccessRecord& access, std::uint32_t pass) {
    const ResourceRecord& resource = graph_.resources[access.resource];
    if (resource.origin != Origin::history) return;
    std::uint32_t& user = workspace_.cull.history_user[access.resource - resource.slot];
    if (user != kNone) return;
    user = pass;
    found_history_ = true;
  }

  static PassCullReason explain(std::uint32_t why, std::uint32_t resource) {
    if (why == kByOutput) return {CullReason::output, kNone, resource};
    if (why == (kNoPass | kHistoryBit)) return {CullReason::feeds_history, kNone, resource};
    if (why & kHistoryBit) return {CullReason::feeds_history, why & ~kHistoryBit, resource};
    return {CullReason::feeds_pass, why, resource};
  }

  const GraphDescription& graph_;
  Workspace& workspace_;
  Plan& plan_;
  bool found_history_ = false;
};

}  // namespace

void cull(const GraphDescription& graph, Workspace& workspace, Plan& plan) {
  Culler(graph, workspace, plan).run();
}

}  // namespace alcove::framegraph
