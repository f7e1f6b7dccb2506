// Estimates the memory of a view from its settings.
#include "alcove/alcove.h"
#include "alcove/passes/occlusion.h"
#include "c/settings.h"
#include "work/output_format.h"

namespace alcove::passes {
namespace {

constexpr std::uint32_t kKnownOutputs = ALCOVE_OUTPUT_VISIBILITY | ALCOVE_OUTPUT_BENT_NORMAL |
                                        ALCOVE_OUTPUT_SPECULAR | ALCOVE_OUTPUT_MULTI_BOUNCE;

// Bytes per texel of the formats that the passes use.
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

bool has(std::uint32_t outputs, AlcoveOutput output) {
  return (outputs & static_cast<std::uint32_t>(output)) != 0;
}

// Settings with the outputs that are asked for.
OcclusionSettings with_outputs(const OcclusionSettings& settings, std::uint32_t outputs) {
  OcclusionSettings result = settings;
  result.visibility = has(outputs, ALCOVE_OUTPUT_VISIBILITY);
  result.bent_normal = has(outputs, ALCOVE_OUTPUT_BENT_NORMAL);
  if (!has(outputs, ALCOVE_OUTPUT_SPECULAR)) {
    result.specular = Specular::none;
  }
  return result;
}

// Bytes per pixel of the transients, without the raw occlusion.
std::uint64_t pixel_bytes(const OcclusionSettings& settings, bool multi_bounce,
                          bool normals_given) {
  const bool by_cone = specular_reads_bent_normal(settings);
  const std::uint64_t depth = bytes_of(VK_FORMAT_R32_SFLOAT);
  std::uint64_t sum = by_cone || !normals_given ? depth : 0;
  sum += normals_given ? 0 : bytes_of(VK_FORMAT_R16G16B16A16_SFLOAT);
  const bool visibility = multi_bounce || by_cone;
  sum += visibility && !settings.visibility ? bytes_of(scalar_format(settings.precision)) : 0;
  const bool bent = needs_bent_normal(settings);
  sum += bent && !settings.bent_normal ? bytes_of(direction_format(settings.precision)) : 0;
  return sum;
}

// Returns the bytes per texel of the textures that the filter writes for the upsampling pass. With
// a history, these are the textures of the history and are counted there.
std::uint64_t half_resolution_bytes(const OcclusionSettings& settings, bool lobe, bool bent) {
  return settings.history_frames > 0 ? 0 : half_history_bytes(lobe, bent) / 2;
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
  if (!given) {
    return ALCOVE_ERROR_INVALID_INPUT;
  }
  const OcclusionSettings wanted = with_outputs(*given, outputs);
  const bool lobe = wanted.specular == Specular::slices;
  const bool bent = needs_bent_normal(wanted);
  const std::uint64_t tile_bytes =
      bytes_of(raw_format(lobe)) + (bent ? bytes_of(kBentRawFormat) : 0);
  const std::uint64_t pixels = std::uint64_t{width} * height;
  const std::uint32_t tile = wanted.tile_size;
  const std::uint64_t tiles =
      std::uint64_t{(width + tile - 1) / tile} * ((height + tile - 1) / tile);
  const bool multi_bounce = has(outputs, ALCOVE_OUTPUT_MULTI_BOUNCE);
  const std::uint64_t texels =
      wanted.half_resolution ? std::uint64_t{(width + 1) / 2} * ((height + 1) / 2) : pixels;
  const std::uint64_t transients =
      pixels * pixel_bytes(wanted, multi_bounce, normals_given != VK_FALSE) + tiles * tile_bytes +
      (wanted.half_resolution ? texels * half_resolution_bytes(wanted, lobe, bent) : 0);
  const std::uint64_t texel_bytes =
      wanted.half_resolution ? half_history_bytes(lobe, bent) : history_bytes(lobe, bent);
  const std::uint64_t history = wanted.history_frames > 0 ? texels * texel_bytes : 0;
  *memory = {.struct_size = sizeof *memory,
             .transients = transients,
             .transients_unshared = transients,
             .history = history,
             .allocated = transients + history};
  return ALCOVE_SUCCESS;
}
