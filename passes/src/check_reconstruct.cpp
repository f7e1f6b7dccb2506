#include "check_reconstruct.h"

#include <array>
#include <cmath>
#include <string>

#include "check_inputs.h"
#include "format_name.h"
#include "maths/history.h"
#include "number_text.h"
#include "output_format.h"

namespace alcove::passes {
namespace {

using framegraph::Texture;

constexpr std::uint32_t kMaxReach = 3;
constexpr float kMaxShape = 16.0f;  // of power and intensity

tl::expected<void, Error> check_settings(const ReconstructSettings& settings) {
  if (!(settings.filter_tolerance_px > 0.0f) || !std::isfinite(settings.filter_tolerance_px)) {
    return tl::unexpected(Error{"The filter's tolerance is " +
                                number_text(settings.filter_tolerance_px) +
                                " pixels; it must be over 0 and finite."});
  }
  if (settings.filter_radius > kMaxReach) {
    return tl::unexpected(Error{"The filter's reach is " + std::to_string(settings.filter_radius) +
                                "; it must be 0 to 3 blocks."});
  }
  if (settings.history_frames > maths::kMaxHistoryFrames) {
    return tl::unexpected(Error{"The history is " + std::to_string(settings.history_frames) +
                                " frames long; it must be 0 to " +
                                std::to_string(maths::kMaxHistoryFrames) + "."});
  }
  if (!(settings.clamp_width >= 0.0f) || !std::isfinite(settings.clamp_width)) {
    return tl::unexpected(Error{"The history's clamp is " + number_text(settings.clamp_width) +
                                " deviations wide; it must be at least 0 and finite."});
  }
  if (!(settings.power > 0.0f && settings.power <= kMaxShape)) {
    return tl::unexpected(Error{"The power is " + number_text(settings.power) +
                                "; it must be above 0 and at most 16."});
  }
  if (!(settings.intensity >= 0.0f && settings.intensity <= kMaxShape)) {
    return tl::unexpected(
        Error{"The intensity is " + number_text(settings.intensity) + "; it must be 0 to 16."});
  }
  return check_roughness(settings.roughness, settings.roughness_channel);
}

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

tl::expected<void, Error> check_textures(const Frame& frame, const ReconstructInputs& inputs) {
  const auto or_line = [&](Texture texture) { return texture ? texture : inputs.inverse_depth; };
  const std::array<NamedInput, 7> needed{
      {{"inverse depth", inputs.inverse_depth},
       {"normals", inputs.normals},
       {"motion vectors", or_line(inputs.motion)},
       {"roughness", or_line(inputs.roughness)},
       {"a texture for visibility", or_line(inputs.into.visibility)},
       {"a texture for bent normals", or_line(inputs.into.bent_normal)},
       {"a texture for specular occlusion", or_line(inputs.into.specular)}}};
  return check_inputs(frame.graph, "reconstruct", needed);
}

// What the shader takes for granted of a texture of the raw occlusion, which may be of the caller's
// making.
tl::expected<void, Error> check_blocks(const Frame& frame, Texture depth, std::uint32_t tile_size,
                                       Texture texture, VkFormat format, const char* name) {
  const VkExtent3D pixels = frame.graph.extent(depth);
  const VkExtent3D found = frame.graph.extent(texture);
  const VkFormat found_format = frame.graph.format(texture);
  const VkExtent2D blocks{(pixels.width + tile_size - 1) / tile_size,
                          (pixels.height + tile_size - 1) / tile_size};
  if (found.width == blocks.width && found.height == blocks.height && found_format == format) {
    return {};
  }
  return tl::unexpected(Error{"The pass reconstruct was given " + std::string(name) + " of " +
                              std::to_string(found.width) + "x" + std::to_string(found.height) +
                              " texels and " + format_name(found_format) + "; it needs " +
                              std::to_string(blocks.width) + "x" + std::to_string(blocks.height) +
                              ", one for each tile, and " + format_name(format) + "."});
}

tl::expected<void, Error> check_raw_occlusion(const Frame& frame, const ReconstructInputs& inputs,
                                              bool half_resolution) {
  const RawOcclusionTextures& raw_occlusion = inputs.raw_occlusion;
  const auto check = [&](Texture texture, VkFormat format, const char* name) {
    return check_blocks(frame, inputs.inverse_depth, raw_occlusion.tile_size, texture, format,
                        name);
  };
  return check_search(raw_occlusion.tile_size, raw_occlusion.slices)
      .and_then([&]() -> tl::expected<void, Error> {
        if (half_resolution && raw_occlusion.tile_size < 2) {
          return tl::unexpected(
              Error{"Half resolution needs tiles of 2 or 4 pixels; the tile_size is 1."});
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

tl::expected<void, Error> check_reconstruct(const Frame& frame, const ReconstructInputs& inputs,
                                            const ReconstructSettings& settings) {
  if (!settings.visibility && !inputs.raw_occlusion.bent && !inputs.raw_occlusion.lobe) {
    return tl::unexpected(
        Error{"The filter is asked for no visibility, and its raw_occlusion has neither bent "
              "normals nor a "
              "lobe; ask for one of the three."});
  }
  return check_settings(settings)
      .and_then([&] { return check_motion(inputs.motion_convention); })
      .and_then([&] { return check_textures(frame, inputs); })
      .and_then([&] { return check_raw_occlusion(frame, inputs, settings.half_resolution); });
}

tl::expected<ReconstructSizes, Error> reconstruct_sizes(const Frame& frame, Texture depth) {
  const VkExtent3D extent = frame.graph.extent(depth);
  const VkExtent2D now{extent.width, extent.height};
  const auto or_now = [&](VkExtent2D given) {
    return given.width == 0 && given.height == 0 ? now : given;
  };
  const ReconstructSizes sizes{now, or_now(frame.previous_size), or_now(frame.largest_size)};
  const auto fits = [&](VkExtent2D size) {
    return size.width > 0 && size.height > 0 && size.width <= sizes.largest.width &&
           size.height <= sizes.largest.height;
  };
  if (fits(sizes.now) && fits(sizes.previous)) {
    return sizes;
  }
  const auto text = [](VkExtent2D size) {
    return std::to_string(size.width) + "x" + std::to_string(size.height);
  };
  return tl::unexpected(Error{"The depth has " + text(sizes.now) + " pixels and had " +
                              text(sizes.previous) + " in the frame before; both must be within " +
                              text(sizes.largest) + ", the largest size."});
}

}  // namespace alcove::passes
