#include "alcove/framegraph/graph.h"

#include <algorithm>
#include <atomic>
#include <bit>

namespace alcove::framegraph {
namespace {

constexpr std::size_t kBlockSize = 16 * 1024;

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
  description_.pass_names.clear();
  description_.resource_names.clear();
  versions_.clear();
  imports_.clear();
  callbacks_.clear();
  histories_.begin_frame();
  block_ = 0;
  used_ = 0;
  tag_ = next_tag();
}

void Graph::destroy_callables() {
  for (const Cleanup& cleanup : cleanups_) cleanup.destroy(cleanup.object);
  cleanups_.clear();
}

void* Graph::allocate(std::size_t size, std::size_t alignment) {
  for (;; ++block_, used_ = 0) {
    if (block_ == blocks_.size()) {
      const std::size_t block_size = std::max(kBlockSize, size + alignment);
      blocks_.push_back({std::make_unique<std::byte[]>(block_size), block_size});
    }
    const Block& block = blocks_[block_];
    const auto base = reinterpret_cast<std::uintptr_t>(block.bytes.get());
    const std::uintptr_t start = (base + used_ + alignment - 1) & ~(std::uintptr_t{alignment} - 1);
    if (start + size > base + block.size) continue;
    used_ = start + size - base;
    return reinterpret_cast<void*>(start);
  }
}

GraphDescription::Name Graph::keep_name(std::string_view name) {
  const auto offset = static_cast<std::uint32_t>(description_.text.size());
  description_.text.insert(description_.text.end(), name.begin(), name.end());
  return {offset, static_cast<std::uint32_t>(name.size())};
}

std::uint32_t Graph::add_resource(std::string_view name, const ResourceRecord& record) {
  const auto index = static_cast<std::uint32_t>(description_.resources.size());
  description_.resources.push_back(record);
  description_.resource_names.push_back(keep_name(name));
  versions_.push_back(0);
  return index;
}

ResourceRecord Graph::texture_record(const TextureDesc& desc) const {
  ResourceRecord record;
  record.format = desc.format;
  record.mips = desc.mips;
  record.layers = desc.layers;
  record.samples = desc.samples;
  record.width = desc.extent.width;
  record.height = desc.extent.height;
  record.depth = desc.extent.depth;
  const Texture& base = desc.extent.relative_to;
  if (base.index == kNone) return record;
  if (base.graph != tag_ || base.index >= description_.resources.size()) {
    record.flags |= kRelativeToNothing;
    return record;
  }
  const ResourceRecord& other = description_.resources[base.index];
  record.width = divided(other.width, desc.extent.divisor);
  record.height = divided(other.height, desc.extent.divisor);
  record.depth = divided(other.depth, desc.extent.divisor);
  return record;
}

Texture Graph::create_texture(std::string_view name, const TextureDesc& desc) {
  return {add_resource(name, texture_record(desc)), 0, tag_};
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

PassBuilder Graph::add_pass(std::string_view name, QueueClass queue) {
  const auto index = static_cast<std::uint32_t>(description_.passes.size());
  description_.passes.push_back(
      {static_cast<std::uint32_t>(description_.accesses.size()), queue, 0, 0});
  description_.pass_names.push_back(keep_name(name));
  callbacks_.push_back({});
  return {*this, index};
}

void Graph::append_access(std::uint32_t pass, std::uint32_t index, std::uint32_t version,
                          std::uint32_t graph, const Access& access, Range range,
                          std::uint32_t flags, ResourceKind kind) {
  AccessRecord record;
  record.stages = access.stages;
  record.access = access.access;
  record.layout = access.layout;
  record.usage = access.usage;
  record.version = version;
  record.kind = kind;
  record.range = range;
  if (index == kNone) {
    flags |= kNull;
  } else if (graph != tag_ || index >= description_.resources.size()) {
    flags |= kForeign;
  } else {
    record.resource = index;
    const ResourceRecord& resource = description_.resources[index];
    if (range.mips == kAll && range.base_mip < resource.mips)
      record.range.mips = static_cast<std::uint16_t>(resource.mips - range.base_mip);
    if (range.layers == kAll && range.base_layer < resource.layers)
      record.range.layers = static_cast<std::uint16_t>(resource.layers - range.base_layer);
  }
  if (pass + 1 != description_.passes.size()) flags |= kClosed;
  record.flags = flags;
  description_.accesses.push_back(record);
}

std::uint32_t Graph::next_version(std::uint32_t index, std::uint32_t graph) {
  if (graph != tag_ || index >= versions_.size()) return kNone;
  return ++versions_[index];
}

void PassBuilder::read(Texture texture, const Access& access, Range range) {
  graph_.append_access(pass_, texture.index, texture.version, texture.graph, access, range, 0,
                       ResourceKind::texture);
}

void PassBuilder::read(Buffer buffer, const Access& access) {
  graph_.append_access(pass_, buffer.index, buffer.version, buffer.graph, access, {}, 0,
                       ResourceKind::buffer);
}

namespace {

std::uint32_t write_flags(Contents contents, Need need) {
  return kWrite | (contents == Contents::discard ? kDiscard : 0u) |
         (need == Need::optional ? kOptional : 0u);
}

}  // namespace

Texture PassBuilder::write(Texture texture, const Access& access, Range range, Contents contents,
                           Need need) {
  graph_.append_access(pass_, texture.index, texture.version, texture.graph, access, range,
                       write_flags(contents, need), ResourceKind::texture);
  texture.version = graph_.next_version(texture.index, texture.graph);
  return texture;
}

Buffer PassBuilder::write(Buffer buffer, const Access& access, Contents contents, Need need) {
  graph_.append_access(pass_, buffer.index, buffer.version, buffer.graph, access, {},
                       write_flags(contents, need), ResourceKind::buffer);
  buffer.version = graph_.next_version(buffer.index, buffer.graph);
  return buffer;
}

void PassBuilder::side_effect() { graph_.description_.passes[pass_].flags |= kSideEffect; }

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
