#pragma once

#include <cstdint>
#include <cstring>

#include "alcove/passes/graph.h"

// The occlusion of a frame, as all programs of the sample and the tests of the passes add it.
namespace alcove::sample {

// The settings of the passes, and the outputs that a frame computes.
struct OcclusionSettings : AlcoveSettings {
  // The settings of a preset, without specular occlusion.
  explicit OcclusionSettings(AlcoveQuality quality, float radius_ws = 0.5f);
  OcclusionSettings() : OcclusionSettings(ALCOVE_QUALITY_MEDIUM) {}

  bool visibility = true;
  bool bent_normal = false;

  friend bool operator==(const OcclusionSettings& a, const OcclusionSettings& b) {
    const AlcoveSettings& plain = a;
    // Settings have no padding, and equal numbers have equal bytes but for zeros of another sign.
    // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
    return std::memcmp(&plain, &static_cast<const AlcoveSettings&>(b), sizeof plain) == 0 &&
           a.visibility == b.visibility && a.bent_normal == b.bent_normal;
  }
};

// The extent of a texture, for another of the same size.
[[nodiscard]] inline framegraph::Extent extent_of(const framegraph::Graph& graph,
                                                  framegraph::Texture texture) {
  const VkExtent3D size = graph.extent(texture);
  return framegraph::Extent::absolute(size.width, size.height);
}

// Adds the passes of a view. Creates textures for the outputs that the settings enable and that
// `textures` lacks, in the precision of the settings.
[[nodiscard]] tl::expected<void, passes::Error> add_occlusion(
    framegraph::Graph& graph, passes::Pipelines& pipelines, const AlcoveViewInfo& info,
    std::uint32_t index, const OcclusionSettings& settings, passes::ViewTextures& textures);

}  // namespace alcove::sample
