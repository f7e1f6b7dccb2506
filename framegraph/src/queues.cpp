// Queues: divides the order of execution into submissions at the points where one queue must wait
// for another. It also finds, for each pass, the last pass of every other queue that has finished
// before it. This decides how long the memory of a transient is in use.
//
// A submission begins with a pass that waits for another queue, and ends with a pass for which
// another queue waits, so that no queue waits longer than it must. With one queue there is one
// submission. A pass that changes a subresource (writes it, or moves it to another layout) waits
// for the passes of other queues that have used it since the last change. A pass that only reads it
// waits for the last change. If passes of several queues read what a pass wrote, all in one other
// layout, the queue of the writer changes the layout at the end of its submission. No reader then
// has to change it, so that the readers need not wait for each other.
#include <algorithm>
#include <bit>

#include "workspace.h"

namespace alcove::framegraph {
namespace {

class QueueAssigner {
 public:
  QueueAssigner(const GraphDescription& graph, const Limits& limits, Workspace& workspace,
                Plan& plan)
      : graph_(graph), limits_(limits), workspace_(workspace), plan_(plan) {}

  void run() {
    const auto count = static_cast<std::uint32_t>(plan_.passes.size());
    workspace_.final_submission = 0;
    if (workspace_.several_queues) {
      add_moves();
      find_waits();
      cut();
      close();
      find_taken();
      extend_lifetimes();
    } else {
      plan_.submissions.push_back({.pass_count = count});
      for (std::uint32_t i = 0; i + 1 < count; ++i) plan_.passes[i].next = i + 1;
    }
    // The memory of an output is in use until the end of the frame.
    for (const OutputRecord& output : graph_.outputs) {
      Placement& placement = plan_.placements[output.resource];
      if (placement.first != kNone) placement.last = count - 1;
    }
  }

 private:
  using ByQueue = Workspace::ByQueue;

  std::uint32_t family(QueueClass queue) const {
    return limits_.queue_families[static_cast<std::size_t>(queue)];
  }

  // Adds a move after each write whose subresource is next read by several queues in another
  // layout. The subresources that one pass writes have neighbouring uses. They are moved together,
  // and only if all that are read next are read in one layout.
  void add_moves() {
    auto& uses = chain_.uses;
    s_.next.assign(uses.size(), kNone);
    for (std::uint32_t u = 0; u < chain_.first_use.back(); ++u)
      if (uses[u].previous != kNone) s_.next[uses[u].previous] = u;
    for (std::uint32_t i = 0, end = 0; i < chain_.first_move; i = end) {
      VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
      unsigned queues = 0;
      bool alike = uses[i].writes && !uses[i].is_initial_state();
      for (end = i; end < chain_.first_move && uses[end].resource == uses[i].resource &&
                    uses[end].first == uses[i].first && uses[end].writes == uses[i].writes;
           ++end) {
        const std::uint32_t next = s_.next[end];
        if (!uses[end].writes || next == kNone || uses[next].writes) continue;
        alike = alike && (queues == 0 || uses[next].layout == layout);
        layout = uses[next].layout;
        for (std::uint32_t u = next; u != kNone; u = uses[u].sibling)
          if (u < chain_.first_use.back()) queues |= bit(uses[u].queue);
      }
      if (!alike || queues == 0 || std::has_single_bit(queues)) continue;
      for (; i < end; ++i)
        if (s_.next[i] != kNone && !uses[s_.next[i]].writes && uses[i].layout != layout)
          add_move(i, s_.next[i]);
    }
  }

  // Makes a move the head of a group of reads.
  void add_move(std::uint32_t write, std::uint32_t reads) {
    const auto index = static_cast<std::uint32_t>(chain_.uses.size());
    const Use& before = chain_.uses[write];
    chain_.uses.push_back({.layout = chain_.uses[reads].layout,
                           .resource = before.resource,
                           .sub = before.sub,
                           .first = before.first,
                           .last = before.last,
                           .head = index,
                           .sibling = reads,
                           .previous = write,
                           .queue = before.queue});
    for (; reads != kNone; reads = chain_.uses[reads].sibling) chain_.uses[reads].head = index;
  }

  static std::uint8_t bit(QueueClass queue) {
    return static_cast<std::uint8_t>(1u << static_cast<unsigned>(queue));
  }

