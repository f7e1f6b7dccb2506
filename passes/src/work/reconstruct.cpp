#include <algorithm>
#include <array>

#include "alcove/passes/setting_table.h"
#include "maths/history.h"
#include "work/bindings.h"
#include "work/output_format.h"
#include "work/reconstruct_uniforms.h"

namespace alcove::passes {

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

bool has_history(const ViewInputs& view) { return view.settings.history_frames > 0; }
bool is_half(const ViewInputs& view) { return view.settings.half_resolution != 0; }

std::array<NamedConstant, 14> constants_of(const ViewInputs& view, Past past, bool motion) {
  const AlcoveSettings& settings = view.settings;
  const bool shaped = settings.power != 1.0f || settings.intensity != 1.0f;
  const bool rough = bool(view.roughness());
  return {{{"kTileSize", settings.tile_size},
           {"kFilterRadius", filter_radius(settings)},
           {"kHistory", flag(has_history(view))},
           {"kMotion", flag(motion && past == Past::moving)},
           {"kPerspective", flag(view.projection.perspective)},
           {"kStatic", flag(past == Past::unchanged)},
           {"kRoughnessTexture", flag(rough)},
           {"kRoughnessChannel", channel_if(rough, settings.roughness_channel)},
           {"kFresh", flag(past == Past::none)},
           {"kVisibility", flag(view.visibility())},
           {"kNormalEncoding", encoding_of(view)},
           {"kShaped", flag(!is_half(view) && shaped)},
           {"kReversed", flag(view.projection.reversed)},
           {"kAreas", flag(view.in_part)}}};
}

// Every texture that the passes write; null where it is not wanted.
struct Textures {
  OutputImages results;         // at half resolution the upsampling pass writes them
  WorkBuilder::History texels;  // visibility; at half resolution maths::pack_half_texel()
  WorkBuilder::History depth;   // maths::half_texel_depth(), only at half resolution
  WorkBuilder::History bent;
  WorkBuilder::History lobe;
  bool valid = false;  // whether the histories of the previous frame can be read
};

VkExtent2D texels(VkExtent2D pixels, bool half) {
  return half ? VkExtent2D{(pixels.width + 1) / 2, (pixels.height + 1) / 2} : pixels;
}

Textures add_textures(const ViewInputs& view) {
  const bool half = is_half(view);
  const AlcovePrecision precision = view.settings.precision;
  Textures textures;
  if (view.visibility()) {
    textures.results.visibility =
        image_or_transient(view, ALCOVE_IMAGE_VISIBILITY, "visibility",
                           output_format(ALCOVE_IMAGE_VISIBILITY, precision));
  }
  if (view.bent_normal()) {
    textures.results.bent_normal =
        image_or_transient(view, ALCOVE_IMAGE_BENT_NORMAL, "bent normal",
                           output_format(ALCOVE_IMAGE_BENT_NORMAL, precision));
  }
  if (view.lobe()) textures.results.specular = view.image(ALCOVE_IMAGE_SPECULAR);
  textures.valid = has_history(view);
  // Adds a history, or at half resolution without history the texture that the upsampling reads.
  const auto add = [&](bool exists, HistoryRole role, const char* name, VkFormat format) {
    if (exists && has_history(view)) {
      const WorkBuilder::History added =
          view.list.add_history(role, format, texels(view.largest, half));
      textures.valid = textures.valid && added.valid;
      return added;
    }
    return exists && half ? WorkBuilder::History{.current = view.list.add_transient(
                                                     name, format, texels(view.size, half))}
                          : WorkBuilder::History{};
  };
  textures.texels =
      add(true, HistoryRole::visibility, "half resolution", half ? kHalfFormat : kHistoryFormat);
  textures.depth = add(half, HistoryRole::depth, "half-resolution depth", kHalfDepthFormat);
  textures.bent = add(view.bent_normal(), HistoryRole::bent_normal, "half-resolution residual",
                      kBentHistoryFormat);
  textures.lobe = add(view.lobe(), HistoryRole::lobe, "half-resolution lobe", kLobeHistoryFormat);
  return textures;
}

// Returns the image of each binding that a variant of the shader can have. An image that is not
// read is replaced by another one, and one that is not written by one of its own. The image is null
// if the variant does not have the binding.
std::array<NamedImage, 18> images_of(const ViewInputs& view, ResourceHandle depth,
                                     const RawOcclusionImages& raw, const Textures& textures,
                                     ResourceHandle motion) {
  const bool half = is_half(view);
  const OutputImages& out = textures.results;  // at half resolution the upsampling pass writes it
  // At half resolution only the weights of GGX lobes need normals.
  const ResourceHandle normals =
      half && !view.lobe() ? ResourceHandle{} : view.image(ALCOVE_IMAGE_NORMALS);
  const VkFormat visibility_format =
      output_format(ALCOVE_IMAGE_VISIBILITY, view.settings.precision);
  const auto unused = [&](bool bound, ResourceHandle texture, VkFormat format) {
    return bound ? or_unused(view, texture, format) : texture;
  };
  return {{{"raw_image", raw.sums},
           {"bent_image", raw.bent},
           {"depth_image", depth},
           {"normal_image", or_else(normals, depth)},
           {"half_image", textures.texels.current},
           {"half_depth_image", textures.depth.current},
           {"visibility_image", unused(!half, out.visibility, visibility_format)},
           {"bent_normal_image", out.bent_normal},
           {"history_image", or_else(textures.texels.previous, depth)},
           {"history_depth_image", or_else(textures.depth.previous, depth)},
           {"next_history_image", unused(!half, textures.texels.current, kHistoryFormat)},
           {"motion_image", or_else(motion, depth)},
           {"bent_history_image", or_else(textures.bent.previous, depth)},
           {"next_bent_history_image",
            unused(view.bent_normal(), textures.bent.current, kBentHistoryFormat)},
           {"roughness_image", or_else(view.roughness(), depth)},
           {"specular_image", out.specular},
           {"lobe_history_image", or_else(textures.lobe.previous, raw.sums)},
           {"next_lobe_history_image",
            unused(view.lobe(), textures.lobe.current, kLobeHistoryFormat)}}};
}

// Returns the invocations of the shader.
VkExtent3D invocations(const ViewInputs& view, VkExtent2D stored) {
  const bool half = is_half(view);
  // The groups begin at a multiple of 8 texels (first_texel() of the shader).
  const std::uint32_t texel = half ? 2 : 1;
  const auto first = [&](std::uint32_t pixel) {
    return (pixel / texel - std::min(pixel / texel, texel - 1)) / 8 * 8;
  };
  // At half resolution the dispatch covers one more texel to the right and below, if the textures
  // have room for it, because the upsampling pass reads those texels.
  const auto end = [&](std::uint32_t pixels, std::uint32_t room) {
    return half ? std::min((pixels + 1) / 2 + 1, room) : pixels;
  };
  const AlcoveArea& written = view.written;
  const std::uint32_t width = end(written.x + written.width, stored.width) - first(written.x);
  const std::uint32_t height = end(written.y + written.height, stored.height) - first(written.y);
  // The number of texels that an invocation reconstructs, kBlocks of the shader.
  const std::uint32_t blocks = view.settings.tile_size > texel ? 4 : 1;
  return {width, (height + blocks - 1) / blocks, 1};
}

}  // namespace

