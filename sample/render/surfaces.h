#pragma once

#include <cstdint>
#include <optional>

#include "gpu/gpu.h"
#include "gpu/occlusion.h"
#include "render/gbuffer.h"
#include "render/normal_source.h"
#include "support/result.h"

// The passes of a frame, as all programs of the sample add them.
namespace alcove::sample {

// The g-buffer of a frame and the values that go with it.
struct Surfaces {
  Gbuffer gbuffer;
  NormalSource normals = NormalSource::shading;
  // Perceptual, of every surface; null: the materials' own roughness.
  std::optional<float> roughness;
  bool motion_vectors = false;  // whether g-buffer motion is used; if not, only the camera moves
};

// The hidden depths that are read besides the g-buffer: back faces and the second layer.
struct HiddenDepths {
  bool back_faces = false;
  bool second_layer = false;

  // Returns the union of both.
  [[nodiscard]] HiddenDepths with(const HiddenDepths& other) const;
  [[nodiscard]] bool covers(const HiddenDepths& other) const;
};
[[nodiscard]] HiddenDepths hidden_depths_of(const AlcoveSettings& settings);

[[nodiscard]] AlcoveViewInfo view_info(const GbufferView& view, std::uint32_t id = 0,
                                       std::uint32_t static_frames = 0);

// The occlusion of the surfaces. Outputs that were not requested are null.
struct Occlusion {
  framegraph::Texture visibility;
  framegraph::Texture bent_normal;
  framegraph::Texture specular;
  framegraph::Texture multi_bounce;
  framegraph::Texture normals;  // those that the passes used
  PassRange passes;             // of the view
};

// Adds the occlusion passes. The roughness of the surfaces replaces that of the settings.
[[nodiscard]] Result<Occlusion> add_occlusion(framegraph::Graph& graph, Gpu& gpu,
                                              const AlcoveViewInfo& view, std::uint32_t index,
                                              const Surfaces& surfaces, OcclusionSettings settings,
                                              bool multi_bounce = false);

}  // namespace alcove::sample