  // Finds, for each pass and each other queue, the last pass of that queue for which this pass must
  // wait. There is none if earlier waits already ensure that it is done. Then updates what the
  // queue of the pass knows to be done: the passes for which this pass waits, and all passes that
  // those passes' queues knew to be done.
  void find_waits() {
    const std::size_t count = plan_.passes.size();
    s_.waits.assign(count, kNothing);
    s_.known.assign(count, kNothing);
    s_.waited_for.assign(count, 0);
    for (std::uint32_t position = 0; position < count; ++position) {
      const auto own = static_cast<std::size_t>(plan_.passes[position].queue);
      for (std::uint32_t u = chain_.first_use[position]; u < chain_.first_use[position + 1]; ++u)
        find_waits_of(chain_.uses[u], s_.waits[position]);
      drop_implied(s_.waits[position]);
      for (std::size_t other = 0; other < kQueueClasses; ++other) {
        const std::int32_t wait = s_.waits[position][other];
        raise(known_[own][other], wait);
        if (wait < 0) continue;
        s_.waited_for[static_cast<std::size_t>(wait)] = 1;
        for (std::size_t third = 0; third < kQueueClasses; ++third)
          raise(known_[own][third], known_by(wait)[third]);
      }
      known_[own][own] = static_cast<std::int32_t>(position);
      s_.known[position] = known_[own];
    }
  }

  void find_waits_of(const Use& use, ByQueue& waits) const {
    const Use& head = chain_.uses[use.head];
    const bool changes = changes_layout(workspace_, head);
    if (&use != &head && changes) return wait_for(head, head.first, use.queue, waits);
    if (head.is_initial_state()) wait_for(head, kNone, use.queue, waits);
    if (head.previous == kNone) return;
    // A read that changes nothing only waits for a write.
    const bool all = use.writes || changes || chain_.uses[head.previous].writes;
    for (std::uint32_t u = all ? head.previous : kNone; u != kNone; u = chain_.uses[u].sibling)
      wait_for(chain_.uses[u], chain_.uses[u].last, use.queue, waits);
  }

  // Makes a pass on the queue `own` wait for a use that ends with the pass `user`, or before the
  // frame. An initial state with stages means that earlier work on its queue must be done. Even if
  // its writes are visible to reads, they are so on that queue only. The work that used a history
  // was that of an earlier frame.
  void wait_for(const Use& use, std::uint32_t user, QueueClass own, ByQueue& waits) const {
    const auto other = static_cast<std::size_t>(use.queue);
    const bool opens = user == kNone;
    if (use.queue == own ||
        (opens && (use.stages == 0 || graph_.resources[use.resource].origin == Origin::history)))
      return;
    const std::int32_t wait = opens ? Workspace::kOpening : static_cast<std::int32_t>(user);
    if (known_[static_cast<std::size_t>(own)][other] < wait) raise(waits[other], wait);
  }

  static void raise(std::int32_t& known, std::int32_t to) { known = std::max(known, to); }
  const ByQueue& known_by(std::int32_t position) const {
    return s_.known[static_cast<std::size_t>(position)];
  }

  // Drops a wait that another wait of the same pass implies.
  void drop_implied(ByQueue& waits) const {
    for (std::size_t other = 0; other < kQueueClasses; ++other)
      for (std::size_t third = 0; third < kQueueClasses; ++third)
        if (third != other && waits[third] >= 0 && known_by(waits[third])[other] >= waits[other])
          waits[other] = Workspace::kNever;
  }

  // Assigns passes to submissions, which are numbered in order of their first passes. If a pass of
  // another queue uses an import, the first submission is one of the graphics queue without passes,
  // which comes after all work before the frame.
  void cut() {
    if (std::any_of(s_.waits.begin(), s_.waits.end(),
                    [](const ByQueue& waits) { return waits[0] == Workspace::kOpening; }))
      plan_.submissions.push_back({});
    std::uint32_t open[kQueueClasses] = {kNone, kNone, kNone};
    std::uint32_t last[kQueueClasses] = {};
    for (std::uint32_t position = 0; position < plan_.passes.size(); ++position) {
      PlannedPass& planned = plan_.passes[position];
      const auto own = static_cast<std::size_t>(planned.queue);
      std::uint32_t& current = open[own];
      if (current == kNone || s_.waits[position] != kNothing) {
        current = static_cast<std::uint32_t>(plan_.submissions.size());
        add_submission(planned.queue, position, s_.waits[position]);
      } else {
        plan_.passes[last[own]].next = position;
      }
      last[own] = position;
      planned.submission = current;
      ++plan_.submissions[current].pass_count;
      if (s_.waited_for[position]) current = kNone;
    }
  }

  void add_submission(QueueClass queue, std::uint32_t first_pass, const ByQueue& waits) {
    Submission submission;
    submission.queue = queue;
    submission.first_pass = first_pass;
    submission.first_wait = static_cast<std::uint32_t>(plan_.waits.size());
    for (const std::int32_t wait : waits)
      if (wait != Workspace::kNever)
        plan_.waits.push_back(
            {wait < 0 ? 0 : plan_.passes[static_cast<std::size_t>(wait)].submission, 0});
    submission.wait_count = static_cast<std::uint32_t>(plan_.waits.size()) - submission.first_wait;
    plan_.submissions.push_back(submission);
  }

