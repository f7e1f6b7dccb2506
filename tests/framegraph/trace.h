// Lists the work of two consecutive frames of a plan: the operations, and the barriers and
// semaphores between them.
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

// Replaces stages that stand for several others by those stages, as far as these tests use them.
VkPipelineStageFlags2 plain(VkPipelineStageFlags2 stages);
VkAccessFlags2 plain_access(VkAccessFlags2 access);

// An access of a pass, a layout change, or a use before or after the frame.
struct Operation {
  std::uint32_t resource = 0;
  std::uint32_t sub = 0;
  std::size_t queue = 0;
  VkPipelineStageFlags2 stages = 0;
  VkAccessFlags2 access = 0;
  bool writes = false;
  bool unordered = false;  // Contents::accumulate
  bool releases = false;   // an ownership release, after which this queue does not use it
  bool departs = false;    // the use after the frame, which must also come after all reads
  std::uint32_t frame = 0;
  std::uint32_t step = 0;  // steps with this index or a higher one come after it
  const Transition* change = nullptr;
};

// The barriers of one command, or the beginning or end of a submission. The submissions of both
// frames are numbered consecutively.
struct Step {
  enum class Kind : std::uint8_t { barriers, begins, ends };
  Kind kind = Kind::barriers;
  std::size_t queue = 0;
  std::vector<const Transition*> barriers;
  // The number of operations that come before the barriers.
  std::size_t operations_before = 0;
  std::uint32_t steps_before = 0;
  std::vector<Wait> waits;       // if a submission begins: its waits
  std::uint32_t submission = 0;  // if a submission ends: its number
};

struct Trace {
  std::vector<Operation> operations;
  std::vector<Step> steps;
};

// Returns the trace of a plan. It refers to the plan, which must outlive it.
Trace trace_of(const GraphDescription& graph, const Plan& plan);

}  // namespace alcove::framegraph
