// The commands of the occlusion passes' frames, recorded without a device that executes them.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "cost/work.h"
#include "gpu_cost/recording_device.h"

namespace alcove::sample {

// The inputs that an engine gives to the passes, and the size of its images.
struct CostInputs {
  std::uint32_t width = 1920;
  std::uint32_t height = 1080;
  bool normals = true;  // true: a texture of normals (RGBA16F); false: normals from depth
  bool motion = false;  // motion vectors (RG16F)
  passes::OcclusionSettings settings;
  passes::NormalEncoding normal_encoding = passes::NormalEncoding::signed_xyz;
};

// An image that a pass reads or writes.
struct ImageTraffic {
  std::string image;  // its name in the graph
  passes::cost::Direction direction = passes::cost::Direction::read;
  double bytes = 0;  // of all its texels
};

struct RecordedPass {
  std::string name;
  std::vector<RecordedDispatch> dispatches;
  std::vector<ImageTraffic> traffic;
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
