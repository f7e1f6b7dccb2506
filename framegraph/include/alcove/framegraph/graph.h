// Declares a frame: resources, passes, what each pass reads and writes, and what is wanted of it.
//
//   Graph graph;
//   Texture depth = graph.import_texture("depth", engine_depth);
//   Texture ao = graph.create_texture("ao", {VK_FORMAT_R8_UNORM, Extent::relative(depth, 2)});
//   PassBuilder pass = graph.add_pass("gtao", QueueClass::compute);
//   pass.read(depth, access::depth_read_compute);
//   ao = pass.write(ao, access::storage_write_compute);
//   pass.record([=](RecordContext& context) { ... context.view(ao) ... });
//   graph.output(ao);
//
// Declaring never fails: what is wrong is kept and comes back from compile as errors, all of them.
// Order of declaration is program order: a pass reads what passes before it wrote. One thread
// declares; a graph may be used by one executor only. A steady frame allocates nothing once reset()
// has been through the first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "alcove/framegraph/access.h"
#include "alcove/framegraph/description.h"
#include "alcove/framegraph/history.h"
#include "alcove/framegraph/record_context.h"
#include "alcove/framegraph/types.h"

namespace alcove::framegraph {

class Graph;

// One pass while it is declared: from add_pass to the next add_pass.
class PassBuilder {
 public:
  // The pass reads this version. A pass may read one texture in several ranges; it may not read and
  // write one subresource in two accesses: for that, write with an access that also reads.
  void read(Texture texture, const Access& access, Range range = {});
  void read(Buffer buffer, const Access& access);

  // The pass writes, which makes the next version and ends the one given.
  [[nodiscard]] Texture write(Texture texture, const Access& access, Range range = {},
                              Contents contents = Contents::keep, Need need = Need::required);
  [[nodiscard]] Buffer write(Buffer buffer, const Access& access,
                             Contents contents = Contents::keep, Need need = Need::required);
  // An output of the pass that costs nothing when nobody reads it.
  [[nodiscard]] Texture write_optional(Texture texture, const Access& access, Range range = {}) {
    return write(texture, access, range, Contents::keep, Need::optional);
  }
  [[nodiscard]] Buffer write_optional(Buffer buffer, const Access& access) {
    return write(buffer, access, Contents::keep, Need::optional);
  }

  // The pass does something that the graph does not see: it is never culled.
  void side_effect();

  // What records the pass: called with a RecordContext& once a frame if the pass is live. It is
  // moved into the graph's own memory and lives until reset. It must not throw.
  template <typename Callable>
  void record(Callable&& callable);

  std::uint32_t index() const { return pass_; }

 private:
  friend class Graph;
  PassBuilder(Graph& graph, std::uint32_t pass) : graph_(graph), pass_(pass) {}
  Graph& graph_;
  std::uint32_t pass_;
};

// A resource with memory from frame to frame. `current` is written this frame; previous(k) is what
// was `current` k frames ago: frames count only when `current` was written by a live pass.
struct TextureHistory {
  Texture current;
  std::uint32_t slots = 0;
  HistoryValidity validity = HistoryValidity::first_frame;  // of previous(1)
  // A version that the graph refuses when age is 0 or not below `slots`.
  Texture previous(std::uint32_t age = 1) const;
};
struct BufferHistory {
  Buffer current;
  std::uint32_t slots = 0;
  HistoryValidity validity = HistoryValidity::first_frame;
  Buffer previous(std::uint32_t age = 1) const;
};

// The caller's Vulkan handles of one frame: no part of the plan.
struct ImportHandles {
  VkImage image = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkBuffer buffer = VK_NULL_HANDLE;
  std::uint32_t history = kNone;  // of a history slot: index into the graph's histories
};

class Graph {
 public:
  Graph();
  ~Graph();
  Graph(const Graph&) = delete;
  Graph& operator=(const Graph&) = delete;

  // Transients: made by the executor for the passes that live. Names need not be unique (except
  // those of histories) and are copied.
  Texture create_texture(std::string_view name, const TextureDesc& desc);
  Buffer create_buffer(std::string_view name, const BufferDesc& desc);
  Texture import_texture(std::string_view name, const ImportedTexture& import);
  Buffer import_buffer(std::string_view name, const ImportedBuffer& import);
  // Histories are known from frame to frame by their name. `slots` counts this frame's: 2 gives one
  // frame of memory; at most 8.
  TextureHistory create_texture_history(std::string_view name, const TextureDesc& desc,
                                        std::uint32_t slots = 2);
  BufferHistory create_buffer_history(std::string_view name, const BufferDesc& desc,
                                      std::uint32_t slots = 2);
  // From the next create_*_history on, nothing of the named history (or of all) is valid.
  void reset_history(std::string_view name);
  void reset_histories();

