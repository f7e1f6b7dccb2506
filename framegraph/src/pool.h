// Device memory, images, buffers and views, kept from frame to frame and shared by all cached
// plans.
//
// The transients of all plans lie in the same heaps, one for each set of memory types. Heaps only
// grow. A transient is looked up by description, usage and offset, so that a cached plan finds its
// own images again. Objects that no frame has used for a while are destroyed after the device has
// finished with them.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "alcove/framegraph/record_context.h"
#include "device_allocator.h"

namespace alcove::framegraph {

struct CachedView {
  Range range;
  VkImageViewType type = kViewTypeByRange;
  VkFormat format = VK_FORMAT_UNDEFINED;
  VkImageView view = VK_NULL_HANDLE;
};

struct Physical {
  ResourceRecord record;
  VkFlags usage = 0;
  VkDeviceSize offset = 0;
  std::uint32_t heap = kNone;  // index into the pool's heaps; kNone if its memory is its own
  VkImage image = VK_NULL_HANDLE;
  VkBuffer buffer = VK_NULL_HANDLE;
  MemoryRange own_memory;
  VkDeviceSize own_size = 0;
  bool owned = true;        // false for imports, of which the pool owns the views only
  std::uint32_t layer = 0;  // the image's layer at which an imported texture begins
  std::vector<CachedView> views;
  std::uint64_t last_frame = 0;
};

class Pool {
 public:
  explicit Pool(const DeviceContext& device) : device_(device), memory_(device) {}
  ~Pool();
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  // Makes the heaps of a plan large enough. If a heap had to grow, all transients are moved to the
  // list of objects to be destroyed, and `generation` changes.
  [[nodiscard]] VkResult reserve(const GraphDescription& graph, const Plan& plan,
                                 std::uint64_t frame);
  // Finds or creates the transient with this description at this place.
  [[nodiscard]] VkResult transient(const ResourceRecord& record, const Plan& plan,
                                   const Placement& placement, std::string_view name,
                                   Physical*& found);
  // Finds or creates one slot of a history, which has memory of its own.
  [[nodiscard]] VkResult history(const HistoryTable& table, std::uint32_t entry,
                                 std::uint32_t position, const ResourceRecord& record,
                                 VkFlags usage, std::string_view name, Physical*& found);
  // Returns the slot of a history, or null if it was not created yet.
  Physical* find_history(const HistoryTable& table, std::uint32_t entry,
                         std::uint32_t position) const;
  // Moves the slots of histories that no longer exist to the list of objects to be destroyed: those
  // that were dropped, those that got another description in an earlier frame, and those whose
  // graph is gone. Histories of other graphs stay.
  void retire_histories(const HistoryTable& table, std::uint64_t frame);
  // Returns an object for an imported resource, whose views are cached by image and layer.
  Physical& import(const ResourceRecord& record, const ImportHandles& handles);
  void forget(VkImage image, std::uint64_t frame);
  // Returns the view of a range, which is created on first use, or null if memory runs out. Several
  // threads may call it at the same time.
  VkImageView view(Physical& physical, const Range& range, VkImageViewType type, VkFormat format);

  // Destroys the objects on the retired list and those that were not used for a while, if the
  // device has finished the last frame that used them. `finished` is the last finished frame.
  void collect(std::uint64_t finished, std::uint64_t frame);

  std::uint64_t generation() const { return generation_; }
  // Returns the allocated device memory in bytes, including retired objects that are not yet freed.
  VkDeviceSize allocated() const;
  VkDeviceSize history_size() const;
  // Returns the reason why an allocation of device memory has failed since the last call. It may be
  // empty.
  std::string take_shortage() { return memory_.take_reason(); }

 private:
  struct HeapMemory {
    std::uint32_t memory_types = 0;
    MemoryRange memory;
    VkDeviceSize size = 0;
    bool has_addresses = false;  // whether its buffers may have a device address
  };
  struct HistoryImage {
    std::weak_ptr<const char> table;  // HistoryTable::life()
    std::uint32_t entry = 0;
    std::uint32_t generation = 0;
    std::uint32_t position = 0;
    std::unique_ptr<Physical> physical;
  };
  struct Retired {
    std::uint64_t frame = 0;
    std::unique_ptr<Physical> physical;
    MemoryRange heap;
    VkDeviceSize heap_size = 0;
  };

  // Returns a start value for `generation`. Start values are so far apart that no two pools of the
  // process ever have the same generation.
  static std::uint64_t first_generation();
  VkResult create(Physical& physical, std::string_view name);
  VkResult allocate(const VkMemoryRequirements& requirements, bool has_addresses,
                    MemoryLifetime lifetime, MemoryRange& memory);
  void destroy(Physical& physical);
  void set_name(const Physical& physical, std::string_view name);

  const DeviceContext& device_;
  DeviceAllocator memory_;
  std::vector<HeapMemory> heaps_;
  std::vector<std::unique_ptr<Physical>> transients_;
  std::vector<HistoryImage> histories_;
  std::vector<std::unique_ptr<Physical>> imports_;
  std::vector<Retired> retired_;
  std::uint64_t generation_ = first_generation();
  std::mutex views_mutex_;  // guards the views
};

}  // namespace alcove::framegraph
