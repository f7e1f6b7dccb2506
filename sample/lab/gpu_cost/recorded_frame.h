// The commands of the occlusion passes' frames, recorded without a device that executes them.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "cost/accesses.h"
#include "gpu_cost/recording_device.h"

namespace alcove::sample {

// The kinds of projection for which the shaders are compiled differently. Depth is reversed in
// perspective views.
enum class ProjectionKind : std::uint8_t { infinite_far, finite_far, orthographic };
inline constexpr std::array<std::string_view, 3> kProjectionNames{
    "infinite far plane", "finite far plane", "orthographic"};

// The inputs that an engine gives to the passes, and the size of its images.
struct CostInputs {
  std::uint32_t width = 1920;
  std::uint32_t height = 1080;
  bool normals = true;   // true: a texture of normals (RGBA16F); false: normals from depth
  bool motion = false;   // motion vectors (RG16F)
  bool area = false;     // the images are read and written in part
  bool mask = false;     // a mask of surfaces (R8)
  bool samples = false;  // four samples of depth per pixel
  ProjectionKind projection = ProjectionKind::finite_far;
  passes::OcclusionSettings settings;
  passes::NormalEncoding normal_encoding = passes::NormalEncoding::signed_xyz;
};

struct RecordedPass {
  std::string name;
  std::vector<RecordedDispatch> dispatches;
  std::vector<passes::cost::PassImage> images;

  bool operator==(const RecordedPass&) const = default;
};

struct RecordedFrame {
  passes::cost::FrameState state = passes::cost::FrameState::first;
  std::vector<RecordedPass> passes;
};

// Returns a recorded frame for each FrameState, in their order, with the outputs that `settings`
// enable. Errors: the passes reject the settings, or the driver rejects a pipeline.
[[nodiscard]] tl::expected<std::vector<RecordedFrame>, std::string> record_frames(
    RecordingDevice& device, const CostInputs& inputs);

}  // namespace alcove::sample
