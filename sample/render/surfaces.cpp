#include "render/surfaces.h"

#include <cstring>

#include "alcove/passes/setting_table.h"

namespace alcove::sample {
namespace {

AlcoveCamera to_camera(const glm::mat4& clip_from_view, const glm::mat4& view_from_world) {
  AlcoveCamera camera;
  std::memcpy(camera.clip_from_view, &clip_from_view, sizeof camera.clip_from_view);
  std::memcpy(camera.view_from_world, &view_from_world, sizeof camera.view_from_world);
  return camera;
}

}  // namespace

HiddenDepths HiddenDepths::with(const HiddenDepths& other) const {
  return {back_faces || other.back_faces, second_layer || other.second_layer};
}

bool HiddenDepths::covers(const HiddenDepths& other) const {
  return (back_faces || !other.back_faces) && (second_layer || !other.second_layer);
}

HiddenDepths hidden_depths_of(const AlcoveSettings& settings) {
  return {passes::needs_back_depth(settings), passes::needs_second_depth(settings)};
}

AlcoveViewInfo view_info(const GbufferView& view, std::uint32_t id, std::uint32_t static_frames) {
  return {
      .id = id,
      .static_frames = static_frames,
      .camera = to_camera(view.clip_from_view, view.view_from_world),
      .previous_camera = to_camera(view.previous_clip_from_view, view.previous_view_from_world)};
}

Result<Occlusion> add_occlusion(Graph& graph, Gpu& gpu, const AlcoveViewInfo& view,
                                std::uint32_t index, const Surfaces& surfaces,
                                OcclusionSettings settings, bool multi_bounce) {
  const Gbuffer& gbuffer = surfaces.gbuffer;
  const bool has_normals = surfaces.normals != NormalSource::depth;
  passes::ViewTextures textures{};
  textures[ALCOVE_IMAGE_DEPTH] = gbuffer.depth;
  textures[ALCOVE_IMAGE_BACK_DEPTH] = gbuffer.back_depth;
  textures[ALCOVE_IMAGE_SECOND_DEPTH] = gbuffer.second_depth;
  if (has_normals) textures[ALCOVE_IMAGE_NORMALS] = gbuffer.normal;
  if (surfaces.motion_vectors) textures[ALCOVE_IMAGE_MOTION] = gbuffer.motion;
  if (surfaces.roughness) {
    settings.roughness = *surfaces.roughness;
  } else {
    textures[ALCOVE_IMAGE_ROUGHNESS] = gbuffer.albedo;
    settings.roughness_channel = 3;
  }
  if (multi_bounce) {
    textures[ALCOVE_IMAGE_ALBEDO] = gbuffer.albedo;
    const VkFormat format = passes::output_format(ALCOVE_IMAGE_MULTI_BOUNCE, settings.precision);
    textures[ALCOVE_IMAGE_MULTI_BOUNCE] =
        graph.create_texture("multi-bounce", {format, extent_of(graph, gbuffer.depth)});
  }
  const auto pass_count = [&] {
    return static_cast<std::uint32_t>(graph.description().passes.size());
  };
  const std::uint32_t first_pass = pass_count();
  ALCOVE_TRY_VOID(add_occlusion(graph, gpu.pipelines(), view, index, settings, textures)
                      .map_error(&passes::Error::message));
  Occlusion result{textures[ALCOVE_IMAGE_VISIBILITY],
                   textures[ALCOVE_IMAGE_BENT_NORMAL],
                   textures[ALCOVE_IMAGE_SPECULAR],
                   textures[ALCOVE_IMAGE_MULTI_BOUNCE],
                   gbuffer.normal,
                   {first_pass, pass_count()}};
  if (!has_normals) {
    ALCOVE_TRY(const auto made,
               passes::add_surface(graph, gpu.pipelines(), view.camera, gbuffer.depth)
                   .map_error(&passes::Error::message));
    result.normals = made.normals;
  }
  return result;
}

}  // namespace alcove::sample
