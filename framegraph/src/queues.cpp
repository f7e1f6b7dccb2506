// Queues: gives each pass its queue, and divides the order of execution into submissions at the
// points where one queue must wait for another. It also finds, for each pass, the last pass of
// every other queue that has finished before it. This decides how long the memory of a transient is
// in use.
//
// A submission begins with a pass that waits for another queue, and ends with a pass for which
// another queue waits, so that no queue waits longer than it must. With one queue there is one
// submission. Two passes on different queues depend on each other when they use one subresource,
// even if both only read it, because its layout or its owning queue family may have to change
// between them.
#include <algorithm>

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
    find_waits();
    cut();
    regroup();
    close();
  }

 private:
  static constexpr std::uint32_t kNobody = kNone;

  std::uint32_t family(QueueClass queue) const {
    return limits_.queue_families[static_cast<std::size_t>(queue)];
  }

  // Assigns each pass to the queue of its class, or to the graphics queue if the device has no
  // queue of that class.
  void choose_queues() {
    plan_.passes.resize(workspace_.order.size());
    workspace_.several_queues = false;
    PlannedPass* planned = plan_.passes.data();
    for (const std::uint32_t pass : workspace_.order) {
      const QueueClass wanted = graph_.passes[pass].queue;
      *planned = {};
      planned->pass = pass;
      planned->queue = family(wanted) != kNone ? wanted : QueueClass::graphics;
      workspace_.several_queues |=
          planned->queue != QueueClass::graphics || takes_from_others(pass);
      ++planned;
    }
  }

  // Returns whether a pass uses a resource whose last use before the frame was on a queue other
  // than graphics.
  bool takes_from_others(std::uint32_t pass) const {
    bool takes = false;
    for_each_live(graph_, plan_, pass, [&](const AccessRecord& access) {
      takes |= given_by(access.resource, QueueClass::graphics) != 0;
    });
    return takes;
  }

  // Finds, for each pass and each other queue, the last pass of that queue for which this pass must
  // wait. There is none if earlier waits already ensure that it is done.
  void find_waits() {
    const std::size_t count = plan_.passes.size();
    s_.waits.assign(count * kQueueClasses, kNobody);
    s_.waited_for.assign(count, 0);
    s_.last_user.assign(workspace_.first_sub.back(), kNobody);
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
    const auto own = static_cast<std::size_t>(plan_.passes[position].queue);
    std::uint32_t* waits = &s_.waits[position * kQueueClasses];
    for_each_live_sub(position, [&](std::uint32_t resource, std::uint32_t sub) {
      const std::uint32_t user = s_.last_user[sub];
      s_.last_user[sub] = position;
      if (user == kNobody) s_.opened[position] |= given_by(resource, plan_.passes[position].queue);
      if (user == kNobody || user == position ||
          plan_.passes[user].queue == plan_.passes[position].queue)
        return;
      const auto other = static_cast<std::size_t>(plan_.passes[user].queue);
      if (known_[own][other] >= static_cast<std::int32_t>(user)) return;
      waits[other] = waits[other] == kNobody ? user : std::max(waits[other], user);
    });
    s_.opened[position] &= static_cast<std::uint8_t>(~known_open_[own]);
    drop_implied(waits);
    for (std::size_t other = 0; other < kQueueClasses; ++other) {
      if (waits[other] != kNobody)
        s_.opened[position] &= static_cast<std::uint8_t>(~s_.opened_at[waits[other]]);
    }
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

  // Returns the bit of the queue that used the resource before the frame, or 0 if that queue is
  // `user`.
  std::uint8_t given_by(std::uint32_t resource, QueueClass user) const {
    const std::uint32_t external = graph_.resources[resource].external;
    if (external == kNone) return 0;
    const ExternalRecord& record = graph_.externals[external];
    const QueueClass owner = initial_queue(record);
    if (owner == user || (!record.has_contents && record.initial_state.stages == 0)) return 0;
    return static_cast<std::uint8_t>(1u << static_cast<unsigned>(owner));
  }

  // Calls f(resource, subresource) for every subresource that a pass uses.
  template <typename Function>
  void for_each_live_sub(std::uint32_t position, Function&& f) const {
    for_each_live(graph_, plan_, plan_.passes[position].pass, [&](const AccessRecord& access) {
      for_each_sub(graph_, workspace_, access, [&](std::uint32_t sub) { f(access.resource, sub); });
    });
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
    plan_.waits.push_back({submission, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT});
    ++plan_.submissions.back().wait_count;
  }

  // Adds a submission without passes on each queue that must release a resource first. That is a
  // queue on which a resource was last used before the frame, if the frame uses the resource on
  // another queue. The other queue waits for the submission.
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
    for (std::uint32_t position = 0; position < plan_.passes.size(); ++position)
      workspace_.order[position] = plan_.passes[position].pass;
  }

  // Makes the graphics queue wait for the last uses of imports, because the next frame expects
  // imports on that queue, and of histories with several subresources, which may be in different
  // states.
  void close() {
    if (graph_.externals.empty()) return;
    std::uint32_t last[kQueueClasses] = {kNobody, kNobody, kNobody};
    for (std::uint32_t r = 0; r < graph_.resources.size(); ++r) {
      const std::uint32_t external = graph_.resources[r].external;
      if (external == kNone) continue;
      const std::uint32_t subs = workspace_.first_sub[r + 1] - workspace_.first_sub[r];
      if (graph_.resources[r].origin == Origin::history &&
          !graph_.externals[external].has_final_state && subs == 1)
        continue;
      for (std::uint32_t sub = workspace_.first_sub[r]; sub < workspace_.first_sub[r + 1]; ++sub) {
        const std::uint32_t user = s_.last_user[sub];
        if (user == kNobody) continue;
        std::uint32_t& there = last[static_cast<std::size_t>(s_.moved[user].queue)];
        there = there == kNobody ? user : std::max(there, user);
      }
    }
    for (std::size_t other = 1; other < kQueueClasses; ++other) {
      if (last[other] != kNobody && known_[0][other] >= static_cast<std::int32_t>(last[other]))
        last[other] = kNobody;
    }
    last[0] = kNobody;
    drop_implied(last);
    Submission submission;
    submission.first_pass = static_cast<std::uint32_t>(plan_.passes.size());
    submission.first_wait = static_cast<std::uint32_t>(plan_.waits.size());
    plan_.submissions.push_back(submission);
    for (std::size_t other = 1; other < kQueueClasses; ++other) {
      if (last[other] != kNobody) add_wait(s_.submission_of[last[other]]);
    }
  }

  // The last position on each other queue (second index) that is known to be done when a queue
  // (first index) reaches its current pass, or -1.
  std::int32_t known_[kQueueClasses][kQueueClasses] = {};
  // For each queue: bits of the queues whose opening submission it knows to be done.
  std::uint8_t known_open_[kQueueClasses] = {};
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

std::uint32_t taken_until(const Workspace& workspace, const Plan& plan, std::uint32_t position) {
  const auto own = static_cast<std::size_t>(plan.passes[position].queue);
  std::uint32_t until = position;
  for (std::size_t other = 0; other < kQueueClasses; ++other) {
    if (other == own) continue;
    // Later passes of the other queue may run at the same time, unless their queue knows this pass
    // to be done.
    for (std::uint32_t later = position + 1; later < plan.passes.size(); ++later) {
      if (static_cast<std::size_t>(plan.passes[later].queue) != other) continue;
      if (workspace.queues.known[later * kQueueClasses + own] >=
          static_cast<std::int32_t>(position))
        break;
      until = std::max(until, later);
    }
  }
  return until;
}

}  // namespace alcove::framegraph
