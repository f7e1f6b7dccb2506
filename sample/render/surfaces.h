#pragma once

#include <optional>

#include "alcove/passes/apply.h"
#include "alcove/passes/occlusion.h"
#include "render/gbuffer.h"
#include "render/normal_source.h"

namespace alcove::sample {

// The g-buffer of a frame and the values that go with it. The functions below pass them to the
// occlusion and lighting passes, in the same way in all programs of the sample.
struct Surfaces {
  Gbuffer gbuffer;
  framegraph::Texture back_depth;    // from GbufferRenderer::add_back_faces; may be null
  framegraph::Texture second_depth;  // from GbufferRenderer::add_second_layer; may be null
  NormalSource normals = NormalSource::kShading;
  // Perceptual, of every surface; null: the materials' own roughness.
  std::optional<float> roughness;
};

// The hidden depths that are read besides the g-buffer: back faces and the second layer.
struct HiddenDepths {
  bool back_faces = false;
  bool second_layer = false;

  // Returns the union of both.
  [[nodiscard]] HiddenDepths with(const HiddenDepths& other) const;
  [[nodiscard]] bool covers(const HiddenDepths& other) const;
};
[[nodiscard]] HiddenDepths hidden_depths_of(const passes::OcclusionSettings& settings);

// Returns the inputs of the occlusion passes: depths, normals and roughness. The caller adds
// motion.
[[nodiscard]] passes::OcclusionInputs occlusion_inputs(const Surfaces& surfaces);
// Returns the settings with the roughness of the surfaces.
[[nodiscard]] passes::OcclusionSettings with_roughness(const passes::OcclusionSettings& settings,
                                                       const Surfaces& surfaces);

// Sets all fields of `inputs` that describe the surfaces, except their occlusion.
void give_surfaces(passes::ApplyInputs& inputs, const Surfaces& surfaces,
                   const passes::OcclusionOutputs& outputs);
[[nodiscard]] passes::ApplySettings apply_settings(const Surfaces& surfaces);

// Converts a matrix to the type that the passes use.
[[nodiscard]] passes::Matrix to_matrix(const glm::mat4& matrix);

}  // namespace alcove::sample
