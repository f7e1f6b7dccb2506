// The data that the phases of compile() share. It is kept from call to call, so that its memory is
// reused.
#pragma once

#include <cstdint>
#include <vector>

#include "alcove/framegraph/compile.h"
#include "alcove/framegraph/description.h"
#include "alcove/framegraph/error.h"
#include "alcove/framegraph/plan.h"
#include "memory_map.h"

namespace alcove::framegraph {

// Points in time within a frame, in half positions: the batch of barriers before the pass at
// position p has the time 2p, and the pass itself has the time 2p + 1.
inline constexpr std::int32_t kBeforeFrame = -1;
inline constexpr std::int32_t kNever = -2;

// The last uses of a subresource, or of a range of bytes of memory, on one queue. If another queue
// changed it last, the state holds the uses since the wait for that change.
struct UseState {
  VkPipelineStageFlags2 write_stages = 0;  // of the last write or layout change
  VkAccessFlags2 write_access = 0;         // 0 after a layout change, which is available by itself
  VkPipelineStageFlags2 read_stages = 0;   // of the reads after that write
  VkPipelineStageFlags2 seen_stages = 0;   // by which the write can be seen
  VkAccessFlags2 seen_access = 0;
  std::int32_t write_time = kNever;
  std::int32_t read_time = kNever;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
  std::uint32_t transition = kNone;  // the image barrier that made this layout
  // The queues that must wait for work of the previous frame before they take over this memory.
  // There are three bits for each waiting queue class: one for each queue class whose work it must
  // wait for.
  std::uint32_t frame_before = 0;
  // Set if other resources occupied this memory before. The recorded reads and writes may then
  // belong to different resources, so that a barrier has to wait for both.
  std::uint8_t reuses_memory = 0;
  // Says which semaphore waits order the next use after work of another queue: kByWait for those of
  // this frame, kByLastFrame for those of the previous frame.
  std::uint8_t by_wait = 0;
  QueueClass owner = QueueClass::graphics;  // the queue that changed it last
  bool operator==(const UseState&) const = default;
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
  struct Queues {
    // The uses of a subresource since it was last changed: written, or moved to another layout.
    struct Uses {
      std::uint32_t changed = kNone;  // position of the change, kNone if it was before the frame
      std::uint32_t last[kQueueClasses] = {kNone, kNone, kNone};  // by queue, with the change
      VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
      QueueClass owner = QueueClass::graphics;  // that changed it last
    };
    // The reads of a subresource between two writes: their layout and their queues, one bit each.
    struct Reads {
      static constexpr VkImageLayout kMixed = VK_IMAGE_LAYOUT_MAX_ENUM;
      VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
      std::uint32_t queues = 0;

      void add(const Reads& more) {
        if (more.queues != 0) layout = queues == 0 || layout == more.layout ? more.layout : kMixed;
        queues |= more.queues;
      }
    };
    std::vector<Uses> uses;    // by subresource
    std::vector<Reads> reads;  // by subresource
    // By access: the layout to which the queue of the writer changes what the access wrote, at the
    // end of its submission, or VK_IMAGE_LAYOUT_UNDEFINED.
    std::vector<VkImageLayout> moved_layouts;
    std::vector<std::uint32_t> waits;      // by position and queue: the pass waited for
    std::vector<std::uint8_t> waited_for;  // by position
    std::vector<std::uint8_t> opened;      // by position: bits of opening submissions waited for
    std::vector<std::uint8_t> opened_at;   // by position: of those known to be done
    std::vector<std::int32_t> known_at;    // by position and queue, before regrouping
    std::vector<std::int32_t> known;       // the last position of the queue known to be done
    std::vector<std::uint32_t> submission_of;
    std::vector<std::uint32_t> new_position;
    std::vector<std::uint32_t> taken_until;  // by position
    std::vector<QueueClass> last_queue;      // by resource: on which the frame leaves a history
    std::vector<PlannedPass> moved;
    std::uint32_t opening[kQueueClasses] = {kNone, kNone, kNone};  // submission before the passes
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
  struct Synchronise {
    // Both arrays have one entry for each subresource and, if the frame uses several queues, each
    // queue: first all subresources on the graphics queue, then those on the next one.
    std::vector<UseState> states;
    std::vector<UseState> last_uses;            // at the end of a frame, where is_last
    std::vector<std::uint8_t> is_last;          // by resource: had its memory last
    std::vector<std::uint8_t> written;          // by subresource: a live pass writes it
    std::vector<MemoryMap> memory;              // by heap
    std::vector<std::uint32_t> batch_memories;  // memory barriers of the last batch
    std::vector<std::uint32_t> moves;           // accesses of this submission with moved layouts
  } synchronise;
};

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

// The phases, in the order in which they run.

// Numbers the subresources and finds all errors of the declaration. Returns false if there are any.
// Finds the attachments that have earlier contents, and writes plan.contents.
bool validate(const GraphDescription& graph, const Limits& limits, Workspace& workspace, Plan& plan,
              Errors& errors);
// Finds the passes that are not culled and the writes whose result is needed, and writes
// plan.cull_reasons and plan.contents.
void cull(const GraphDescription& graph, Workspace& workspace, Plan& plan);
// Assigns passes to queues and submissions.
void assign_queues(const GraphDescription& graph, const Limits& limits, Workspace& workspace,
                   Plan& plan);
// Finds the first and last position of each resource, and its usage.
void lifetimes(const GraphDescription& graph, const Limits& limits, Workspace& workspace,
               Plan& plan);
// Returns whether the device can create the textures that live passes use, and adds an error for
// each one that it cannot create.
bool check_images(const GraphDescription& graph, const Limits& limits, const Plan& plan,
                  Errors& errors);
// Returns the usage with which a history is created: every usage that it can have. A later frame
// that uses it in another way then does not need to create it again, which would lose the contents.
VkFlags history_usage(const Limits& limits, const ResourceRecord& record);
// Assigns each live transient an offset in a heap.
void place(const GraphDescription& graph, const Limits& limits, Workspace& workspace, Plan& plan);
// Adds barriers, and the waits of submissions.
void synchronise(const GraphDescription& graph, const Limits& limits, Workspace& workspace,
                 Plan& plan);

}  // namespace alcove::framegraph
