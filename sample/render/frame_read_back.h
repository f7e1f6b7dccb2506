#pragma once

#include <functional>
#include <vector>

#include "alcove/framegraph/graph.h"
#include "alcove/passes/apply.h"
#include "alcove/passes/occlusion.h"
#include "gpu/gpu.h"
#include "render/frame_renderer.h"

// What a frame of the occlusion makes, and how it comes back as images.
namespace alcove::sample {

// The occlusion's frame: what it was given and what it makes.
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

// A texture that is read back and where its texels go.
struct Wanted {
  framegraph::Texture texture;
  std::function<void(const HostBuffer&, FrameImages&)> store;
};

// Everything that is read back of a frame.
[[nodiscard]] std::vector<Wanted> wanted_of(const DeclaredFrame& declared, VkExtent2D size,
                                            passes::Precision precision);

}  // namespace alcove::sample
