// What a view takes of memory, from its settings alone.
#include "alcove/alcove.h"
#include "alcove/passes/occlusion.h"
#include "c_settings.h"
#include "output_format.h"

namespace alcove::passes {
namespace {

constexpr std::uint32_t kKnownOutputs = ALCOVE_OUTPUT_VISIBILITY | ALCOVE_OUTPUT_BENT_NORMAL |
                                        ALCOVE_OUTPUT_SPECULAR | ALCOVE_OUTPUT_MULTI_BOUNCE;

// Of a texel of the formats that the passes use.
std::uint64_t bytes_of(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R8_UNORM:
      return 1;
    case VK_FORMAT_R16_SFLOAT:
      return 2;
    case VK_FORMAT_R32_SFLOAT:
    case VK_FORMAT_R8G8B8A8_SNORM:
    case VK_FORMAT_R8G8B8A8_UNORM:
      return 4;
    case VK_FORMAT_R16G16B16A16_SFLOAT:
    case VK_FORMAT_R32G32_UINT:
      return 8;
    default:
      return 16;
  }
}

struct Wanted {
  bool visibility;
  bool bent_normal;
  bool specular;
  bool multi_bounce;
  bool by_model;  // specular occlusion from visibility and bent normals

  bool searches_bent(Specular specular_model) const {
    return bent_normal || (by_model && specular_model != Specular::lagarde);
  }
};

Wanted wanted_of(std::uint32_t outputs, Specular model) {
  const auto has = [outputs](AlcoveOutput output) {
    return (outputs & static_cast<std::uint32_t>(output)) != 0;
  };
  return {has(ALCOVE_OUTPUT_VISIBILITY), has(ALCOVE_OUTPUT_BENT_NORMAL),
          has(ALCOVE_OUTPUT_SPECULAR), has(ALCOVE_OUTPUT_MULTI_BOUNCE),
          has(ALCOVE_OUTPUT_SPECULAR) && model != Specular::slices};
}

// Bytes of a pixel, and of a tile.
std::uint64_t pixel_bytes(const Wanted& wanted, const GivenSettings& given, bool normals_given) {
  const OcclusionSettings& settings = given.settings;
  const std::uint64_t depth = bytes_of(VK_FORMAT_R32_SFLOAT);
  std::uint64_t sum = depth;
  sum += wanted.by_model || !normals_given ? depth : 0;
  sum += normals_given ? 0 : bytes_of(VK_FORMAT_R16G16B16A16_SFLOAT);
  sum += needs_back_depth(settings.estimator, settings.thickness_unit) ? depth : 0;
  sum += needs_second_depth(settings.estimator, settings.depth_layers) ? depth : 0;
  const bool visibility = wanted.multi_bounce || wanted.by_model;
  sum += visibility && !wanted.visibility ? bytes_of(scalar_format(settings.precision)) : 0;
  const bool bent = wanted.searches_bent(given.specular);
  sum += bent && !wanted.bent_normal ? bytes_of(direction_format(settings.precision)) : 0;
  return sum;
}

}  // namespace
}  // namespace alcove::passes

using namespace alcove::passes;

AlcoveResult alcoveEstimateMemory(const AlcoveSettings* settings, uint32_t width, uint32_t height,
                                  uint32_t outputs, VkBool32 normals_given, AlcoveMemory* memory) {
  constexpr std::uint32_t kLargest = 1u << 16;
  if (memory == nullptr || memory->struct_size != sizeof *memory || width < 1 || height < 1 ||
      width > kLargest || height > kLargest || outputs == 0 || (outputs & ~kKnownOutputs) != 0) {
    return ALCOVE_ERROR_INVALID_INPUT;
  }
  const auto given = to_settings(settings);
  if (!given || given->settings.tile_size < 1) {
    return ALCOVE_ERROR_INVALID_INPUT;
  }
  const Wanted wanted = wanted_of(outputs, given->specular);
  const bool lobe = wanted.specular && !wanted.by_model;
  const bool bent = wanted.searches_bent(given->specular);
  const std::uint64_t tile_bytes =
      bytes_of(raw_format(lobe)) + (bent ? bytes_of(kBentRawFormat) : 0);
  const std::uint64_t pixels = std::uint64_t{width} * height;
  const std::uint32_t tile = given->settings.tile_size;
  const std::uint64_t tiles =
      std::uint64_t{(width + tile - 1) / tile} * ((height + tile - 1) / tile);
  const std::uint64_t transients =
      pixels * pixel_bytes(wanted, *given, normals_given != VK_FALSE) + tiles * tile_bytes;
  const std::uint64_t history =
      given->settings.history_frames > 0 ? pixels * history_bytes(lobe, bent) : 0;
  *memory = {.struct_size = sizeof *memory,
             .transients = transients,
             .transients_unshared = transients,
             .history = history,
             .allocated = transients + history};
  return ALCOVE_SUCCESS;
}
