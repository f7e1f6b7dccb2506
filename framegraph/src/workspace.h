// The data that the phases of compile() share. It is kept from call to call, so that its memory is
// reused.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "alcove/framegraph/compile.h"
#include "alcove/framegraph/description.h"
#include "alcove/framegraph/error.h"
#include "alcove/framegraph/plan.h"
#include "memory_map.h"

namespace alcove::framegraph {

// The uses of a subresource by one queue that need not wait for each other: one write, or the reads
// in one layout between two writes. Uses of several queues that only read form one group. The chain
// of a subresource is the list of its groups:
//
//   initial state <- write <- reads on graphics -> reads on compute <- write <- final state
//                 previous    (head)           sibling              previous
//
// A group takes the uses of the group before it as its source. If its layout differs, its head
// changes the layout. If a write is followed by reads of several queues in another layout, no
// reader can be the head, because the others would have to wait for it. The head is then a use of
// its own on the queue of the write, which only changes the layout ("move"):
//
//   write <- move -> reads on graphics -> reads on compute
//
struct Use {
  VkPipelineStageFlags2 stages = 0;
  VkAccessFlags2 access = 0;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;  // of a buffer, always undefined
  std::uint32_t resource = kNone;
  std::uint32_t sub = 0;
  std::uint32_t first = kNone;  // positions; kNone for the state before the frame
  std::uint32_t last = kNone;
  std::uint32_t head = kNone;      // the use of its group that changes the layout if needed
  std::uint32_t sibling = kNone;   // the next use of its group
  std::uint32_t previous = kNone;  // of a head: the first use of the group before
  QueueClass queue = QueueClass::graphics;
  bool writes = false;
  bool discards = false;

  bool is_initial_state() const { return first == kNone; }
  // Returns whether it is in the first group of a transient, which finds no contents.
  bool is_first_of_transient() const { return previous == kNone && !is_initial_state(); }
};

// A transient, with the data that placement needs.
struct PlaceItem {
  VkDeviceSize size = 0;
  VkDeviceSize alignment = 1;
  VkDeviceSize offset = 0;
  std::uint32_t first = 0;  // positions
  std::uint32_t last = 0;
  std::uint32_t resource = kNone;
};

struct Workspace {
  // The index of each resource's first subresource in the numbering of all subresources. Within a
  // resource the mip varies fastest, then the layer. A resource with an invalid description has no
  // subresources.
  std::vector<std::uint32_t> first_sub;

  // Whether the frame uses queues other than graphics, or resources that were last used on another
  // queue. The phase queues writes it, and all later phases read it.
  bool several_queues = false;

  // Written by lifetimes, read by place: the live transients in order of first use.
  std::vector<std::uint32_t> transients;

  // The submission of the graphics queue after which the final states are reached.
  std::uint32_t final_submission = 0;

