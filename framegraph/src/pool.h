// The physical side: device memory, images, buffers and views, kept from frame to frame and shared
// by all cached plans.
//
// Transients of every plan lie in the same heaps, one for each set of memory types, which only
// grow. A transient is found again by description, usage and offset, so that a plan that comes back
// finds its very images. Objects that no frame used for a while are destroyed once the device is
// done with them.
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
  std::uint32_t heap = kNone;  // into the pool's heaps; kNone with memory of its own
  VkImage image = VK_NULL_HANDLE;
  VkBuffer buffer = VK_NULL_HANDLE;
  MemoryRange own_memory;
  VkDeviceSize own_size = 0;
  bool owned = true;        // false for imports: only the views are the pool's
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

  // Makes the heaps of a plan large enough. When one had to grow, all transients are retired and
  // `generation` changes.
  [[nodiscard]] VkResult reserve(const GraphDescription& graph, const Plan& plan,
                                 std::uint64_t frame);
  // The transient of this description at this place.
  [[nodiscard]] VkResult transient(const ResourceRecord& record, const Plan& plan,
                                   const Placement& placement, std::string_view name,
                                   Physical*& found);
  // One slot of a history, with memory of its own.
  [[nodiscard]] VkResult history(const HistoryTable& table, std::uint32_t entry,
                                 std::uint32_t position, const ResourceRecord& record,
                                 VkFlags usage, std::string_view name, Physical*& found);
  // The slot of a history if it was made already, else null.
  Physical* find_history(const HistoryTable& table, std::uint32_t entry,
                         std::uint32_t position) const;
  // Retires what belongs to no entry any more: dropped, made anew in another shape in an earlier
  // frame, or of a graph that is gone. Other graphs' histories stay.
  void retire_histories(const HistoryTable& table, std::uint64_t frame);
  // A stand-in for an import: its views are cached by image and layer.
  Physical& import(const ResourceRecord& record, const ImportHandles& handles);
  void forget(VkImage image, std::uint64_t frame);
  // The view of a range, made on first use; null when the device is out of memory. Several threads
  // may ask at the same time.
  VkImageView view(Physical& physical, const Range& range, VkImageViewType type, VkFormat format);

  // Destroys what is retired or was not used for long, up to a frame that the device has finished.
  void collect(std::uint64_t finished, std::uint64_t frame);

  std::uint64_t generation() const { return generation_; }
  // Bytes of device memory, what is retired and not yet freed among them.
  VkDeviceSize allocated() const;
  VkDeviceSize history_size() const;
  // Why an allocation of device memory has failed since the last call; may be empty.
  std::string take_shortage() { return memory_.take_reason(); }

 private:
  struct HeapMemory {
    std::uint32_t memory_types = 0;
    MemoryRange memory;
    VkDeviceSize size = 0;
    bool has_addresses = false;  // Buffers in it may have a device address.
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

  // Far enough apart that no two pools of the process ever have a generation in common.
  static std::uint64_t first_generation();
  VkResult create(Physical& physical, std::string_view name);
  VkResult allocate(const VkMemoryRequirements& requirements, bool has_addresses,
                    MemoryRange& memory);
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
