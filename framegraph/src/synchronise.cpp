// Synchronisation: goes through the passes in order of execution, and orders each use after the
// group of uses before it in the chain of its subresource, or after the uses of the resources that
// occupied its memory before. A dependency can be met by a batch of barriers at any position after
// the work that it waits for, and up to the pass that needs it. It goes into the last batch if that
// batch is late enough, and otherwise into a new batch immediately before the pass. Placing each
// new batch as late as possible gives the least number of batches. A barrier covers all uses of its
// group on its queue, so that later reads need none.
#include <algorithm>
#include <span>
#include <utility>

#include "workspace.h"

namespace alcove::framegraph {
namespace {

// Points in time within a frame, in half positions: the batch of barriers before the pass at
// position p has the time 2p, and the pass itself has the time 2p + 1.
constexpr std::int32_t kBeforeFrame = -1;
constexpr std::int32_t kNever = -2;

std::int32_t batch_time(std::uint32_t position) { return static_cast<std::int32_t>(2 * position); }

std::int32_t pass_time(std::uint32_t position) {
  return position == kNone ? kBeforeFrame : batch_time(position) + 1;
}

// Returns the stages of a use for which a semaphore wait is made.
VkPipelineStageFlags2 waited_stages(VkPipelineStageFlags2 stages) {
  stages &= ~(VK_PIPELINE_STAGE_2_HOST_BIT | VK_PIPELINE_STAGE_2_BOTTOM_OF_PIPE_BIT);
  return stages != 0 ? stages : VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
}

// Returns an access mask in which the bit that stands for every read is replaced by all bits.
constexpr VkAccessFlags2 kEveryAccess = ~VkAccessFlags2{0};
VkAccessFlags2 every_read(VkAccessFlags2 access) {
  return (access & VK_ACCESS_2_MEMORY_READ_BIT) != 0 ? kEveryAccess : access;
}

class Synchroniser {
 public:
  using Source = Workspace::Source;

  Synchroniser(const GraphDescription& graph, Workspace& workspace, Plan& plan)
      : graph_(graph), workspace_(workspace), plan_(plan) {}

  void run() {
    for (auto& waits : last_waits_) std::fill(std::begin(waits), std::end(waits), kNone);
    find_last_owners();
    const auto count = static_cast<std::uint32_t>(plan_.passes.size());
    const auto& first_use = workspace_.chain.first_use;
    for (std::uint32_t s = 0; s < plan_.submissions.size(); ++s) {
      const Submission submission = plan_.submissions[s];
      queue_ = submission.queue;
      if (several_) begin_submission(s);
      std::uint32_t position = submission.first_pass;
      for (std::uint32_t left = submission.pass_count; left > 0; --left) {
        const std::uint32_t next = plan_.passes[position].next;
        for (std::uint32_t u = first_use[position]; u < first_use[position + 1]; ++u)
          order(uses_[u], position);
        if (batch_time_ == batch_time(position))
          plan_.passes[position].batch = static_cast<std::uint32_t>(plan_.batches.size() - 1);
        if (several_) end_pass(position);
        position = next;
      }
    }
    end_frame(count);
  }

 private:
  std::size_t queues() const { return several_ ? kQueueClasses : 1; }

  // Finds, for each byte of the heaps, the last transient that occupies it in a frame: the previous
  // frame had the same plan. The loop goes from the last transient to the first, and ends when each
  // byte has an owner.
  void find_last_owners() {
    s_.memory.resize(std::max(s_.memory.size(), plan_.heaps.size()));
    for (MemoryMap& map : s_.memory) map.clear();
    s_.formers.resize(graph_.resources.size() * queues());
    s_.owns_memory.assign(graph_.resources.size(), 0);
    VkDeviceSize unclaimed = 0;
    for (const Heap& heap : plan_.heaps) unclaimed += heap.size;
    const auto& transients = workspace_.transients;
    for (std::size_t i = transients.size(); i-- > 0 && unclaimed > 0;) {
      const Placement& placed = plan_.placements[transients[i]];
      unclaimed -= claim_free(s_.memory[placed.heap],
                              {placed.offset, placed.offset + placed.size, transients[i], true});
    }
    std::fill(std::begin(last_position_), std::end(last_position_), kNone);
    for (std::uint32_t position = 0; position < plan_.passes.size() && several_; ++position)
      last_position_[static_cast<std::size_t>(plan_.passes[position].queue)] = position;
  }

