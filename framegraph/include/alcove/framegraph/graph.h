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
  void grow_text(std::size_t size);
  std::uint32_t add_resource(std::string_view name, const ResourceRecord& record);
  ResourceRecord texture_record(const TextureDesc& desc) const;
  void fill_texture_record(ResourceRecord& record, const TextureDesc& desc) const;
  void resolve_extent(ResourceRecord& record, const Extent& extent) const;
  std::uint32_t add_history(std::string_view name, ResourceRecord record, std::uint32_t slots,
                            HistoryValidity& validity);
  static void resolve_range(Range& range, const ResourceRecord& resource);
  void append_access(std::uint32_t pass, std::uint32_t index, std::uint32_t version,
                     std::uint32_t graph, const Access& access, Range range, std::uint32_t flags,
                     ResourceKind kind);
  std::uint32_t next_version(std::uint32_t index, std::uint32_t graph);
  void* allocate(std::size_t size, std::size_t alignment);
  void* allocate_in_next_block(std::size_t size, std::size_t alignment);
  void destroy_callables();

  GraphDescription description_;
  std::vector<std::uint32_t> versions_;  // of each resource, at this point of the declaration
  std::vector<ImportHandles> imports_;   // parallel to description_.externals
  std::vector<Callback> callbacks_;      // parallel to description_.passes
  std::vector<Cleanup> cleanups_;
  std::vector<Block> blocks_;
  std::size_t block_ = 0;      // the next block
  std::byte* next_ = nullptr;  // free bytes of the current one
  std::byte* end_ = nullptr;
  std::size_t text_used_ = 0;  // of description_.text
  std::uint32_t tag_ = 0;      // of the handles of this frame of this graph
  HistoryTable histories_;
};

template <typename Callable>
void PassBuilder::record(Callable&& callable) {
  using Stored = std::decay_t<Callable>;
  void* object = graph_.allocate(sizeof(Stored), alignof(Stored));
  ::new (object) Stored(std::forward<Callable>(callable));
  graph_.callbacks_[pass_] = {
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
  const std::size_t padding = (0 - reinterpret_cast<std::uintptr_t>(next_)) & (alignment - 1);
  if (padding + size > static_cast<std::size_t>(end_ - next_))
    return allocate_in_next_block(size, alignment);
  std::byte* const start = next_ + padding;
  next_ = start + size;
  return start;
}

inline GraphDescription::Name Graph::keep_name(std::string_view name) {
  const std::size_t size = name.size();
  if (text_used_ + size > description_.text.size()) grow_text(size);
  char* to = description_.text.data() + text_used_;
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
  const GraphDescription::Name kept{static_cast<std::uint32_t>(text_used_),
                                    static_cast<std::uint32_t>(size)};
  text_used_ += size;
  return kept;
}

inline void Graph::fill_texture_record(ResourceRecord& record, const TextureDesc& desc) const {
  record.format = desc.format;
  record.width = desc.extent.width;
  record.height = desc.extent.height;
  record.depth = desc.extent.depth;
  record.mips = desc.mips;
  record.layers = desc.layers;
  record.samples = desc.samples;
  if (desc.extent.relative_to.index != kNone) resolve_extent(record, desc.extent);
}

inline std::uint32_t Graph::add_resource(std::string_view name, const ResourceRecord& record) {
  const auto index = static_cast<std::uint32_t>(description_.resources.size());
  description_.resources.push_back(record);
  description_.resource_names.push_back(keep_name(name));
  versions_.push_back(0);
  return index;
}

inline Texture Graph::create_texture(std::string_view name, const TextureDesc& desc) {
  const auto index = static_cast<std::uint32_t>(description_.resources.size());
  fill_texture_record(description_.resources.emplace_back(), desc);
  description_.resource_names.push_back(keep_name(name));
  versions_.push_back(0);
  return {index, 0, tag_};
}

inline PassBuilder Graph::add_pass(std::string_view name, QueueClass queue) {
  const auto index = static_cast<std::uint32_t>(description_.passes.size());
  description_.passes.push_back(
      {static_cast<std::uint32_t>(description_.accesses.size()), queue, 0, 0});
  description_.pass_names.push_back(keep_name(name));
  callbacks_.push_back({});
  return {*this, index};
}

inline void Graph::append_access(std::uint32_t pass, std::uint32_t index, std::uint32_t version,
                                 std::uint32_t graph, const Access& access, Range range,
                                 std::uint32_t flags, ResourceKind kind) {
  AccessRecord& record = description_.accesses.emplace_back();
  record.stages = access.stages;
  record.access = access.access;
  record.layout = access.layout;
  record.usage = access.usage;
  record.version = version;
  record.kind = kind;
  record.range = range;
  if (graph == tag_ && index < description_.resources.size()) {
    record.resource = index;
    const ResourceRecord& resource = description_.resources[index];
    if (range == Range{} && resource.mips == 1 && resource.layers == 1) {
      record.range = {0, 1, 0, 1};
      // As a rule the access is a constant, and all but the resource is known to the compiler.
      const bool fits = access.stages != 0 && access.access != 0 &&
                        ((access.access & kWriteBits) != 0) == ((flags & kWrite) != 0) &&
                        (kind == ResourceKind::buffer || layout_is_usable(access.layout));
      if (fits && resource.kind == kind && resource.origin != Origin::imported) flags |= kPlain;
    } else {
      resolve_range(record.range, resource);
    }
  } else {
    flags |= index == kNone ? kNull : kForeign;
  }
  if (pass + 1 != description_.passes.size()) flags |= kClosed;
  record.flags = flags;
}

inline std::uint32_t Graph::next_version(std::uint32_t index, std::uint32_t graph) {
  if (graph != tag_ || index >= versions_.size()) return kNone;
  return ++versions_[index];
}

inline void PassBuilder::read(Texture texture, const Access& access, Range range) {
  graph_.append_access(pass_, texture.index, texture.version, texture.graph, access, range, 0,
                       ResourceKind::texture);
}

inline void PassBuilder::read(Buffer buffer, const Access& access) {
  graph_.append_access(pass_, buffer.index, buffer.version, buffer.graph, access, {}, 0,
                       ResourceKind::buffer);
}

inline Texture PassBuilder::write(Texture texture, const Access& access, Range range,
                                  Contents contents, Need need) {
  const std::uint32_t flags = kWrite | (contents == Contents::discard ? kDiscard : 0u) |
                              (need == Need::optional ? kOptional : 0u);
  graph_.append_access(pass_, texture.index, texture.version, texture.graph, access, range, flags,
                       ResourceKind::texture);
  texture.version = graph_.next_version(texture.index, texture.graph);
  return texture;
}

inline Buffer PassBuilder::write(Buffer buffer, const Access& access, Contents contents,
                                 Need need) {
  const std::uint32_t flags = kWrite | (contents == Contents::discard ? kDiscard : 0u) |
                              (need == Need::optional ? kOptional : 0u);
  graph_.append_access(pass_, buffer.index, buffer.version, buffer.graph, access, {}, flags,
                       ResourceKind::buffer);
  buffer.version = graph_.next_version(buffer.index, buffer.graph);
  return buffer;
}

inline void PassBuilder::side_effect() { graph_.description_.passes[pass_].flags |= kSideEffect; }

}  // namespace alcove::framegraph
