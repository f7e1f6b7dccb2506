#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tl/expected.hpp>

#include "alcove/framegraph/executor.h"
#include "alcove/framegraph/graph.h"
#include "alcove/passes/pipelines.h"
#include "gpu/gpu_image.h"
#include "gpu/vulkan_device.h"

namespace alcove::sample {

// The names of the render graph that the passes of the sample use unqualified.
using framegraph::Graph;
using framegraph::RecordContext;
using framegraph::Texture;

// A host-visible buffer for uploads and read-back. The device must have finished with it before it
// is destroyed.
class HostBuffer {
 public:
  [[nodiscard]] static tl::expected<std::unique_ptr<HostBuffer>, std::string> create(
      const VulkanDevice& device, VkDeviceSize bytes, VkBufferUsageFlags usage);
  ~HostBuffer();
  HostBuffer(const HostBuffer&) = delete;
  HostBuffer& operator=(const HostBuffer&) = delete;

  VkBuffer buffer() const { return buffer_; }
  std::span<std::byte> bytes() const { return {mapped_, size_}; }
  // Import of the buffer into a graph: the host has written its contents and reads them afterwards.
  framegraph::ImportedBuffer import() const;

 private:
  explicit HostBuffer(const VulkanDevice& device) : device_(device) {}
  const VulkanDevice& device_;
  VkBuffer buffer_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  std::byte* mapped_ = nullptr;
  std::size_t size_ = 0;
  VkBufferUsageFlags usage_ = 0;
};

// GPU time of a pass.
struct PassTime {
  std::string pass;
  double milliseconds;
  bool of_view = false;  // in the window: the pass belongs to the view with the chosen settings
};

// Some passes of a frame, which were declared one after the other: see PassBuilder::index().
struct PassRange {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  bool contains(std::uint32_t pass) const { return begin <= pass && pass < end; }
};

// A render graph with its executor and pipelines. The sample and the tests run their frames with
// it.
class Gpu {
 public:
  [[nodiscard]] static tl::expected<std::unique_ptr<Gpu>, std::string> create(
      const DeviceOptions& options = {}, const framegraph::ExecutorOptions& executor = {});
  ~Gpu();
  // Waits for the device and starts again without histories and resources. Pipelines stay.
  [[nodiscard]] tl::expected<void, std::string> restart();

  const VulkanDevice& device() const { return *device_; }
  const framegraph::DeviceHandles& handles() const { return handles_; }
  passes::Pipelines& pipelines() { return *pipelines_; }
  framegraph::Executor& executor() { return *executor_; }

  // Declares a frame with `declare`, submits it and waits for it. If `declare` or the graph fails,
  // the error has one sentence for each fault, on separate lines.
  using Declare = std::function<tl::expected<void, std::string>(framegraph::Graph&)>;
  [[nodiscard]] tl::expected<framegraph::FrameReport, std::string> run(const Declare& declare);
  // Declares a frame and submits it without waiting, for callers with several frames in flight.
  // frame.slot cycles from 0 to frames_in_flight() - 1. Waits for the last frame of the slot first.
  [[nodiscard]] tl::expected<framegraph::FrameReport, std::string> submit(
      const Declare& declare, const framegraph::FrameInfo& frame = {});
  // Waits until the device has finished the last frame of a slot.
  [[nodiscard]] tl::expected<void, std::string> wait(std::uint32_t slot = 0);
  std::uint32_t frames_in_flight() const { return executor_options_.frames_in_flight; }

  // Timings of the passes of the last frame of a slot, which the device must have finished.
  std::span<const framegraph::PassTiming> timings(std::uint32_t slot = 0) {
    return executor_->timings(slot);
  }

 private:
  Gpu() = default;

  std::unique_ptr<VulkanDevice> device_;
  std::optional<framegraph::Executor> executor_;
  std::optional<passes::Pipelines> pipelines_;
  framegraph::Graph graph_;
  framegraph::DeviceHandles handles_;
  framegraph::ExecutorOptions executor_options_;
};

// Adds a pass that fills mip 0 of `target` from tightly packed texels in `source`, and returns the
// filled version.
framegraph::Texture add_copy(framegraph::Graph& graph, const HostBuffer& source,
                             framegraph::Texture target);

// Returns an image in kSampledState that has the tightly packed texels in mip 0, and all other
// mips. Each mip is made from the one before by a linear blit, which the format must support: if
// width and height are even, each texel is the mean of four texels, for sRGB formats in linear
// light. Waits for the device.
[[nodiscard]] tl::expected<std::unique_ptr<GpuImage>, std::string> upload_image(
    Gpu& gpu, VkFormat format, VkExtent2D size, std::span<const std::byte> texels);

// Adds a pass that copies mip `mip` of `texture` (colour, or the depth of D32_SFLOAT) to `target`,
// tightly packed, and makes it an output of the frame.
void add_read_back(framegraph::Graph& graph, framegraph::Texture texture, const HostBuffer& target,
                   std::uint32_t mip = 0);

// The texels of a format that is read back: their channels, and the bytes of a channel.
struct TexelLayout {
  std::uint32_t channels;
  std::uint32_t bytes;
  bool is_signed = false;  // of 8 bits
};
[[nodiscard]] TexelLayout texel_layout(VkFormat format);
// Returns a channel of such a texel as a float.
[[nodiscard]] float read_channel(const std::byte* data, const TexelLayout& layout);

}  // namespace alcove::sample