  // Collects the last uses of all resources that occupied the bytes of a transient before.
  void take_over_memory(std::uint32_t resource) {
    const Placement& placed = plan_.placements[resource];
    Source* const formers = &s_.formers[resource * queues()];
    std::fill(formers, formers + queues(), Source{.time = kNever});
    take_over(s_.memory[placed.heap], {placed.offset, placed.offset + placed.size, resource, false},
              [&](const Segment& segment) {
                const std::uint32_t* const subs = workspace_.first_sub.data() + segment.resource;
                for (std::uint32_t sub = subs[0]; sub < subs[1]; ++sub)
                  for (std::size_t queue = 0; queue < queues(); ++queue)
                    add_group(formers[queue], static_cast<QueueClass>(queue),
                              workspace_.chain.tails[sub], segment.before);
              });
  }

  // Adds the uses of a group to the work after which a use on `queue` comes. `before` says that
  // they are those of the previous frame.
  void add_group(Source& source, QueueClass queue, std::uint32_t group, bool before) const {
    for (; group != kNone; group = uses_[group].sibling) {
      const Use& use = uses_[group];
      if (use.queue == queue) {
        source.stages |= use.stages;
        if (use.writes) source.access |= use.access & kWriteBits;
        source.time = std::max(source.time, before ? kBeforeFrame : pass_time(use.last));
      } else if (before && is_known_after_frame(use, queue)) {
        source.by_last_frame = true;
      } else if (use.stages != 0) {
        source.by_wait = true;
        if (before ||
            (use.is_initial_state() && graph_.resources[use.resource].origin == Origin::history))
          source.frame_before |= static_cast<std::uint8_t>(1u << static_cast<unsigned>(use.queue));
      }
    }
  }

  // Returns whether a queue has waited for a use on another queue by the end of a frame, or does
  // not run in the frame.
  bool is_known_after_frame(const Use& use, QueueClass queue) const {
    const std::uint32_t last = last_position_[static_cast<std::size_t>(queue)];
    return last == kNone || workspace_.queues.known[last][static_cast<std::size_t>(use.queue)] >=
                                static_cast<std::int32_t>(use.last);
  }

  // Orders a use after its source, of which there are four kinds.
  void order(const Use& use, std::uint32_t position) {
    const Use& head = uses_[use.head];
    const bool is_head = &use == &head;
    if (position == plan_.passes.size() && !is_head) order_after_reads(use, position);
    if (head.is_first_of_transient())
      order_after_former_owners(use, is_head, position);
    else if (head.is_initial_state())
      order_after_initial_state(use, head, position);
    else if (!is_head && changes_layout(workspace_, head))
      order_after_head(use, head, position);
    else
      order_after_group(use, head, position);
  }

  // The first group of a transient comes after the uses of the resources whose memory it takes.
  void order_after_former_owners(const Use& use, bool is_head, std::uint32_t position) {
    if (!std::exchange(s_.owns_memory[use.resource], 1)) take_over_memory(use.resource);
    const Source& former = s_.formers[use.resource * queues() + static_cast<std::size_t>(queue_)];
    order_after(former, use, VK_IMAGE_LAYOUT_UNDEFINED, is_head && changes_layout(workspace_, use),
                true, position);
  }

  // A read in the layout of the initial state comes after the work before the frame.
  void order_after_initial_state(const Use& use, const Use& initial, std::uint32_t position) {
    Source source{.time = kNever};
    add_group(source, queue_, use.head, false);
    source.access = 0;
    source.time = kBeforeFrame;
    const bool is_own = initial.queue == queue_;
    if (is_own) source.stages = initial.stages;
    order_after(source, use, initial.layout, false, is_own && !is_visible(use, initial), position);
  }

