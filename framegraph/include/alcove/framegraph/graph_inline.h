// The functions of Graph and PassBuilder that run for every pass of every frame. graph.h includes
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

inline std::string_view Graph::keep_name(std::string_view name) {
  if (name.empty()) return {};
  void* const place = allocate(name.size(), 1);
  std::memcpy(place, name.data(), name.size());
  return {static_cast<const char*>(place), name.size()};
}

inline ResourceRecord Graph::texture_record(const TextureDesc& desc) {
  ResourceRecord record;
  record.format = desc.format;
  record.width = desc.extent.width;
  record.height = desc.extent.height;
  record.depth = desc.extent.depth;
  record.mips = desc.mips;
  record.layers = desc.layers;
  record.samples = desc.samples;
  record.create_flags = desc.flags;
  return record;
}

// Returns whether a record is the one that texture_record() makes for a transient. It combines the
// differences of all fields, so that there is one branch.
inline bool Graph::is_transient(const ResourceRecord& record, const TextureDesc& desc) {
  const auto pair = [](std::uint32_t low, std::uint32_t high) {
    return low | std::uint64_t{high} << 32;
  };
  return ((pair(record.format, record.width) ^ pair(desc.format, desc.extent.width)) |
          (pair(record.height, record.depth) ^ pair(desc.extent.height, desc.extent.depth)) |
          (pair(record.mips, record.layers) ^ pair(desc.mips, desc.layers)) |
          (pair(record.samples, record.create_flags) ^ pair(desc.samples, desc.flags)) |
          static_cast<std::uint32_t>(record.origin) | static_cast<std::uint32_t>(record.kind)) == 0;
}

// The usual frame repeats the previous one. Its records are only compared, which costs less than
// writing them.
inline Texture Graph::create_texture(std::string_view name, const TextureDesc& desc) {
  const auto index = static_cast<std::uint32_t>(description_.resources.size());
  if (index >= versions_.size()) [[unlikely]]
    return {add_resource(name, texture_record(desc)), 0, tag_};
  ResourceRecord& next = description_.resources.next();
  if (!is_transient(next, desc)) [[unlikely]] {
    next = texture_record(desc);
    change();
  }
  description_.resources.repeat();
  description_.resource_names[index] = keep_name(name);
  versions_[index] = 0;
  return {index, 0, tag_};
}

inline PassBuilder Graph::add_pass(std::string_view name, QueueClass queue) {
  const std::size_t index = description_.passes.size();
  if (index == callbacks_.size()) [[unlikely]]
    grow_passes();
  description_.pass_names[index] = keep_name(name);
  callbacks_[index] = {};
  description_.passes.add({static_cast<std::uint32_t>(description_.accesses.size()), queue, 0, 0});
  return {*this, static_cast<std::uint32_t>(index), tag_};
}

inline bool PassBuilder::is_current() const {
  if (tag_ == graph_.tag_) [[likely]]
    return true;
  graph_.add_stale_builder();
  return false;
}

// Adds an access and returns the version after it.
template <ResourceKind kKind>
inline std::uint32_t Graph::add_access(PassBuilder pass, const Handle<kKind>& handle,
                                       const Access& access, Range range, std::uint32_t flags) {
  if (kKind == ResourceKind::buffer) flags |= kOnBuffer;
  const auto is_whole = [&](std::uint32_t tag) {
    return range == Range{} && handle.graph == tag && pass.tag_ == tag &&
           handle.index < description_.resources.size() &&
           pass.pass_ + 1 == description_.passes.size();
  };
  AccessRecord& next = description_.accesses.next();
  // The range need not be compared, because a frame that repeats the one before has the same
  // resources.
  if (!(is_whole(repeating_tag_) && next.stages == access.stages && next.access == access.access &&
        next.layout == access.layout && next.usage == access.usage &&
        next.resource == handle.index && next.flags == (flags | kWhole) &&
        next.version == handle.version)) [[unlikely]] {
    if (!is_whole(tag_) || description_.accesses.is_full()) [[unlikely]]
      return add_any_access(pass, handle.index, handle.version, handle.graph, access, range, flags);
    const ResourceRecord& resource = description_.resources[handle.index];
    next.stages = access.stages;
    next.access = access.access;
    next.layout = access.layout;
    next.usage = access.usage;
    next.resource = handle.index;
    next.flags = flags | kWhole;
    next.range = {0, static_cast<std::uint16_t>(resource.mips), 0,
                  static_cast<std::uint16_t>(resource.layers)};
    next.version = handle.version;
    change();
  }
  description_.accesses.repeat();
  return (flags & kWrite) != 0 ? ++versions_[handle.index] : handle.version;
}

constexpr std::uint32_t write_flags(Contents contents) {
  return contents == Contents::discard ? kWrite | kDiscard : kWrite;
}

inline void PassBuilder::read(Texture texture, const Access& access, Range range) {
  graph_.add_access(*this, texture, access, range, 0);
}

inline void PassBuilder::read(Buffer buffer, const Access& access) {
  graph_.add_access(*this, buffer, access, {}, 0);
}

inline Texture PassBuilder::write(Texture texture, const Access& access, Range range,
                                  Contents contents) {
  texture.version = graph_.add_access(*this, texture, access, range, write_flags(contents));
  return texture;
}

inline Buffer PassBuilder::write(Buffer buffer, const Access& access, Contents contents) {
  buffer.version = graph_.add_access(*this, buffer, access, {}, write_flags(contents));
  return buffer;
}

inline void PassBuilder::side_effect() {
  if (is_current()) graph_.description_.passes[pass_].flags |= kSideEffect;
}

}  // namespace alcove::framegraph
