// The synchroniser: see synchronise.cpp, and handover.cpp for what goes from queue to queue,
// split_barriers.cpp for events.
#pragma once

#include "memory_map.h"
#include "workspace.h"

namespace alcove::framegraph {

// Stages of this access that a semaphore wait covers.
inline VkPipelineStageFlags2 waited_stages(const AccessRecord& access) {
  const VkPipelineStageFlags2 stages =
      access.stages & ~(VK_PIPELINE_STAGE_2_HOST_BIT | VK_PIPELINE_STAGE_2_BOTTOM_OF_PIPE_BIT);
  return stages != 0 ? stages : VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
}

// A time before the frame: see UseState.
inline constexpr std::int32_t kBeforeFrame = -1;

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
  void arrive();
  void find_last_uses();
  void find_last_owners();
  void take_over_memory(std::uint32_t resource);
  void use(std::uint32_t position, const AccessRecord& access);
  void use_range(std::uint32_t position, const AccessRecord& access, UseState& state,
                 const Range& range);
  void change_layout(std::uint32_t position, const AccessRecord& access, UseState& state,
                     const Range& range);
  void note_change(std::uint32_t position, const AccessRecord& access, UseState& state,
                   std::uint32_t transition);
  bool change_queue(std::uint32_t position, const AccessRecord& access, UseState& state,
                    const Range& range);
  void take_without_giver(UseState& state, bool same_family) const;
  Transition release_of(const AccessRecord& access, const UseState& state,
                        const Range& range) const;
  void add_releases();
  void read_again(std::uint32_t position, const AccessRecord& access, UseState& state);
  void write_again(std::uint32_t position, const AccessRecord& access, UseState& state);
  void depart();
  void split();
  std::uint32_t set_position(std::uint32_t position) const;
  bool can_split(const Batch& batch) const;
  AccessRecord outside_use(std::uint32_t resource, const State& state) const;
  void leave(std::uint32_t resource);

  Batch& batch_after(std::int32_t time, std::uint32_t position);
  std::uint32_t add_image(std::int32_t time, std::uint32_t position, const Transition& wanted);
  void add_memory(std::int32_t time, std::uint32_t position, const Transition& wanted);

  const GraphDescription& graph_;
  const Limits& limits_;
  Workspace& workspace_;
  Plan& plan_;
  Workspace::Synchronise& s_;
  std::uint32_t batch_position_ = kNone;     // of the last batch
  QueueClass queue_ = QueueClass::graphics;  // of the pass in hand
  std::uint32_t floor_ = 0;  // first position of its submission: no barrier can be put before
};

}  // namespace alcove::framegraph