  // A read comes after the change of the layout by the head of its group. On the queue of the head,
  // the barrier of that change covers it.
  void order_after_head(const Use& use, const Use& head, std::uint32_t position) {
    if (head.queue != queue_)
      return order_after({.time = kNever, .by_wait = true}, use, head.layout, false, false,
                         position);
    const auto move = std::find(s_.moves.begin(), s_.moves.end(), use.head);
    if (move == s_.moves.end()) return;
    s_.moves.erase(move);
    apply_moves({&use.head, 1}, position);
  }

  // Any other use comes after the group before its own.
  void order_after_group(const Use& use, const Use& head, std::uint32_t position) {
    const Use& before = uses_[head.previous];
    Source source{.time = kNever};
    add_group(source, queue_, head.previous, false);
    order_after(source, use, before.layout, changes_layout(workspace_, head),
                use.writes || before.writes, position);
  }

  void order_after(const Source& source, const Use& use, VkImageLayout layout, bool changes,
                   bool needs_barrier, std::uint32_t position) {
    if (several_) wait_in(use.stages, source, position);
    // A semaphore wait covers all commands, but not the host.
    const bool by_host =
        source.by_wait && source.stages == 0 && (use.stages & VK_PIPELINE_STAGE_2_HOST_BIT) != 0;
    if (changes)
      change_layout(use, source, layout, position);
    else if (by_host)
      add_memory(source.time, position,
                 {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0, use.stages, use.access});
    else if (needs_barrier && source.stages != 0 && use.stages != 0)
      add_memory(source.time, position, {source.stages, source.access, use.stages, use.access});
  }

  // Returns whether earlier writes are visible to a read because they are visible to the read
  // accesses of the initial state.
  static bool is_visible(const Use& use, const Use& initial) {
    const VkAccessFlags2 access = every_read(initial.access);
    const bool every_stage = (initial.stages & VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT) != 0;
    const VkPipelineStageFlags2 stages =
        access == kEveryAccess && every_stage ? ~VK_PIPELINE_STAGE_2_HOST_BIT : initial.stages;
    return initial.access != 0 && (use.stages & ~stages) == 0 && (use.access & ~access) == 0;
  }

  // Functions for frames that use several queues.

  // Sets the point before which no barrier can be placed, and the last waits of the queue.
  void begin_submission(std::uint32_t index) {
    const Submission& submission = plan_.submissions[index];
    earliest_ = batch_time(submission.first_pass) - 1;
    batch_time_ = kNever;
    auto& waits = last_waits_[static_cast<std::size_t>(submission.queue)];
    for (std::uint32_t w = submission.first_wait; w < submission.first_wait + submission.wait_count;
         ++w)
      waits[static_cast<std::size_t>(plan_.submissions[plan_.waits[w].submission].queue)] = w;
  }

  // Makes the waits that order a use in these stages after work of other queues cover the stages.
  void wait_in(VkPipelineStageFlags2 stages, const Source& source, std::uint32_t position) {
    stages = waited_stages(stages);
    if (source.frame_before != 0) wait_for_frame_before(position, source.frame_before);
    if (source.by_wait) add_stages(stages);
    if (source.by_last_frame) next_frame_[static_cast<std::size_t>(queue_)] |= stages;
  }

  // Adds stages to the last waits of the current queue. An earlier use on another queue is known to
  // be done by the last wait for that queue, or by the last wait for a third one that waited for
  // it.
  void add_stages(VkPipelineStageFlags2 stages) {
    for (const std::uint32_t wait : last_waits_[static_cast<std::size_t>(queue_)])
      if (wait != kNone) plan_.waits[wait].stages |= stages;
  }