tl::expected<OutputImages, Error> describe_reconstruct(const ViewInputs& view, ResourceHandle depth,
                                                       const RawOcclusionImages& raw) {
  const AlcoveViewInfo& info = view.info;
  const bool same = same_camera(info.camera, info.previous_camera);
  const bool reads_motion = has_history(view) && !(same && view.static_frames > 0);
  const ResourceHandle motion = reads_motion ? view.image(ALCOVE_IMAGE_MOTION) : ResourceHandle{};
  const bool sized = info.reset_history == 0 && (info.previous_width | info.previous_height) != 0;
  const VkExtent2D size = sized ? VkExtent2D{info.previous_width, info.previous_height} : view.size;
  Textures textures = add_textures(view);
  // A size that the history has no room for begins a new one.
  textures.valid = textures.valid && size.width > 0 && size.height > 0 &&
                   size.width <= view.largest.width && size.height <= view.largest.height;
  view.list.work().history_valid = textures.valid ? 1 : 0;
  PreviousFrame previous{textures.valid ? info.previous_camera : info.camera, view.projection};
  if (textures.valid) {
    const auto projection = projection_of(previous.camera, size, "The previous view");
    if (!projection) {
      return tl::unexpected(Error{projection.error().message +
                                  " Where there was none, reset the history (reset_history)."});
    }
    previous.projection = *projection;
  }
  const bool moved = textures.valid && !same;
  previous.is_same = !moved && !motion;
  const bool same_size = size.width == view.size.width && size.height == view.size.height;
  const Past past = !textures.valid                 ? Past::none
                    : previous.is_same && same_size ? Past::unchanged
                                                    : Past::moving;
  maths::ReconstructParameters parameters = reconstruct_parameters(view, previous);
  // In a static view all frames get the same weight in the history.
  if (past == Past::unchanged && view.static_frames >= kTileFrames)
    parameters.largest_weight = static_cast<float>(maths::kMaxHistoryFrames) - 1.0f;
  const VkExtent2D stored =
      textures.texels.current ? view.list.size(textures.texels.current) : VkExtent2D{1, 1};
  parameters.history_texel = 1.0f / maths::vec2(stored.width, stored.height);
  const bool half = is_half(view);
  view.list.dispatch({.label = "reconstruct",
                      .shader = variant(half ? Shader::reconstruct_half : Shader::reconstruct,
                                        view.bent_normal(), view.lobe()),
                      .constants = constants_of(view, past, bool(motion)),
                      .images = images_of(view, depth, raw, textures, motion),
                      .parameters = bytes_of(parameters),
                      .size = invocations(view, stored)});
  if (half) {
    describe_upsample(view, depth,
                      {.half = textures.texels.current,
                       .depth = textures.depth.current,
                       .residuals = textures.bent.current,
                       .lobes = textures.lobe.current},
                      textures.results);
  }
  return textures.results;
}

}  // namespace alcove::passes
