// The Synchroniser is split into two source files. synchronise.cpp follows the passes, and
// externals.cpp handles the initial and final states of imports and histories.
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

inline constexpr std::uint8_t kByWait = 1;
inline constexpr std::uint8_t kByLastFrame = 2;

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
        s_(workspace.synchronise),
        subs_(workspace.first_sub.back()) {}
  void run();

 private:
  void find_last_uses();
  void find_last_owners();
  void take_over_memory(std::uint32_t resource);
  std::uint32_t queues_that_wait(std::uint32_t position) const;
  void wait_for_frame_before(std::uint32_t position, std::uint32_t frame_before);
  void use(std::uint32_t position, const AccessRecord& access);
  void use_several(std::uint32_t position, const AccessRecord& access);
  template <typename Function>
  void for_each_part(const AccessRecord& access, Function&& f) const;
  void end_pass(std::uint32_t position);
  void move_layouts(std::uint32_t last);
  void use_range(std::uint32_t position, const AccessRecord& access, std::uint32_t sub,
                 const Range& range);
  void change_layout(std::uint32_t position, const AccessRecord& access, std::uint32_t sub,
                     const Range& range);
  void record_transition(std::uint32_t position, const AccessRecord& access, UseState& state);
  void read_in_same_layout(std::uint32_t position, const AccessRecord& access, UseState& state);
  void write_in_same_layout(std::uint32_t position, const AccessRecord& access, UseState& state);

  // Functions for frames that use several queues.
  void begin_submission(std::uint32_t submission);
  bool is_used_elsewhere(std::uint32_t sub) const;
  void wait_in(VkPipelineStageFlags2 stages, const UseState& state);
  void add_stages(VkPipelineStageFlags2 stages);
  std::uint32_t family(QueueClass queue) const {
    return limits_.queue_families[static_cast<std::size_t>(queue)];
  }
  void tell_other_queues(std::uint32_t sub, const UseState& state);

  // externals.cpp
  void apply_initial_states();
  void apply_final_states();
  void end_reads(std::uint32_t resource, const State& final_state);
  AccessRecord use_outside_frame(std::uint32_t resource, const State& state) const;
  void leave_history_slot(std::uint32_t resource);

  Batch& batch_after(std::int32_t time, std::uint32_t position);
  Transition& next_image(std::int32_t time, std::uint32_t position);
  void merge_neighbours();
  static bool extend(Transition& last, const Transition& next);
  void add_memory(std::int32_t time, std::uint32_t position, const Transition& wanted);

  // Returns the states of all subresources on a queue.
  UseState* states_on(QueueClass queue) {
    return s_.states.data() + (several() ? static_cast<std::size_t>(queue) * subs_ : 0);
  }
  UseState* last_uses_on(QueueClass queue) {
    return s_.last_uses.data() + (several() ? static_cast<std::size_t>(queue) * subs_ : 0);
  }
  bool several() const { return workspace_.several_queues; }
  // Calls f for each queue of the frame except `queue`.
  template <typename Function>
  void for_each_other(QueueClass queue, Function&& f) const {
    for (std::size_t other = 0; other < kQueueClasses && several(); ++other)
      if (other != static_cast<std::size_t>(queue)) f(static_cast<QueueClass>(other));
  }
  void set_queue(QueueClass queue) {
    queue_ = queue;
    states_ = states_on(queue);
  }

  const GraphDescription& graph_;
  const Limits& limits_;
  Workspace& workspace_;
  Plan& plan_;
  Workspace::Synchronise& s_;
  std::size_t subs_;                  // number of subresources
  std::int32_t batch_time_ = kNever;  // time of the last batch
  // The start of the current pass's submission, before which no barrier can be placed.
  std::int32_t earliest_ = kBeforeFrame;
  QueueClass queue_ = QueueClass::graphics;  // of the current pass
  UseState* states_ = nullptr;               // on that queue
  // For each queue and each other queue: the last wait for it, an index into Plan::waits.
  std::uint32_t last_waits_[kQueueClasses][kQueueClasses] = {};
  // For each queue: stages that use what the waits of the previous frame have waited for.
  VkPipelineStageFlags2 next_frame_[kQueueClasses] = {};
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
    s_.batch_memories.clear();
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
  bool is_new = true;
  while (plan_.batches.back().count >= 2) {
    Transition* const last = &plan_.transitions.back();
    if (last[-1].resource != last->resource) return;
    AccessRecord moved;
    moved.resource = last->resource;
    moved.range = last->range;
    if (!extend(last[-1], *last)) return;
    plan_.transitions.pop_back();
    --plan_.batches.back().count;
    // The states of the subresources hold the index of the barrier that was removed, unless it is
    // the new one. They now belong to the barrier into which that one was merged.
    const auto gone = static_cast<std::uint32_t>(plan_.transitions.size());
    if (!is_new) {
      for_each_sub(graph_, workspace_, moved, [&](std::uint32_t sub) {
        if (states_[sub].transition == gone) --states_[sub].transition;
      });
    }
    is_new = false;
  }
}

// Sets the state after an access whose image barrier is the one that was added last.
inline void Synchroniser::record_transition(std::uint32_t position, const AccessRecord& access,
                                            UseState& state) {
  state = {};
  state.write_stages = access.stages;
  state.layout = access.layout;
  state.owner = queue_;
  if (access.flags & kWrite) {
    state.write_access = access.access & kWriteBits;
    state.write_time = pass_time(position);
    return;
  }
  state.write_time = batch_time_;
  state.read_stages = state.seen_stages = access.stages;
  state.seen_access = access.access;
  state.read_time = pass_time(position);
  state.transition = static_cast<std::uint32_t>(plan_.transitions.size() - 1);
}

}  // namespace alcove::framegraph
