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
    state.unordered_access = access.flags & kUnordered ? access.access : 0;
  } else {
    state.read_stages |= access.stages;
    state.read_time = time;
  }
  state.layout = access.layout;
  state.used = 1;
}

// Returns whether the access continues a series of writes whose order does not matter. All writes
// of the series wait for the same work as the first one, and not for each other.
bool continues_write(const UseState& state, const AccessRecord& access) {
  return (access.flags & kUnordered) && state.read_stages == 0 &&
         state.write_stages == access.stages && state.unordered_access == access.access;
}

}  // namespace

void Synchroniser::run() {
  // Imports and histories get their states from before the frame. A transient gets its state when
  // it takes over memory from other resources.
  s_.states.resize(workspace_.first_sub.back());
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
    queue_ = planned.queue;
    if (workspace_.several_queues)
      earliest_ = batch_time(plan_.submissions[planned.submission].first_pass) - 1;
    for (; start == position; start = next_start()) take_over_memory(*starting++);
    for_each_live(graph_, plan_, planned.pass,
                  [&](const AccessRecord& access) { use(position, access); });
    if (batch_time_ != batch_time(position)) continue;
    planned.first_batch = static_cast<std::uint32_t>(plan_.batches.size() - 1);
    planned.batch_count = 1;
  }
  apply_final_states();
}

