#include "alcove/framegraph/graph.h"

#include <algorithm>
#include <atomic>
#include <utility>

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

std::size_t hash_of(const ImportHandles& handles) {
  // A Vulkan handle is a pointer or an integer, depending on the platform. This cast works for
  // both.
  std::uint64_t bits = (std::uint64_t)handles.image ^ (std::uint64_t)handles.buffer;
  bits *= 0x9fb21c651e98df25u;
  return static_cast<std::size_t>(bits >> 32);
}

}  // namespace

Graph::Graph() { reset(); }

Graph::~Graph() { destroy_callables(); }

void Graph::reset() {
  destroy_callables();
  description_.passes.clear();
  description_.accesses.clear();
  description_.resources.clear();
  description_.externals.clear();
  description_.outputs.clear();
  imports_.clear();
  std::fill(buckets_.begin(), buckets_.end(), kNone);
  histories_.begin_frame();
  if (lost_executor()) {
    histories_.forget_contents();
    executor_.reset();
  }
  recorded_ = false;
  block_ = 0;
  next_ = end_ = nullptr;
  frame_ = next_frame();
  tag_ = repeating_tag_ = static_cast<std::uint32_t>(frame_);
}

// Returns whether the executor that recorded this graph, and with it the contents of the histories,
// is gone.
bool Graph::lost_executor() const {
  const std::weak_ptr<const char> none;
  return executor_.expired() && (executor_.owner_before(none) || none.owner_before(executor_));
}

