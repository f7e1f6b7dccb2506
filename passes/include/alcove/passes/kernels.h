// The compute pipelines of the passes, and the descriptors and parameters that a frame gives them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <tl/expected.hpp>

#include "alcove/framegraph/executor.h"
#include "alcove/framegraph/graph.h"

namespace alcove::passes {

// Why a pass could not be made: a sentence, and Vulkan's result where a call of its failed.
struct Error {
  std::string message;
  VkResult result = VK_SUCCESS;
};

// The shaders of the library, each one file in shaders/.
enum class Shader : std::uint8_t {
  depth_pyramid,
  normals,
  line_depth,
  gtao,
  gtao_lobe,
  reconstruct,
  reconstruct_history,
  reconstruct_lobe,
  reconstruct_lobe_history,
  multi_bounce,
  gtso,
  gtso_by_table,
  apply,
  apply_specular,
  environment_map,
  environment_half,
  environment_prefilter,
  environment_harmonics,
  count,
};

// A pipeline of Kernels: valid as long as they are.
struct Kernel {
  VkPipeline pipeline = VK_NULL_HANDLE;
  Shader shader = Shader::count;
};

// Owns every pipeline, descriptor and parameter buffer of the passes on one device. Pipelines are
// made at the first use of a shader with a set of constants and kept; a frame that uses none anew
// allocates nothing. One thread at a time.
class Kernels {
 public:
  // Passes use at most this many dispatches, and this many bytes of parameters, in a frame.
  static constexpr std::uint32_t kMaxDispatches = 72;
  static constexpr std::uint32_t kMaxParameterBytes = 1024;

  // `device` must outlive the kernels. `frames_in_flight` is how many frames may be recorded before
  // the first of them has finished on the device.
  [[nodiscard]] static tl::expected<Kernels, Error> create(const framegraph::DeviceHandles& device,
                                                           std::uint32_t frames_in_flight);
  Kernels(Kernels&&) noexcept;
  Kernels& operator=(Kernels&&) noexcept;
  ~Kernels();

  // Takes back the descriptors and parameters of the frame that was recorded `frames_in_flight`
  // frames ago; that frame must have finished on the device.
  void begin_frame();
  // The same for a caller that numbers its frames in flight: `slot` is below `frames_in_flight`,
  // and the frame that was last recorded with it must have finished on the device.
  void begin_frame(std::uint32_t slot);

  // The pipeline of `shader` with specialisation constants 0, 1, 2... of these values.
  [[nodiscard]] tl::expected<Kernel, Error> get(Shader shader,
                                                std::span<const std::uint32_t> constants);

  // Bytes of the tables that the shaders in use look up; one that is not used has none.
  [[nodiscard]] std::size_t table_bytes() const;

  // Bytes of device memory: parameters of all frames in flight, and those tables.
  [[nodiscard]] VkDeviceSize memory_bytes() const;

  // Records a dispatch that covers `size` pixels (and layers) with 8x8 groups. Binding 0 is a
  // uniform buffer with `parameters`; the views follow in the order of the shader's bindings,
  // sampled ones in SHADER_READ_ONLY_OPTIMAL, stored ones in GENERAL; the shader's table comes
  // last.
  void dispatch(framegraph::RecordContext& context, Kernel kernel,
                std::span<const VkImageView> views, std::span<const std::byte> parameters,
                VkExtent3D size);

  // How many pipelines exist: a frame that models less makes fewer.
  [[nodiscard]] std::size_t pipeline_count() const;

 private:
  struct State;
  explicit Kernels(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace alcove::passes
