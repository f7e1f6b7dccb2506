// Device memory, images, buffers and views, kept from frame to frame and shared by all cached
// plans.
//
// The transients of all plans lie in the same heaps, one for each set of memory types. If no frame
// of a while has needed half of a heap, the heaps are freed and allocated anew. A transient is
// looked up by description, usage and offset, so that a cached plan finds its own images again.
// Objects that no frame has used for a while are destroyed after the device has finished with them.
#pragma once

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "alcove/framegraph/device_memory.h"
#include "alcove/framegraph/record_context.h"
#include "device_context.h"

namespace alcove::framegraph {

// The number of frames after which an unused object is destroyed. All objects and heaps are checked
// once in so many frames.
inline constexpr std::uint64_t kFramesUntilEviction = 120;

struct CachedView {
  Range range;
  VkImageViewType type = kViewTypeByRange;
  VkFormat format = VK_FORMAT_UNDEFINED;
  VkImageView view = VK_NULL_HANDLE;
};

struct Physical {
  ResourceRecord record;
  VkFlags usage = 0;
  bool concurrent = false;  // see Placement::concurrent
  VkDeviceSize offset = 0;
  std::uint32_t heap = kNone;  // index into the pool's heaps; kNone if its memory is its own
  VkImage image = VK_NULL_HANDLE;
  VkBuffer buffer = VK_NULL_HANDLE;
  MemoryRange own_memory;
  VkDeviceSize own_size = 0;
  bool owned = true;        // false for imports, of which the pool owns the views only
  std::uint32_t layer = 0;  // the image's layer at which an imported texture begins
  std::vector<CachedView> views;
  // The last frame that used it. For a transient it may be up to half of kFramesUntilEviction
  // older.
  std::uint64_t last_frame = 0;
};

class Pool {
 public:
  explicit Pool(const DeviceContext& device) : device_(device) {}
  ~Pool();
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  // Makes the heaps of a plan large enough. If a heap had to grow, all transients are moved to the
  // list of objects to be destroyed, and `generation` changes.
  [[nodiscard]] VkResult reserve(const Plan& plan, std::uint64_t frame);
  // Finds or creates the transient with this description at this place.
  [[nodiscard]] VkResult transient(const ResourceRecord& record, const Plan& plan,
                                   const Placement& placement, std::string_view name,
                                   Physical*& output);
  // Finds or creates one slot of a history, which has memory of its own.
  [[nodiscard]] VkResult history(const HistoryTable& table, std::uint32_t entry,
                                 std::uint32_t position, const ResourceRecord& record,
                                 VkFlags usage, std::string_view name, Physical*& output);
  // Moves the slots of histories that no longer exist to the list of objects to be destroyed: those
  // that were dropped, those that got another description in an earlier frame, and those whose
  // graph is gone. Histories of other graphs stay.
  void retire_histories(const HistoryTable& table, std::uint64_t frame);
  // Returns an object for an imported resource, whose views are cached by image and layer.
  Physical& import(const ResourceRecord& record, const ImportHandles& handles);
  void forget(VkImage image, std::uint64_t frame);
  // Returns the view of a range, which is created on first use, or null if memory runs out.
  VkImageView view(Physical& physical, const Range& range, VkImageViewType type, VkFormat format);

  // Destroys the objects on the retired list and those that were not used for a while, if the
  // device has finished the last frame that used them. `finished` is the last finished frame.
  void collect(std::uint64_t finished, std::uint64_t frame);

  // Returns a number that changes when transients or histories are created or destroyed.
  std::uint64_t generation() const { return generation_; }
  // See RecordContext: it changes with `generation` and when views of imports are destroyed.
  std::uint64_t handle_epoch() const { return generation_ + destroyed_views_; }
  // Returns the allocated device memory in bytes, including retired objects that are not yet freed.
  VkDeviceSize allocated() const;
  VkDeviceSize history_size() const;

 private:
  using Objects = std::unordered_multimap<std::uint64_t, std::unique_ptr<Physical>>;
  struct HeapMemory {
    std::uint32_t memory_types = 0;
    MemoryRange memory;
    VkDeviceSize size = 0;
    VkDeviceSize needed = 0;     // most bytes that a frame needed since the last check
    bool has_addresses = false;  // whether its buffers may have a device address
  };
  struct HistoryImage {
    std::weak_ptr<const char> table;  // HistoryTable::life()
    std::uint32_t entry = 0;
    std::uint32_t generation = 0;
    std::uint32_t position = 0;
    std::unique_ptr<Physical> physical;
  };
  struct RetiredObject {
    std::uint64_t frame = 0;
    std::unique_ptr<Physical> physical;
    MemoryRange heap;
    VkDeviceSize heap_size = 0;
  };

  // Returns a start value for `generation`. Start values are so far apart that no two pools of the
  // process ever have the same generation.
  static std::uint64_t first_generation();
  // Creates the object with its memory, or nothing if memory runs out.
  VkResult create(Physical& physical, std::string_view name);
  VkResult create_bound(Physical& physical, std::string_view name);
  VkResult allocate(const VkMemoryRequirements& requirements, bool has_addresses,
                    MemoryLifetime lifetime, MemoryRange& memory);
  void free(const MemoryRange& memory) { free_memory(device_.vk, device_.handles, memory); }
  void retire_objects(Objects& objects, std::uint64_t frame);
  // Moves all heaps and transients to the list of objects to be destroyed.
  void retire_transients(std::uint64_t frame);
  void destroy(Physical& physical);
  void set_name(const Physical& physical, std::string_view name);

  const DeviceContext& device_;
  std::vector<HeapMemory> heaps_;
  Objects transients_;  // by offset
  std::vector<HistoryImage> histories_;
  Objects imports_;  // by Vulkan handle
  std::vector<RetiredObject> retired_;
  std::uint64_t generation_ = first_generation();
  std::uint64_t destroyed_views_ = 0;
};

}  // namespace alcove::framegraph
