// Handles, descriptions, accesses and ranges, with which a frame is declared. Plain data, no
// device: Vulkan's own enums are used as they are, and nothing of Vulkan is called.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>

namespace alcove::framegraph {

inline constexpr std::uint32_t kNone = ~std::uint32_t{0};
// In a Range: all mips or layers from the base on.
inline constexpr std::uint16_t kAll = 0xffff;

// One version of a texture of one frame of one graph. A write gives the next version and the graph
// refuses the old one from then on. A handle is dead after Graph::reset.
struct Texture {
  std::uint32_t index = kNone;
  std::uint32_t version = 0;
  std::uint32_t graph = 0;
  explicit operator bool() const { return index != kNone; }
  bool operator==(const Texture&) const = default;
};

// One version of a buffer, as Texture is of a texture.
struct Buffer {
  std::uint32_t index = kNone;
  std::uint32_t version = 0;
  std::uint32_t graph = 0;
  explicit operator bool() const { return index != kNone; }
  bool operator==(const Buffer&) const = default;
};

// A size in texels, or relative to another texture's size: each side is multiplied, then divided
// and rounded up, and is at least 1.
struct Extent {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t depth = 1;  // over 1 makes a 3D image
  Texture relative_to = {};
  std::uint32_t divisor = 1;
  std::uint32_t multiplier = 1;

  static Extent absolute(std::uint32_t width, std::uint32_t height, std::uint32_t depth = 1) {
    return {width, height, depth, {}, 1, 1};
  }
  static Extent relative(Texture to, std::uint32_t divisor = 1, std::uint32_t multiplier = 1) {
    return {0, 0, 1, to, divisor, multiplier};
  }
};

struct TextureDesc {
  VkFormat format = VK_FORMAT_UNDEFINED;
  Extent extent;
  std::uint32_t mips = 1;
  std::uint32_t layers = 1;  // over 1 makes an array
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  // For example VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT, or MUTABLE_FORMAT_BIT for views of another
  // format.
  VkImageCreateFlags flags = 0;
};

struct BufferDesc {
  VkDeviceSize size = 0;  // bytes
  // Usage besides what the accesses of the live passes ask for. A history needs it for every usage
  // that is not of Vulkan 1.0, for example SHADER_DEVICE_ADDRESS_BIT: histories are made once, for
  // all frames.
  VkBufferUsageFlags usage = 0;
};

// How a pass touches a resource. `layout` is for textures only. `usage` is VkImageUsageFlags for a
// texture and VkBufferUsageFlags for a buffer; the graph creates a resource with all that its live
// passes ask for. access.h names the common ones.
struct Access {
  VkPipelineStageFlags2 stages = 0;
  VkAccessFlags2 access = 0;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
  VkFlags usage = 0;
};

// The mips, layers and aspects of one access; the default is all of them.
struct Range {
  std::uint16_t base_mip = 0;
  std::uint16_t mips = kAll;
  std::uint16_t base_layer = 0;
  std::uint16_t layers = kAll;
  // One aspect of a texture with depth and stencil; 0 is every aspect of the format. A pass may
  // read the depth and write the stencil of one texture. Needs the feature
  // separateDepthStencilLayouts.
  VkImageAspectFlags aspects = 0;

  static constexpr Range mip(std::uint32_t mip) { return {base(mip), 1, 0, kAll}; }
  static constexpr Range layer(std::uint32_t layer) { return {0, kAll, base(layer), 1}; }
  static constexpr Range depth() { return {0, kAll, 0, kAll, VK_IMAGE_ASPECT_DEPTH_BIT}; }
  static constexpr Range stencil() { return {0, kAll, 0, kAll, VK_IMAGE_ASPECT_STENCIL_BIT}; }
  constexpr bool operator==(const Range&) const = default;

 private:
  // An index that does not fit stays out of range: no texture has so many mips or layers.
  static constexpr std::uint16_t base(std::uint32_t index) {
    return index < kAll ? static_cast<std::uint16_t>(index) : kAll;
  }
};

// Where an imported resource comes from, or is to be left: the last (or next) stages and accesses
// outside the graph and, for a texture, the layout. An initial_state in VK_IMAGE_LAYOUT_UNDEFINED
// (for a buffer: with no access) has no contents. Reads that a resource arrives with have seen what
// was written before; the graph makes it visible to other stages, and to theirs for other accesses.
struct State {
  VkPipelineStageFlags2 stages = 0;
  VkAccessFlags2 access = 0;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
  std::uint32_t reserved = 0;
};

// An image of the caller's. The graph never owns or outlives it; `view` may be null, then the
// executor makes the views that passes ask for and keeps them by image: call Executor::forget
// before the image is destroyed. `usage` is what the image was created with.
struct ImportedTexture {
  VkImage image = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;  // of the whole image
  TextureDesc desc;                   // the extent must be absolute
  VkImageUsageFlags usage = 0;
  // The first layer of the image's array that is imported; desc.layers follow from it. Barriers and
  // views count from it; a callback that takes the image itself has to.
  std::uint32_t first_layer = 0;
  State initial_state;
  // The queue family (VK_QUEUE_FAMILY_EXTERNAL is allowed) that has released the image to the
  // family of the queue that uses it first in this frame, or to the graphics family if no pass uses
  // it. The graph records the matching acquire barrier, with initial_state.layout as old and new
  // layout. kNone: no ownership transfer is needed.
  std::uint32_t initial_family = kNone;
  // The family that the graph releases the image to from graphics, in final_state's layout.
  std::uint32_t final_family = kNone;
  // With a final_state the graph leaves the image so, and a write to it is an output of the frame.
  // All that the frame does with it comes before what is done at these stages later. Without one
  // (layout undefined and no stages) a write that nobody reads is culled.
  State final_state;
};

struct ImportedBuffer {
  VkBuffer buffer = VK_NULL_HANDLE;
  BufferDesc desc;
  VkBufferUsageFlags usage = 0;
  // A buffer that arrives with contents that need no barrier has has_contents and no stages.
  bool has_contents = true;
  State initial_state;
  State final_state;
  std::uint32_t initial_family = kNone;  // as in ImportedTexture
  std::uint32_t final_family = kNone;
};

// The effect of a write on the earlier contents of its range.
enum class Contents : std::uint8_t {
  // The write may be partial: the earlier contents stay. The passes that made them run if the
  // result is wanted, or if the access reads as well (blending, a depth test, atomics): the pass
  // then depends on the earlier contents, whatever becomes of the result.
  keep,
  // The pass writes every texel and reads none: the earlier contents may be thrown away.
  discard,
  // Keeps as `keep` does. The order among writes of this kind does not matter, as with atomic
  // additions: writes that follow each other with the same access on one queue get no barrier
  // between them. All of them come after what was before, and before the next read or other write.
  accumulate,
};

// Whether a write has to take place.
enum class Need : std::uint8_t {
  required,  // takes place whenever its pass runs
  optional,  // costs nothing when nobody reads it: RecordContext::is_used tells the pass
};

enum class QueueClass : std::uint8_t { graphics, compute, transfer };
inline constexpr std::size_t kQueueClasses = 3;

// Why a slot of a history resource has no contents, or that it has.
enum class HistoryValidity : std::uint8_t {
  valid,
  first_frame,      // never written so far
  resized,          // the description changed: extent, format, mips, layers, samples or slot count
  reset,            // Graph::reset_history was called
  written_in_part,  // the frame that wrote it left out some mip or layer
};

}  // namespace alcove::framegraph