  // Makes a submission wait for the previous frame's work on these queues. The wait is left out for
  // a queue if an earlier submission has it, or the pass waits for a pass of this frame there.
  void wait_for_frame_before(std::uint32_t position, std::uint8_t queues) {
    const bool is_pass = position < plan_.passes.size();
    for (std::size_t queue = 0; queue < kQueueClasses && is_pass; ++queue)
      if (workspace_.queues.known[position][queue] >= Workspace::kOpening)
        queues &= static_cast<std::uint8_t>(~(1u << queue));
    std::uint8_t& waited = frame_before_[static_cast<std::size_t>(queue_)];
    const std::uint32_t submission =
        is_pass ? plan_.passes[position].submission : workspace_.final_submission;
    plan_.submissions[submission].frame_before |= static_cast<std::uint8_t>(queues & ~waited);
    waited |= queues;
  }

  // Notes the moves after the writes of a pass. After the last pass of a submission, adds those
  // that no read of the submission has needed.
  void end_pass(std::uint32_t position) {
    const auto is_before = [](const Use& move, std::uint32_t at) { return move.first < at; };
    auto move = std::lower_bound(uses_.begin() + workspace_.chain.first_move, uses_.end(), position,
                                 is_before);
    for (; move != uses_.end() && move->first == position; ++move) s_.moves.push_back(move->head);
    if (plan_.passes[position].next != kNone || s_.moves.empty()) return;
    batch_time_ = kNever;
    const std::span<const std::uint32_t> moves = s_.moves;
    for (std::size_t i = 0, end = 0; i < moves.size(); i = end) {
      while (end < moves.size() && uses_[moves[end]].resource == uses_[moves[i]].resource) ++end;
      apply_moves(moves.subspan(i, end - i), position + 1);
    }
    plan_.submissions[plan_.passes[position].submission].end_batch =
        static_cast<std::uint32_t>(plan_.batches.size() - 1);
    s_.moves.clear();
    batch_time_ = kNever;  // No later dependency can use this batch.
  }

  // Adds the changes of these moves of one resource, for all reads on this queue.
  void apply_moves(std::span<const std::uint32_t> moves, std::uint32_t position) {
    Use scope;
    for (const std::uint32_t move : moves)
      for (std::uint32_t u = uses_[move].sibling; u != kNone; u = uses_[u].sibling)
        if (uses_[u].queue == queue_) {
          scope.stages |= uses_[u].stages;
          scope.access |= uses_[u].access;
        }
    for (const std::uint32_t index : moves) {
      Use move = uses_[index];
      const Use& write = uses_[move.previous];
      // Without reads on this queue, the barrier needs a second scope all the same, by which the
      // signal of the submission comes after it.
      move.stages = scope.stages != 0 ? scope.stages : write.stages;
      move.access = scope.access;
      change_layout(move, {write.stages, write.access & kWriteBits, pass_time(write.last)},
                    write.layout, position);
    }
  }

  void end_frame(std::uint32_t count) {
    const std::uint32_t final = workspace_.final_submission;
    queue_ = QueueClass::graphics;
    if (several_) {
      if (final != kNone && plan_.submissions[final].pass_count == 0) begin_submission(final);
      earliest_ = batch_time(count) - 1;
    }
    if (!graph_.externals.empty()) apply_final_states(count);
    for (std::size_t queue = 0; queue < kQueueClasses && several_; ++queue) {
      queue_ = static_cast<QueueClass>(queue);
      add_stages(next_frame_[queue]);
    }
    plan_.final_submission = final;
    plan_.final_batch = batch_time_ == batch_time(count) && !plan_.batches.empty()
                            ? static_cast<std::uint32_t>(plan_.batches.size() - 1)
                            : kNone;
  }

