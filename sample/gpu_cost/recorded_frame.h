// The frames of the occlusion passes as a device would get them, without a device that runs them.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "cost/work.h"
#include "gpu_cost/recording_device.h"

namespace alcove::sample {

// What an engine gives to the passes and what size its images have.
struct CostInputs {
  std::uint32_t width = 1920;
  std::uint32_t height = 1080;
  bool normals = true;  // a texture of normals (RGBA16F); else they are made from depth
  bool motion = false;  // motion vectors (RG16F)
  passes::OcclusionSettings settings;
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

// A frame of each state, in their order, with what `settings` ask for as outputs. Errors: settings
// that the passes refuse, pipelines that the driver refuses.
[[nodiscard]] tl::expected<std::vector<RecordedFrame>, std::string> record_frames(
    RecordingDevice& device, const CostInputs& inputs);

}  // namespace alcove::sample
