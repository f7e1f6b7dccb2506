// The pipelines, descriptor sets and parameter buffers that the passes keep on a device.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <tl/expected.hpp>

#include "alcove/framegraph/executor.h"
#include "alcove/passes/error.h"

namespace alcove::passes {

// Owns the pipelines, descriptor sets and parameter buffers of the passes on one device. A pipeline
// is created when a shader is first used with a set of constants, and is kept (prepare_view()
// creates all that a view can need). A frame that needs no new pipeline allocates nothing. Only one
// thread at a time may use the object, recording of the graph included.
class Pipelines {
 public:
  static constexpr std::uint32_t kMaxDispatches = 88;  // in a frame
  static constexpr std::uint32_t kMaxFramesInFlight = 8;

  // Creates the object of a device, which must have been created with the feature
  // shaderStorageImageWriteWithoutFormat, and must outlive it. `frames_in_flight`, 1 to
  // kMaxFramesInFlight, is the number of frames that may be recorded before the first of them has
  // finished on the device: the same value as ExecutorOptions::frames_in_flight.
  //
  // `cache` is a pipeline cache of the same device, or null for none. The caller loads, stores and
  // destroys it, and it must outlive the object. Other threads may use it at the same time, unless
  // it was created with VK_PIPELINE_CACHE_CREATE_EXTERNALLY_SYNCHRONIZED_BIT: then no other thread
  // may use it while passes are added.
  //
  // Errors: a null handle, frames in flight out of range, a Vulkan function that the device lacks,
  // a limit maxPerStageDescriptorStorageImages below 6, or no more memory.
  [[nodiscard]] static tl::expected<Pipelines, Error> create(
      const framegraph::DeviceHandles& device, std::uint32_t frames_in_flight,
      VkPipelineCache cache = VK_NULL_HANDLE);
  Pipelines(Pipelines&&) noexcept;
  Pipelines& operator=(Pipelines&&) noexcept;
  ~Pipelines();

  // Begins a frame that is recorded with the frame slot `slot` (FrameInfo::slot), which must be
  // below `frames_in_flight`. The frame reuses the descriptors and parameters of the slot's
  // previous frame, which must have finished on the device. Call it once per frame, before the
  // frame is recorded. Executor::record() returns an error if the slot is out of range, or if the
  // frame has more than kMaxDispatches.
  void begin_frame(std::uint32_t slot);

  // Returns the device memory in bytes: the parameters of all frames in flight, and the lookup
  // tables of the shaders that have a pipeline.
  [[nodiscard]] VkDeviceSize memory_bytes() const;

  // Returns how many pipelines have been created. Passes that are not added create none.
  [[nodiscard]] std::size_t pipeline_count() const;

  // For the library itself (vulkan/pipeline_state.h).
  struct State;
  State& state() { return *state_; }

 private:
  explicit Pipelines(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace alcove::passes
