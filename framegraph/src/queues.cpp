// Queues: gives each pass its queue, and divides the order of execution into submissions at the
// points where one queue must wait for another. It also finds, for each pass, the last pass of
// every other queue that has finished before it. This decides how long the memory of a transient is
// in use.
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
      : graph_(graph), limits_(limits), workspace_(workspace), plan_(plan), s_(workspace.queues) {}

  void run() {
    choose_queues();
    const auto count = static_cast<std::uint32_t>(plan_.passes.size());
    if (!workspace_.several_queues) {
      plan_.submissions.push_back({.pass_count = count});
      return;
    }
    find_moved_layouts();
    find_waits();
    cut();
    regroup();
    close();
    find_taken();
  }

 private:
  static constexpr std::uint32_t kNobody = kNone;
  static constexpr VkImageLayout kMixed = Workspace::Queues::Reads::kMixed;

  std::uint32_t family(QueueClass queue) const {
    return limits_.queue_families[static_cast<std::size_t>(queue)];
  }

  // Assigns each live pass to the queue of its class, or to the graphics queue if the device has no
  // queue of that class.
  void choose_queues() {
    plan_.passes.clear();
    workspace_.several_queues = false;
    workspace_.final_submission = 0;
    for (std::uint32_t pass = 0; pass < graph_.passes.size(); ++pass) {
      if (!plan_.cull_reasons[pass].is_live()) continue;
      const QueueClass wanted = graph_.passes[pass].queue;
      const QueueClass queue = family(wanted) != kNone ? wanted : QueueClass::graphics;
      plan_.passes.push_back({pass, queue});
      workspace_.several_queues |= queue != QueueClass::graphics;
    }
    // A graphics pass may use a resource that was last used on another queue.
    if (!workspace_.several_queues && !graph_.externals.empty()) {
      for (const PlannedPass& planned : plan_.passes) {
        for (const AccessRecord& access : graph_.pass_accesses(planned.pass)) {
          const std::uint32_t external = graph_.resources[access.resource].external;
          workspace_.several_queues |=
              external != kNone &&
              initial_queue(graph_.externals[external]) != QueueClass::graphics;
        }
      }
    }
  }

  // Finds the writes after which the queue of the writer changes the layout. Goes from the last
  // pass to the first, and follows for each subresource the layout and the queues of the reads up
  // to the next write.
  void find_moved_layouts() {
    s_.moved_layouts.assign(graph_.accesses.size(), VK_IMAGE_LAYOUT_UNDEFINED);
    s_.reads.assign(workspace_.first_sub.back(), {});
    for (std::size_t position = plan_.passes.size(); position-- > 0;) {
      const PlannedPass& planned = plan_.passes[position];
      for (const AccessRecord& access : graph_.pass_accesses(planned.pass)) {
        if (access.kind() != ResourceKind::texture) continue;
        Workspace::Queues::Reads all;
        const Workspace::Queues::Reads own{access.layout,
                                           1u << static_cast<unsigned>(planned.queue)};
        for_each_sub(graph_, workspace_, access, [&](std::uint32_t sub) {
          all.add(s_.reads[sub]);
          if (access.flags & kWrite)
            s_.reads[sub] = {};
          else
            s_.reads[sub].add(own);
        });
        if ((access.flags & kWrite) && !std::has_single_bit(all.queues) && all.layout != kMixed)
          s_.moved_layouts[index_of(access)] = all.layout;
      }
    }
  }

  std::size_t index_of(const AccessRecord& access) const {
    return static_cast<std::size_t>(&access - graph_.accesses.data());
  }

  // Finds, for each pass and each other queue, the last pass of that queue for which this pass must
  // wait. There is none if earlier waits already ensure that it is done.
  void find_waits() {
    const std::size_t count = plan_.passes.size();
    s_.waits.assign(count * kQueueClasses, kNobody);
    s_.waited_for.assign(count, 0);
    s_.uses.assign(workspace_.first_sub.back(), {});
    for (std::uint32_t r = 0; r < graph_.resources.size() && !graph_.externals.empty(); ++r) {
      if (graph_.resources[r].external == kNone) continue;
      const ExternalRecord& external = graph_.externals[graph_.resources[r].external];
      Workspace::Queues::Uses before;
      before.owner = initial_queue(external);
      if (external.has_contents) before.layout = external.initial_state.layout;
      for_each_sub_of(r, [&](std::uint32_t sub) { s_.uses[sub] = before; });
    }
    s_.known_at.assign(count * kQueueClasses, -1);
    s_.opened.assign(count, 0);
    s_.opened_at.assign(count, 0);
    for (auto& of_queue : known_) std::fill(std::begin(of_queue), std::end(of_queue), -1);
    for (std::uint32_t position = 0; position < count; ++position) {
      find_wait_of(position);
      learn(position);
    }
  }

  void find_wait_of(std::uint32_t position) {
    const QueueClass queue = plan_.passes[position].queue;
    const auto own = static_cast<std::size_t>(queue);
    std::uint32_t* waits = &s_.waits[position * kQueueClasses];
    for (const AccessRecord& access : graph_.pass_accesses(plan_.passes[position].pass)) {
      const VkImageLayout moved = s_.moved_layouts[index_of(access)];
      for_each_sub(graph_, workspace_, access, [&](std::uint32_t sub) {
        Workspace::Queues::Uses& uses = s_.uses[sub];
        const bool changes =
            (access.flags & kWrite) != 0 ||
            (access.kind() == ResourceKind::texture && uses.layout != access.layout);
        if (uses.changed == kNobody) s_.opened[position] |= opening_of(access, queue);
        for (std::size_t other = 0; other < kQueueClasses; ++other) {
          if (other == own) continue;
          std::uint32_t user = uses.last[other];
          if (!changes)
            user = uses.changed != kNobody && uses.owner == static_cast<QueueClass>(other)
                       ? uses.changed
                       : kNobody;
          if (user == kNobody || known_[own][other] >= static_cast<std::int32_t>(user)) continue;
          waits[other] = waits[other] == kNobody ? user : std::max(waits[other], user);
        }
        if (changes) {
          uses = {};
          uses.changed = position;
          uses.owner = queue;
        }
        uses.last[own] = position;
        uses.layout = moved != VK_IMAGE_LAYOUT_UNDEFINED ? moved : access.layout;
      });
    }
    s_.opened[position] &= static_cast<std::uint8_t>(~known_open_[own]);
    drop_implied(waits);
    for (std::size_t other = 0; other < kQueueClasses; ++other)
      if (waits[other] != kNobody)
        s_.opened[position] &= static_cast<std::uint8_t>(~s_.opened_at[waits[other]]);
  }

  // Drops a wait that another wait of the same pass implies.
  void drop_implied(std::uint32_t* waits) const {
    for (std::size_t other = 0; other < kQueueClasses; ++other) {
      for (std::size_t third = 0; third < kQueueClasses; ++third) {
        if (third == other || waits[third] == kNobody || waits[other] == kNobody) continue;
        if (s_.known_at[waits[third] * kQueueClasses + other] >=
            static_cast<std::int32_t>(waits[other]))
          waits[other] = kNobody;
      }
    }
  }

  // Updates what this pass's queue knows to be done: the passes for which this pass waits, and all
  // passes that those passes' queues knew to be done.
  void learn(std::uint32_t position) {
    const auto own = static_cast<std::size_t>(plan_.passes[position].queue);
    for (std::size_t other = 0; other < kQueueClasses; ++other) {
      const std::uint32_t wait = s_.waits[position * kQueueClasses + other];
      if (wait == kNobody) continue;
      s_.waited_for[wait] = 1;
      known_open_[own] |= s_.opened_at[wait];
      known_[own][other] = std::max(known_[own][other], static_cast<std::int32_t>(wait));
      for (std::size_t third = 0; third < kQueueClasses; ++third)
        known_[own][third] =
            std::max(known_[own][third], s_.known_at[wait * kQueueClasses + third]);
    }
    known_[own][own] = static_cast<std::int32_t>(position);
    known_open_[own] |= s_.opened[position];
    s_.opened_at[position] = known_open_[own];
    for (std::size_t other = 0; other < kQueueClasses; ++other)
      s_.known_at[position * kQueueClasses + other] = known_[own][other];
  }

  // Returns the bit of the queue that used the resource before the frame, if the access must wait
  // for that use, and 0 otherwise.
  std::uint8_t opening_of(const AccessRecord& access, QueueClass queue) const {
    const ResourceRecord& resource = graph_.resources[access.resource];
    if (resource.external == kNone) return 0;
    const ExternalRecord& external = graph_.externals[resource.external];
    const QueueClass owner = initial_queue(external);
    // An initial state with stages means that earlier work on its queue must be done. Even if its
    // writes are visible to reads, they are so on that queue only.
    if (owner == queue || external.initial_state.stages == 0) return 0;
    return static_cast<std::uint8_t>(1u << static_cast<unsigned>(owner));
  }

  template <typename Function>
  void for_each_sub_of(std::uint32_t resource, Function&& f) const {
    const auto& first = workspace_.first_sub;
    for (std::uint32_t sub = first[resource]; sub < first[resource + 1]; ++sub) f(sub);
  }

  // Assigns passes to submissions, which are numbered in order of their first passes.
  void cut() {
    open_before();
    std::uint32_t open[kQueueClasses] = {kNobody, kNobody, kNobody};
    s_.submission_of.resize(plan_.passes.size());
    for (std::uint32_t position = 0; position < plan_.passes.size(); ++position) {
      const QueueClass queue = plan_.passes[position].queue;
      std::uint32_t& current = open[static_cast<std::size_t>(queue)];
      const std::uint32_t* waits = &s_.waits[position * kQueueClasses];
      const bool has_waits = s_.opened[position] != 0 ||
                             std::any_of(waits, waits + kQueueClasses,
                                         [](std::uint32_t wait) { return wait != kNobody; });
      if (current == kNobody || has_waits) {
        current = static_cast<std::uint32_t>(plan_.submissions.size());
        Submission submission;
        submission.queue = queue;
        submission.first_wait = static_cast<std::uint32_t>(plan_.waits.size());
        plan_.submissions.push_back(submission);
        for (std::size_t other = 0; other < kQueueClasses; ++other) {
          if (s_.opened[position] & (1u << other)) add_wait(s_.opening[other]);
          if (waits[other] != kNobody) add_wait(s_.submission_of[waits[other]]);
        }
      }
      s_.submission_of[position] = current;
      ++plan_.submissions[current].pass_count;
      if (s_.waited_for[position]) current = kNobody;
    }
  }

  void add_wait(std::uint32_t submission) {
    plan_.waits.push_back({submission, 0});
    ++plan_.submissions.back().wait_count;
  }

  // Adds a submission without passes on each queue on which a resource was last used before the
  // frame, if the frame uses the resource on another queue. That queue waits for the submission.
  void open_before() {
    std::fill(std::begin(s_.opening), std::end(s_.opening), kNobody);
    std::uint8_t opened = 0;
    for (const std::uint8_t queues : s_.opened) opened |= queues;
    for (std::size_t queue = 0; queue < kQueueClasses; ++queue) {
      if (!(opened & (1u << queue))) continue;
      s_.opening[queue] = static_cast<std::uint32_t>(plan_.submissions.size());
      Submission submission;
      submission.queue = static_cast<QueueClass>(queue);
      plan_.submissions.push_back(submission);
    }
  }

  // Returns the queue on which the resource was last used before the frame, or graphics if the
  // device has no queue of that class.
  QueueClass initial_queue(const ExternalRecord& external) const {
    return family(external.queue) == kNone ? QueueClass::graphics : external.queue;
  }

  // Reorders the passes by submission, so that each submission is a range of positions.
  void regroup() {
    std::uint32_t next = 0;
    for (Submission& submission : plan_.submissions) {
      submission.first_pass = next;
      next += submission.pass_count;
      submission.pass_count = 0;
    }
    s_.moved.resize(plan_.passes.size());
    s_.known.resize(s_.known_at.size());
    s_.new_position.resize(plan_.passes.size());
    for (std::uint32_t position = 0; position < plan_.passes.size(); ++position) {
      Submission& submission = plan_.submissions[s_.submission_of[position]];
      const std::uint32_t to = submission.first_pass + submission.pass_count++;
      s_.moved[to] = plan_.passes[position];
      s_.moved[to].submission = s_.submission_of[position];
      s_.new_position[position] = to;
    }
    // Translates the known positions to the new numbering. The passes of a queue keep their order.
    for (std::uint32_t position = 0; position < plan_.passes.size(); ++position) {
      for (std::size_t other = 0; other < kQueueClasses; ++other) {
        const std::int32_t old = s_.known_at[position * kQueueClasses + other];
        s_.known[s_.new_position[position] * kQueueClasses + other] =
            old < 0 ? -1
                    : static_cast<std::int32_t>(s_.new_position[static_cast<std::size_t>(old)]);
      }
    }
    plan_.passes.swap(s_.moved);
  }

  // Chooses the queue on which the frame leaves each history, and the submission of the graphics
  // queue that brings imports and histories into their final states. The graphics queue waits for
  // the last uses of imports, because the next frame expects them on that queue, and of histories
  // that several queues used.
  void close() {
    std::uint32_t last[kQueueClasses] = {kNobody, kNobody, kNobody};
    bool imports = false;
    s_.last_queue.assign(graph_.resources.size(), QueueClass::graphics);
    for (std::uint32_t r = 0; r < graph_.resources.size() && !graph_.externals.empty(); ++r) {
      const ResourceRecord& resource = graph_.resources[r];
      if (resource.external == kNone) continue;
      const ExternalRecord& external = graph_.externals[resource.external];
      imports |= resource.origin == Origin::imported;
      if (resource.origin == Origin::imported ? !external.has_final_state : stays_on_one_queue(r))
        continue;
      for_each_sub_of(r, [&](std::uint32_t sub) {
        for (std::size_t other = 1; other < kQueueClasses; ++other) {
          const std::uint32_t user = s_.uses[sub].last[other];
          if (user == kNobody || known_[0][other] >= static_cast<std::int32_t>(user)) continue;
          last[other] = last[other] == kNobody ? user : std::max(last[other], user);
        }
      });
    }
    drop_implied(last);
    const auto& submissions = plan_.submissions;
    workspace_.final_submission = kNobody;
    for (std::uint32_t s = 0; s < submissions.size(); ++s)
      if (submissions[s].queue == QueueClass::graphics) workspace_.final_submission = s;
    const bool waits = last[1] != kNobody || last[2] != kNobody;
    if (!waits && (workspace_.final_submission != kNobody || !imports)) return;
    workspace_.final_submission = static_cast<std::uint32_t>(submissions.size());
    Submission submission;
    submission.first_pass = static_cast<std::uint32_t>(plan_.passes.size());
    submission.first_wait = static_cast<std::uint32_t>(plan_.waits.size());
    plan_.submissions.push_back(submission);
    for (std::size_t other = 1; other < kQueueClasses; ++other)
      if (last[other] != kNobody) add_wait(s_.submission_of[last[other]]);
  }

  // Returns whether the frame can leave a history on one queue without final barriers, and sets
  // that queue.
  bool stays_on_one_queue(std::uint32_t resource) {
    unsigned queues = 0;
    for_each_sub_of(resource, [&](std::uint32_t sub) {
      const auto& uses = s_.uses[sub];
      for (std::size_t queue = 0; queue < kQueueClasses; ++queue)
        queues |= uses.last[queue] != kNobody ? 1u << queue : 0u;
      if (uses.layout != VK_IMAGE_LAYOUT_UNDEFINED)
        queues |= 1u << static_cast<unsigned>(uses.owner);
    });
    const bool single = workspace_.first_sub[resource + 1] - workspace_.first_sub[resource] == 1;
    if (queues != 1 && !(single && std::has_single_bit(queues))) return queues == 0;
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
            if (s_.known[next * kQueueClasses + own] >= static_cast<std::int32_t>(position)) break;
            last = next;
          }
          s_.taken_until[position] = std::max(s_.taken_until[position], last);
        }
      }
    }
  }

  // The last position on each other queue (second index) that is known to be done when a queue
  // (first index) reaches its current pass, or -1.
  std::int32_t known_[kQueueClasses][kQueueClasses] = {};
  // For each queue: bits of the queues whose opening submission it knows to be done. A pass knows
  // it of its own queue, and a pass that waits for the pass knows it too.
  std::uint8_t known_open_[kQueueClasses] = {1, 2, 4};
  const GraphDescription& graph_;
  const Limits& limits_;
  Workspace& workspace_;
  Plan& plan_;
  Workspace::Queues& s_;
};

}  // namespace

void assign_queues(const GraphDescription& graph, const Limits& limits, Workspace& workspace,
                   Plan& plan) {
  QueueAssigner(graph, limits, workspace, plan).run();
}

}  // namespace alcove::framegraph
