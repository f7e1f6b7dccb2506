#include "gpu/occlusion.h"

#include "alcove/passes/setting_table.h"

namespace alcove::sample {

OcclusionSettings::OcclusionSettings(AlcoveQuality quality, float radius_ws) : AlcoveSettings{} {
  struct_size = sizeof(AlcoveSettings);
  if (alcoveGetSettings(quality, radius_ws, this) == ALCOVE_SUCCESS)
    specular = ALCOVE_SPECULAR_NONE;
}

tl::expected<void, passes::Error> add_occlusion(framegraph::Graph& graph,
                                                passes::Pipelines& pipelines,
                                                const AlcoveViewInfo& info, std::uint32_t index,
                                                const OcclusionSettings& settings,
                                                passes::ViewTextures& textures) {
  const auto request = [&](bool wanted, AlcoveImageRole role, const char* name) {
    if (wanted && !textures[role] && textures[ALCOVE_IMAGE_DEPTH]) {
      textures[role] = graph.create_texture(name, {passes::output_format(role, settings.precision),
                                                   extent_of(graph, textures[ALCOVE_IMAGE_DEPTH])});
    }
  };
  request(settings.visibility, ALCOVE_IMAGE_VISIBILITY, "visibility");
  request(settings.bent_normal, ALCOVE_IMAGE_BENT_NORMAL, "bent normal");
  request(settings.specular != ALCOVE_SPECULAR_NONE, ALCOVE_IMAGE_SPECULAR, "specular occlusion");
  AlcoveViewInfo view = info;
  view.settings = &settings;
  return passes::add_view(graph, pipelines, view, index, textures);
}

}  // namespace alcove::sample
