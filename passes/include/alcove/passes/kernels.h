// The compute pipelines of the passes, and the descriptors and parameters that a frame gives them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <tl/expected.hpp>

#include "alcove/framegraph/executor.h"
#include "alcove/framegraph/graph.h"

namespace alcove::passes {

// Why a pass could not be added: a sentence, and the result of the Vulkan call that failed, or
// VK_ERROR_FEATURE_NOT_PRESENT if the device lacks something.
struct Error {
  std::string message;
  VkResult result = VK_SUCCESS;
};

// The shaders of the library: each a file in shaders/, or a variant of one.
enum class Shader : std::uint8_t {
  linear_depth,
  normals,
  gtao,
  gtao_specular,
  reconstruct,
  reconstruct_history,
  reconstruct_specular,
  reconstruct_specular_history,
  reconstruct_half,
  reconstruct_half_history,
  reconstruct_half_specular,
  reconstruct_half_specular_history,
  upsample,
  upsample_specular,
  multi_bounce,
  gtso,
  gtso_by_table,
  apply,
  apply_specular,
  environment_map,
  environment_half,
  environment_prefilter,
  environment_harmonics,
  inspect,
  count,
};

// A pipeline of Kernels: valid as long as they are.
struct Kernel {
  VkPipeline pipeline = VK_NULL_HANDLE;
  Shader shader = Shader::count;
};

// Owns every pipeline, descriptor and parameter buffer of the passes on one device. Pipelines are
// made at the first use of a shader with a set of constants, or before it (Frame::prepare), and
// kept; a frame that uses none anew allocates nothing. One thread at a time, but for dispatch(),
// which the threads that record a frame (ExecutorOptions::recording_threads) may call at the same
// time.
class Kernels {
 public:
  static constexpr std::uint32_t kMaxDispatches = 80;        // of a frame
  static constexpr std::uint32_t kMaxParameterBytes = 1024;  // of a dispatch
  static constexpr std::size_t kMaxConstants = 24;           // of a pipeline
  static constexpr std::uint32_t kMaxFramesInFlight = 8;

  // `device`, made with the feature shaderStorageImageWriteWithoutFormat, must outlive the kernels.
  // `frames_in_flight`, 1 to kMaxFramesInFlight, is how many frames may be recorded before the
  // first of them has finished on the device: ExecutorOptions::frames_in_flight.
  //
  // `cache`, of the same device, is where every pipeline is looked up and kept. It is the caller's
  // to load, store and destroy, and outlives the kernels. Vulkan synchronises it, so that others
  // may use it at the same time, unless it was created with
  // VK_PIPELINE_CACHE_CREATE_EXTERNALLY_SYNCHRONIZED_BIT: then none may while passes are added.
  //
  // Errors: a handle that is null, frames in flight out of range, a function or a limit that the
  // device lacks (maxPerStageDescriptorStorageImages must be 9), memory that gives out.
  [[nodiscard]] static tl::expected<Kernels, Error> create(const framegraph::DeviceHandles& device,
                                                           std::uint32_t frames_in_flight,
                                                           VkPipelineCache cache = VK_NULL_HANDLE);
  Kernels(Kernels&&) noexcept;
  Kernels& operator=(Kernels&&) noexcept;
  ~Kernels();

  // Takes back the descriptors and parameters of the frame that was last recorded with `slot`
  // (below `frames_in_flight`), which must have finished on the device: FrameInfo::slot. Once a
  // frame, before it is recorded.
  void begin_frame(std::uint32_t slot);

  // Returns the pipeline of `shader` with specialisation constants 0, 1, 2... of these values.
  template <std::size_t N>
  requires(N <= kMaxConstants)
      [[nodiscard]] tl::expected<Kernel, Error> get(Shader shader,
                                                    const std::array<std::uint32_t, N>& constants) {
    return get_pipeline(shader, constants);
  }
  [[nodiscard]] tl::expected<Kernel, Error> get(Shader shader) { return get_pipeline(shader, {}); }

  // Returns the size in bytes of the tables that the shaders in use look up. Unused tables do not
  // count.
  [[nodiscard]] std::size_t table_bytes() const;

  // Returns the bytes of device memory: parameters of all frames in flight, and those tables.
  [[nodiscard]] VkDeviceSize memory_bytes() const;

  // Records a dispatch that covers `size` pixels (and layers) with 8x8 groups. Binding 0 is a
  // uniform buffer with `parameters`; the views follow in the order of the shader's bindings,
  // sampled ones in SHADER_READ_ONLY_OPTIMAL, stored ones in GENERAL; the shader's table comes
  // last. Where memory gives out, there is no such slot, or the frame has kMaxDispatches already,
  // Executor::record() gives the error.
  void dispatch(framegraph::RecordContext& context, Kernel kernel,
                std::span<const VkImageView> views, std::span<const std::byte> parameters,
                VkExtent3D size);

  // How many pipelines exist: a frame that models less makes fewer.
  [[nodiscard]] std::size_t pipeline_count() const;

 private:
  struct State;
  explicit Kernels(std::unique_ptr<State> state);
  // At most kMaxConstants.
  tl::expected<Kernel, Error> get_pipeline(Shader shader, std::span<const std::uint32_t> constants);
  std::unique_ptr<State> state_;
};

}  // namespace alcove::passes
