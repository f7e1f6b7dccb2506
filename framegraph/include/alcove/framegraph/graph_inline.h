// The functions of Graph and PassBuilder that run for every pass of every frame. They are inline,
// so that declaring an unchanged frame costs little more than writing its records. graph.h includes
// this file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <string_view>
#include <type_traits>
#include <utility>

#include "alcove/framegraph/graph.h"

namespace alcove::framegraph {

template <typename Callable>
void PassBuilder::record(Callable&& callable) {
  using Stored = std::decay_t<Callable>;
  if (!is_current()) [[unlikely]]
    return;
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

inline void* Graph::allocate(std::size_t size, std::size_t alignment) {
  // Free memory begins at a multiple of kAlignment, which is enough for nearly everything.
  const std::size_t padding =
      alignment <= kAlignment ? 0 : (0 - reinterpret_cast<std::uintptr_t>(next_)) & (alignment - 1);
  size = (size + kAlignment - 1) & ~(kAlignment - 1);
  if (padding + size > static_cast<std::size_t>(end_ - next_))
    return allocate_in_next_block(size, alignment);
  std::byte* const start = next_ + padding;
  next_ = start + size;
  return start;
}

inline void Graph::keep_name(std::string_view name, GraphDescription::Name& to) {
  const std::size_t size = name.size();
  to.size = static_cast<std::uint32_t>(size);
  // Two overlapping copies of a fixed size are cheaper than one of a size that is not known.
  const auto copy = [&](std::size_t half) {
    std::memcpy(to.place, name.data(), half);
    std::memcpy(to.place + size - half, name.data() + size - half, half);
  };
  if (size > sizeof to.place) {
    keep_long_name(name, to);
  } else if (size >= 16) {
    copy(16);
  } else if (size >= 8) {
    copy(8);
  } else if (size >= 4) {
    copy(4);
  } else {
    for (std::size_t i = 0; i < size; ++i) to.place[i] = name[i];
  }
}

inline void Graph::changed() {
  description_.edition = frame_;
  repeating_tag_ = 0;
}

inline bool Graph::is_texture_record(const ResourceRecord& record, const TextureDesc& desc) {
  // These fields are neighbours in both structs, so that the compiler compares two at a time.
  const auto pair = [](std::uint32_t low, std::uint32_t high) {
    return low | static_cast<std::uint64_t>(high) << 32;
  };
  return pair(record.format, record.width) == pair(desc.format, desc.extent.width) &&
         pair(record.height, record.depth) == pair(desc.extent.height, desc.extent.depth) &&
         pair(record.mips, record.layers) == pair(desc.mips, desc.layers) &&
         record.samples == desc.samples && record.size == 0 && record.external == kNone &&
         record.kind == ResourceKind::texture && record.origin == Origin::transient &&
         record.slot == 0 && record.slots == 1 && record.flags == 0 &&
         record.create_flags == desc.flags;
}

inline void Graph::fill_texture_record(ResourceRecord& record, const TextureDesc& desc) {
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
  record.create_flags = desc.flags;
  record.planes = has_depth_and_stencil(desc.format) ? 2 : 1;
}

inline Texture Graph::create_texture(std::string_view name, const TextureDesc& desc) {
  const auto index = static_cast<std::uint32_t>(description_.resources.size());
  if (description_.resources.is_full() || desc.extent.relative_to.index != kNone) [[unlikely]] {
    add_resource(texture_record(desc));
  } else {
    ResourceRecord& next = description_.resources.next();
    if (!is_texture_record(next, desc)) [[unlikely]] {
      fill_texture_record(next, desc);
      changed();
    }
    description_.resources.repeat();
    versions_[index] = 0;
  }
  keep_name(name, description_.resource_names[index]);
  return {index, 0, tag_};
}

inline PassBuilder Graph::add_pass(std::string_view name, QueueClass queue) {
  const auto index = static_cast<std::uint32_t>(description_.passes.size());
  if (description_.passes.is_full()) [[unlikely]]
    grow_passes();
  PassRecord& record = description_.passes.next();
  record.first_access = static_cast<std::uint32_t>(description_.accesses.size());
  record.queue = queue;
  record.flags = 0;
  record.reserved = 0;
  description_.passes.repeat();
  keep_name(name, description_.pass_names[index]);
  return {*this, index, tag_};
}

inline bool PassBuilder::is_current() {
  if (tag_ == graph_.tag_) [[likely]]
    return true;
  graph_.add_stale_builder();
  return false;
}

// Adds an access and returns the version after it.
template <typename Handle>
inline std::uint32_t Graph::add_access(std::uint32_t pass, const Handle& handle,
                                       const Access& access, Range range, std::uint32_t flags) {
  constexpr ResourceKind kKind =
      std::is_same_v<Handle, Texture> ? ResourceKind::texture : ResourceKind::buffer;
  const bool writes = (flags & kWrite) != 0;
  if (kKind == ResourceKind::buffer) flags |= kOnBuffer;
  // The access is nearly always a constant, so that the compiler knows everything but the handle.
  const auto is_of_whole = [&](std::uint32_t tag) {
    return range == Range{} && handle.graph == tag &&
           handle.index < description_.resources.size() &&
           has_one_subresource(description_.resources[handle.index]) &&
           pass + 1 == description_.passes.size();
  };
  AccessRecord& next = *next_access_;
  if (!(is_of_whole(repeating_tag_) && next.stages == access.stages &&
        next.access == access.access && next.layout == access.layout &&
        next.usage == access.usage && next.resource == handle.index &&
        next.version == handle.version && next.range == Range{0, 1, 0, 1} && next.flags == flags))
      [[unlikely]] {
    if (!is_of_whole(tag_) || description_.accesses.is_full()) [[unlikely]]
      return add_any_access(pass, handle.index, handle.version, handle.graph, access, range, flags);
    next.stages = access.stages;
    next.access = access.access;
    next.layout = access.layout;
    next.usage = access.usage;
    next.resource = handle.index;
    next.flags = flags;
    next.range = {0, 1, 0, 1};
    next.version = handle.version;
    changed();
  }
  ++next_access_;
  description_.accesses.repeat();
  return writes ? ++versions_[handle.index] : handle.version;
}

inline void PassBuilder::read(Texture texture, const Access& access, Range range) {
  if (is_current()) graph_.add_access(pass_, texture, access, range, rendering_);
}

inline void PassBuilder::read(Buffer buffer, const Access& access) {
  if (is_current()) graph_.add_access(pass_, buffer, access, {}, 0);
}

inline Texture PassBuilder::write(Texture texture, const Access& access, Range range,
                                  Contents contents, Need need) {
  const std::uint32_t flags = kWrite | (contents == Contents::discard ? kDiscard : 0u) |
                              (contents == Contents::accumulate ? kUnordered : 0u) |
                              (need == Need::optional ? kOptional : 0u) | rendering_;
  if (is_current()) texture.version = graph_.add_access(pass_, texture, access, range, flags);
  return texture;
}

inline Buffer PassBuilder::write(Buffer buffer, const Access& access, Contents contents,
                                 Need need) {
  const std::uint32_t flags = kWrite | (contents == Contents::discard ? kDiscard : 0u) |
                              (contents == Contents::accumulate ? kUnordered : 0u) |
                              (need == Need::optional ? kOptional : 0u);
  if (is_current()) buffer.version = graph_.add_access(pass_, buffer, access, {}, flags);
  return buffer;
}

inline void PassBuilder::side_effect() {
  if (is_current()) graph_.description_.passes[pass_].flags |= kSideEffect;
}

}  // namespace alcove::framegraph
