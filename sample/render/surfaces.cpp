#include "render/surfaces.h"

#include <cstring>

namespace alcove::sample {
namespace {

// The channel of the g-buffer textures that holds roughness (with the albedo) and metallic (with
// the emission).
constexpr std::uint32_t kAlpha = 3;

}  // namespace

HiddenDepths HiddenDepths::with(const HiddenDepths& other) const {
  return {back_faces || other.back_faces, second_layer || other.second_layer};
}

bool HiddenDepths::covers(const HiddenDepths& other) const {
  return (back_faces || !other.back_faces) && (second_layer || !other.second_layer);
}

HiddenDepths hidden_depths_of(const passes::OcclusionSettings& settings) {
  return {passes::needs_back_depth(settings), passes::needs_second_depth(settings)};
}

passes::OcclusionInputs occlusion_inputs(const Surfaces& surfaces) {
  passes::OcclusionInputs inputs{.depth_ndc = surfaces.gbuffer.depth};
  if (surfaces.normals != NormalSource::kDepth) {
    inputs.normals = surfaces.gbuffer.normal;
  }
  if (!surfaces.roughness) {
    inputs.roughness = surfaces.gbuffer.albedo;
  }
  inputs.back_depth_ndc = surfaces.back_depth;
  inputs.second_depth_ndc = surfaces.second_depth;
  return inputs;
}

passes::OcclusionSettings with_roughness(const passes::OcclusionSettings& settings,
                                         const Surfaces& surfaces) {
  passes::OcclusionSettings result = settings;
  if (surfaces.roughness) {
    result.roughness = *surfaces.roughness;
  } else {
    result.roughness_channel = kAlpha;
  }
  return result;
}

void give_surfaces(passes::ApplyInputs& inputs, const Surfaces& surfaces,
                   const passes::OcclusionOutputs& outputs) {
  inputs.depth = outputs.linear_depth;
  inputs.normals = outputs.normals;
  inputs.albedo = surfaces.gbuffer.albedo;
  if (!surfaces.roughness) {
    inputs.roughness = surfaces.gbuffer.albedo;
  }
  inputs.metallic = surfaces.gbuffer.emissive;
  inputs.normals_in_view_space = surfaces.normals == NormalSource::kDepth;
}

passes::ApplySettings apply_settings(const Surfaces& surfaces) {
  return {.roughness = surfaces.roughness.value_or(0.0f),
          .roughness_channel = kAlpha,
          .metallic_channel = kAlpha};
}

passes::Matrix to_matrix(const glm::mat4& matrix) {
  passes::Matrix result;
  std::memcpy(result.data(), &matrix, sizeof(result));
  return result;
}

}  // namespace alcove::sample
