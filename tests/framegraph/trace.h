// Two frames of a plan, one after the other, as a list of what the device is told: operations, and
// the barriers, events and semaphores between them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "alcove/framegraph/description.h"
#include "alcove/framegraph/plan.h"

namespace alcove::framegraph {

inline constexpr VkAccessFlags2 kWriteMask =
    VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
    VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;

// Without those that stand for others, as far as these tests have them.
VkPipelineStageFlags2 plain(VkPipelineStageFlags2 stages);
VkAccessFlags2 plain_access(VkAccessFlags2 access);

// An access of a pass, a layout change, or what came before or comes after the frame.
struct Operation {
  std::uint32_t resource = 0;
  std::uint32_t sub = 0;
  std::size_t queue = 0;
  VkPipelineStageFlags2 stages = 0;
  VkAccessFlags2 access = 0;
  bool writes = false;
  bool unordered = false;  // Contents::accumulate
  bool releases = false;   // to another queue: nothing on this one follows it
  bool departs = false;    // the use after the frame: it comes after reads in other stages too
  std::uint32_t frame = 0;
  std::uint32_t step = 0;  // steps at or above this come after it
  const Transition* change = nullptr;
};

// The barriers recorded by one command, or where a submission begins or ends; those of
// two frames are numbered through.
struct Step {
  enum class Kind : std::uint8_t { barriers, begins, ends };
  Kind kind = Kind::barriers;
  std::size_t queue = 0;
  std::vector<const Transition*> barriers;
  // The numbers of the operations and steps that come before the barriers.
  std::size_t operations_before = 0;
  std::uint32_t steps_before = 0;
  std::vector<Wait> waits;       // of a submission that begins
  std::uint32_t submission = 0;  // that ends
};

struct Trace {
  std::vector<Operation> operations;
  std::vector<Step> steps;
};

// It points into the plan.
Trace trace_of(const GraphDescription& graph, const Plan& plan);

}  // namespace alcove::framegraph
