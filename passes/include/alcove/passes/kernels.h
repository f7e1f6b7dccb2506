// The compute pipelines of the passes, and the descriptors and parameters of their dispatches.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "alcove/alcove_work.h"
#include "alcove/framegraph/executor.h"
#include "alcove/framegraph/graph.h"

namespace alcove::passes {

// The reason why a pass could not be added. `message` is a sentence. `result` is that of the Vulkan
// call that failed, or VK_ERROR_FEATURE_NOT_PRESENT if the device lacks a function or its limits
// are too small.
struct Error {
  std::string message;
  VkResult result = VK_SUCCESS;
};

// The compute shaders of the library. Each is a file in shaders/, or a variant of a file that is
// compiled with other preprocessor definitions.
enum class Shader : std::uint8_t {
  linear_depth,
  normals,
  gtao,
  gtao_bent,
  gtao_specular,
  gtao_bent_specular,
  reconstruct,
  reconstruct_bent,
  reconstruct_specular,
  reconstruct_bent_specular,
  reconstruct_half,
  reconstruct_half_bent,
  reconstruct_half_specular,
  reconstruct_half_bent_specular,
  upsample,
  upsample_bent,
  upsample_specular,
  upsample_bent_specular,
  resolve_depth,
  halve_depth,
  mask_depth,
  mask_depth_integer,
  multi_bounce,
  gtso,
  inspect,
  count,
};

// A pipeline of Kernels: valid as long as they are.
struct Kernel {
  VkPipeline pipeline = VK_NULL_HANDLE;
  Shader shader = Shader::count;
};

// A value for a specialisation constant of a shader, by the constant's name in GLSL.
struct NamedConstant {
  std::string_view name;
  std::uint32_t value = 0;  // of a bool: 0 or 1
};

// Owns the pipelines, descriptor sets and parameter buffers of the passes on one device. A pipeline
// is created when a shader is first used with a set of constants, and is kept (prepare_view()
// creates all that a view can need). A frame that needs no new pipeline allocates nothing. Several
// threads may call dispatch() at the same time; only one thread at a time may call any other
// function.
class Kernels {
 public:
  static constexpr std::uint32_t kMaxDispatches = 88;  // in a frame
  static constexpr std::uint32_t kMaxFramesInFlight = 8;

  // Creates the kernels of a device. `device` must have been created with the feature
  // shaderStorageImageWriteWithoutFormat, and must outlive the kernels. `frames_in_flight`, 1 to
  // kMaxFramesInFlight, is the number of frames that may be recorded before the first of them has
  // finished on the device: the same value as ExecutorOptions::frames_in_flight.
  //
  // `cache` is a pipeline cache of the same device, or null for none. The caller loads, stores and
  // destroys it, and it must outlive the kernels. Other threads may use it at the same time, unless
  // it was created with VK_PIPELINE_CACHE_CREATE_EXTERNALLY_SYNCHRONIZED_BIT: then no other thread
  // may use it while passes are added.
  //
  // Errors: a null handle, frames in flight out of range, a Vulkan function that the device lacks,
  // a limit maxPerStageDescriptorStorageImages below 6, or no more memory.
  [[nodiscard]] static tl::expected<Kernels, Error> create(const framegraph::DeviceHandles& device,
                                                           std::uint32_t frames_in_flight,
                                                           VkPipelineCache cache = VK_NULL_HANDLE);
  Kernels(Kernels&&) noexcept;
  Kernels& operator=(Kernels&&) noexcept;
  ~Kernels();

  // Begins a frame that is recorded with the frame slot `slot` (FrameInfo::slot), which must be
  // below `frames_in_flight`. The frame reuses the descriptors and parameters of the slot's
  // previous frame, which must have finished on the device. Call it once per frame, before the
  // frame is recorded.
  void begin_frame(std::uint32_t slot);

  // Returns the pipeline of `shader` with the values of AlcoveWorkDispatch::constants. Errors: a
  // pipeline that the device could not create.
  [[nodiscard]] tl::expected<Kernel, Error> get(Shader shader,
                                                std::span<const AlcoveWorkConstant> constants = {});

  // Returns the size in bytes of the lookup tables of the shaders that have a pipeline. Tables of
  // other shaders are not created and do not count.
  [[nodiscard]] std::size_t table_bytes() const;

  // Returns the device memory that the kernels use, in bytes: the parameters of all frames in
  // flight, and table_bytes().
  [[nodiscard]] VkDeviceSize memory_bytes() const;

  // Records a dispatch of `groups`. `parameters` are the contents of the shader's uniform buffer.
  // `views` has one view for each image binding of the shader, ascending by number: sampled images
  // in the layout SHADER_READ_ONLY_OPTIMAL, storage images in GENERAL. Executor::record() returns
  // an error if memory runs out, if begin_frame() was given no valid slot, or if the frame already
  // has kMaxDispatches.
  void dispatch(framegraph::RecordContext& context, Kernel kernel,
                std::span<const VkImageView> views, std::span<const std::byte> parameters,
                const std::array<std::uint32_t, 3>& groups);

  // Returns a list for the work that is being described, which is too large for a stack. Its
  // contents are undefined.
  [[nodiscard]] AlcoveWork& scratch();

  // Returns how many pipelines have been created. Passes that are not added create none.
  [[nodiscard]] std::size_t pipeline_count() const;

 private:
  struct State;
  explicit Kernels(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace alcove::passes
