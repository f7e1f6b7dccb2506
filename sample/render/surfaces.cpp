#include "render/surfaces.h"

#include <cstring>

namespace alcove::sample {
namespace {

passes::Matrix to_matrix(const glm::mat4& matrix) {
  passes::Matrix result;
  std::memcpy(result.data(), &matrix, sizeof(result));
  return result;
}

std::string message(const passes::Error& error) { return error.message; }

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

passes::Frame pass_frame(Graph& graph, Gpu& gpu, const GbufferView& view, std::uint32_t index,
                         std::uint32_t static_frames) {
  return {graph,
          gpu.kernels(),
          {to_matrix(view.clip_from_view), to_matrix(view.view_from_world)},
          index,
          {to_matrix(view.previous_clip_from_view), to_matrix(view.previous_view_from_world)},
          static_frames};
}

Result<passes::OcclusionOutputs> add_occlusion(const passes::Frame& frame, const Surfaces& surfaces,
                                               passes::OcclusionSettings settings,
                                               std::string_view history_name) {
  const Gbuffer& gbuffer = surfaces.gbuffer;
  passes::OcclusionInputs inputs{.depth_ndc = gbuffer.depth};
  inputs.back_depth_ndc = gbuffer.back_depth;
  inputs.second_depth_ndc = gbuffer.second_depth;
  if (surfaces.normals != NormalSource::depth) inputs.normals = gbuffer.normal;
  if (surfaces.motion_vectors) inputs.motion = gbuffer.motion;
  if (surfaces.roughness) {
    settings.roughness = *surfaces.roughness;
  } else {
    inputs.roughness = gbuffer.albedo;
    settings.roughness_channel = 3;
  }
  return passes::add_occlusion(frame, inputs, settings, history_name).map_error(message);
}

}  // namespace alcove::sample