Error Graph::missing_callback(std::uint32_t pass) const {
  return {.code = ErrorCode::missing_callback,
          .message = "pass '" + std::string(description_.pass_name(pass)) +
                     "' is live but has nothing to record: call PassBuilder::record",
          .pass = pass};
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

std::uint32_t Graph::add_resource(std::string_view name, const ResourceRecord& record) {
  const std::size_t index = description_.resources.size();
  if (index >= versions_.size()) {
    // There is room for as many resources as `versions_` has elements, also if memory runs out
    // here.
    description_.resource_names.resize(2 * index + 16);
    description_.resources.reserve(2 * index + 16);
    versions_.resize(2 * index + 16);
  }
  description_.resource_names[index] = keep_name(name);
  versions_[index] = 0;
  add(description_.resources, record);
  return static_cast<std::uint32_t>(index);
}

void Graph::grow_passes() {
  const std::size_t size = 2 * description_.passes.size() + 16;
  description_.pass_names.resize(size);
  callbacks_.resize(size);
}

std::uint32_t Graph::add_any_access(PassBuilder pass, std::uint32_t index, std::uint32_t version,
                                    std::uint32_t tag, const Access& access, Range range,
                                    std::uint32_t flags) {
  if (!pass.is_current()) return version;
  if (range == Range{}) flags |= kWhole;
  AccessRecord record{access.stages, access.access, access.layout, access.usage,
                      index,         flags,         range,         version};
  std::uint32_t left = kNone;
  if (pass.pass_ + 1 != description_.passes.size()) record.flags |= kClosed;
  if (tag != tag_ || index >= description_.resources.size()) {
    record.flags |= index == kNone ? kNull : kForeign;
    record.resource = kNone;
  } else {
    record.range = resolved_range(record.range, description_.resources[index]);
    left = versions_[index] += (record.flags & kWrite) != 0;
  }
  add(description_.accesses, record);
  return left;
}

Range Graph::resolved_range(Range range, const ResourceRecord& resource) {
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
// overlapping range of layers, and adds this import to the table of hashes.
std::uint32_t Graph::find_same(std::uint32_t import) {
  if (imports_.size() > buckets_.size()) {
    buckets_.assign(2 * imports_.size() + 16, kNone);
    for (std::uint32_t i = 0; i < import; ++i) {
      if (imports_[i].history != kNone) continue;
      std::uint32_t& first = buckets_[hash_of(imports_[i]) % buckets_.size()];
      imports_[i].next = std::exchange(first, i);
    }
  }
  ImportHandles& own = imports_[import];
  if (own.image == VK_NULL_HANDLE && own.buffer == VK_NULL_HANDLE) return kNone;
  std::uint32_t& first = buckets_[hash_of(own) % buckets_.size()];
  own.next = std::exchange(first, import);
  for (std::uint32_t i = own.next; i != kNone; i = imports_[i].next) {
    const ImportHandles& other = imports_[i];
    const auto end = [](const ImportHandles& h) { return std::uint64_t{h.layer} + h.layers; };
    if (other.image == own.image && other.buffer == own.buffer && own.layer < end(other) &&
        other.layer < end(own))
      return i;
  }
  return kNone;
}

template <typename Import>
std::uint32_t Graph::add_import(std::string_view name, const Import& import, ResourceRecord record,
                                ImportHandles handles, bool has_contents) {
  record.origin = Origin::imported;
  record.external = static_cast<std::uint32_t>(description_.externals.size());
  handles.layers = record.layers;
  imports_.push_back(handles);
  ExternalRecord external;
  external.initial_state = import.initial_state;
  external.final_state = import.final_state;
  external.usage = import.usage;
  external.has_contents = has_contents;
  external.has_final_state =
      import.final_state.stages != 0 || import.final_state.layout != VK_IMAGE_LAYOUT_UNDEFINED;
  external.has_handle = handles.image != VK_NULL_HANDLE || handles.buffer != VK_NULL_HANDLE;
  external.same_as = find_same(record.external);
  add(description_.externals, external);
  return add_resource(name, record);
}

Texture Graph::import_texture(std::string_view name, const ImportedTexture& import) {
  ImportHandles handles;
  handles.image = import.image;
  handles.view = import.view;
  handles.layer = import.first_layer;
  return {add_import(name, import, texture_record(import.desc), handles,
                     import.initial_state.layout != VK_IMAGE_LAYOUT_UNDEFINED),
          0, tag_};
}

Buffer Graph::import_buffer(std::string_view name, const ImportedBuffer& import) {
  ImportHandles handles;
  handles.buffer = import.buffer;
  return {add_import(name, import, buffer_record(import.desc), handles, import.has_contents), 0,
          tag_};
}

ExternalRecord Graph::external_of(const HistoryEntry& entry, std::uint32_t slot) {
  const HistorySlot& state = entry.slots[entry.physical(slot)];
  ExternalRecord external;
  external.initial_state = state.state;
  external.validity = state.validity;
  external.has_contents = slot != 0 && state.validity == HistoryValidity::valid;
  external.queue = state.queue;
  external.has_handle = 1;
  return external;
}

void Graph::add_stale_builder() {
  for (const OutputRecord& output : description_.outputs)
    if (output.flags == kStaleBuilder) return;
  add(description_.outputs, {kNone, 0, kStaleBuilder});
}

TextureHistory Graph::create_texture_history(std::string_view name, const TextureDesc& desc,
                                             std::uint32_t slots) {
  TextureHistory history;
  history.slots = std::clamp(slots, 1u, kMaxHistorySlots);
  ResourceRecord record = texture_record(desc);
  record.origin = Origin::history;
  record.slots = static_cast<std::uint8_t>(history.slots);
  ImportHandles handles;
  handles.history = histories_.declare(name, record);
  const HistoryEntry& entry = histories_.entries()[handles.history];
  for (std::uint32_t slot = 0; slot < history.slots; ++slot) {
    const ExternalRecord external = external_of(entry, slot);
    record.external = static_cast<std::uint32_t>(description_.externals.size());
    record.slot = static_cast<std::uint8_t>(slot);
    imports_.push_back(handles);
    add(description_.externals, external);
    const std::uint32_t index = add_resource(name, record);
    if (slot == 0) history.current = {index, 0, tag_};
    if (slot == 1) history.validity = external.validity;
  }
  return history;
}

void Graph::leave_histories(std::span<const FinalState> finals) {
  for (const FinalState& final : finals) {
    const ResourceRecord& record = description_.resources[final.resource];
    const std::uint32_t index = imports_[record.external].history;
    const HistoryEntry& entry = histories_.entry(index);
    HistorySlot slot = entry.slots[entry.physical(record.slot)];
    slot.state = final.state;
    slot.queue = final.queue;
    if (final.written != WriteCoverage::nothing) {
      // A valid slot that is updated in place stays valid if only a part of it is written.
      const bool whole = final.written == WriteCoverage::whole ||
                         (record.slot != 0 && slot.validity == HistoryValidity::valid);
      slot.validity = whole ? HistoryValidity::valid : HistoryValidity::written_in_part;
    }
    histories_.leave(index, record.slot, slot);
  }
  for (const FinalState& final : finals) {
    const ResourceRecord& record = description_.resources[final.resource];
    if (record.slot == 0 && final.written != WriteCoverage::nothing)
      histories_.rotate(imports_[record.external].history);
  }
}

void Graph::reset_history(std::string_view name) { histories_.invalidate(name); }

void Graph::reset_histories() { histories_.invalidate_all(); }

void Graph::drop_history(std::string_view name) { histories_.drop(name); }

void Graph::add_output(std::uint32_t index, std::uint32_t version, std::uint32_t tag) {
  const bool known = tag == tag_ && index < description_.resources.size();
  add(description_.outputs,
      {known ? index : kNone, version, index == kNone ? kNull : (known ? 0u : kForeign)});
}

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
