#pragma once

#include <optional>

#include "alcove/passes/apply.h"
#include "alcove/passes/occlusion.h"
#include "render/gbuffer.h"
#include "render/normal_source.h"

namespace alcove::sample {

// What a frame knows of the surfaces that it shows, and how the passes are given it: alike wherever
// the sample draws.
struct Surfaces {
  Gbuffer gbuffer;
  framegraph::Texture back_depth;    // as GbufferRenderer::add_back_faces fills it; may be null
  framegraph::Texture second_depth;  // as GbufferRenderer::add_second_layer does; may be null
  NormalSource normals = NormalSource::kShading;
  std::optional<float> roughness;  // perceptual, of every surface; none: of their materials
};

// Which depths beyond the g-buffer's are read.
struct HiddenDepths {
  bool back_faces = false;
  bool second_layer = false;

  // With those that another reads.
  [[nodiscard]] HiddenDepths with(const HiddenDepths& other) const;
  [[nodiscard]] bool covers(const HiddenDepths& other) const;
};
[[nodiscard]] HiddenDepths hidden_depths_of(const passes::OcclusionSettings& settings);

// Depths, normals and roughness; motion is left to the caller.
[[nodiscard]] passes::OcclusionInputs occlusion_inputs(const Surfaces& surfaces);
// The settings with the roughness of the surfaces.
[[nodiscard]] passes::OcclusionSettings with_roughness(const passes::OcclusionSettings& settings,
                                                       const Surfaces& surfaces);

// Fills in all that is known of the surfaces but their occlusion.
void give_surfaces(passes::ApplyInputs& inputs, const Surfaces& surfaces,
                   const passes::OcclusionOutputs& outputs);
[[nodiscard]] passes::ApplySettings apply_settings(const Surfaces& surfaces);

// A matrix as the passes take it.
[[nodiscard]] passes::Matrix to_matrix(const glm::mat4& matrix);

}  // namespace alcove::sample
