// A stand-in for a Vulkan device. It creates real pipelines and records all other commands; its
// images, memory and command buffers are handles without contents. With it, a frame is declared,
// compiled and recorded as in an engine, on a driver that can only compile.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "alcove/framegraph/executor.h"
#include "gpu_cost/compiled_shader.h"
#include "gpu_cost/null_device.h"

namespace alcove::sample {

struct RecordedDispatch {
  std::string pass;  // its name in the graph
  VkPipeline pipeline = VK_NULL_HANDLE;
  std::uint32_t groups_x = 0;
  std::uint32_t groups_y = 0;
  std::uint32_t groups_z = 0;

  bool operator==(const RecordedDispatch&) const = default;
};

class RecordingDevice {
 public:
  explicit RecordingDevice(const NullDevice& device);
  ~RecordingDevice();
  RecordingDevice(const RecordingDevice&) = delete;
  RecordingDevice& operator=(const RecordingDevice&) = delete;

  // Returns the handles for Executor::create and Kernels::create. Whatever these functions create
  // must be destroyed before this object.
  framegraph::DeviceHandles handles();
  // A primary command buffer in the recording state.
  VkCommandBuffer commands();
  // A new handle of an image without contents, for imports.
  VkImage next_image();

  // The dispatches since the last call, in order.
  std::vector<RecordedDispatch> take_dispatches();
  // Null if the pipeline was not created by this device.
  const CompiledShader* compiled(VkPipeline pipeline) const;
  // The error of pipeline creation; empty if there was none.
  const std::string& error() const { return error_; }

 private:
  friend struct RecordingFunctions;
  std::uint64_t next_handle() { return ++last_handle_; }

  NullDevice device_;
  std::uint64_t last_handle_ = 0x1000;
  std::map<std::uint64_t, std::unique_ptr<std::byte[]>> memory_;
  std::map<VkShaderModule, std::uint32_t> group_sizes_;
  std::map<VkShaderModule, std::string> codes_;
  std::map<VkPipeline, CompiledShader> compiled_;
  std::vector<RecordedDispatch> dispatches_;
  std::string pass_;
  VkPipeline bound_ = VK_NULL_HANDLE;
  std::string error_;
};

}  // namespace alcove::sample
