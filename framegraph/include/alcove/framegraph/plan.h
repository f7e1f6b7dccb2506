// A compiled frame as plain data: which passes run, in which order and on which queue, where each
// transient lies in memory, and every dependency between them.
#pragma once

#include <cstdint>
#include <vector>

#include "alcove/framegraph/types.h"

namespace alcove::framegraph {

// Why a pass is in the plan, or is not.
enum class CullReason : std::uint8_t {
  side_effect,    // the pass runs because it has effects outside the graph
  output,         // the pass runs because it writes an output, or an import with a final state
  feeds_pass,     // the pass runs because `consumer` reads what it writes
  feeds_history,  // the pass runs because `consumer` uses the history that it writes, or, without a
                  // consumer, because an older slot of that history has no contents yet
  unread,         // the pass is culled because no pass that runs reads what it writes
  writes_nothing  // the pass is culled because it writes nothing and has no side effect
};

struct PassCullReason {
  CullReason cull_reason = CullReason::unread;
  std::uint32_t consumer = kNone;  // the pass that needs it
  std::uint32_t resource = kNone;  // the resource that the consumer needs
  bool is_live() const { return cull_reason < CullReason::unread; }
};

// One dependency of a barrier command. If `resource` is set, it is an image barrier over `range`.
// Otherwise it is a memory barrier over all memory, which is enough for a buffer and for a texture
// that keeps its layout.
struct Transition {
  VkPipelineStageFlags2 src_stages = 0;
  VkAccessFlags2 src_access = 0;
  VkPipelineStageFlags2 dst_stages = 0;
  VkAccessFlags2 dst_access = 0;
  std::uint32_t resource = kNone;
  VkImageLayout old_layout = VK_IMAGE_LAYOUT_UNDEFINED;
  VkImageLayout new_layout = VK_IMAGE_LAYOUT_UNDEFINED;
  Range range;
};

// The transitions that one vkCmdPipelineBarrier2 records, before a pass or after the last pass of a
// submission.
struct Batch {
  std::uint32_t first = 0;  // into Plan::transitions
  std::uint32_t count = 0;
};

// A pass that runs. Positions index Plan::passes, in the order of declaration.
struct PlannedPass {
  std::uint32_t pass = kNone;  // declaration index
  QueueClass queue = QueueClass::graphics;
  std::uint32_t submission = 0;  // into Plan::submissions
  std::uint32_t batch = kNone;   // into Plan::batches; recorded before the pass; kNone: no barriers
  std::uint32_t next = kNone;    // the next pass of its submission
};

// Work that is submitted to one queue at once. A submission waits only for earlier submissions.
//
// Consecutive frames of one plan may overlap on the GPU. Barriers order work after the previous
// frame's work on the same queue if both use the same memory or histories. The bits of
// `frame_before` say for which other queues' work of the previous frame the submission waits.
struct Submission {
  QueueClass queue = QueueClass::graphics;
  // A mask with one bit per queue class. The submission waits until all work of the previous frame
  // on these queues is done, because it uses memory or a history that this work used.
  std::uint8_t frame_before = 0;
  std::uint32_t first_pass = 0;  // a position; the others follow by PlannedPass::next
  std::uint32_t pass_count = 0;
  std::uint32_t first_wait = 0;  // into Plan::waits
  std::uint32_t wait_count = 0;
  std::uint32_t end_batch = kNone;  // into Plan::batches; recorded after its last pass
};

// A wait for a timeline semaphore. Work in `stages` of the waiting submission, and of later ones on
// its queue, begins after all work of the submission with the index `submission` is done. The
// stages are those that first use what is waited for.
struct Wait {
  std::uint32_t submission = 0;
  VkPipelineStageFlags2 stages = 0;
};

// The memory of a transient. A resource that no live pass uses has heap == kNone.
struct Placement {
  std::uint32_t heap = kNone;
  VkDeviceSize offset = 0;
  VkDeviceSize size = 0;
  VkDeviceSize alignment = 1;
  std::uint32_t first = kNone;  // positions of its first and its last use
  std::uint32_t last = kNone;
  VkFlags usage = 0;  // of all live accesses
  // Passes of several queue families use it: it is created with VK_SHARING_MODE_CONCURRENT.
  bool concurrent = false;
};

struct Heap {
  std::uint32_t memory_types = 0;  // allowed memory types, as a mask
  bool device_address = false;     // whether it has buffers with a device address
  VkDeviceSize alignment = 1;      // the largest of its resources
  VkDeviceSize size = 0;           // in bytes
  VkDeviceSize lower_bound = 0;    // most bytes that are live at the same time
  VkDeviceSize unaliased = 0;      // sum of the sizes
};

// Whether an access finds contents in its range and whether it leaves some that are needed.
enum ContentFlags : std::uint8_t {
  kHasContents = 1,  // the access keeps earlier contents, and there are some
  kIsNeeded = 2,     // a later pass, or whoever comes after the frame, needs what the access leaves
};

// The mips and layers of a history slot that the live passes wrote: none, some or all.
enum class WriteCoverage : std::uint8_t { nothing, part, whole };

// The state in which the frame leaves a history slot, and from which the next frame starts. If the
// state has read accesses, the last write is already visible to them.
struct FinalState {
  std::uint32_t resource = kNone;
  State state;
  QueueClass queue = QueueClass::graphics;
  WriteCoverage written = WriteCoverage::nothing;
};

struct Plan {
  std::vector<PlannedPass> passes;
  std::vector<Batch> batches;
  std::vector<Transition> transitions;
  std::vector<Submission> submissions;
  std::vector<Wait> waits;
  std::vector<Placement> placements;  // by resource
  std::vector<Heap> heaps;
  std::vector<PassCullReason> cull_reasons;  // by declared pass
  std::vector<std::uint8_t> contents;        // by declared access: ContentFlags
  std::vector<FinalState> finals;
  // The submission of the graphics queue after which imports are in their final states. kNone if
  // the frame has no imports and no pass on the graphics queue.
  std::uint32_t final_submission = 0;
  std::uint32_t final_batch = kNone;  // into batches; recorded at the end of final_submission
};

}  // namespace alcove::framegraph
