#pragma once

#include <functional>
#include <vector>

#include "alcove/framegraph/graph.h"
#include "alcove/passes/apply.h"
#include "alcove/passes/occlusion.h"
#include "gpu/gpu.h"
#include "render/frame_renderer.h"

// The textures of a declared occlusion frame, and how they are read back as images.
namespace alcove::sample {

// The textures of a frame that computes occlusion: its inputs and its outputs.
struct DeclaredFrame {
  framegraph::Texture depth;
  framegraph::Texture normal;
  framegraph::Texture albedo;
  framegraph::Texture emissive;
  passes::OcclusionOutputs outputs;
  framegraph::Texture multi_bounce;
  std::vector<framegraph::Texture> specular_occlusion;
  passes::AppliedLight lit;
  framegraph::Texture unoccluded;
  framegraph::Texture unbent;
  framegraph::Texture occluded;
  framegraph::Texture bounced;
};

// A texture that is read back, and the image that receives its texels.
struct Wanted {
  framegraph::Texture texture;
  std::function<void(const HostBuffer&, FrameImages&)> store;
};

// Returns all textures of a frame that are read back.
[[nodiscard]] std::vector<Wanted> wanted_of(const DeclaredFrame& declared, VkExtent2D size,
                                            passes::Precision precision);

}  // namespace alcove::sample
