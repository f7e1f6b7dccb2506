#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "alcove/passes/occlusion.h"
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
[[nodiscard]] HiddenDepths hidden_depths_of(const passes::OcclusionSettings& settings);

[[nodiscard]] passes::Frame pass_frame(framegraph::Graph& graph, Gpu& gpu, const GbufferView& view,
                                       std::uint32_t index = 0, std::uint32_t static_frames = 0);

// Adds the occlusion passes. The roughness of the surfaces replaces that of the settings.
[[nodiscard]] Result<passes::OcclusionOutputs> add_occlusion(
    const passes::Frame& frame, const Surfaces& surfaces, passes::OcclusionSettings settings,
    std::string_view history_name = "occlusion");

}  // namespace alcove::sample
