#include "pool.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstring>

#include "aspects.h"

namespace alcove::framegraph {
namespace {

// Makes room for `more` values before they exist, so that no object is lost if memory runs out.
template <typename Value>
void make_room(std::vector<Value>& values, std::size_t more = 1) {
  const std::size_t size = values.size() + more;
  if (size > values.capacity()) values.reserve(std::max(size, 2 * values.size()));
}

bool belongs_to(const std::weak_ptr<const char>& life, const HistoryTable& table) {
  const auto own = table.life();
  return !life.owner_before(own) && !own.owner_before(life);
}

// Returns the bits of an image or buffer; the other one is null. A handle is a pointer or an
// integer, depending on the platform. This cast works for both.
std::uint64_t handle_key(VkImage image, VkBuffer buffer) {
  return (std::uint64_t)image ^ (std::uint64_t)buffer;
}

bool same(const ResourceRecord& a, const ResourceRecord& b) {
  // Compares descriptions only. The origin of a resource does not matter.
  return a.kind == b.kind && a.size == b.size && a.format == b.format && a.width == b.width &&
         a.height == b.height && a.depth == b.depth && a.mips == b.mips && a.layers == b.layers &&
         a.samples == b.samples && a.create_flags == b.create_flags;
}

}  // namespace

std::uint64_t Pool::first_generation() {
  static std::atomic<std::uint64_t> pools = 0;
  return (++pools << 40) + 1;
}

Pool::~Pool() {
  for (auto& [offset, physical] : transients_) destroy(*physical);
  for (auto& history : histories_) destroy(*history.physical);
  for (auto& [handle, physical] : imports_) destroy(*physical);
  for (auto& retired : retired_) {
    if (retired.physical) destroy(*retired.physical);
    free(retired.heap);
  }
  for (const HeapMemory& heap : heaps_) free(heap.memory);
}

VkResult Pool::reserve(const Plan& plan, std::uint64_t frame) {
  for (const Heap& plan_heap : plan.heaps) {
    auto heap = std::find_if(heaps_.begin(), heaps_.end(), [&](const HeapMemory& memory) {
      return memory.memory_types == plan_heap.memory_types;
    });
    if (heap == heaps_.end()) {
      heaps_.push_back({plan_heap.memory_types});
      heap = heaps_.end() - 1;
    }
    heap->needed = std::max(heap->needed, plan_heap.size);
    const bool has_addresses = heap->has_addresses || plan_heap.device_address;
    if (heap->size >= plan_heap.size && heap->has_addresses == has_addresses) continue;
    const VkDeviceSize size = std::max(heap->size, plan_heap.size);
    make_room(retired_, transients_.size() + 1);  // before anything is allocated or retired
    MemoryRange memory;
    if (const VkResult result = allocate({size, plan_heap.alignment, plan_heap.memory_types},
                                         has_addresses, MemoryLifetime::frame, memory))
      return result;
    // This includes transients of other heaps, because creating them again is cheap.
    retire_objects(transients_, frame);
    if (heap->memory.memory) retired_.push_back({frame, nullptr, heap->memory, heap->size});
    heap->memory = memory;
    heap->size = size;
    heap->has_addresses = has_addresses;
    ++generation_;
  }
  return VK_SUCCESS;
}

void Pool::retire_objects(Objects& objects, std::uint64_t frame) {
  make_room(retired_, objects.size());
  for (auto& [key, physical] : objects) retired_.push_back({frame, std::move(physical)});
  objects.clear();
}

void Pool::retire_transients(std::uint64_t frame) {
  retire_objects(transients_, frame);
  make_room(retired_, heaps_.size());
  for (const HeapMemory& heap : heaps_)
    retired_.push_back({frame, nullptr, heap.memory, heap.size});
  heaps_.clear();
  ++generation_;
}

VkResult Pool::transient(const ResourceRecord& record, const Plan& plan, const Placement& placement,
                         std::string_view name, Physical*& output) {
  const std::uint32_t types = plan.heaps[placement.heap].memory_types;
  const auto heap = std::find_if(heaps_.begin(), heaps_.end(),
                                 [types](const HeapMemory& h) { return h.memory_types == types; });
  const auto index = static_cast<std::uint32_t>(heap - heaps_.begin());
  const auto [first, last] = transients_.equal_range(placement.offset);
  for (auto at = first; at != last; ++at) {
    Physical& other = *at->second;
    if (other.heap == index && other.usage == placement.usage &&
        other.concurrent == placement.concurrent && same(other.record, record)) {
      output = &other;
      return VK_SUCCESS;
    }
  }
  auto physical = std::make_unique<Physical>();
  physical->record = record;
  physical->usage = placement.usage;
  physical->concurrent = placement.concurrent;
  physical->heap = index;
  physical->offset = placement.offset;
  if (const VkResult result = create(*physical, name)) return result;
  output = transients_.emplace(placement.offset, std::move(physical))->second.get();
  return VK_SUCCESS;
}

VkResult Pool::history(const HistoryTable& table, std::uint32_t entry, std::uint32_t position,
                       const ResourceRecord& record, VkFlags usage, std::string_view name,
                       Physical*& output) {
  const std::uint32_t generation = table.entries()[entry].generation;
  for (const HistoryImage& other : histories_) {
    if (other.entry == entry && other.position == position && other.generation == generation &&
        belongs_to(other.table, table)) {
      output = other.physical.get();
      return VK_SUCCESS;
    }
  }
  make_room(histories_);
  auto physical = std::make_unique<Physical>();
  physical->record = record;
  physical->usage = usage;
  // Passes of any queue may use it in later frames.
  physical->concurrent = device_.families.size() > 1;
  if (const VkResult result = create(*physical, name)) return result;
  histories_.push_back({table.life(), entry, generation, position, std::move(physical)});
  ++generation_;
  output = histories_.back().physical.get();
  return VK_SUCCESS;
}

void Pool::retire_histories(const HistoryTable& table, std::uint64_t frame) {
  make_room(retired_, histories_.size());
  const auto gone = [&](HistoryImage& history) {
    const bool stays = belongs_to(history.table, table)
                           ? table.needs(history.entry, history.generation)
                           : !history.table.expired();
    if (stays) return false;
    retired_.push_back({frame, std::move(history.physical)});
    return true;
  };
  if (std::erase_if(histories_, gone) != 0) ++generation_;
}

Physical& Pool::import(const ResourceRecord& record, const ImportHandles& handles) {
  const std::uint64_t key = handle_key(handles.image, handles.buffer);
  const auto [first, last] = imports_.equal_range(key);
  for (auto at = first; at != last; ++at) {
    Physical& other = *at->second;
    if (other.image == handles.image && other.buffer == handles.buffer &&
        other.layer == handles.layer && same(other.record, record))
      return other;
  }
  auto physical = std::make_unique<Physical>();
  physical->record = record;
  physical->image = handles.image;
  physical->buffer = handles.buffer;
  physical->layer = handles.layer;
  physical->owned = false;
  return *imports_.emplace(key, std::move(physical))->second;
}

void Pool::forget(VkImage image, std::uint64_t frame) {
  make_room(retired_, imports_.size());
  const auto [first, last] = imports_.equal_range(handle_key(image, VK_NULL_HANDLE));
  for (auto at = first; at != last;) {
    if (at->second->image == image) {
      retired_.push_back({frame, std::move(at->second)});
      ++destroyed_views_;
      at = imports_.erase(at);
    } else {
      ++at;
    }
  }
}

VkImageView Pool::view(Physical& physical, const Range& range, VkImageViewType type,
                       VkFormat format) {
  if (type == kViewTypeByRange)
    type = physical.record.depth > 1 ? VK_IMAGE_VIEW_TYPE_3D
           : range.layers > 1        ? VK_IMAGE_VIEW_TYPE_2D_ARRAY
                                     : VK_IMAGE_VIEW_TYPE_2D;
  if (format == VK_FORMAT_UNDEFINED) format = physical.record.format;
  for (const CachedView& cached : physical.views)
    if (cached.range == range && cached.type == type && cached.format == format) return cached.view;
  make_room(physical.views);
  const VkImageViewCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
      .image = physical.image,
      .viewType = type,
      .format = format,
      .subresourceRange = {view_aspect(physical.record.format), range.base_mip, range.mips,
                           physical.layer + range.base_layer, range.layers}};
  VkImageView view = VK_NULL_HANDLE;
  if (device_.vk.vkCreateImageView(device_.handles.device, &info, device_.callbacks(), &view) !=
      VK_SUCCESS)
    return VK_NULL_HANDLE;
  physical.views.push_back({range, type, format, view});
  return view;
}

