// Compiles a declared frame to a plan. It is a pure function that needs no device. Its phases are:
// validate, cull, chain, queues, check images, place, synchronise. Each phase has a source file of
// its own.
#pragma once

#include <cstdint>
#include <memory>
#include <tl/expected.hpp>

#include "alcove/framegraph/description.h"
#include "alcove/framegraph/error.h"
#include "alcove/framegraph/graph.h"
#include "alcove/framegraph/plan.h"

namespace alcove::framegraph {

struct MemoryRequirements {
  VkDeviceSize size = 0;
  VkDeviceSize alignment = 1;        // a power of two
  std::uint32_t memory_types = ~0u;  // allowed types, as a mask
  VkResult result = VK_SUCCESS;      // an error if the device could not be asked
};

// A function that returns the memory requirements of a transient. The compiler calls it for each
// transient that a live pass uses. `usage` is the union of the usages of these passes, and
// `concurrent` is Placement::concurrent. It must be a pure function. A frame whose
// requirements cannot be met is refused. Without a query, a texel of mip 0 counts as 4 bytes, which
// only tests of plans without a device use.
struct MemoryOracle {
  MemoryRequirements (*query)(const void* context, const ResourceRecord& record, VkFlags usage,
                              bool concurrent) = nullptr;
  const void* context = nullptr;

  MemoryRequirements operator()(const ResourceRecord& record, VkFlags usage,
                                bool concurrent) const {
    if (query) return query(context, record, usage, concurrent);
    const VkDeviceSize texels = VkDeviceSize{record.width} * record.height * record.depth;
    return {record.size + 4 * texels * record.layers * record.samples};
  }
};

// A function that returns the usages that a format supports, or 0 to refuse the format. It must be
// a pure function.
struct FormatOracle {
  VkImageUsageFlags (*query)(const void* context,
                             VkFormat format) = nullptr;  // if null, every usage is supported
  const void* context = nullptr;
};

// The device's limits for a texture of a format, dimension, usage and flags.
struct ImageLimits {
  VkExtent3D extent{};             // the largest size; 0 if the combination is not supported
  std::uint32_t mips = 0;          // the largest number of mips
  std::uint32_t layers = 0;        // the largest number of layers
  VkSampleCountFlags samples = 0;  // mask of the supported sample counts
};
// A function that returns the device's limits for one texture. The compiler calls it only for
// textures whose support does not follow from the other fields of Limits: those with flags, or with
// more than one sample, layer or depth slice. It must be a pure function.
struct ImageOracle {
  ImageLimits (*query)(const void* context, const ResourceRecord& record, VkFlags usage) = nullptr;
  const void* context = nullptr;
};

// Limits of the device and options of the caller. The defaults suit any desktop device.
struct Limits {
  std::uint32_t max_extent_2d = 16384;
  std::uint32_t max_extent_3d = 2048;
  std::uint32_t max_layers = 2048;
  VkDeviceSize max_buffer_size = VkDeviceSize{1} << 32;
  std::uint32_t max_samples = 64;  // all powers of two up to it are allowed
  // The device limit bufferImageGranularity in bytes. A buffer and an image with optimal tiling
  // never share a page of this size, even if both lie in the same heap.
  VkDeviceSize buffer_image_granularity = 1;
  // Queue family of each QueueClass. If a class has none (kNone), its passes run on the graphics
  // queue.
  std::uint32_t queue_families[kQueueClasses] = {0, kNone, kNone};
  MemoryOracle memory;
  FormatOracle formats;
  ImageOracle images;  // if it has no query, every texture within the fields above is allowed
  bool alias = true;   // whether transients may share memory
};

// Compiles graphs and keeps its working memory from call to call, so that it allocates nothing
// after that memory has grown to the largest graph. Only one thread at a time may use it.
class Compiler {
 public:
  Compiler();
  ~Compiler();
  Compiler(const Compiler&) = delete;
  Compiler& operator=(const Compiler&) = delete;

  // Compiles `graph` and writes the result to `plan`. If the declaration has errors, returns all of
  // them.
  [[nodiscard]] tl::expected<void, Errors> compile(const GraphDescription& graph,
                                                   const Limits& limits, Plan& plan);

 private:
  std::unique_ptr<struct Workspace> workspace_;
};

[[nodiscard]] tl::expected<Plan, Errors> compile(const GraphDescription& graph,
                                                 const Limits& limits = {});
// Also refuses passes that run and have no callback.
[[nodiscard]] tl::expected<Plan, Errors> compile(const Graph& graph, const Limits& limits = {});

}  // namespace alcove::framegraph
