// Handles, descriptions, accesses and ranges: the plain data with which a frame is declared. It
// uses Vulkan's enums as they are and calls no Vulkan function.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>

namespace alcove::framegraph {

inline constexpr std::uint32_t kNone = ~std::uint32_t{0};
// Value of Range::mips and Range::layers: all mips or layers from the base on.
inline constexpr std::uint16_t kAll = 0xffff;

enum class ResourceKind : std::uint8_t { texture, buffer };

// One version of a texture or buffer, in one frame of one graph. A write returns the next version,
// and the graph then refuses the old one. Graph::reset() makes all handles invalid.
template <ResourceKind kKind>
struct Handle {
  std::uint32_t index = kNone;
  std::uint32_t version = 0;
  std::uint32_t graph = 0;
  explicit operator bool() const { return index != kNone; }
  bool operator==(const Handle&) const = default;
};
using Texture = Handle<ResourceKind::texture>;
using Buffer = Handle<ResourceKind::buffer>;

// A size in texels.
struct Extent {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t depth = 1;  // above 1 makes a 3D image

  static constexpr Extent absolute(std::uint32_t width, std::uint32_t height,
                                   std::uint32_t depth = 1) {
    return {width, height, depth};
  }
};

struct TextureDesc {
  VkFormat format = VK_FORMAT_UNDEFINED;
  Extent extent;
  std::uint32_t mips = 1;
  std::uint32_t layers = 1;  // above 1 makes an array
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  // Flags with which the image is created, for example VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT, or
  // VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT for views of another format.
  VkImageCreateFlags flags = 0;
};

struct BufferDesc {
  VkDeviceSize size = 0;  // bytes
  // Additional usage flags. The graph adds the usages of the accesses that are not culled.
  VkBufferUsageFlags usage = 0;
};

// How a pass uses a resource: pipeline stages, memory accesses, layout and usage. `layout` applies
// to textures only. `usage` is VkImageUsageFlags for a texture and VkBufferUsageFlags for a buffer.
// The graph creates a resource with the usages of all passes that are not culled. access.h names
// the common accesses.
struct Access {
  VkPipelineStageFlags2 stages = 0;
  VkAccessFlags2 access = 0;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
  VkFlags usage = 0;
};

// The mips and layers of one access. The default is all of them. An access to a texture with depth
// and stencil is to both.
struct Range {
  std::uint16_t base_mip = 0;
  std::uint16_t mips = kAll;
  std::uint16_t base_layer = 0;
  std::uint16_t layers = kAll;

  static constexpr Range mip(std::uint32_t mip) { return {base(mip), 1, 0, kAll}; }
  static constexpr Range layer(std::uint32_t layer) { return {0, kAll, base(layer), 1}; }
  constexpr bool operator==(const Range&) const = default;

 private:
  // Converts an index. One that does not fit becomes kAll, which is out of range for every texture.
  static constexpr std::uint16_t base(std::uint32_t index) {
    return index < kAll ? static_cast<std::uint16_t>(index) : kAll;
  }
};

// The state of an imported resource before or after the frame: the last (or next) pipeline stages
// and accesses outside the graph and, for a texture, the layout. An initial_state with
// VK_IMAGE_LAYOUT_UNDEFINED (for a buffer: without accesses) means that the resource has no
// contents. Earlier writes are assumed to be visible to the read accesses of an initial_state
// already; the graph makes them visible to other stages and accesses. A pass on another queue than
// graphics waits for the graphics queue's earlier work if an initial_state has stages. Leave it
// without stages if no wait is needed, for example for a texture that never changes.
struct State {
  VkPipelineStageFlags2 stages = 0;
  VkAccessFlags2 access = 0;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
  std::uint32_t reserved = 0;
  bool operator==(const State&) const = default;
};

// An image that the caller owns. If `view` is null, the executor creates the views that passes ask
// for and caches them by image: call Executor::forget before you destroy the image. `usage` is the
// usage with which the image was created. The graph records no transfers of queue family ownership.
// An image or buffer that passes of several queue families use must have been created with
// VK_SHARING_MODE_CONCURRENT for them. If it arrives from another family, or leaves to one, the
// caller records the barriers before and after the frame.
struct ImportedTexture {
  VkImage image = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;  // a view of the whole image, or null
  TextureDesc desc;
  VkImageUsageFlags usage = 0;
  // The first imported layer of the image; desc.layers layers are imported. In barriers and views
  // of the graph, layer 0 is this layer. A callback that uses the VkImage directly must add
  // first_layer to its layer numbers.
  std::uint32_t first_layer = 0;
  // By default, the image has no contents, and its first use comes after all earlier work on the
  // graphics queue and after the semaphores that the frame waits for. For an image of a swapchain,
  // access::acquired() names the stages instead, so that less work has to wait.
  State initial_state{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT};
  // The state in which the graph leaves the image. A write to an image with a final_state is an
  // output of the frame. All work of the frame on the image is ordered before later work in the
  // stages of final_state. Without a final_state (undefined layout and no stages), a write that
  // nobody reads is culled.
  State final_state;
};

struct ImportedBuffer {
  VkBuffer buffer = VK_NULL_HANDLE;
  BufferDesc desc;
  VkBufferUsageFlags usage = 0;
  // Whether the buffer has contents at the start of the frame. If no barrier is needed between
  // earlier work on the buffer and the frame's first access, leave initial_state without stages.
  bool has_contents = true;
  State initial_state;
  State final_state;
};

// The effect of a write on the earlier contents of its range.
enum class Contents : std::uint8_t {
  // The write may cover a part of the range, so the earlier contents are kept. There must be some,
  // except of an attachment, which is then cleared or undefined. If the result is needed, the
  // passes
  // that wrote the earlier contents run too. If the access also reads (blending, a depth test,
  // atomics), they run whenever the pass of this access runs.
  keep,
  // No earlier contents are needed: the pass writes every texel and reads none, or it is the first
  // to write. Texels that it does not write are undefined.
  discard,
};

enum class QueueClass : std::uint8_t { graphics, compute, transfer };
inline constexpr std::size_t kQueueClasses = 3;

// Whether a slot of a history resource has contents, and if not, why.
enum class HistoryValidity : std::uint8_t {
  valid,
  first_frame,      // it was never written
  resized,          // the description changed: extent, format, mips, layers, samples or slot count
  reset,            // Graph::reset_history was called
  written_in_part,  // the frame that wrote it did not write every mip and layer
};

}  // namespace alcove::framegraph