  void apply_final_states(std::uint32_t end) {
    const auto& first_use = workspace_.chain.first_use;
    s_.written.assign(workspace_.first_sub.back(), 0);
    for (const Use& use : uses_) s_.written[use.sub] |= use.writes && use.first < end;
    for (std::uint32_t u = first_use[end]; u < workspace_.chain.first_move; ++u)
      order(uses_[u], end);
    for (std::uint32_t r = 0; r < graph_.resources.size(); ++r) {
      const ResourceRecord& resource = graph_.resources[r];
      if (plan_.placements[r].first != kNone && resource.origin == Origin::history)
        leave_history_slot(r);
    }
  }

  // Orders the other reads of its group before a state after the frame. Work after the frame waits
  // only for the stages of that state, so that a barrier from the other reading stages to those
  // stages is added.
  void order_after_reads(const Use& use, std::uint32_t end) {
    Transition transition;
    transition.dst_stages = use.stages;
    std::int32_t time = kBeforeFrame;
    for (std::uint32_t u = use.head; u != kNone; u = uses_[u].sibling) {
      const Use& read = uses_[u];
      if (&read == &use || read.stages == 0) continue;
      if (read.queue != queue_) add_stages(waited_stages(use.stages));
      if (read.queue != queue_ || (read.stages & ~use.stages) == 0) continue;
      transition.src_stages |= read.stages & ~use.stages;
      time = std::max(time, pass_time(read.last));
    }
    if (transition.src_stages != 0 && use.stages != 0 &&
        (use.stages & VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT) == 0)
      add_memory(time, end, transition);
  }

  // Finds the state in which the frame leaves a history slot. It names no reads: over 3,000 random
  // plans, naming those that see the last write saves no barrier command.
  void leave_history_slot(std::uint32_t resource) {
    const std::uint32_t* const subs = workspace_.first_sub.data() + resource;
    FinalState final{resource, {}, QueueClass::graphics, WriteCoverage::nothing};
    if (several_) final.queue = workspace_.queues.last_queue[resource];
    queue_ = final.queue;
    std::uint32_t written = 0;
    bool elsewhere = false;
    for (std::uint32_t sub = subs[0]; sub < subs[1]; ++sub) {
      written += s_.written[sub];
      const std::uint32_t tail = workspace_.chain.tails[sub];
      VkPipelineStageFlags2 stages = 0;
      for (std::uint32_t u = tail; u != kNone; u = uses_[u].sibling) {
        if (uses_[u].queue == queue_)
          stages |= uses_[u].stages;
        else
          elsewhere = elsewhere || uses_[u].stages != 0;
      }
      const Use& last = uses_[tail];
      if (last.writes && stages != 0) final.state.access |= last.access & kWriteBits;
      // Work on another queue was waited for by all commands.
      if (stages == 0 && last.queue != queue_) stages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
      final.state.stages |= stages;
      final.state.layout = last.layout;
    }
    if (written != 0)
      final.written = written == subs[1] - subs[0] ? WriteCoverage::whole : WriteCoverage::part;
    if (elsewhere) add_stages(final.state.stages);
    plan_.finals.push_back(final);
  }

  void change_layout(const Use& use, const Source& source, VkImageLayout from,
                     std::uint32_t position) {
    Batch& batch = batch_after(source.time, position);
    Transition& transition = plan_.transitions.emplace_back();
    transition.src_stages = source.stages;
    transition.src_access = source.access;
    if (source.by_wait || source.by_last_frame) {
      // The change comes after a semaphore wait if it comes after stages in which the wait is made.
      if (transition.src_stages == 0) transition.src_stages = waited_stages(use.stages);
      wait_in(transition.src_stages, source, position);
    }
    transition.dst_stages = use.stages;
    transition.dst_access = use.access;
    transition.resource = use.resource;
    transition.old_layout = use.discards ? VK_IMAGE_LAYOUT_UNDEFINED : from;
    transition.new_layout = use.layout;
    transition.range = {0, 1, 0, 1};
    if (const std::uint32_t index = use.sub - workspace_.first_sub[use.resource]; index != 0) {
      const std::uint32_t mips = graph_.resources[use.resource].mips;
      transition.range.base_mip = static_cast<std::uint16_t>(index % mips);
      transition.range.base_layer = static_cast<std::uint16_t>(index / mips);
    }
    ++batch.count;
    while (batch.count >= 2 && extend(*(plan_.transitions.end() - 2), plan_.transitions.back())) {
      plan_.transitions.pop_back();
      --batch.count;
    }
  }

