#include <algorithm>
#include <array>
#include <utility>

#include "alcove/passes/work.h"
#include "gtao_parameters.h"
#include "maths/slice_line.h"
#include "maths/visibility_bitmask.h"
#include "work/areas.h"
#include "work/bindings.h"
#include "work/check_inputs.h"
#include "work/interleave_offset.h"
#include "work/output_format.h"
#include "work/view_parameters.h"

namespace alcove::passes {

using framegraph::Texture;

namespace {

bool has_lobe(const OcclusionSettings& settings) { return settings.specular == Specular::slices; }

// The optional inputs that the shader reads with the given settings.
struct Reads {
  bool roughness = false;
  bool back_faces = false;
  bool second_layer = false;
};

Reads reads_of(const GtaoInputs& inputs, const OcclusionSettings& settings) {
  return {has_lobe(settings) && inputs.roughness, needs_back_depth(settings),
          needs_second_depth(settings)};
}

// Larger radii than this, in scene units, are treated as this radius. The shader measures lengths
// in radii, and the squares of such lengths would underflow.
constexpr float kLargestRadius = 1e12f;

std::array<NamedConstant, 15> constants_of(const WorkFrame& frame, const GtaoInputs& inputs,
                                           const OcclusionSettings& settings, const Reads& reads,
                                           const maths::Projection& projection) {
  const bool horizons = settings.estimator == Estimator::horizons;
  return {{{"kSliceCount", settings.slices},
           {"kStepCount", settings.steps},
           {"kHorizons", flag(horizons)},
           {"kTileSize", settings.tile_size},
           {"kPerspective", flag(is_perspective(projection))},
           {"kRoughnessTexture", flag(reads.roughness)},
           {"kRoughnessChannel", channel_if(reads.roughness, settings.roughness_channel)},
           {"kBackFaces", flag(reads.back_faces)},
           {"kSecondLayer", flag(reads.second_layer)},
           {"kNormalEncoding", encoding_of(inputs.normals, inputs.normal_convention.encoding)},
           {"kReversed", flag(is_reversed(projection))},
           {"kInfiniteFar", flag(has_infinite_far(projection))},
           {"kAreas", flag(has_areas(frame))},
           {"kMask", flag(bool(inputs.receiver_depth_ndc))},
           {"kUniform", flag(horizons && settings.weighting == Weighting::uniform)}}};
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
AlcoveArea traced_tiles(const WorkFrame& frame, VkExtent2D read,
                        const OcclusionSettings& settings) {
  const AlcoveArea written = written_area(frame, read);
  const std::uint32_t tile = settings.tile_size;
  // The groups of the reconstruction begin at multiples of 8 texels, of which one precedes the
  // first that is written at half resolution, and filter so many tiles on each side.
  const std::uint32_t texel = settings.half_resolution ? 2 : 1;
  const std::uint32_t around = filter_radius(settings) + 1;
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
  return {x, y, last(written.x + written.width, read.width) - x + 1,
          last(written.y + written.height, read.height) - y + 1};
}

maths::GtaoParameters parameters_of(const WorkList& list, const WorkFrame& frame,
                                    const GtaoInputs& inputs, const OcclusionSettings& settings,
                                    const maths::Projection& projection, VkExtent2D read,
                                    const AlcoveArea& tiles) {
  const float radius = std::min(settings.radius, kLargestRadius);
  const std::uint32_t index = noise_index(settings, frame.index);
  const InterleaveOffset interleave_offset = interleave_offset_of(settings.tile_size, index);
  const maths::DepthStep step =
      depth_step(projection, stored_format(list, inputs.depth_ndc, inputs.depth_format));
  return {
      maths::uvec4(frame.areas.read.x, frame.areas.read.y, read.width, read.height),
      maths::uvec4(tiles.x, tiles.y, tiles.x + tiles.width - 1, tiles.y + tiles.height - 1),
      view_from_normal(frame.view, inputs.normals ? inputs.normal_convention : kOwnNormals),
      maths::vec4(maths::ray_per_px(projection), projection.uv_to_slope.z,
                  projection.uv_to_slope.w),
      inverse_depth_from_ndc(projection),
      maths::vec2(static_cast<float>(interleave_offset.x), static_cast<float>(interleave_offset.y)),
      radius,
      index,
      in_strips({tiles.width, tiles.height}).width / kGroup,
      settings.thickness,
      maths::hidden_exponent(settings.hidden_occlusion),
      settings.roughness,
      step.constant,
      step.per_inverse_depth};
}

}  // namespace

tl::expected<RawOcclusionTextures, Error> describe_gtao(WorkList& list, const WorkFrame& frame,
                                                        const GtaoInputs& inputs,
                                                        const OcclusionSettings& settings) {
  const Reads reads = reads_of(inputs, settings);
  const auto optional = [](bool read, Texture texture, Texture instead) {
    return read ? texture : instead;
  };
  const Texture normals = or_else(inputs.normals, inputs.depth_ndc);
  const Texture roughness = optional(reads.roughness, inputs.roughness, inputs.depth_ndc);
  const Texture back = optional(reads.back_faces, inputs.back_depth_ndc, inputs.depth_ndc);
  const Texture receiver = or_else(inputs.receiver_depth_ndc, inputs.depth_ndc);
  const Texture second = optional(reads.second_layer, inputs.second_depth_ndc, inputs.depth_ndc);
  auto good = validate(settings)
                  .and_then([&] { return check_areas(frame.areas, list.size(inputs.depth_ndc)); })
                  .and_then([&] {
                    return check_inputs(list, "gtao",
                                        {{"depth", inputs.depth_ndc},
                                         {"normals", normals},
                                         {"roughness", roughness},
                                         {"back-face depth", back},
                                         {"second depth", second},
                                         {"depth of receivers", receiver}});
                  });
  if (!good) return tl::unexpected(std::move(good.error()));
  const VkExtent2D pixels = read_size(frame, list.size(inputs.depth_ndc));
  const auto projection = projection_of(frame.view, pixels);
  if (!projection) return tl::unexpected(projection.error());
  const std::uint32_t tile = settings.tile_size;
  const VkExtent2D size{(pixels.width + tile - 1) / tile, (pixels.height + tile - 1) / tile};
  const AlcoveArea traced = traced_tiles(frame, pixels, settings);
  RawOcclusionTextures result{
      .tile_size = tile, .slices = settings.slices, .lobe = has_lobe(settings)};
  result.raw_occlusion =
      list.add(ALCOVE_RESOURCE_KIND_TRANSIENT, "raw occlusion", raw_format(result.lobe), size);
  if (needs_bent_normal(settings)) {
    result.bent =
        list.add(ALCOVE_RESOURCE_KIND_TRANSIENT, "bent-normal residual", kBentRawFormat, size);
  }
  const NamedTexture images[] = {{"depth_image", inputs.depth_ndc},
                                 {"normal_image", normals},
                                 {"raw_image", result.raw_occlusion},
                                 {"bent_image", result.bent},
                                 {"back_image", back},
                                 {"second_image", second},
                                 {"receiver_image", receiver},
                                 {"roughness_image", roughness}};
  return list
      .dispatch({.label = "gtao",
                 .shader = variant(Shader::gtao, bool(result.bent), result.lobe),
                 .constants = constants_of(frame, inputs, settings, reads, *projection),
                 .images = images,
                 .parameters = bytes_of(
                     parameters_of(list, frame, inputs, settings, *projection, pixels, traced)),
                 .size = in_strips({traced.width, traced.height})})
      .map([&] { return result; });
}

}  // namespace alcove::passes
