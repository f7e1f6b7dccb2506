#include "work/check_reconstruct.h"

#include <array>
#include <cmath>
#include <string>

#include "work/areas.h"
#include "work/check_inputs.h"
#include "work/format_name.h"
#include "work/number_text.h"
#include "work/output_format.h"

namespace alcove::passes {
namespace {

using framegraph::Texture;

tl::expected<void, Error> check_motion(const MotionConvention& motion) {
  for (std::size_t i = 0; i < 2; ++i) {
    if (!std::isfinite(motion.scale[i]) || motion.scale[i] == 0.0f ||
        !std::isfinite(motion.offset[i])) {
      return tl::unexpected(Error{"The scale of motion vectors is " + number_text(motion.scale[i]) +
                                  " and their offset " + number_text(motion.offset[i]) +
                                  "; both must be finite, and the scale not 0."});
    }
  }
  return {};
}

tl::expected<void, Error> check_textures(const WorkList& list, const ReconstructInputs& inputs) {
  const auto or_depth = [&](Texture texture) { return texture ? texture : inputs.depth_ndc; };
  return check_inputs(list, "reconstruct",
                      {{"depth", inputs.depth_ndc},
                       {"normals", or_depth(inputs.normals)},
                       {"motion vectors", or_depth(inputs.motion)},
                       {"roughness", or_depth(inputs.roughness)}});
}

// Checks the sizes of the caller's textures for results.
tl::expected<void, Error> check_result_sizes(const WorkList& list, const WorkFrame& frame,
                                             const ReconstructInputs& inputs) {
  const VkExtent2D read = read_size(frame, list.size(inputs.depth_ndc));
  const AlcoveArea written = written_area(frame, read);
  const VkExtent2D wanted{written.width, written.height};
  const std::array<NamedInput, 3> given{{{"visibility", inputs.into.visibility},
                                         {"bent normals", inputs.into.bent_normal},
                                         {"specular occlusion", inputs.into.specular}}};
  for (const NamedInput& texture : given) {
    if (!texture.texture) continue;
    if (auto good = check_output(frame, wanted, list.size(texture.texture), texture.name); !good)
      return good;
  }
  return {};
}

// Checks size and format of a texture of the raw occlusion, which the caller may have made.
tl::expected<void, Error> check_blocks(const WorkList& list, VkExtent2D pixels,
                                       std::uint32_t tile_size, Texture texture, VkFormat format,
                                       const char* name) {
  const VkExtent2D found = list.size(texture);
  const VkFormat found_format = list.format(texture);
  const VkExtent2D blocks{(pixels.width + tile_size - 1) / tile_size,
                          (pixels.height + tile_size - 1) / tile_size};
  if (found.width == blocks.width && found.height == blocks.height && found_format == format)
    return {};
  return tl::unexpected(Error{"The pass reconstruct was given " + std::string(name) + " of " +
                              size_text(found) + " texels and " + format_name(found_format) +
                              "; it needs " + size_text(blocks) + ", one for each tile, and " +
                              format_name(format) + "."});
}

// Checks that add_gtao() can have made the raw occlusion with this tile size and number of slices.
tl::expected<void, Error> check_tracing(const RawOcclusionTextures& raw_occlusion) {
  OcclusionSettings settings;
  settings.tile_size = raw_occlusion.tile_size;
  settings.slices = raw_occlusion.slices;
  return validate(settings);
}

tl::expected<void, Error> check_raw_occlusion(const WorkList& list, VkExtent2D pixels,
                                              const ReconstructInputs& inputs,
                                              bool half_resolution) {
  const RawOcclusionTextures& raw_occlusion = inputs.raw_occlusion;
  const auto check = [&](Texture texture, VkFormat format, const char* name) {
    return check_blocks(list, pixels, raw_occlusion.tile_size, texture, format, name);
  };
  return check_tracing(raw_occlusion)
      .and_then([&]() -> tl::expected<void, Error> {
        if (half_resolution && raw_occlusion.tile_size < 2) {
          return tl::unexpected(
              Error{"Half resolution needs tiles of at least 2 pixels; the tile_size is 1."});
        }
        return {};
      })
      .and_then([&] {
        return check(raw_occlusion.raw_occlusion, raw_format(raw_occlusion.lobe), "raw occlusion");
      })
      .and_then([&] {
        return raw_occlusion.bent
                   ? check(raw_occlusion.bent, kBentRawFormat, "bent-normal residuals")
                   : tl::expected<void, Error>();
      });
}

}  // namespace

tl::expected<void, Error> check_reconstruct(const WorkList& list, const WorkFrame& frame,
                                            const ReconstructInputs& inputs,
                                            const OcclusionSettings& settings) {
  if (!needs_visibility(settings) && !inputs.raw_occlusion.bent && !inputs.raw_occlusion.lobe) {
    return tl::unexpected(
        Error{"The pass reconstruct has nothing to write: visibility is off, and the raw occlusion "
              "has neither bent normals nor a lobe; ask for one of the three."});
  }
  return validate(settings)
      .and_then([&] { return check_motion(inputs.motion_convention); })
      .and_then([&] { return check_textures(list, inputs); })
      .and_then([&] { return check_areas(frame.areas, list.size(inputs.depth_ndc)); })
      .and_then([&] { return check_result_sizes(list, frame, inputs); })
      .and_then([&] {
        return check_raw_occlusion(list, read_size(frame, list.size(inputs.depth_ndc)), inputs,
                                   settings.half_resolution);
      });
}

tl::expected<ReconstructSizes, Error> reconstruct_sizes(const WorkFrame& frame, VkExtent2D now) {
  const auto or_now = [&](VkExtent2D given) {
    return given.width == 0 && given.height == 0 ? now : given;
  };
  const ReconstructSizes sizes{now, or_now(frame.previous_size), or_now(frame.largest_size)};
  const auto fits = [&](VkExtent2D size) {
    return size.width > 0 && size.height > 0 && size.width <= sizes.largest.width &&
           size.height <= sizes.largest.height;
  };
  if (fits(sizes.now) && fits(sizes.previous)) return sizes;
  return tl::unexpected(Error{"The depth has " + size_text(sizes.now) + " pixels and had " +
                              size_text(sizes.previous) +
                              " in the frame before; both must be within " +
                              size_text(sizes.largest) + ", the largest size."});
}

}  // namespace alcove::passes
