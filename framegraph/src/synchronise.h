// The Synchroniser is split into three source files. synchronise.cpp follows the passes,
// externals.cpp handles the initial and final states of imports and histories, and
// queue_transfer.cpp handles resources that move from one queue to another.
#pragma once

#include <algorithm>

#include "memory_map.h"
#include "workspace.h"

namespace alcove::framegraph {

// Returns the stages of this access for which a semaphore wait is made.
inline VkPipelineStageFlags2 waited_stages(const AccessRecord& access) {
  const VkPipelineStageFlags2 stages =
      access.stages & ~(VK_PIPELINE_STAGE_2_HOST_BIT | VK_PIPELINE_STAGE_2_BOTTOM_OF_PIPE_BIT);
  return stages != 0 ? stages : VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
}

// The value of UseState::seen_access when every access sees the write.
inline constexpr VkAccessFlags2 kEveryAccess = ~VkAccessFlags2{0};

// Converts UseState::seen_access to the access mask of a barrier or a state.
inline VkAccessFlags2 reads_in(VkAccessFlags2 seen) {
  return seen == kEveryAccess ? VK_ACCESS_2_MEMORY_READ_BIT : seen;
}

inline std::int32_t batch_time(std::uint32_t position) {
  return static_cast<std::int32_t>(2 * position);
}

inline std::int32_t pass_time(std::uint32_t position) {
  return static_cast<std::int32_t>(2 * position + 1);
}

class Synchroniser {
 public:
  Synchroniser(const GraphDescription& graph, const Limits& limits, Workspace& workspace,
               Plan& plan)
      : graph_(graph),
        limits_(limits),
        workspace_(workspace),
        plan_(plan),
        s_(workspace.synchronise) {}
  void run();

 private:
  void find_last_uses();
  void find_last_owners();
  void take_over_memory(std::uint32_t resource);
  std::uint32_t queues_that_wait(std::uint32_t position) const;
  void wait_for_frame_before(std::uint32_t position, std::uint32_t frame_before);
  void use(std::uint32_t position, const AccessRecord& access);
  void use_several(std::uint32_t position, const AccessRecord& access);
  void use_range(std::uint32_t position, const AccessRecord& access, UseState& state,
                 const Range& range);
  void change_layout(std::uint32_t position, const AccessRecord& access, UseState& state,
                     const Range& range);
  void record_transition(std::uint32_t position, const AccessRecord& access, UseState& state);
  void read_in_same_layout(std::uint32_t position, const AccessRecord& access, UseState& state);
  void write_in_same_layout(std::uint32_t position, const AccessRecord& access, UseState& state);

  // externals.cpp
  void apply_initial_states();
  void apply_final_states();
  void end_reads(std::uint32_t resource, const State& final_state);
  AccessRecord use_outside_frame(std::uint32_t resource, const State& state) const;
  void leave_history_slot(std::uint32_t resource);

  // queue_transfer.cpp
  bool change_queue(std::uint32_t position, const AccessRecord& access, UseState& state,
                    const Range& range);
  void acquire_without_release(std::uint32_t position, UseState& state, bool same_family);
  std::uint32_t releasing_submission(const UseState& state) const;
  Transition release_of(const AccessRecord& access, const UseState& state,
                        const Range& range) const;
  void add_releases();

  Batch& batch_after(std::int32_t time, std::uint32_t position);
  Transition& next_image(std::int32_t time, std::uint32_t position);
  void merge_neighbours();
  static bool extend(Transition& last, const Transition& next);
  void add_memory(std::int32_t time, std::uint32_t position, const Transition& wanted);

  const GraphDescription& graph_;
  const Limits& limits_;
  Workspace& workspace_;
  Plan& plan_;
  Workspace::Synchronise& s_;
  std::int32_t batch_time_ = kNever;  // time of the last batch
  // The start of the current pass's submission, before which no barrier can be placed.
  std::int32_t earliest_ = kBeforeFrame;
  QueueClass queue_ = QueueClass::graphics;  // of the current pass
  // For each queue: bits of the queues for whose work of the previous frame it has already waited.
  std::uint8_t frame_before_[kQueueClasses] = {};
  std::uint32_t last_position_[kQueueClasses] = {};  // for each queue: position of its last pass
};

// Returns the batch of barriers for a dependency on work that ends at `time`: the last batch if it
// comes after that work, otherwise a new batch before the pass at `position`.
inline Batch& Synchroniser::batch_after(std::int32_t time, std::uint32_t position) {
  time = std::max(time, earliest_);
  if (batch_time_ < time) {
    batch_time_ = batch_time(position);
    plan_.batches.push_back({static_cast<std::uint32_t>(plan_.transitions.size()), 0});
  }
  return plan_.batches.back();
}

// Appends an image barrier. merge_neighbours() joins it with its neighbours after it is filled in.
inline Transition& Synchroniser::next_image(std::int32_t time, std::uint32_t position) {
  ++batch_after(time, position).count;
  return plan_.transitions.emplace_back();
}

// Joins barriers of neighbouring mips and layers that change in the same way into one barrier.
inline void Synchroniser::merge_neighbours() {
  while (plan_.batches.back().count >= 2) {
    Transition* const last = &plan_.transitions.back();
    const std::uint32_t resource = last->resource;
    if (last[-1].resource != resource || !extend(last[-1], *last)) return;
    plan_.transitions.pop_back();
    --plan_.batches.back().count;
    // The UseState of a subresource may still hold the index of the barrier that was removed. It
    // now belongs to the barrier into which that one was merged.
    const auto gone = static_cast<std::uint32_t>(plan_.transitions.size());
    const auto& first = workspace_.first_sub;
    for (std::uint32_t sub = first[resource]; sub < first[resource + 1]; ++sub) {
      if (s_.states[sub].transition == gone) --s_.states[sub].transition;
    }
  }
}

// Sets the state after an access whose image barrier is the one that was added last.
inline void Synchroniser::record_transition(std::uint32_t position, const AccessRecord& access,
                                            UseState& state) {
  state = {};
  state.write_stages = access.stages;
  state.layout = access.layout;
  state.queue = queue_;
  state.used = 1;
  if (access.flags & kWrite) {
    state.write_access = access.access & kWriteBits;
    state.write_time = pass_time(position);
    state.unordered_access = access.flags & kUnordered ? access.access : 0;
    return;
  }
  state.write_time = batch_time_;
  state.read_stages = state.seen_stages = access.stages;
  state.seen_access = access.access;
  state.read_time = pass_time(position);
  state.transition = static_cast<std::uint32_t>(plan_.transitions.size() - 1);
}

}  // namespace alcove::framegraph