  PassBuilder add_pass(std::string_view name, QueueClass queue = QueueClass::graphics);

  // This version is wanted after the frame: what leads to it is not culled. A transient's contents
  // can be read until its memory is used again in the next frame.
  void output(Texture texture);
  void output(Buffer buffer);

  // Forgets all that was declared but keeps the memory, and histories.
  void reset();

  // Absolute extent of mip 0, as known at declaration.
  VkExtent3D extent(Texture texture) const;
  VkFormat format(Texture texture) const;

  const GraphDescription& description() const { return description_; }
  std::span<const ImportHandles> imports() const { return imports_; }
  HistoryTable& histories() { return histories_; }
  const HistoryTable& histories() const { return histories_; }

  // Calls the callback of a pass.
  void call(std::uint32_t pass, RecordContext& context) const {
    callbacks_[pass].call(callbacks_[pass].object, context);
  }

 private:
  friend class PassBuilder;
  static constexpr std::size_t kAlignment = alignof(std::max_align_t);
  struct Callback {
    void (*call)(void*, RecordContext&) = nullptr;
    void* object = nullptr;
  };
  struct Cleanup {
    void (*destroy)(void*) = nullptr;
    void* object = nullptr;
  };
  struct Block {
    std::unique_ptr<std::byte[]> bytes;
    std::size_t size = 0;
  };

  GraphDescription::Name keep_name(std::string_view name);
  std::uint32_t add_resource(std::string_view name, const ResourceRecord& record);
  ResourceRecord texture_record(const TextureDesc& desc) const;
  void fill_texture_record(ResourceRecord& record, const TextureDesc& desc) const;
  void resolve_extent(ResourceRecord& record, const Extent& extent) const;
  std::uint32_t add_history(std::string_view name, ResourceRecord record, std::uint32_t slots,
                            HistoryValidity& validity);
  static Range resolved_range(Range range, const ResourceRecord& resource);
  template <typename Handle>
  std::uint32_t add_access(std::uint32_t pass, const Handle& handle, const Access& access,
                           Range range, std::uint32_t flags);
  void* allocate(std::size_t size, std::size_t alignment);
  void* allocate_in_next_block(std::size_t size, std::size_t alignment);
  void destroy_callables();

