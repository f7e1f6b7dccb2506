#include <algorithm>
#include <array>

#include "alcove/passes/work.h"
#include "maths/history.h"
#include "work/areas.h"
#include "work/bindings.h"
#include "work/check_reconstruct.h"
#include "work/output_format.h"
#include "work/reconstruct_uniforms.h"
#include "work/upsample.h"
#include "work/view_parameters.h"

namespace alcove::passes {

using framegraph::Texture;

namespace {

// Static frames after which every pixel of a tile of 4x4 has been traced once.
constexpr std::uint32_t kTileFrames = 16;

// The kind of history that a frame can use. The pipeline depends on it, and also on the settings,
// the inputs and the kind of projection.
enum class Past : std::uint8_t {
  none,  // no history, or none that can be read
  moving,
  unchanged,  // the previous frame shows the same
};

Past past_of(const WorkFrame& frame, const ReconstructSizes& sizes, bool history_valid,
             bool motion) {
  if (!history_valid) return Past::none;
  const bool same_size =
      sizes.now.width == sizes.previous.width && sizes.now.height == sizes.previous.height;
  if (motion || !same_size || frame.view != frame.previous_view) return Past::moving;
  return Past::unchanged;
}

std::array<NamedConstant, 14> constants_of(const WorkFrame& frame, const ReconstructInputs& inputs,
                                           const OcclusionSettings& settings,
                                           const maths::Projection& projection, Past past) {
  const bool shaped = settings.power != 1.0f || settings.intensity != 1.0f;
  return {{{"kTileSize", inputs.raw_occlusion.tile_size},
           {"kFilterRadius", filter_radius(settings)},
           {"kHistory", flag(settings.history_frames > 0)},
           {"kMotion", flag(inputs.motion && past == Past::moving)},
           {"kPerspective", flag(is_perspective(projection))},
           {"kStatic", flag(past == Past::unchanged)},
           {"kRoughnessTexture", flag(bool(inputs.roughness))},
           {"kRoughnessChannel", channel_if(bool(inputs.roughness), settings.roughness_channel)},
           {"kFresh", flag(past == Past::none)},
           {"kVisibility", flag(needs_visibility(settings))},
           {"kNormalEncoding", encoding_of(inputs.normals, inputs.normal_convention.encoding)},
           {"kShaped", flag(!settings.half_resolution && shaped)},
           {"kReversed", flag(is_reversed(projection))},
           {"kAreas", flag(has_areas(frame))}}};
}

// Every texture that the passes access; null where it is not wanted.
struct Textures {
  Occlusion result;          // at half resolution the upsampling pass writes it
  WorkList::History texels;  // visibility; at half resolution maths::pack_half_texel()
  WorkList::History depth;   // maths::half_texel_depth(), only at half resolution
  WorkList::History bent;
  WorkList::History lobe;
  bool valid = false;  // whether the histories of the previous frame can be read
};

VkExtent2D texels(VkExtent2D pixels, bool half) {
  return half ? VkExtent2D{(pixels.width + 1) / 2, (pixels.height + 1) / 2} : pixels;
}

Textures add_textures(WorkList& list, const WorkFrame& frame, const ReconstructInputs& inputs,
                      const OcclusionSettings& settings, const ReconstructSizes& sizes) {
  const bool half = settings.half_resolution;
  const bool history = settings.history_frames > 0;
  const AlcoveArea written = written_area(frame, sizes.now);
  const VkExtent2D size = output_size(frame, {written.width, written.height});
  Textures textures;
  if (needs_visibility(settings)) {
    textures.result.visibility = given_or_added(list, inputs.into.visibility, "visibility",
                                                scalar_format(settings.precision), size);
  }
  if (inputs.raw_occlusion.bent) {
    textures.result.bent_normal = given_or_added(list, inputs.into.bent_normal, "bent normal",
                                                 direction_format(settings.precision), size);
  }
  if (inputs.raw_occlusion.lobe) {
    textures.result.specular = given_or_added(list, inputs.into.specular, "specular occlusion",
                                              scalar_format(settings.precision), size);
  }
  textures.valid = history;
  // Adds a history, or at half resolution without history the texture that the upsampling reads.
  const auto add = [&](bool wanted, HistoryRole role, const char* name, VkFormat format) {
    if (wanted && history) {
      const WorkList::History added = list.add_history(role, format, texels(sizes.largest, half));
      textures.valid = textures.valid && added.valid;
      return added;
    }
    return wanted && half
               ? WorkList::History{.current = list.add(ALCOVE_RESOURCE_KIND_TRANSIENT, name, format,
                                                       texels(sizes.now, half))}
               : WorkList::History{};
  };
  textures.texels =
      add(true, HistoryRole::visibility, "half resolution", half ? kHalfFormat : kHistoryFormat);
  textures.depth = add(half, HistoryRole::depth, "half-resolution depth", kHalfDepthFormat);
  textures.bent = add(bool(inputs.raw_occlusion.bent), HistoryRole::bent_normal,
                      "half-resolution residual", kBentHistoryFormat);
  textures.lobe =
      add(inputs.raw_occlusion.lobe, HistoryRole::lobe, "half-resolution lobe", kLobeHistoryFormat);
  list.work().history_valid = textures.valid ? 1 : 0;
  return textures;
}

// Returns the image of each binding that a variant of the shader can have. An image that is not
// read is replaced by another one, and one that is not written by one of its own. The image is null
// if the variant does not have the binding.
std::array<NamedTexture, 18> images_of(WorkList& list, const ReconstructInputs& in,
                                       const Textures& textures,
                                       const OcclusionSettings& settings) {
  const bool half = settings.half_resolution;
  const Occlusion& out = textures.result;  // at half resolution the upsampling pass writes it
  // At half resolution only the weights of GGX lobes need normals.
  const Texture normals = half && !in.raw_occlusion.lobe ? Texture{} : in.normals;
  const Texture sampled = in.depth_ndc;
  const Texture raw = in.raw_occlusion.raw_occlusion;
  const auto unused = [&](bool bound, Texture texture, VkFormat format) {
    return bound ? or_unused(list, texture, format) : texture;
  };
  return {{{"raw_image", raw},
           {"bent_image", in.raw_occlusion.bent},
           {"depth_image", in.depth_ndc},
           {"normal_image", or_else(normals, sampled)},
           {"half_image", textures.texels.current},
           {"half_depth_image", textures.depth.current},
           {"visibility_image", unused(!half, out.visibility, scalar_format(settings.precision))},
           {"bent_normal_image", out.bent_normal},
           {"history_image", or_else(textures.texels.previous, sampled)},
           {"history_depth_image", or_else(textures.depth.previous, sampled)},
           {"next_history_image", unused(!half, textures.texels.current, kHistoryFormat)},
           {"motion_image", or_else(in.motion, sampled)},
           {"bent_history_image", or_else(textures.bent.previous, sampled)},
           {"next_bent_history_image",
            unused(bool(in.raw_occlusion.bent), textures.bent.current, kBentHistoryFormat)},
           {"roughness_image", or_else(in.roughness, sampled)},
           {"specular_image", out.specular},
           {"lobe_history_image", or_else(textures.lobe.previous, raw)},
           {"next_lobe_history_image",
            unused(in.raw_occlusion.lobe, textures.lobe.current, kLobeHistoryFormat)}}};
}

// Returns the frame without its previous view and sizes, which are not read if there is no history.
WorkFrame without_past(const WorkFrame& frame) {
  return {.view = frame.view,
          .index = frame.index,
          .previous_view = frame.view,
          .static_frames = frame.static_frames,
          .areas = frame.areas};
}

}  // namespace

tl::expected<Occlusion, Error> describe_reconstruct(WorkList& list, const WorkFrame& given_frame,
                                                    const ReconstructInputs& given,
                                                    const OcclusionSettings& settings) {
  const bool history = settings.history_frames > 0;
  const bool half = settings.half_resolution;
  WorkFrame frame = history ? given_frame : without_past(given_frame);
  ReconstructInputs inputs = given;
  if (frame.view == frame.previous_view && frame.static_frames > 0) inputs.motion = {};
  if (!inputs.raw_occlusion.lobe) inputs.roughness = {};
  if (!inputs.normals) inputs.normal_convention = kOwnNormals;
  if (auto good = check_reconstruct(list, frame, inputs, settings); !good)
    return tl::unexpected(good.error());
  if (!history) inputs.motion = {};
  const auto sizes = reconstruct_sizes(frame, read_size(frame, list.size(inputs.depth_ndc)));
  if (!sizes) return tl::unexpected(sizes.error());
  const auto projection = projection_of(frame.view, sizes->now);
  if (!projection) return tl::unexpected(projection.error());
  const Textures textures = add_textures(list, frame, inputs, settings, *sizes);
  if (!textures.valid)  // the previous view is not read
    frame.previous_view = frame.view;
  const auto previous = projection_of(frame.previous_view, sizes->previous, "The previous view");
  if (!previous) {
    return tl::unexpected(Error{previous.error().message +
                                " Where there was none, reset the history (reset_history)."});
  }
  const Past past = past_of(frame, *sizes, textures.valid, bool(inputs.motion));
  maths::ReconstructParameters parameters =
      reconstruct_parameters(frame, *projection, *previous, inputs, settings,
                             stored_format(list, inputs.depth_ndc, inputs.depth_format));
  // In a static view all frames get the same weight in the history.
  if (past == Past::unchanged && frame.static_frames >= kTileFrames)
    parameters.largest_weight = static_cast<float>(maths::kMaxHistoryFrames) - 1.0f;
  const VkExtent2D stored =
      textures.texels.current ? list.size(textures.texels.current) : VkExtent2D{1, 1};
  parameters.history_texel = 1.0f / maths::vec2(stored.width, stored.height);
  // The groups begin at a multiple of 8 texels (first_texel() of the shader).
  const AlcoveArea written = written_area(frame, sizes->now);
  const std::uint32_t texel = half ? 2 : 1;
  const auto first = [&](std::uint32_t pixel) {
    return (pixel / texel - std::min(pixel / texel, texel - 1)) / 8 * 8;
  };
  // At half resolution the dispatch covers one more texel to the right and below, if the textures
  // have room for it, because the upsampling pass reads those texels.
  const auto end = [&](std::uint32_t pixels, std::uint32_t room) {
    return half ? std::min((pixels + 1) / 2 + 1, room) : pixels;
  };
  const VkExtent2D covered{end(written.x + written.width, stored.width) - first(written.x),
                           end(written.y + written.height, stored.height) - first(written.y)};
  // The number of texels that an invocation reconstructs, kBlocks of the shader.
  const std::uint32_t blocks = inputs.raw_occlusion.tile_size > (half ? 2u : 1u) ? 4 : 1;
  auto added =
      list.dispatch({.label = "reconstruct",
                     .shader = variant(half ? Shader::reconstruct_half : Shader::reconstruct,
                                       bool(inputs.raw_occlusion.bent), inputs.raw_occlusion.lobe),
                     .constants = constants_of(frame, inputs, settings, *projection, past),
                     .images = images_of(list, inputs, textures, settings),
                     .parameters = bytes_of(parameters),
                     .size = {covered.width, (covered.height + blocks - 1) / blocks, 1}});
  if (!added) return tl::unexpected(std::move(added.error()));
  if (!half) return textures.result;
  return describe_upsample(list, frame,
                           {.half = textures.texels.current,
                            .half_depth = textures.depth.current,
                            .residuals = textures.bent.current,
                            .lobes = textures.lobe.current,
                            .depth_ndc = inputs.depth_ndc,
                            .normals = inputs.normals,
                            .normal_convention = inputs.normal_convention},
                           textures.result, settings);
}

}  // namespace alcove::passes
