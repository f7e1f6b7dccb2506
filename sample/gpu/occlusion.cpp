#include "gpu/occlusion.h"

#include <array>

namespace alcove::sample {

OcclusionSettings::OcclusionSettings(AlcoveQuality quality, float radius_ws) : AlcoveSettings{} {
  struct_size = sizeof(AlcoveSettings);
  if (alcoveGetSettings(quality, radius_ws, this) == ALCOVE_SUCCESS)
    specular = ALCOVE_SPECULAR_NONE;
}

tl::expected<void, passes::Error> add_occlusion(framegraph::Graph& graph, passes::Kernels& kernels,
                                                const AlcoveViewInfo& info, std::uint32_t index,
                                                const OcclusionSettings& settings,
                                                passes::ViewTextures& textures) {
  const bool bytes = settings.precision == ALCOVE_PRECISION_UNORM8;
  const bool halves = settings.precision == ALCOVE_PRECISION_FLOAT16;
  const VkFormat scalar = bytes    ? VK_FORMAT_R8_UNORM
                          : halves ? VK_FORMAT_R16_SFLOAT
                                   : VK_FORMAT_R32_SFLOAT;
  const VkFormat direction = bytes    ? VK_FORMAT_R8G8B8A8_SNORM
                             : halves ? VK_FORMAT_R16G16B16A16_SFLOAT
                                      : VK_FORMAT_R32G32B32A32_SFLOAT;
  const auto request = [&](bool wanted, AlcoveImageRole role, const char* name, VkFormat format) {
    if (wanted && !textures[role] && textures[ALCOVE_IMAGE_DEPTH]) {
      textures[role] =
          graph.create_texture(name, {format, extent_of(graph, textures[ALCOVE_IMAGE_DEPTH])});
    }
  };
  request(settings.visibility, ALCOVE_IMAGE_VISIBILITY, "visibility", scalar);
  request(settings.bent_normal, ALCOVE_IMAGE_BENT_NORMAL, "bent normal", direction);
  request(settings.specular != ALCOVE_SPECULAR_NONE, ALCOVE_IMAGE_SPECULAR, "specular occlusion",
          scalar);
  AlcoveViewInfo view = info;
  view.settings = &settings;
  return passes::add_view(graph, kernels, view, index, textures);
}

}  // namespace alcove::sample
