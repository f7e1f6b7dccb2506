// Synchronisation: follows every subresource through the passes in order of execution, and adds the
// barriers. A dependency can be met by a batch of barriers at any position after the work that it
// waits for, and up to the pass that needs it. It goes into the last batch if that batch is late
// enough, and otherwise into a new batch immediately before the pass. Placing each new batch as
// late as possible gives the least number of batches.
#include "synchronise.h"

#include <algorithm>

namespace alcove::framegraph {
namespace {

// Records a use in a state without adding dependencies.
void record_use(UseState& state, const AccessRecord& access, std::int32_t time) {
  if (access.flags & kWrite) {
    state.write_stages = access.stages;
    state.write_access = access.access & kWriteBits;
    state.write_time = time;
    state.read_stages = 0;
    state.read_time = kNever;
    state.seen_stages = 0;
    state.seen_access = 0;
    state.transition = kNone;
    state.reuses_memory = 0;
    state.by_wait = 0;
  } else {
    state.read_stages |= access.stages;
    state.read_time = time;
  }
  state.layout = access.layout;
}

// Adds the last uses of a resource that gives up its memory to the state of the one that takes it.
void merge(UseState& merged, const UseState& state, bool before) {
  merged.frame_before |= before ? state.frame_before : 0u;
  merged.by_wait |= state.by_wait;
  if (state.read_stages != 0) {
    merged.read_stages |= state.read_stages;
    merged.read_time = std::max(merged.read_time, state.read_time);
  } else {
    merged.write_stages |= state.write_stages;
    merged.write_access |= state.write_access;
    merged.write_time = std::max(merged.write_time, state.write_time);
  }
}

}  // namespace

void Synchroniser::run() {
  // Imports and histories get their states from before the frame. A transient gets its state when
  // it takes over memory from other resources.
  s_.states.resize(subs_ * (several() ? kQueueClasses : 1));
  for (auto& waits : last_waits_) std::fill(std::begin(waits), std::end(waits), kNone);
  apply_initial_states();
  find_last_uses();
  const auto count = static_cast<std::uint32_t>(plan_.passes.size());
  const std::uint32_t* starting = workspace_.transients.data();
  const std::uint32_t* const end = starting + workspace_.transients.size();
  const auto next_start = [&] {
    return starting == end ? count : plan_.placements[*starting].first;
  };
  std::uint32_t start = next_start();
  for (std::uint32_t position = 0; position < count; ++position) {
    PlannedPass& planned = plan_.passes[position];
    set_queue(planned.queue);
    if (several()) begin_submission(planned.submission);
    for (; start == position; start = next_start()) take_over_memory(*starting++);
    for (const AccessRecord& access : graph_.pass_accesses(planned.pass)) use(position, access);
    if (batch_time_ == batch_time(position))
      planned.batch = static_cast<std::uint32_t>(plan_.batches.size() - 1);
    if (several()) end_pass(position);
  }
  apply_final_states();
  for (std::size_t queue = 0; queue < kQueueClasses && several(); ++queue) {
    set_queue(static_cast<QueueClass>(queue));
    add_stages(next_frame_[queue]);
  }
}

// Sets the point before which no barrier can be placed, and the last waits of the queue.
void Synchroniser::begin_submission(std::uint32_t index) {
  const Submission& submission = plan_.submissions[index];
  earliest_ = batch_time(submission.first_pass) - 1;
  auto& waits = last_waits_[static_cast<std::size_t>(submission.queue)];
  for (std::uint32_t w = submission.first_wait; w < submission.first_wait + submission.wait_count;
       ++w)
    waits[static_cast<std::size_t>(plan_.submissions[plan_.waits[w].submission].queue)] = w;
}

// Returns whether another queue has used the subresource since its last change, or changed it.
bool Synchroniser::is_used_elsewhere(std::uint32_t sub) const {
  bool used = states_[sub].by_wait != 0;
  for_each_other(queue_, [&](QueueClass other) {
    const UseState& there = s_.states[static_cast<std::size_t>(other) * subs_ + sub];
    used = used || (there.read_stages | there.write_stages) != 0;
  });
  return used;
}

// Adds stages to the last waits of the current queue. An earlier use on another queue is known to
// be done by the last wait for that queue, or by the last wait for a third one that waited for it.
void Synchroniser::add_stages(VkPipelineStageFlags2 stages) {
  for (const std::uint32_t wait : last_waits_[static_cast<std::size_t>(queue_)])
    if (wait != kNone) plan_.waits[wait].stages |= stages;
}

// Makes the waits that order a use in these stages after work of other queues cover the stages.
void Synchroniser::wait_in(VkPipelineStageFlags2 stages, const UseState& state) {
  if (state.by_wait != kByLastFrame) add_stages(stages);
  if (state.by_wait & kByLastFrame) next_frame_[static_cast<std::size_t>(queue_)] |= stages;
}

// Notes the layouts that the submission of a pass changes at its end, and changes them after its
// last pass.
void Synchroniser::end_pass(std::uint32_t position) {
  const PlannedPass& planned = plan_.passes[position];
  const std::uint32_t first = graph_.passes[planned.pass].first_access;
  const auto count = static_cast<std::uint32_t>(graph_.pass_accesses(planned.pass).size());
  for (std::uint32_t i = first; i < first + count; ++i)
    if (workspace_.queues.moved_layouts[i] != VK_IMAGE_LAYOUT_UNDEFINED) s_.moves.push_back(i);
  const Submission& submission = plan_.submissions[planned.submission];
  if (position + 1 != submission.first_pass + submission.pass_count || s_.moves.empty()) return;
  move_layouts(position);
  s_.moves.clear();
}

// Changes what passes of this submission wrote to the layouts in which passes of several queues
// read it, in a batch after the last pass of the submission. A pass of the submission that reads it
// may already have changed it.
void Synchroniser::move_layouts(std::uint32_t last) {
  const Batch batch{static_cast<std::uint32_t>(plan_.transitions.size()), 0};
  plan_.batches.push_back(batch);
  batch_time_ = pass_time(last);
  s_.batch_memories.clear();
  for (const std::uint32_t index : s_.moves) {
    AccessRecord moved = graph_.accesses[index];
    moved.layout = workspace_.queues.moved_layouts[index];
    // The barrier needs a second scope, by which the signal of the submission comes after it.
    moved.access = 0;
    moved.flags = 0;
    for_each_part(moved, [&](std::uint32_t sub, const Range& range) {
      if (states_[sub].layout != moved.layout) use_range(last, moved, sub, range);
    });
  }
  if (plan_.batches.back().count == 0)
    plan_.batches.pop_back();
  else
    plan_.submissions[plan_.passes[last].submission].end_batch =
        static_cast<std::uint32_t>(plan_.batches.size() - 1);
  batch_time_ = kNever;  // No later dependency can use this batch.
}

// Finds the last use, in the previous frame, of each transient that is the last one in a frame to
// occupy some byte. This frame's plan gives the answer, because the previous frame had the same
// plan.
void Synchroniser::find_last_uses() {
  s_.last_uses.resize(s_.states.size());
  s_.is_last.assign(graph_.resources.size(), 0);
  auto from = static_cast<std::uint32_t>(plan_.passes.size());
  find_last_owners();
  for (const MemoryMap& map : s_.memory) {
    for (const Segment& segment : map) {
      s_.is_last[segment.resource] = 1;
      from = std::min(from, plan_.placements[segment.resource].first);
      const auto& first = workspace_.first_sub;
      for (std::size_t base = 0; base < s_.last_uses.size(); base += subs_) {
        UseState* const last = s_.last_uses.data() + base;
        std::fill(last + first[segment.resource], last + first[segment.resource + 1], UseState{});
      }
    }
  }
  std::fill(std::begin(last_position_), std::end(last_position_), kNone);
  for (std::uint32_t position = 0; position < plan_.passes.size(); ++position)
    last_position_[static_cast<std::size_t>(plan_.passes[position].queue)] = position;
  for (std::uint32_t position = from; position < plan_.passes.size(); ++position) {
    const QueueClass queue = plan_.passes[position].queue;
    const std::uint32_t frame_before = queues_that_wait(position);
    UseState* const last_uses = last_uses_on(queue);
    for (const AccessRecord& access : graph_.pass_accesses(plan_.passes[position].pass)) {
      if (!s_.is_last[access.resource]) continue;
      for_each_sub(graph_, workspace_, access, [&](std::uint32_t sub) {
        UseState& last = last_uses[sub];
        const bool writes = (access.flags & kWrite) != 0;
        record_use(last, access, kBeforeFrame);
        last.frame_before = writes ? frame_before : last.frame_before | frame_before;
        // A write comes after the uses on other queues, ordered by a semaphore.
        for_each_other(queue, [&](QueueClass other) {
          UseState& there = last_uses_on(other)[sub];
          if (writes) there = {};
          there.by_wait = 1;
          there.frame_before = last.frame_before;
        });
      });
    }
  }
}

// Finds, for each byte of the heaps, the last transient that occupies it in a frame. The loop goes
// from the last transient to the first, and ends when each byte has an owner.
void Synchroniser::find_last_owners() {
  s_.memory.resize(std::max(s_.memory.size(), plan_.heaps.size()));
  for (MemoryMap& map : s_.memory) map.clear();
  VkDeviceSize unclaimed = 0;
  for (const Heap& heap : plan_.heaps) unclaimed += heap.size;
  const auto& transients = workspace_.transients;
  for (std::size_t i = transients.size(); i-- > 0 && unclaimed > 0;) {
    const Placement& placed = plan_.placements[transients[i]];
    unclaimed -= claim_free(s_.memory[placed.heap],
                            {placed.offset, placed.offset + placed.size, transients[i], true});
  }
}

// Orders a transient's first use on each queue after the last uses of all resources that occupied
// its bytes before.
inline void Synchroniser::take_over_memory(std::uint32_t resource) {
  const Placement& placed = plan_.placements[resource];
  const std::uint32_t* const subs = workspace_.first_sub.data();
  // The states are merged in place for the first subresource, and then copied to the others.
  const std::size_t copies = several() ? kQueueClasses : 1;
  UseState* const merged = s_.states.data() + subs[resource];
  for (std::size_t queue = 0; queue < copies; ++queue) {
    merged[queue * subs_] = {};
    merged[queue * subs_].reuses_memory = 1;
    merged[queue * subs_].owner = queue_;
  }
  take_over(s_.memory[placed.heap], {placed.offset, placed.offset + placed.size, resource, false},
            [&](const Segment& segment) {
              const UseState* const all = segment.before ? s_.last_uses.data() : s_.states.data();
              for (std::size_t queue = 0; queue < copies; ++queue)
                for (std::uint32_t sub = subs[segment.resource]; sub < subs[segment.resource + 1];
                     ++sub)
                  merge(merged[queue * subs_], all[queue * subs_ + sub], segment.before);
            });
  for (std::size_t queue = 0; queue < copies; ++queue) {
    UseState* const first = merged + queue * subs_;
    for_each_other(static_cast<QueueClass>(queue), [&](QueueClass other) {
      const UseState& there = merged[static_cast<std::size_t>(other) * subs_];
      if ((there.read_stages | there.write_stages) == 0) return;
      first->by_wait |= kByWait | kByLastFrame;
    });
    std::fill(first + 1, first + (subs[resource + 1] - subs[resource]), *first);
  }
}

// Returns UseState::frame_before for a use at this position in the previous frame. It has a bit for
// each queue that, by the end of that frame, has not waited for the use.
std::uint32_t Synchroniser::queues_that_wait(std::uint32_t position) const {
  if (!several()) return 0;
  const auto used_on = static_cast<std::size_t>(plan_.passes[position].queue);
  std::uint32_t bits = 0;
  for (std::size_t queue = 0; queue < kQueueClasses; ++queue) {
    const std::uint32_t last = last_position_[queue];
    if (queue == used_on || last == kNone) continue;
    const std::int32_t known = workspace_.queues.known[last * kQueueClasses + used_on];
    if (known < static_cast<std::int32_t>(position))
      bits |= 1u << (queue * kQueueClasses + used_on);
  }
  return bits;
}

// Makes the pass's submission wait for the previous frame's work on the queues in `frame_before`,
// because the pass takes over their memory. The wait is left out for a queue if this pass already
// waits for a pass of this frame on that queue.
void Synchroniser::wait_for_frame_before(std::uint32_t position, std::uint32_t frame_before) {
  const auto own = static_cast<std::size_t>(queue_);
  unsigned queues = frame_before >> (own * kQueueClasses) & ((1u << kQueueClasses) - 1);
  for (std::size_t queue = 0; queue < kQueueClasses; ++queue)
    if ((queues & (1u << queue)) != 0 &&
        workspace_.queues.known[position * kQueueClasses + queue] >= 0)
      queues &= ~(1u << queue);
  queues &= ~static_cast<unsigned>(frame_before_[own]);
  frame_before_[own] |= static_cast<std::uint8_t>(queues);
  plan_.submissions[plan_.passes[position].submission].frame_before |=
      static_cast<std::uint8_t>(queues);
}

void Synchroniser::use(std::uint32_t position, const AccessRecord& access) {
  const std::uint32_t* const subs = workspace_.first_sub.data() + access.resource;
  if (subs[1] == subs[0] + 1)
    use_range(position, access, subs[0], access.range);
  else
    use_several(position, access);
}

void Synchroniser::use_several(std::uint32_t position, const AccessRecord& access) {
  const ResourceRecord& resource = graph_.resources[access.resource];
  const std::uint32_t first = workspace_.first_sub[access.resource];
  const std::uint32_t lead =
      first + access.range.base_mip + access.range.base_layer * resource.mips;
  UseState* const states = s_.states.data();
  bool alike = true;
  for_each_sub(graph_, workspace_, access, [&](std::uint32_t sub) {
    for (std::size_t base = 0; base < s_.states.size(); base += subs_)
      alike = alike && states[base + sub] == states[base + lead];
  });
  if (alike) {
    use_range(position, access, lead, access.range);
    for_each_sub(graph_, workspace_, access, [&](std::uint32_t sub) {
      for (std::size_t base = 0; base < s_.states.size(); base += subs_)
        states[base + sub] = states[base + lead];
    });
    return;
  }
  for_each_part(access, [&](std::uint32_t sub, const Range& range) {
    use_range(position, access, sub, range);
  });
}

// Calls f(subresource, its range) for each subresource of an access.
template <typename Function>
void Synchroniser::for_each_part(const AccessRecord& access, Function&& f) const {
  const std::uint32_t first = workspace_.first_sub[access.resource];
  const std::uint32_t mips = graph_.resources[access.resource].mips;
  for_each_sub(graph_, workspace_, access, [&](std::uint32_t sub) {
    f(sub, Range{static_cast<std::uint16_t>((sub - first) % mips), 1,
                 static_cast<std::uint16_t>((sub - first) / mips), 1});
  });
}

inline void Synchroniser::use_range(std::uint32_t position, const AccessRecord& access,
                                    std::uint32_t sub, const Range& range) {
  UseState& state = states_[sub];
  const bool writes = (access.flags & kWrite) != 0;
  if (several() && state.frame_before != 0) wait_for_frame_before(position, state.frame_before);
  const bool changes = access.kind() == ResourceKind::texture && state.layout != access.layout;
  const bool is_last = position == plan_.passes.size();
  if (several() && (writes || changes || is_last ? is_used_elsewhere(sub) : state.by_wait != 0))
    wait_in(waited_stages(access), state);
  if (changes)
    change_layout(position, access, sub, range);
  else if (writes)
    write_in_same_layout(position, access, state);
  else
    read_in_same_layout(position, access, state);
  if (!several() || !(writes || changes)) return;
  state.owner = queue_;
  tell_other_queues(sub, state);
}

// Sets the state of a subresource on the other queues after this queue has changed it. Their next
// use waits for the change with a semaphore, which covers all commands, but not the host.
void Synchroniser::tell_other_queues(std::uint32_t sub, const UseState& state) {
  UseState told;
  told.by_wait = 1;
  told.owner = state.owner;
  told.layout = state.layout;
  told.seen_stages = ~VkPipelineStageFlags2{VK_PIPELINE_STAGE_2_HOST_BIT};
  told.seen_access = kEveryAccess;
  for_each_other(state.owner, [&](QueueClass other) { states_on(other)[sub] = told; });
}

inline void Synchroniser::change_layout(std::uint32_t position, const AccessRecord& access,
                                        std::uint32_t sub, const Range& range) {
  UseState& state = states_[sub];
  Transition& wanted = next_image(std::max(state.read_time, state.write_time), position);
  // Reads come after the write that they read from, so that waiting for the reads is enough. This
  // does not hold for memory that the resource took over from others: there, the reads and the
  // writes may belong to different resources.
  const bool after_reads = state.read_stages != 0 && !state.reuses_memory;
  wanted.src_stages = after_reads ? state.read_stages : state.read_stages | state.write_stages;
  wanted.src_access = after_reads ? 0 : state.write_access;
  // A semaphore wait covers all stages, so that any stage comes after it.
  if (wanted.src_stages == 0 && state.by_wait) wanted.src_stages = waited_stages(access);
  if (several() && is_used_elsewhere(sub)) wait_in(wanted.src_stages, state);
  wanted.dst_stages = access.stages;
  wanted.dst_access = access.access;
  wanted.resource = access.resource;
  wanted.old_layout = access.flags & kDiscard ? VK_IMAGE_LAYOUT_UNDEFINED : state.layout;
  wanted.new_layout = access.layout;
  wanted.range = range;
  merge_neighbours();
  record_transition(position, access, state);
}

void Synchroniser::read_in_same_layout(std::uint32_t position, const AccessRecord& access,
                                       UseState& state) {
  const bool seen =
      (access.stages & ~state.seen_stages) == 0 && (access.access & ~state.seen_access) == 0;
  if (!seen && (state.write_time != kNever || state.by_wait)) {
    if (state.transition != kNone) {
      plan_.transitions[state.transition].dst_stages |= access.stages;
      plan_.transitions[state.transition].dst_access |= access.access;
    } else {
      Transition wanted;
      wanted.src_stages = state.by_wait ? VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT : state.write_stages;
      wanted.src_access = state.write_access;
      // The state stores the stages and the accesses to which the write is visible as two separate
      // masks. The barrier makes the write visible to every combination of the two.
      wanted.dst_stages = access.stages;
      wanted.dst_access = access.access;
      const bool new_stages = (access.stages & ~state.seen_stages) != 0;
      if (new_stages) wanted.dst_access |= reads_in(state.seen_access);
      // The stages of this access may not be able to make the other accesses.
      const bool others =
          state.seen_access != kEveryAccess && (state.seen_access & ~access.access) != 0;
      if ((access.access & ~state.seen_access) != 0 || (new_stages && others))
        wanted.dst_stages |= state.seen_stages;
      add_memory(state.write_time, position, wanted);
    }
    state.seen_stages |= access.stages;
    state.seen_access |= access.access;
  }
  record_use(state, access, pass_time(position));
}

void Synchroniser::write_in_same_layout(std::uint32_t position, const AccessRecord& access,
                                        UseState& state) {
  Transition wanted;
  wanted.src_stages = state.read_stages | state.write_stages;
  wanted.src_access = state.write_access;
  if (state.read_stages != 0 && !state.reuses_memory) {
    wanted.src_stages = state.read_stages;
    wanted.src_access = 0;
  }
  wanted.dst_stages = access.stages;
  wanted.dst_access = access.access;
  if (wanted.src_stages != 0)
    add_memory(std::max(state.read_time, state.write_time), position, wanted);
  record_use(state, access, pass_time(position));
}

// Extends the barrier `last` to also cover the mips or layers of `next`, if both barriers
// are of one resource, cover adjacent subresources, and make the same change. Returns whether it
// did.
bool Synchroniser::extend(Transition& last, const Transition& next) {
  const Range& a = last.range;
  const Range& b = next.range;
  const bool alike = last.src_stages == next.src_stages && last.src_access == next.src_access &&
                     last.dst_stages == next.dst_stages && last.dst_access == next.dst_access &&
                     last.old_layout == next.old_layout && last.new_layout == next.new_layout;
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

void Synchroniser::add_memory(std::int32_t time, std::uint32_t position, const Transition& wanted) {
  Batch& batch = batch_after(time, position);
  for (const std::uint32_t i : s_.batch_memories) {
    Transition& there = plan_.transitions[i];
    if (there.src_stages != wanted.src_stages && there.dst_stages != wanted.dst_stages) continue;
    there.src_stages |= wanted.src_stages;
    there.src_access |= wanted.src_access;
    there.dst_stages |= wanted.dst_stages;
    there.dst_access |= wanted.dst_access;
    return;
  }
  s_.batch_memories.push_back(static_cast<std::uint32_t>(plan_.transitions.size()));
  plan_.transitions.push_back(wanted);
  ++batch.count;
}

void synchronise(const GraphDescription& graph, const Limits& limits, Workspace& workspace,
                 Plan& plan) {
  Synchroniser(graph, limits, workspace, plan).run();
}

}  // namespace alcove::framegraph