  // Working memory of the individual phases.
  struct Touch {
    std::uint32_t stamp = 0;  // the last pass that used it, from 1
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
    bool reads = false;  // whether that pass does
    bool writes = false;
    bool written = false;  // has contents
  };
  struct Validate {
    std::vector<std::uint32_t> versions;
    std::vector<Touch> touches;  // by subresource
  } validate;
  struct Cull {
    std::vector<std::uint32_t> needed_by;  // by subresource
    // For slot 0 of each history, indexed by resource: a live pass that uses one of the slots.
    std::vector<std::uint32_t> history_user;
  } cull;
  struct Chain {
    std::vector<Use> uses;
    std::vector<std::uint32_t> tails;  // by subresource: the first use of its last group, or kNone
    // By position: the first use that begins there. Then those of the final states, and then the
    // moves, in order of their writes.
    std::vector<std::uint32_t> first_use;
    std::uint32_t first_move = 0;
  } chain;
  // A position for each queue, or one of these values.
  using ByQueue = std::array<std::int32_t, kQueueClasses>;
  static constexpr std::int32_t kOpening = -1;  // the work before the frame
  static constexpr std::int32_t kNever = -2;
  struct Queues {
    std::vector<ByQueue> waits;              // by position: the passes waited for
    std::vector<ByQueue> known;              // by position: the last passes known to be done
    std::vector<std::uint8_t> waited_for;    // by position
    std::vector<std::uint32_t> taken_until;  // by position
    std::vector<std::uint32_t> next;         // by write: the first use of the group after
    std::vector<QueueClass> last_queue;      // by resource: on which the frame leaves a history
  } queues;
  // A range of bytes of a heap that is in use up to and including a position.
  struct UsedRange {
    VkDeviceSize begin = 0;
    VkDeviceSize end = 0;
    std::uint32_t last = 0;
  };
  struct Place {
    std::vector<PlaceItem> items;                // in order of first use
    std::vector<std::vector<PlaceItem>> blocks;  // by block of positions, in order of offset
    std::vector<UsedRange> taken;                // in order of offset
    std::vector<std::int64_t> change;
    std::vector<std::uint32_t> order;
    std::vector<VkDeviceSize> offsets;
  } place;
  // The work after which a use comes: its stages and writes on the queue of the use, and whether
  // semaphore waits order the use after work of other queues.
  struct Source {
    VkPipelineStageFlags2 stages = 0;
    VkAccessFlags2 access = 0;
    std::int32_t time = 0;          // see synchronise.cpp
    std::uint8_t frame_before = 0;  // bits of queues, whose work of the previous frame it is
    bool by_wait = false;           // a wait of this frame
    bool by_last_frame = false;     // a wait of the previous frame
  };
  struct Synchronise {
    std::vector<Source> formers;  // by resource and queue: of what occupied a transient's memory
    std::vector<std::uint8_t> owns_memory;      // by resource: a use has been reached
    std::vector<MemoryMap> memory;              // by heap
    std::vector<std::uint32_t> batch_memories;  // memory barriers of the last batch
    std::vector<std::uint32_t> moves;           // of this submission that are not in the plan yet
    std::vector<std::uint8_t> written;  // by subresource of histories: a live pass writes it
  } synchronise;
};

// Returns the queue class, or graphics if the device has no queue of that class.
inline QueueClass queue_of(const Limits& limits, QueueClass queue) {
  return limits.queue_families[static_cast<std::size_t>(queue)] == kNone ? QueueClass::graphics
                                                                         : queue;
}

// Returns whether the head of a group changes the layout of its subresource.
inline bool changes_layout(const Workspace& workspace, const Use& head) {
  if (head.is_initial_state()) return false;
  return head.layout != (head.previous == kNone ? VK_IMAGE_LAYOUT_UNDEFINED
                                                : workspace.chain.uses[head.previous].layout);
}

// Calls f(subresource index) for each subresource of an access.
template <typename Function>
inline void for_each_sub(const GraphDescription& graph, const Workspace& workspace,
                         const AccessRecord& access, Function&& f) {
  const std::uint32_t* const subs = workspace.first_sub.data() + access.resource;
  const std::uint32_t first = subs[0];
  if (subs[1] == first + 1) [[likely]] {
    f(first);
    return;
  }
  const ResourceRecord& resource = graph.resources[access.resource];
  const Range& range = access.range;
  for (std::uint32_t layer = range.base_layer; layer < range.base_layer + range.layers; ++layer)
    for (std::uint32_t mip = range.base_mip; mip < range.base_mip + range.mips; ++mip)
      f(first + layer * resource.mips + mip);
}

// Calls f(resource index, record, external) for each import and history slot.
template <typename Function>
inline void for_each_external(const GraphDescription& graph, Function&& f) {
  if (graph.externals.empty()) return;
  for (std::uint32_t r = 0; r < graph.resources.size(); ++r) {
    const ResourceRecord& resource = graph.resources[r];
    if (resource.external != kNone) f(r, resource, graph.externals[resource.external]);
  }
}

// The phases, in the order in which they run.

// Numbers the subresources and finds all errors of the declaration. Returns false if there are any.
// Finds the attachments that have earlier contents, and writes plan.contents.
bool validate(const GraphDescription& graph, const Limits& limits, Workspace& workspace, Plan& plan,
              Errors& errors);
// Finds the passes that are not culled and the writes whose result is needed, and writes
// plan.cull_reasons and plan.contents.
void cull(const GraphDescription& graph, Workspace& workspace, Plan& plan);
// Lists the passes that run and the uses of each subresource, and finds the usage of each resource
// and the positions between which it is in use.
void chain(const GraphDescription& graph, const Limits& limits, Workspace& workspace, Plan& plan);
// Divides the passes of several queues into submissions, which changes their positions.
void assign_queues(const GraphDescription& graph, const Limits& limits, Workspace& workspace,
                   Plan& plan);
// Returns whether the device can create the textures that live passes use, and adds an error for
// each one that it cannot create.
bool check_images(const GraphDescription& graph, const Limits& limits, const Plan& plan,
                  Errors& errors);
// Returns the usage with which a history is created: every usage that it can have. A later frame
// that uses it in another way then does not need to create it again, which would lose the contents.
VkFlags history_usage(const Limits& limits, const ResourceRecord& record);
// Assigns each live transient an offset in a heap. Returns whether the device gives memory to all
// of them, and adds an error for each one that gets none.
bool place(const GraphDescription& graph, const Limits& limits, Workspace& workspace, Plan& plan,
           Errors& errors);
// Adds barriers, and the waits of submissions.
void synchronise(const GraphDescription& graph, Workspace& workspace, Plan& plan);

}  // namespace alcove::framegraph
