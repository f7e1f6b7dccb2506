#include <algorithm>
#include <array>

#include "alcove/passes/setting_table.h"
#include "gtao_parameters.h"
#include "maths/slice_line.h"
#include "maths/visibility_bitmask.h"
#include "work/bindings.h"
#include "work/interleave_offset.h"
#include "work/output_format.h"

namespace alcove::passes {

namespace {

// Larger radii than this, in scene units, are treated as this radius. The shader measures lengths
// in radii, and the squares of such lengths would underflow.
constexpr float kLargestRadius = 1e12f;

std::array<NamedConstant, 16> constants_of(const ViewInputs& view, const Depths& depths) {
  const AlcoveSettings& settings = view.settings;
  const bool horizons = settings.estimator == ALCOVE_ESTIMATOR_HORIZONS;
  const bool rough = bool(view.roughness());
  return {{{"kSliceCount", settings.slices},
           {"kStepCount", settings.steps},
           {"kHorizons", flag(horizons)},
           {"kTileSize", settings.tile_size},
           {"kPerspective", flag(view.projection.perspective)},
           {"kRoughnessTexture", flag(rough)},
           {"kRoughnessChannel", channel_if(rough, settings.roughness_channel)},
           {"kBackFaces", flag(needs_back_depth(settings))},
           {"kSecondStepCount", second_layer_steps(settings)},
           {"kNormalEncoding", encoding_of(view)},
           {"kReversed", flag(view.projection.reversed)},
           {"kInfiniteFar", flag(view.projection.has_infinite_far())},
           {"kAreas", flag(view.in_part)},
           {"kMask", flag(bool(view.image(ALCOVE_IMAGE_MASK)))},
           {"kUniform", flag(horizons && settings.weighting == ALCOVE_WEIGHTING_UNIFORM)},
           {"kHalfSearch", flag(bool(depths.halved))}}};
}

// Returns the invocations of the dispatch. The image is divided into strips of about 16 rows of
// groups, and groups are numbered column by column in each strip (invocation_tile() in
// gtao.comp).
constexpr std::uint32_t kGroup = 8;
VkExtent3D in_strips(VkExtent2D tiles) {
  const std::uint32_t rows = (tiles.height + kGroup - 1) / kGroup;
  const std::uint32_t strips = std::max(rows / 16, 1u);
  return {(rows + strips - 1) / strips * kGroup, tiles.width, strips};
}

// Returns the tiles that are traced: those of the area that is read which the reconstruction
// filters.
AlcoveArea traced_tiles(const ViewInputs& view) {
  const AlcoveArea& written = view.written;
  const std::uint32_t tile = view.settings.tile_size;
  // The groups of the reconstruction begin at multiples of 8 texels, of which one precedes the
  // first that is written at half resolution, and filter so many tiles on each side.
  const std::uint32_t texel = view.settings.half_resolution != 0 ? 2 : 1;
  const std::uint32_t around = filter_radius(view.settings) + 1;
  const auto first = [&](std::uint32_t begin) {
    const std::uint32_t texels = begin / texel;
    const std::uint32_t group = (texels - std::min(texels, texel - 1)) / 8 * 8;
    const std::uint32_t tiles = group * texel / tile;
    return tiles - std::min(tiles, around);
  };
  const auto last = [&](std::uint32_t end, std::uint32_t size) {
    return std::min((end + texel - 1) / tile + around, (size - 1) / tile);
  };
  const std::uint32_t x = first(written.x);
  const std::uint32_t y = first(written.y);
  return {x, y, last(written.x + written.width, view.size.width) - x + 1,
          last(written.y + written.height, view.size.height) - y + 1};
}

maths::GtaoParameters parameters_of(const ViewInputs& view, const AlcoveArea& tiles) {
  const AlcoveSettings& settings = view.settings;
  const maths::Projection& projection = view.projection;
  const InterleaveOffset offset = interleave_offset_of(settings.tile_size, view.index);
  const maths::DepthStep step = depth_step(projection, view.depth_format);
  return {maths::uvec4(view.read.x, view.read.y, view.size.width, view.size.height),
          maths::uvec4(tiles.x, tiles.y, tiles.x + tiles.width - 1, tiles.y + tiles.height - 1),
          view_from_normal(view.info.camera, normals_of(view)),
          projection.slope(),
          projection.inverse_depth_from_ndc,
          maths::vec2(static_cast<float>(offset.x), static_cast<float>(offset.y)),
          std::min(settings.radius, kLargestRadius),
          view.index,
          in_strips({tiles.width, tiles.height}).width / kGroup,
          settings.thickness,
          maths::hidden_exponent(settings.hidden_occlusion),
          settings.roughness,
          step.constant,
          step.per_inverse_depth};
}

}  // namespace

RawOcclusionImages describe_gtao(const ViewInputs& view, const Depths& depths) {
  const std::uint32_t tile = view.settings.tile_size;
  const VkExtent2D size{(view.size.width + tile - 1) / tile, (view.size.height + tile - 1) / tile};
  RawOcclusionImages raw{view.list.add_transient("raw occlusion", raw_format(view.lobe()), size),
                         {}};
  if (view.bent_normal())
    raw.bent = view.list.add_transient("bent-normal residual", kBentRawFormat, size);
  const auto or_depth = [&](bool read, AlcoveImageRole role) {
    return read ? view.image(role) : depths.occluders;
  };
  const NamedImage images[] = {
      {"depth_image", depths.occluders},
      {"normal_image", or_else(view.image(ALCOVE_IMAGE_NORMALS), depths.occluders)},
      {"raw_image", raw.sums},
      {"bent_image", raw.bent},
      {"back_image", or_depth(needs_back_depth(view.settings), ALCOVE_IMAGE_BACK_DEPTH)},
      {"second_image", or_depth(needs_second_depth(view.settings), ALCOVE_IMAGE_SECOND_DEPTH)},
      {"receiver_image", depths.receivers},
      {"search_image", or_else(depths.halved, depths.occluders)},
      {"roughness_image", or_else(view.roughness(), depths.occluders)}};
  const AlcoveArea traced = traced_tiles(view);
  view.list.dispatch({.label = "gtao",
                      .shader = variant(Shader::gtao, view.bent_normal(), view.lobe()),
                      .constants = constants_of(view, depths),
                      .images = images,
                      .parameters = bytes_of(parameters_of(view, traced)),
                      .size = in_strips({traced.width, traced.height})});
  return raw;
}

}  // namespace alcove::passes
