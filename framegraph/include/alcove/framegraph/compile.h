// Turns a declared frame into a plan: a pure function, no device. The phases, each in a file of its
// own: validate, cull, order, assign queues, lifetimes, place, synchronise.
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
};

// Asked for each live transient; `usage` is what its live passes need. Must be a pure function.
struct MemoryOracle {
  MemoryRequirements (*query)(const void* context, const ResourceRecord& record,
                              VkFlags usage) = nullptr;
  const void* context = nullptr;
};
// Width times height times texel size, mips summed, aligned to 256 bytes: what the default oracle
// gives, for plans without a device.
MemoryRequirements estimate_requirements(const ResourceRecord& record);

// The usages that a format supports; 0 refuses the format. The query must be a pure function.
struct FormatOracle {
  VkImageUsageFlags (*query)(const void* context, VkFormat format) = nullptr;  // null: anything
  const void* context = nullptr;
};

// The device's limits for a texture of a format, dimension, usage and flags.
struct ImageLimits {
  VkExtent3D extent{};             // the largest; 0 where the combination is not supported at all
  std::uint32_t mips = 0;          // the most
  std::uint32_t layers = 0;        // the most
  VkSampleCountFlags samples = 0;  // each allowed count
};
// Asked for textures that the fixed limits do not settle: with several samples, layers or slices,
// or with flags. Must be pure.
struct ImageOracle {
  ImageLimits (*query)(const void* context, const ResourceRecord& record, VkFlags usage) = nullptr;
  const void* context = nullptr;
};

enum class Ordering : std::uint8_t {
  program,  // as declared
  // In another order if that lowers the bytes of all heaps, as they are placed: never a higher
  // peak. Passes with side effects keep their order among each other.
  lower_peak,
};

// Limits of the device and wishes of the caller. The defaults suit any desktop device.
struct Limits {
  std::uint32_t max_extent_2d = 16384;
  std::uint32_t max_extent_3d = 2048;
  std::uint32_t max_layers = 2048;
  VkDeviceSize max_buffer_size = VkDeviceSize{1} << 32;
  std::uint32_t max_samples = 64;  // mask of VkSampleCountFlagBits is (2 * max_samples - 1)
  // Bytes between a buffer and an image (optimal tiling) that share memory.
  VkDeviceSize buffer_image_granularity = 1;
  // The device has lazily allocated memory: attachments whose contents no pass loads or needs get
  // it.
  bool has_lazy_memory = false;
  // The feature separateDepthStencilLayouts, for accesses to one aspect of a texture with two.
  bool separate_depth_stencil = true;
  // Queue family of each class, kNone where there is none: its passes then run on graphics.
  std::uint32_t queue_families[kQueueClasses] = {0, kNone, kNone};
  MemoryOracle memory;
  FormatOracle formats;
  ImageOracle images;  // without it everything within the fixed limits is allowed
  Ordering ordering = Ordering::lower_peak;
  // Graphs of more live passes than this keep program order: looking for another takes time that
  // grows faster than the graph.
  std::uint32_t reorder_passes = 48;
  // How long placement looks for a lower peak if its first attempt does not meet the lower bound,
  // in comparisons of two resources, 0 or more; 0 keeps the first attempt. The time that a changed
  // frame takes grows with it. For 200 passes with textures of differing sizes
  // (framegraph_benchmark):
  // 0 takes .05 ms at a median peak of 1.16 times the lower bound, 2^18 takes .6 ms at 1.002, and
  // 2^24 takes up to 30 ms for the last hundredths of the worst frames.
  std::int64_t placement_effort = 1 << 18;
  bool alias = true;  // false gives each transient bytes of its own
};

// Everything that compiling needs beside its input: kept from call to call, so that no memory is
// allocated once it has grown. One thread at a time.
class Compiler {
 public:
  Compiler();
  ~Compiler();
  Compiler(const Compiler&) = delete;
  Compiler& operator=(const Compiler&) = delete;

  // Overwrites `plan`. All errors of the declaration, or none and the plan is right.
  [[nodiscard]] tl::expected<void, Errors> compile(const GraphDescription& graph,
                                                   const Limits& limits, Plan& plan);

 private:
  std::unique_ptr<struct Workspace> workspace_;
};

[[nodiscard]] tl::expected<Plan, Errors> compile(const GraphDescription& graph,
                                                 const Limits& limits = {});
[[nodiscard]] inline tl::expected<Plan, Errors> compile(const Graph& graph,
                                                        const Limits& limits = {}) {
  return compile(graph.description(), limits);
}

}  // namespace alcove::framegraph