  // Extends the barrier `last` to also cover the mips or layers of `next`, if both barriers are of
  // one resource, cover adjacent subresources, and make the same change. Returns whether it did.
  static bool extend(Transition& last, const Transition& next) {
    const Range& a = last.range;
    const Range& b = next.range;
    const bool alike = last.resource == next.resource && last.src_stages == next.src_stages &&
                       last.src_access == next.src_access && last.dst_stages == next.dst_stages &&
                       last.dst_access == next.dst_access && last.old_layout == next.old_layout &&
                       last.new_layout == next.new_layout;
    const bool next_mips =
        a.base_layer == b.base_layer && a.layers == b.layers && a.base_mip + a.mips == b.base_mip;
    const bool next_layers =
        a.base_mip == b.base_mip && a.mips == b.mips && a.base_layer + a.layers == b.base_layer;
    if (!alike || !(next_mips || next_layers)) return false;
    if (next_mips)
      last.range.mips = static_cast<std::uint16_t>(a.mips + b.mips);
    else
      last.range.layers = static_cast<std::uint16_t>(a.layers + b.layers);
    return true;
  }

  void add_memory(std::int32_t time, std::uint32_t position, const Transition& transition) {
    Batch& batch = batch_after(time, position);
    for (const std::uint32_t i : s_.batch_memories) {
      Transition& other = plan_.transitions[i];
      if (other.src_stages != transition.src_stages && other.dst_stages != transition.dst_stages)
        continue;
      other.src_stages |= transition.src_stages;
      other.src_access |= transition.src_access;
      other.dst_stages |= transition.dst_stages;
      other.dst_access |= transition.dst_access;
      return;
    }
    s_.batch_memories.push_back(static_cast<std::uint32_t>(plan_.transitions.size()));
    plan_.transitions.push_back(transition);
    ++batch.count;
  }

  // Returns the batch of barriers for a dependency on work that ends at `time`: the last batch if
  // it comes after that work, otherwise a new batch before the pass at `position`.
  Batch& batch_after(std::int32_t time, std::uint32_t position) {
    time = std::max(time, earliest_);
    if (batch_time_ < time) {
      batch_time_ = batch_time(position);
      plan_.batches.push_back({static_cast<std::uint32_t>(plan_.transitions.size()), 0});
      s_.batch_memories.clear();
    }
    return plan_.batches.back();
  }

  const GraphDescription& graph_;
  Workspace& workspace_;
  Plan& plan_;
  std::vector<Use>& uses_ = workspace_.chain.uses;
  Workspace::Synchronise& s_ = workspace_.synchronise;
  const bool several_ = workspace_.several_queues;
  std::int32_t batch_time_ = kNever;  // time of the last batch
  // The start of the current pass's submission, before which no barrier can be placed.
  std::int32_t earliest_ = kBeforeFrame;
  QueueClass queue_ = QueueClass::graphics;  // of the current pass
  // For each queue and each other queue: the last wait for it, an index into Plan::waits.
  std::uint32_t last_waits_[kQueueClasses][kQueueClasses] = {};
  // For each queue: stages that use what the waits of the previous frame have waited for.
  VkPipelineStageFlags2 next_frame_[kQueueClasses] = {};
  // For each queue: bits of the queues for whose work of the previous frame it has already waited.
  std::uint8_t frame_before_[kQueueClasses] = {};
  std::uint32_t last_position_[kQueueClasses] = {};  // for each queue: position of its last pass
};

}  // namespace

void synchronise(const GraphDescription& graph, Workspace& workspace, Plan& plan) {
  Synchroniser(graph, workspace, plan).run();
}

}  // namespace alcove::framegraph