void Pool::collect(std::uint64_t finished, std::uint64_t frame) {
  std::erase_if(retired_, [&](RetiredObject& retired) {
    if (retired.frame > finished) return false;
    if (retired.physical) destroy(*retired.physical);
    free(retired.heap);
    return true;
  });
  const auto destroy_unused = [&](Objects& objects) {
    return std::erase_if(objects, [&](auto& object) {
      Physical& physical = *object.second;
      if (physical.last_frame + kFramesUntilEviction > frame || physical.last_frame > finished)
        return false;
      if (!physical.owned && !physical.views.empty()) ++destroyed_views_;
      destroy(physical);
      return true;
    });
  };
  if (frame % kFramesUntilEviction != 0) return;
  if (destroy_unused(transients_) != 0) ++generation_;
  destroy_unused(imports_);
  bool shrinks = false;
  for (HeapMemory& heap : heaps_) {
    shrinks |= heap.needed < heap.size / 2;
    heap.needed = 0;
  }
  if (shrinks) retire_transients(frame - 1);
}

VkDeviceSize Pool::allocated() const {
  VkDeviceSize sum = history_size();
  for (const HeapMemory& heap : heaps_) sum += heap.size;
  for (const RetiredObject& retired : retired_)
    sum += retired.heap_size + (retired.physical ? retired.physical->own_size : 0);
  return sum;
}

