#include "alcove/framegraph/graph.h"

#include <algorithm>
#include <atomic>
#include <bit>

namespace alcove::framegraph {
namespace {

constexpr std::size_t kBlockSize = 16384;

// Handles of different graphs and frames differ by this: its only use is to refuse foreign ones.
std::uint32_t next_tag() {
  static std::atomic<std::uint32_t> tag{0};
  return tag.fetch_add(1, std::memory_order_relaxed) + 1;
}

std::uint32_t divided(std::uint32_t size, std::uint32_t divisor) {
  if (divisor == 0) return 0;
  return std::max<std::uint32_t>(1, size / divisor + (size % divisor != 0));
}

bool has_departure(const State& state) {
  return state.stages != 0 || state.layout != VK_IMAGE_LAYOUT_UNDEFINED;
}

}  // namespace

Graph::Graph() : tag_(next_tag()) {}

Graph::~Graph() { destroy_callables(); }

void Graph::reset() {
  destroy_callables();
  description_.passes.clear();
  description_.accesses.clear();
  description_.resources.clear();
  description_.externals.clear();
  description_.outputs.clear();
  description_.text.clear();
  imports_.clear();
  histories_.begin_frame();
  block_ = 0;
  next_ = end_ = nullptr;
  tag_ = next_tag();
}

void Graph::destroy_callables() {
  for (const Cleanup& cleanup : cleanups_) cleanup.destroy(cleanup.object);
  cleanups_.clear();
}

void* Graph::allocate_in_next_block(std::size_t size, std::size_t alignment) {
  for (;; ++block_) {
    if (block_ == blocks_.size()) {
      const std::size_t block_size = std::max(kBlockSize, size + alignment);
      blocks_.push_back({std::make_unique<std::byte[]>(block_size), block_size});
    }
    const Block& block = blocks_[block_];
    void* first = block.bytes.get();
    std::size_t left = block.size;
    if (std::align(alignment, size, first, left) == nullptr) continue;
    next_ = static_cast<std::byte*>(first) + size;
    end_ = block.bytes.get() + block.size;
    ++block_;
    return first;
  }
}

void Graph::resolve_extent(ResourceRecord& record, const Extent& extent) const {
  const Texture& base = extent.relative_to;
  if (base.graph != tag_ || base.index >= description_.resources.size()) {
    record.flags |= kRelativeToNothing;
    return;
  }
  const ResourceRecord& other = description_.resources[base.index];
  record.width = divided(other.width, extent.divisor);
  record.height = divided(other.height, extent.divisor);
  record.depth = divided(other.depth, extent.divisor);
}

Range Graph::resolved_range(Range range, const ResourceRecord& resource) {
  if (range.mips == kAll && range.base_mip < resource.mips)
    range.mips = static_cast<std::uint16_t>(resource.mips - range.base_mip);
  if (range.layers == kAll && range.base_layer < resource.layers)
    range.layers = static_cast<std::uint16_t>(resource.layers - range.base_layer);
  return range;
}

ResourceRecord Graph::texture_record(const TextureDesc& desc) const {
  ResourceRecord record;
  fill_texture_record(record, desc);
  return record;
}

std::uint32_t Graph::add_resource(std::string_view name, const ResourceRecord& record) {
  const auto index = static_cast<std::uint32_t>(description_.resources.size());
  description_.resources.push_back(record);
  description_.resource_names.at(index) = keep_name(name);
  versions_.at(index) = 0;
  return index;
}

Buffer Graph::create_buffer(std::string_view name, const BufferDesc& desc) {
  ResourceRecord record;
  record.kind = ResourceKind::buffer;
  record.size = desc.size;
  return {add_resource(name, record), 0, tag_};
}

Texture Graph::import_texture(std::string_view name, const ImportedTexture& import) {
  ResourceRecord record = texture_record(import.desc);
  record.origin = Origin::imported;
  record.external = static_cast<std::uint32_t>(description_.externals.size());
  ExternalRecord external;
  external.arrival = import.arrival;
  external.departure = import.departure;
  external.usage = import.usage;
  external.has_contents = import.arrival.layout != VK_IMAGE_LAYOUT_UNDEFINED;
  external.has_departure = has_departure(import.departure);
  external.has_handle = import.image != VK_NULL_HANDLE;
  description_.externals.push_back(external);
  imports_.push_back({import.image, import.view, VK_NULL_HANDLE, kNone});
  return {add_resource(name, record), 0, tag_};
}

Buffer Graph::import_buffer(std::string_view name, const ImportedBuffer& import) {
  ResourceRecord record;
  record.kind = ResourceKind::buffer;
  record.origin = Origin::imported;
  record.size = import.desc.size;
  record.external = static_cast<std::uint32_t>(description_.externals.size());
  ExternalRecord external;
  external.arrival = import.arrival;
  external.departure = import.departure;
  external.usage = import.usage;
  external.has_contents = import.has_contents;
  external.has_departure = has_departure(import.departure);
  external.has_handle = import.buffer != VK_NULL_HANDLE;
  description_.externals.push_back(external);
  imports_.push_back({VK_NULL_HANDLE, VK_NULL_HANDLE, import.buffer, kNone});
  return {add_resource(name, record), 0, tag_};
}

std::uint32_t Graph::add_history(std::string_view name, ResourceRecord record, std::uint32_t slots,
                                 HistoryValidity& validity) {
  record.origin = Origin::history;
  record.slots = static_cast<std::uint8_t>(std::clamp(slots, 1u, kMaxHistorySlots));
  const std::uint32_t history = histories_.declare(name, record);
  const HistoryEntry& entry = histories_.entries()[history];
  std::uint32_t first = kNone;
  for (std::uint32_t slot = 0; slot < record.slots; ++slot) {
    const HistorySlot& state = entry.slots[entry.physical(slot)];
    ExternalRecord external;
    external.arrival = state.state;
    external.validity = state.validity;
    external.has_contents = slot != 0 && state.validity == HistoryValidity::valid;
    external.queue = state.queue;
    external.has_handle = 1;
    record.external = static_cast<std::uint32_t>(description_.externals.size());
    record.slot = static_cast<std::uint8_t>(slot);
    description_.externals.push_back(external);
    imports_.push_back({VK_NULL_HANDLE, VK_NULL_HANDLE, VK_NULL_HANDLE, history});
    const std::uint32_t index = add_resource(name, record);
    if (slot == 0) first = index;
    if (slot == 1) validity = state.validity;
  }
  return first;
}

TextureHistory Graph::create_texture_history(std::string_view name, const TextureDesc& desc,
                                             std::uint32_t slots) {
  TextureHistory history;
  history.current = {add_history(name, texture_record(desc), slots, history.validity), 0, tag_};
  history.slots = std::clamp(slots, 1u, kMaxHistorySlots);
  return history;
}

BufferHistory Graph::create_buffer_history(std::string_view name, const BufferDesc& desc,
                                           std::uint32_t slots) {
  ResourceRecord record;
  record.kind = ResourceKind::buffer;
  record.size = desc.size;
  BufferHistory history;
  history.current = {add_history(name, record, slots, history.validity), 0, tag_};
  history.slots = std::clamp(slots, 1u, kMaxHistorySlots);
  return history;
}

Texture TextureHistory::previous(std::uint32_t age) const {
  if (age == 0 || age >= slots) return {};
  return {current.index + age, 0, current.graph};
}

Buffer BufferHistory::previous(std::uint32_t age) const {
  if (age == 0 || age >= slots) return {};
  return {current.index + age, 0, current.graph};
}

void Graph::reset_history(std::string_view name) { histories_.invalidate(name); }

void Graph::reset_histories() { histories_.invalidate_all(); }

void Graph::output(Texture texture) {
  const bool known = texture.graph == tag_ && texture.index < description_.resources.size();
  description_.outputs.push_back({known ? texture.index : kNone, texture.version,
                                  texture.index == kNone ? kNull : (known ? 0u : kForeign)});
}

void Graph::output(Buffer buffer) { output(Texture{buffer.index, buffer.version, buffer.graph}); }

VkExtent3D Graph::extent(Texture texture) const {
  if (texture.graph != tag_ || texture.index >= description_.resources.size()) return {0, 0, 0};
  const ResourceRecord& record = description_.resources[texture.index];
  return {record.width, record.height, record.depth};
}

VkFormat Graph::format(Texture texture) const {
  if (texture.graph != tag_ || texture.index >= description_.resources.size())
    return VK_FORMAT_UNDEFINED;
  return description_.resources[texture.index].format;
}

}  // namespace alcove::framegraph
