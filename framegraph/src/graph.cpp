#include "alcove/framegraph/graph.h"

#include <algorithm>
#include <atomic>
#include <cstring>

#include "aspects.h"

namespace alcove::framegraph {
namespace {

constexpr std::size_t kBlockSize = 16384;

// Returns a new number for a frame of any graph. Its lower half is never 0.
std::uint64_t next_frame() {
  static std::atomic<std::uint64_t> frame{0};
  for (;;) {
    const std::uint64_t number = frame.fetch_add(1, std::memory_order_relaxed);
    if (static_cast<std::uint32_t>(number) != 0) return number;
  }
}

// Returns the size relative to another size, or 0 if the result is not a valid size.
std::uint32_t relative_size(std::uint32_t size, const Extent& extent) {
  if (extent.divisor == 0 || extent.multiplier == 0) return 0;
  const std::uint64_t multiplied = std::uint64_t{size} * extent.multiplier;
  const std::uint64_t divided = multiplied / extent.divisor + (multiplied % extent.divisor != 0);
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(divided, 1, ~std::uint32_t{0}));
}

bool has_final_state(const State& state) {
  return state.stages != 0 || state.layout != VK_IMAGE_LAYOUT_UNDEFINED;
}

}  // namespace

Graph::Graph() { reset(); }

Graph::~Graph() { destroy_callables(); }