VkDeviceSize Pool::history_size() const {
  VkDeviceSize sum = 0;
  for (const HistoryImage& history : histories_) sum += history.physical->own_size;
  return sum;
}

VkResult Pool::create(Physical& physical, std::string_view name) {
  const VkResult result = create_bound(physical, name);
  if (result != VK_SUCCESS) destroy(physical);
  return result;
}

VkResult Pool::create_bound(Physical& physical, std::string_view name) {
  const VkDevice device = device_.handles.device;
  VkMemoryRequirements requirements{};
  VkResult result = create_unbound(device_, physical.record, physical.usage, physical.concurrent,
                                   physical.image, physical.buffer, requirements);
  if (result != VK_SUCCESS) return result;
  set_name(physical, name);
  MemoryRange memory;
  if (physical.heap != kNone) {
    memory = heaps_[physical.heap].memory;
  } else {
    result = allocate(requirements, false, MemoryLifetime::persistent, physical.own_memory);
    if (result != VK_SUCCESS) return result;
    physical.own_size = requirements.size;
    memory = physical.own_memory;
  }
  const VkDeviceSize offset = memory.offset + physical.offset;
  return physical.image
             ? device_.vk.vkBindImageMemory(device, physical.image, memory.memory, offset)
             : device_.vk.vkBindBufferMemory(device, physical.buffer, memory.memory, offset);
}

VkResult Pool::allocate(const VkMemoryRequirements& requirements, bool has_addresses,
                        MemoryLifetime lifetime, MemoryRange& memory) {
  const VkResult result = allocate_memory(
      device_.vk, device_.handles,
      {requirements, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, has_addresses, lifetime}, memory);
  const Log& log = device_.handles.host.log;
  if (result == VK_SUCCESS && log.write != nullptr) {
    char text[96];
    std::snprintf(text, sizeof text, "The render graph has allocated %.2f MiB of device memory.",
                  static_cast<double>(requirements.size) / (1 << 20));
    log.write(log.user, Severity::info, text);
  }
  return result;
}

void Pool::destroy(Physical& physical) {
  const VkDevice device = device_.handles.device;
  for (const CachedView& cached : physical.views)
    device_.vk.vkDestroyImageView(device, cached.view, device_.callbacks());
  if (!physical.owned) return;
  device_.vk.vkDestroyImage(device, physical.image, device_.callbacks());
  device_.vk.vkDestroyBuffer(device, physical.buffer, device_.callbacks());
  free(physical.own_memory);
}

void Pool::set_name(const Physical& physical, std::string_view name) {
  if (!device_.handles.debug_utils || device_.vk.vkSetDebugUtilsObjectNameEXT == nullptr) return;
  const DebugName text(name);
  const VkDebugUtilsObjectNameInfoEXT info{
      .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
      .objectType = physical.image ? VK_OBJECT_TYPE_IMAGE : VK_OBJECT_TYPE_BUFFER,
      .objectHandle = handle_key(physical.image, physical.buffer),
      .pObjectName = text.text};
  device_.vk.vkSetDebugUtilsObjectNameEXT(device_.handles.device, &info);
}

}  // namespace alcove::framegraph