  GraphDescription description_;
  Beside<std::uint32_t> versions_;      // of each resource, at this point of the declaration
  std::vector<ImportHandles> imports_;  // parallel to description_.externals
  Beside<Callback> callbacks_;          // parallel to description_.passes
  std::vector<Cleanup> cleanups_;
  std::vector<Block> blocks_;
  std::size_t block_ = 0;      // the next block
  std::byte* next_ = nullptr;  // free bytes of the current one
  std::byte* end_ = nullptr;
  std::uint32_t tag_ = 0;  // of the handles of this frame of this graph
  HistoryTable histories_;
};

template <typename Callable>
void PassBuilder::record(Callable&& callable) {
  using Stored = std::decay_t<Callable>;
  void* object = graph_.allocate(sizeof(Stored), alignof(Stored));
  ::new (object) Stored(std::forward<Callable>(callable));
  graph_.callbacks_.at(pass_) = {
      [](void* stored, RecordContext& context) { (*static_cast<Stored*>(stored))(context); },
      object};
  graph_.description_.passes[pass_].flags |= kHasCallback;
  if constexpr (!std::is_trivially_destructible_v<Stored>) {
    graph_.cleanups_.push_back(
        {[](void* stored) { static_cast<Stored*>(stored)->~Stored(); }, object});
  }
}

// What follows runs for every pass of every frame: inline, so that a frame that did not change
// costs little more than writing its records.

inline void* Graph::allocate(std::size_t size, std::size_t alignment) {
  // What is free begins at a multiple of kAlignment, which is enough for nearly everything.
  const std::size_t padding =
      alignment <= kAlignment ? 0 : (0 - reinterpret_cast<std::uintptr_t>(next_)) & (alignment - 1);
  size = (size + kAlignment - 1) & ~(kAlignment - 1);
  if (padding + size > static_cast<std::size_t>(end_ - next_))
    return allocate_in_next_block(size, alignment);
  std::byte* const start = next_ + padding;
  next_ = start + size;
  return start;
}

inline GraphDescription::Name Graph::keep_name(std::string_view name) {
  const std::size_t size = name.size();
  const std::size_t offset = description_.text.size();
  char* const to = description_.text.append(size);
  // Two overlapping copies of a fixed size are cheaper than one of a size that is not known.
  if (size >= 8 && size <= 16) {
    std::memcpy(to, name.data(), 8);
    std::memcpy(to + size - 8, name.data() + size - 8, 8);
  } else if (size >= 4 && size < 8) {
    std::memcpy(to, name.data(), 4);
    std::memcpy(to + size - 4, name.data() + size - 4, 4);
  } else if (size != 0) {
    std::memcpy(to, name.data(), size);
  }
  return {static_cast<std::uint32_t>(offset), static_cast<std::uint32_t>(size)};
}

inline void Graph::fill_texture_record(ResourceRecord& record, const TextureDesc& desc) const {
  record.size = 0;
  record.format = desc.format;
  record.width = desc.extent.width;
  record.height = desc.extent.height;
  record.depth = desc.extent.depth;
  record.mips = desc.mips;
  record.layers = desc.layers;
  record.samples = desc.samples;
  record.external = kNone;
  record.kind = ResourceKind::texture;
  record.origin = Origin::transient;
  record.slot = 0;
  record.slots = 1;
  record.flags = 0;
  if (desc.extent.relative_to.index != kNone) resolve_extent(record, desc.extent);
}

inline Texture Graph::create_texture(std::string_view name, const TextureDesc& desc) {
  const auto index = static_cast<std::uint32_t>(description_.resources.size());
  fill_texture_record(description_.resources.append(), desc);
  description_.resource_names.at(index) = keep_name(name);
  versions_.at(index) = 0;
  return {index, 0, tag_};
}

inline PassBuilder Graph::add_pass(std::string_view name, QueueClass queue) {
  const auto index = static_cast<std::uint32_t>(description_.passes.size());
  PassRecord& record = description_.passes.append();
  record.first_access = static_cast<std::uint32_t>(description_.accesses.size());
  record.queue = queue;
  record.flags = 0;
  record.reserved = 0;
  description_.pass_names.at(index) = keep_name(name);
  return {*this, index};
}

// The version that the access leaves.
template <typename Handle>
inline std::uint32_t Graph::add_access(std::uint32_t pass, const Handle& handle,
                                       const Access& access, Range range, std::uint32_t flags) {
  constexpr ResourceKind kKind =
      std::is_same_v<Handle, Texture> ? ResourceKind::texture : ResourceKind::buffer;
  const bool writes = (flags & kWrite) != 0;
  if (pass + 1 != description_.passes.size()) [[unlikely]]
    flags |= kClosed;
  AccessRecord& record = description_.accesses.append();
  record.stages = access.stages;
  record.access = access.access;
  record.layout = access.layout;
  record.usage = access.usage;
  record.version = handle.version;
  record.kind = kKind;
  if (handle.graph != tag_ || handle.index >= description_.resources.size()) [[unlikely]] {
    record.range = range;
    record.resource = kNone;
    record.flags = flags | (handle.index == kNone ? kNull : kForeign);
    return kNone;
  }
  record.resource = handle.index;
  const ResourceRecord& resource = description_.resources[handle.index];
  if (range == Range{} && resource.mips == 1 && resource.layers == 1) [[likely]] {
    record.range = {0, 1, 0, 1};
    // As a rule the access is a constant, and all but the resource is known to the compiler.
    const bool fits = access.stages != 0 && access.access != 0 &&
                      ((access.access & kWriteBits) != 0) == writes &&
                      (kKind == ResourceKind::buffer || layout_is_usable(access.layout));
    if (fits && resource.kind == kKind && resource.origin == Origin::transient) flags |= kPlain;
  } else {
    record.range = resolved_range(range, resource);
  }
  record.flags = flags;
  return versions_[handle.index] += writes;
}

inline void PassBuilder::read(Texture texture, const Access& access, Range range) {
  graph_.add_access(pass_, texture, access, range, 0);
}

inline void PassBuilder::read(Buffer buffer, const Access& access) {
  graph_.add_access(pass_, buffer, access, {}, 0);
}

inline Texture PassBuilder::write(Texture texture, const Access& access, Range range,
                                  Contents contents, Need need) {
  const std::uint32_t flags = kWrite | (contents == Contents::discard ? kDiscard : 0u) |
                              (need == Need::optional ? kOptional : 0u);
  texture.version = graph_.add_access(pass_, texture, access, range, flags);
  return texture;
}

inline Buffer PassBuilder::write(Buffer buffer, const Access& access, Contents contents,
                                 Need need) {
  const std::uint32_t flags = kWrite | (contents == Contents::discard ? kDiscard : 0u) |
                              (need == Need::optional ? kOptional : 0u);
  buffer.version = graph_.add_access(pass_, buffer, access, {}, flags);
  return buffer;
}

inline void PassBuilder::side_effect() { graph_.description_.passes[pass_].flags |= kSideEffect; }

}  // namespace alcove::framegraph