void Graph::reset() {
  destroy_callables();
  description_.passes.clear();
  // The next record is from an earlier frame and may name resources that no longer exist.
  description_.accesses.next() = {};
  description_.accesses.clear();
  next_access_ = &description_.accesses.next();
  description_.resources.clear();
  description_.externals.clear();
  description_.outputs.clear();
  description_.long_names.clear();
  imports_.clear();
  histories_.begin_frame();
  block_ = 0;
  next_ = end_ = nullptr;
  frame_ = next_frame();
  repeating_tag_ = tag_ = static_cast<std::uint32_t>(frame_);
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

void Graph::keep_long_name(std::string_view name, GraphDescription::Name& to) {
  to.offset = static_cast<std::uint32_t>(description_.long_names.size());
  description_.long_names.append(name);
}

// Appends a record. The place usually holds the same record from the frame before.
template <typename Record>
void Graph::add(Records<Record>& records, const Record& record) {
  if (records.is_full()) records.grow();
  Record& next = records.next();
  records.repeat();
  if (repeating_tag_ != 0 && std::memcmp(&next, &record, sizeof record) == 0) return;
  next = record;
  changed();
}

// Grows the arrays that run parallel to the records before the records themselves. If memory runs
// out in between, no parallel array is then shorter than the records.
void Graph::grow_resources() {
  const std::size_t capacity = description_.resources.next_capacity();
  description_.resource_names.resize(capacity);
  versions_.resize(capacity);
  description_.resources.grow();
}

void Graph::grow_passes() {
  const std::size_t capacity = description_.passes.next_capacity();
  description_.pass_names.resize(capacity);
  callbacks_.resize(capacity);
  description_.passes.grow();
}

ResourceRecord Graph::texture_record(const TextureDesc& desc) const {
  ResourceRecord record;
  fill_texture_record(record, desc);
  const Texture& base = desc.extent.relative_to;
  if (base.index == kNone) return record;
  if (base.graph != tag_ || base.index >= description_.resources.size()) {
    record.flags |= kRelativeToNothing;
    return record;
  }
  const ResourceRecord& other = description_.resources[base.index];
  record.width = relative_size(other.width, desc.extent);
  record.height = relative_size(other.height, desc.extent);
  record.depth = relative_size(other.depth, desc.extent);
  return record;
}

void Graph::add_resource(const ResourceRecord& record) {
  if (description_.resources.is_full()) grow_resources();
  versions_[description_.resources.size()] = 0;
  add(description_.resources, record);
}

std::uint32_t Graph::add_resource(std::string_view name, const ResourceRecord& record) {
  const auto index = static_cast<std::uint32_t>(description_.resources.size());
  add_resource(record);
  keep_name(name, description_.resource_names[index]);
  return index;
}

std::uint32_t Graph::add_any_access(std::uint32_t pass, std::uint32_t index, std::uint32_t version,
                                    std::uint32_t tag, const Access& access, Range range,
                                    std::uint32_t flags) {
  AccessRecord record{access.stages, access.access, access.layout, access.usage,
                      index,         flags,         range,         version};
  std::uint32_t left = kNone;
  if (pass + 1 != description_.passes.size()) record.flags |= kClosed;
  if (tag != tag_ || index >= description_.resources.size()) {
    record.flags |= index == kNone ? kNull : kForeign;
    record.resource = kNone;
  } else {
    record.range = resolved_range(range, description_.resources[index]);
    left = versions_[index] += (flags & kWrite) != 0;
  }
  add(description_.accesses, record);
  next_access_ = &description_.accesses.next();
  return left;
}

Range Graph::resolved_range(Range range, const ResourceRecord& resource) {
  if (range.aspects == aspects(resource.format)) range.aspects = 0;
  if (range.mips == kAll && range.base_mip < resource.mips)
    range.mips = static_cast<std::uint16_t>(resource.mips - range.base_mip);
  if (range.layers == kAll && range.base_layer < resource.layers)
    range.layers = static_cast<std::uint16_t>(resource.layers - range.base_layer);
  return range;
}

ResourceRecord Graph::buffer_record(const BufferDesc& desc) {
  ResourceRecord record;
  record.kind = ResourceKind::buffer;
  record.size = desc.size;
  record.create_flags = desc.usage;
  return record;
}

Buffer Graph::create_buffer(std::string_view name, const BufferDesc& desc) {
  return {add_resource(name, buffer_record(desc)), 0, tag_};
}

// Returns the external that was imported with the same buffer, or with the same image and an
// overlapping range of layers.
std::uint32_t Graph::imported_before(VkImage image, VkBuffer buffer, std::uint32_t layer,
                                     const ResourceRecord& record) const {
  if (image == VK_NULL_HANDLE && buffer == VK_NULL_HANDLE) return kNone;
  for (std::uint32_t i = 0; i < imports_.size(); ++i) {
    const ImportHandles& other = imports_[i];
    if (other.image != image || other.buffer != buffer) continue;
    const std::uint64_t end = std::uint64_t{layer} + record.layers;
    const std::uint64_t other_end = std::uint64_t{other.layer} + other.layers;
    if (buffer != VK_NULL_HANDLE || (layer < other_end && other.layer < end)) return i;
  }
  return kNone;
}

Texture Graph::import_texture(std::string_view name, const ImportedTexture& import) {
  ResourceRecord record = texture_record(import.desc);
  record.origin = Origin::imported;
  record.external = static_cast<std::uint32_t>(description_.externals.size());
  ExternalRecord external;
  external.initial_state = import.initial_state;
  external.final_state = import.final_state;
  external.usage = import.usage;
  external.has_contents = import.initial_state.layout != VK_IMAGE_LAYOUT_UNDEFINED;
  external.has_final_state = has_final_state(import.final_state);
  external.has_handle = import.image != VK_NULL_HANDLE;
  external.same_as = imported_before(import.image, VK_NULL_HANDLE, import.first_layer, record);
  add(description_.externals, external);
  imports_.push_back(
      {import.image, import.view, VK_NULL_HANDLE, kNone, import.first_layer, record.layers});
  imports_.back().initial_family = import.initial_family;
  imports_.back().final_family = import.final_family;
  return {add_resource(name, record), 0, tag_};
}

Buffer Graph::import_buffer(std::string_view name, const ImportedBuffer& import) {
  ResourceRecord record = buffer_record(import.desc);
  record.origin = Origin::imported;
  record.external = static_cast<std::uint32_t>(description_.externals.size());
  ExternalRecord external;
  external.initial_state = import.initial_state;
  external.final_state = import.final_state;
  external.usage = import.usage;
  external.has_contents = import.has_contents;
  external.has_final_state = has_final_state(import.final_state);
  external.has_handle = import.buffer != VK_NULL_HANDLE;
  external.same_as = imported_before(VK_NULL_HANDLE, import.buffer, 0, record);
  add(description_.externals, external);
  imports_.push_back({VK_NULL_HANDLE, VK_NULL_HANDLE, import.buffer, kNone});
  imports_.back().initial_family = import.initial_family;
  imports_.back().final_family = import.final_family;
  return {add_resource(name, record), 0, tag_};
}

ExternalRecord Graph::external_of(const HistoryEntry& entry, std::uint32_t slot) {
  const HistorySlot& state = entry.slots[entry.physical(slot)];
  const bool keeps = slot != 0 || (entry.record.flags & kPersistent) != 0;
  ExternalRecord external;
  external.initial_state = state.state;
  external.validity = state.validity;
  external.has_contents = keeps && state.validity == HistoryValidity::valid;
  external.queue = state.queue;
  external.has_handle = 1;
  return external;
}

bool Graph::refresh_histories() {
  if (!histories_.have_moved()) return true;
  bool changes = false;
  for (const ResourceRecord& record : description_.resources) {
    if (record.origin != Origin::history) continue;
    const HistoryEntry& entry = histories_.entry(imports_[record.external].history);
    if (entry.dropped) return false;
    ExternalRecord& declared = description_.externals[record.external];
    ExternalRecord now = external_of(entry, record.slot);
    now.final_state = declared.final_state;
    now.has_final_state = declared.has_final_state;
    if (std::memcmp(&declared, &now, sizeof now) == 0) continue;
    declared = now;
    changes = true;
  }
  if (changes) description_.edition = next_frame();
  histories_.clear_moved();
  return true;
}

void Graph::add_stale_builder() {
  for (const OutputRecord& output : description_.outputs) {
    if (output.flags == kStaleBuilder) return;
  }
  add(description_.outputs, {kNone, 0, kStaleBuilder});
}

std::uint32_t Graph::add_history(std::string_view name, ResourceRecord record, std::uint32_t slots,
                                 HistoryValidity& validity, const State& final_state) {
  record.origin = Origin::history;
  record.slots = static_cast<std::uint8_t>(std::clamp(slots, 1u, kMaxHistorySlots));
  const std::uint32_t history = histories_.declare(name, record);
  const HistoryEntry& entry = histories_.entries()[history];
  std::uint32_t first = kNone;
  for (std::uint32_t slot = 0; slot < record.slots; ++slot) {
    ExternalRecord external = external_of(entry, slot);
    external.final_state = final_state;
    external.has_final_state = has_final_state(final_state);
    record.external = static_cast<std::uint32_t>(description_.externals.size());
    record.slot = static_cast<std::uint8_t>(slot);
    add(description_.externals, external);
    imports_.push_back({VK_NULL_HANDLE, VK_NULL_HANDLE, VK_NULL_HANDLE, history});
    const std::uint32_t index = add_resource(name, record);
    if (slot == 0) first = index;
    if (slot == 1 || record.slots == 1) validity = external.validity;
  }
  return first;
}

void Graph::leave_histories(std::span<const FinalState> finals) {
  for (const FinalState& final : finals) {
    const ResourceRecord& record = description_.resources[final.resource];
    const std::uint32_t index = imports_[record.external].history;
    const HistoryEntry& entry = histories_.entry(index);
    HistorySlot slot = entry.slots[entry.physical(record.slot)];
    slot.state = final.state;
    slot.queue = final.queue;
    if (record.slot == 0 && final.written != Written::nothing) {
      // A valid persistent resource stays valid if only a part of it is written.
      const bool whole =
          final.written == Written::whole ||
          ((record.flags & kPersistent) != 0 && slot.validity == HistoryValidity::valid);
      slot.validity = whole ? HistoryValidity::valid : HistoryValidity::written_in_part;
    }
    histories_.leave(index, record.slot, slot);
  }
  for (const FinalState& final : finals) {
    const ResourceRecord& record = description_.resources[final.resource];
    if (record.slot == 0 && final.written != Written::nothing)
      histories_.rotate(imports_[record.external].history);
  }
}

template <typename History>
History Graph::make_history(std::string_view name, const ResourceRecord& record,
                            std::uint32_t slots, const State& final_state) {
  History history;
  history.current = {add_history(name, record, slots, history.validity, final_state), 0, tag_};
  history.slots = std::clamp(slots, 1u, kMaxHistorySlots);
  return history;
}

TextureHistory Graph::create_texture_history(std::string_view name, const TextureDesc& desc,
                                             std::uint32_t slots) {
  return make_history<TextureHistory>(name, texture_record(desc), slots);
}

BufferHistory Graph::create_buffer_history(std::string_view name, const BufferDesc& desc,
                                           std::uint32_t slots) {
  return make_history<BufferHistory>(name, buffer_record(desc), slots);
}

TextureHistory Graph::create_persistent_texture(std::string_view name, const TextureDesc& desc,
                                                const State& final_state) {
  ResourceRecord record = texture_record(desc);
  record.flags |= kPersistent;
  return make_history<TextureHistory>(name, record, 1, final_state);
}

BufferHistory Graph::create_persistent_buffer(std::string_view name, const BufferDesc& desc,
                                              const State& final_state) {
  ResourceRecord record = buffer_record(desc);
  record.flags |= kPersistent;
  return make_history<BufferHistory>(name, record, 1, final_state);
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

void Graph::drop_history(std::string_view name) { histories_.drop(name); }

void Graph::output(Texture texture) {
  const bool known = texture.graph == tag_ && texture.index < description_.resources.size();
  const OutputRecord record{known ? texture.index : kNone, texture.version,
                            texture.index == kNone ? kNull : (known ? 0u : kForeign)};
  add(description_.outputs, record);
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