  // Chooses the queue on which the frame leaves each history, and the submission of the graphics
  // queue that brings imports and histories into their final states. The graphics queue waits for
  // the last uses of imports, because the next frame expects them on that queue, and of histories
  // that several queues used.
  void close() {
    ByQueue last = kNothing;
    bool imports = false;
    s_.last_queue.assign(graph_.resources.size(), QueueClass::graphics);
    for_each_external(graph_, [&](std::uint32_t r, const ResourceRecord& resource,
                                  const ExternalRecord& external) {
      const bool is_import = resource.origin == Origin::imported;
      imports |= is_import;
      if (is_import ? !external.has_final_state : stays_on_one_queue(r)) return;
      for_each_last_use(r, [&](const Use& use) {
        if (use.last != kNone) wait_for(use, use.last, QueueClass::graphics, last);
      });
    });
    drop_implied(last);
    workspace_.final_submission = kNone;
    for (std::uint32_t s = 0; s < plan_.submissions.size(); ++s)
      if (plan_.submissions[s].queue == QueueClass::graphics) workspace_.final_submission = s;
    if (last == kNothing && (workspace_.final_submission != kNone || !imports)) return;
    workspace_.final_submission = static_cast<std::uint32_t>(plan_.submissions.size());
    add_submission(QueueClass::graphics, static_cast<std::uint32_t>(plan_.passes.size()), last);
  }

  // Calls f for each use of the last groups in the frame of a resource's subresources.
  template <typename Function>
  void for_each_last_use(std::uint32_t resource, Function&& f) const {
    const auto& first = workspace_.first_sub;
    for (std::uint32_t sub = first[resource]; sub < first[resource + 1]; ++sub) {
      std::uint32_t u = chain_.tails[sub];
      if (u != kNone && chain_.uses[u].first == plan_.passes.size()) u = chain_.uses[u].previous;
      for (; u != kNone; u = chain_.uses[u].sibling) f(chain_.uses[u]);
    }
  }

  // Returns whether the frame can leave a history on one queue without final barriers, and sets
  // that queue.
  bool stays_on_one_queue(std::uint32_t resource) {
    if (plan_.placements[resource].first == kNone) return true;
    unsigned queues = 0;
    for_each_last_use(resource, [&](const Use& use) { queues |= bit(use.queue); });
    const bool single = workspace_.first_sub[resource + 1] - workspace_.first_sub[resource] == 1;
    if (queues != 1 && !(single && std::has_single_bit(queues))) return false;
    s_.last_queue[resource] = static_cast<QueueClass>(std::countr_zero(queues));
    return true;
  }

  // Finds, for each pass, the last position at which another queue may still run at the same time.
  // That are the later passes of the other queue that do not know this pass to be done.
  void find_taken() {
    const auto count = static_cast<std::uint32_t>(plan_.passes.size());
    s_.taken_until.resize(count);
    for (std::uint32_t position = 0; position < count; ++position)
      s_.taken_until[position] = position;
    const auto queue_of = [this](std::uint32_t position) {
      return static_cast<std::size_t>(plan_.passes[position].queue);
    };
    for (std::size_t own = 0; own < kQueueClasses; ++own) {
      for (std::size_t other = 0; other < kQueueClasses; ++other) {
        if (own == other) continue;
        std::uint32_t next = 0;  // the first pass of the other queue that knows `position`
        std::uint32_t last = 0;  // the last one before it
        for (std::uint32_t position = 0; position < count; ++position) {
          if (queue_of(position) != own) continue;
          for (; next < count; ++next) {
            if (queue_of(next) != other) continue;
            if (s_.known[next][own] >= static_cast<std::int32_t>(position)) break;
            last = next;
          }
          s_.taken_until[position] = std::max(s_.taken_until[position], last);
        }
      }
    }
  }

  // A resource is in use up to the last pass of another queue that may run at the same time as its
  // last use.
  void extend_lifetimes() {
    for (const Use& use : chain_.uses) {
      if (use.first >= plan_.passes.size()) continue;
      Placement& placement = plan_.placements[use.resource];
      placement.last = std::max(placement.last, s_.taken_until[use.last]);
      placement.concurrent |= family(use.queue) != family(plan_.passes[placement.first].queue);
    }
  }

  static constexpr ByQueue kNothing{Workspace::kNever, Workspace::kNever, Workspace::kNever};

  // The last position on each other queue (second index) that is known to be done when a queue
  // (first index) reaches its current pass.
  ByQueue known_[kQueueClasses] = {kNothing, kNothing, kNothing};
  const GraphDescription& graph_;
  const Limits& limits_;
  Workspace& workspace_;
  Plan& plan_;
  Workspace::Chain& chain_ = workspace_.chain;
  Workspace::Queues& s_ = workspace_.queues;
};

}  // namespace

void assign_queues(const GraphDescription& graph, const Limits& limits, Workspace& workspace,
                   Plan& plan) {
  QueueAssigner(graph, limits, workspace, plan).run();
}

}  // namespace alcove::framegraph