// Finds the last use, in the previous frame, of each history and of each transient that is the last
// one in a frame to occupy some byte. This frame's plan gives the answer, because the previous
// frame had the same plan.
void Synchroniser::find_last_uses() {
  s_.last_uses.resize(workspace_.first_sub.back());
  s_.is_last.assign(graph_.resources.size(), 0);
  auto from = static_cast<std::uint32_t>(plan_.passes.size());
  const auto want = [&](std::uint32_t resource) {
    s_.is_last[resource] = 1;
    from = std::min(from, plan_.placements[resource].first);
    const auto& first = workspace_.first_sub;
    std::fill(s_.last_uses.begin() + first[resource], s_.last_uses.begin() + first[resource + 1],
              UseState{});
  };
  find_last_owners();
  for (const MemoryMap& map : s_.memory) {
    for (const Segment& segment : map) want(segment.resource);
  }
  for (std::uint32_t r = 0; r < graph_.resources.size() && !graph_.externals.empty(); ++r) {
    if (graph_.resources[r].origin == Origin::history) want(r);
  }
  std::fill(std::begin(last_position_), std::end(last_position_), kNone);
  for (std::uint32_t position = 0; position < plan_.passes.size(); ++position)
    last_position_[static_cast<std::size_t>(plan_.passes[position].queue)] = position;
  for (std::uint32_t position = from; position < plan_.passes.size(); ++position) {
    const QueueClass queue = plan_.passes[position].queue;
    const std::uint32_t frame_before = queues_that_wait(position);
    for_each_live(graph_, plan_, plan_.passes[position].pass, [&](const AccessRecord& access) {
      if (!s_.is_last[access.resource]) return;
      for_each_sub(graph_, workspace_, access, [&](std::uint32_t sub) {
        UseState& last = s_.last_uses[sub];
        // Uses on another queue come before this one, ordered by a semaphore.
        if (last.queue != queue) last = {};
        record_use(last, access, kBeforeFrame);
        last.queue = queue;
        last.frame_before = frame_before;
      });
    });
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

// Orders a transient's first use after the last uses of all resources that occupied its bytes
// before.
inline void Synchroniser::take_over_memory(std::uint32_t resource) {
  const Placement& placed = plan_.placements[resource];
  const std::uint32_t* const subs = workspace_.first_sub.data();
  UseState* const states = s_.states.data();
  // The state is merged in place for the first subresource, and then copied to the others.
  UseState& merged = states[subs[resource]];
  merged = {};
  const auto merge = [&](const Segment& segment) {
    const UseState* const theirs = segment.before ? s_.last_uses.data() : states;
    for (std::uint32_t sub = subs[segment.resource]; sub < subs[segment.resource + 1]; ++sub) {
      const UseState& state = theirs[sub];
      merged.frame_before |= segment.before ? state.frame_before : 0u;
      if (state.queue != queue_) {
        merged.by_wait = 1;
        continue;
      }
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
  };
  take_over(s_.memory[placed.heap], {placed.offset, placed.offset + placed.size, resource, false},
            merge);
  merged.reuses_memory = 1;
  merged.queue = queue_;
  if (merged.frame_before != 0)
    wait_for_frame_before(plan_.placements[resource].first, merged.frame_before);
  std::fill(states + subs[resource] + 1, states + subs[resource + 1], merged);
}

// Returns UseState::frame_before for a use at this position in the previous frame. It has a bit for
// each queue that, by the end of that frame, has not waited for the use.
std::uint32_t Synchroniser::queues_that_wait(std::uint32_t position) const {
  if (!workspace_.several_queues) return 0;
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
  for (std::size_t queue = 0; queue < kQueueClasses; ++queue) {
    if ((queues & (1u << queue)) != 0 &&
        workspace_.queues.known[position * kQueueClasses + queue] >= 0)
      queues &= ~(1u << queue);
  }
  queues &= ~static_cast<unsigned>(frame_before_[own]);
  frame_before_[own] |= static_cast<std::uint8_t>(queues);
  plan_.submissions[plan_.passes[position].submission].frame_before |=
      static_cast<std::uint8_t>(queues);
}

void Synchroniser::use(std::uint32_t position, const AccessRecord& access) {
  const std::uint32_t* const subs = workspace_.first_sub.data() + access.resource;
  if (subs[1] == subs[0] + 1)
    use_range(position, access, s_.states[subs[0]], access.range);
  else
    use_several(position, access);
}

void Synchroniser::use_several(std::uint32_t position, const AccessRecord& access) {
  const ResourceRecord& resource = graph_.resources[access.resource];
  const std::uint32_t first = workspace_.first_sub[access.resource];
  UseState* const states = s_.states.data() + first;
  const std::size_t lead_layer =
      std::size_t{first_plane(access.range)} * resource.layers + access.range.base_layer;
  UseState* const lead = states + lead_layer * resource.mips + access.range.base_mip;
  bool alike = true;
  for_each_sub(graph_, workspace_, access,
               [&](std::uint32_t sub) { alike = alike && s_.states[sub] == *lead; });
  if (alike) {
    use_range(position, access, *lead, access.range);
    for_each_sub(graph_, workspace_, access, [&](std::uint32_t sub) { s_.states[sub] = *lead; });
    return;
  }
  for_each_sub(graph_, workspace_, access, [&](std::uint32_t sub) {
    const std::uint32_t mip = (sub - first) % resource.mips;
    const std::uint32_t layer = (sub - first) / resource.mips % resource.layers;
    Range range{static_cast<std::uint16_t>(mip), 1, static_cast<std::uint16_t>(layer), 1};
    if (resource.planes == 2)
      range.aspects = sub - first < resource.mips * resource.layers ? VK_IMAGE_ASPECT_DEPTH_BIT
                                                                    : VK_IMAGE_ASPECT_STENCIL_BIT;
    use_range(position, access, s_.states[sub], range);
  });
}

inline void Synchroniser::use_range(std::uint32_t position, const AccessRecord& access,
                                    UseState& state, const Range& range) {
  const bool texture = access.kind() == ResourceKind::texture;
  if (state.queue != queue_ && change_queue(position, access, state, range)) return;
  if (texture && state.layout != access.layout)
    change_layout(position, access, state, range);
  else if (access.flags & kWrite)
    write_in_same_layout(position, access, state);
  else
    read_in_same_layout(position, access, state);
}

inline void Synchroniser::change_layout(std::uint32_t position, const AccessRecord& access,
                                        UseState& state, const Range& range) {
  Transition& wanted = next_image(std::max(state.read_time, state.write_time), position);
  // Reads come after the write that they read from, so that waiting for the reads is enough. This
  // does not hold for memory that the resource took over from others: there, the reads and the
  // writes may belong to different resources.
  const bool after_reads = state.read_stages != 0 && !state.reuses_memory;
  wanted.src_stages = after_reads ? state.read_stages : state.read_stages | state.write_stages;
  wanted.src_access = after_reads ? 0 : state.write_access;
  // A semaphore wait covers all stages, so that any stage comes after it.
  if (wanted.src_stages == 0 && state.by_wait) wanted.src_stages = waited_stages(access);
  wanted.dst_stages = access.stages;
  wanted.dst_access = access.access;
  wanted.resource = access.resource;
  wanted.old_layout = access.flags & kDiscard ? VK_IMAGE_LAYOUT_UNDEFINED : state.layout;
  wanted.new_layout = access.layout;
  wanted.range = range;
  wanted.src_queue = wanted.dst_queue = queue_;
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
      if (access.access & ~state.seen_access) wanted.dst_stages |= state.seen_stages;
      wanted.dst_access = access.access;
      if (access.stages & ~state.seen_stages) wanted.dst_access |= reads_in(state.seen_access);
      add_memory(state.write_time, position, wanted);
    }
    state.seen_stages |= access.stages;
    state.seen_access |= access.access;
  }
  record_use(state, access, pass_time(position));
}

void Synchroniser::write_in_same_layout(std::uint32_t position, const AccessRecord& access,
                                        UseState& state) {
  if (continues_write(state, access)) {
    state.write_time = pass_time(position);
    return;
  }
  Transition wanted;
  wanted.src_stages = state.read_stages | state.write_stages;
  wanted.src_access = state.write_access;
  if (state.read_stages != 0 && !state.reuses_memory) {
    wanted.src_stages = state.read_stages;
    wanted.src_access = 0;
  }
  wanted.dst_stages = access.stages;
  wanted.dst_access = access.access;
  if (state.read_stages != 0 && !state.reuses_memory) {
    // An execution dependency on the reads is enough, unless this access reads something itself.
    wanted.dst_access &= access.flags & kDiscard ? 0 : ~kWriteBits;
    if ((wanted.dst_access & ~state.seen_access) == 0 && (access.stages & ~state.seen_stages) == 0)
      wanted.dst_access = 0;
  }
  if (wanted.src_stages != 0)
    add_memory(std::max(state.read_time, state.write_time), position, wanted);
  record_use(state, access, pass_time(position));
}

// Extends the barrier `last` to also cover the mips, layers or aspect of `next`, if both barriers
// are of one resource, cover adjacent subresources, and make the same change. Returns whether it
// did.
bool Synchroniser::extend(Transition& last, const Transition& next) {
  const Range& a = last.range;
  const Range& b = next.range;
  const bool alike = last.src_stages == next.src_stages && last.src_access == next.src_access &&
                     last.dst_stages == next.dst_stages && last.dst_access == next.dst_access &&
                     last.old_layout == next.old_layout && last.new_layout == next.new_layout &&
                     last.src_queue == next.src_queue && last.dst_queue == next.dst_queue;
  const bool same_aspects = a.aspects == b.aspects;
  const bool next_mips = same_aspects && a.base_layer == b.base_layer && a.layers == b.layers &&
                         a.base_mip + a.mips == b.base_mip;
  const bool next_layers = same_aspects && a.base_mip == b.base_mip && a.mips == b.mips &&
                           a.base_layer + a.layers == b.base_layer;
  const bool next_aspect = !same_aspects && a.base_mip == b.base_mip && a.mips == b.mips &&
                           a.base_layer == b.base_layer && a.layers == b.layers;
  if (!alike || !(next_mips || next_layers || next_aspect)) return false;
  if (next_aspect)
    last.range.aspects = 0;
  else if (next_mips)
    last.range.mips = static_cast<std::uint16_t>(a.mips + b.mips);
  else
    last.range.layers = static_cast<std::uint16_t>(a.layers + b.layers);
  return true;
}

void Synchroniser::add_memory(std::int32_t time, std::uint32_t position, const Transition& wanted) {
  Batch& batch = batch_after(time, position);
  for (std::uint32_t i = batch.first; i < batch.first + batch.count; ++i) {
    Transition& there = plan_.transitions[i];
    if (there.resource != kNone) continue;
    if (there.src_stages != wanted.src_stages && there.dst_stages != wanted.dst_stages) continue;
    there.src_stages |= wanted.src_stages;
    there.src_access |= wanted.src_access;
    there.dst_stages |= wanted.dst_stages;
    there.dst_access |= wanted.dst_access;
    return;
  }
  plan_.transitions.push_back(wanted);
  ++batch.count;
}

void synchronise(const GraphDescription& graph, const Limits& limits, Workspace& workspace,
                 Plan& plan) {
  Synchroniser(graph, limits, workspace, plan).run();
}

}  // namespace alcove::framegraph
