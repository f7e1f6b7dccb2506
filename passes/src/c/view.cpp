#include "c/view.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "alcove/passes/multi_bounce.h"
#include "alcove/passes/occlusion.h"
#include "c/settings.h"
#include "diagnose/pixel_observer.h"
#include "work/view_parameters.h"

namespace alcove::passes {
namespace {

using framegraph::Texture;
using Kind = ImageRole::Kind;

constexpr ImageRole kDepth{"depth", Kind::depth};
constexpr ImageRole kMotion{"motion vectors", Kind::signed_colour, 2};
constexpr ImageRole kBackDepth{"back-face depth", Kind::depth};
constexpr ImageRole kSecondDepth{"second depth", Kind::depth};
constexpr ImageRole kAlbedo{"albedo", Kind::colour, 3};
constexpr ImageRole kMultiBounce{"multi-bounce", Kind::colour, 3, true};

struct Textures {
  OcclusionInputs inputs;
  Texture albedo;
  Texture multi_bounce;
};

std::string sentence_begin(const AlcoveView& view) { return "View " + std::to_string(view.id); }

// Copies the matrices. The passes check them.
View to_view(const AlcoveCamera& camera) {
  View result;
  std::copy_n(camera.clip_from_view, 16, result.clip_from_view.begin());
  std::copy_n(camera.view_from_world, 16, result.view_from_world.begin());
  return result;
}

tl::expected<void, Failure> check_given(const AlcoveView& view) {
  const auto lacks = [&](const char* what) {
    return invalid(sentence_begin(view) + " has no image " + what);
  };
  const auto given = [](const AlcoveImage& image) { return image.image != VK_NULL_HANDLE; };
  if (!given(view.depth)) {
    return lacks("of depth, which everything is made from.");
  }
  if (given(view.multi_bounce) && !given(view.albedo)) {
    return lacks("of albedo, which multi-bounce is made from.");
  }
  if (!given(view.visibility) && !given(view.bent_normal) && !given(view.specular) &&
      !given(view.multi_bounce)) {
    return lacks("to write to; give one of visibility, bent_normal, specular and multi_bounce.");
  }
  return {};
}

// Checks the images that only some settings need.
tl::expected<void, Failure> check_hidden(const AlcoveView& view,
                                         const OcclusionSettings& settings) {
  if (needs_back_depth(settings) && view.back_depth.image == VK_NULL_HANDLE) {
    return invalid(sentence_begin(view) +
                   " has no image of back_depth, which its settings' thickness_unit needs.");
  }
  if (needs_second_depth(settings) && view.second_depth.image == VK_NULL_HANDLE) {
    return invalid(sentence_begin(view) +
                   " has no image of second_depth, which its settings' depth_layers need.");
  }
  return {};
}

tl::expected<NormalEncoding, Failure> normal_encoding(const AlcoveView& view) {
  const std::uint32_t number = number_of(view.normal_encoding);
  if (number > static_cast<std::uint32_t>(NormalEncoding::unsigned_octahedral)) {
    return invalid(sentence_begin(view) + ": AlcoveView::normal_encoding is " +
                   std::to_string(number) + ", which is none of its values.");
  }
  return static_cast<NormalEncoding>(number);
}

ImageRole normals_role(NormalEncoding encoding) {
  const bool packed =
      encoding == NormalEncoding::unsigned_xyz || encoding == NormalEncoding::unsigned_octahedral;
  const bool two =
      encoding == NormalEncoding::octahedral || encoding == NormalEncoding::unsigned_octahedral;
  return {"normals", packed ? Kind::colour : Kind::signed_colour, two ? 2u : 3u};
}

ImageRole visibility_role(VisibilityChannel channel, bool half_size) {
  return {"visibility",
          Kind::colour,
          channel_index(channel) + 1,
          true,
          channel != VisibilityChannel::all,
          half_size};
}

tl::expected<VisibilityChannel, Failure> visibility_channel(const AlcoveView& view) {
  const std::uint32_t number = number_of(view.visibility_channel);
  if (number > static_cast<std::uint32_t>(VisibilityChannel::alpha)) {
    return invalid(sentence_begin(view) + ": AlcoveView::visibility_channel is " +
                   std::to_string(number) + ", which is none of its values.");
  }
  return static_cast<VisibilityChannel>(number);
}

// Checks what outputs of half size need.
tl::expected<void, Failure> check_half_size(const AlcoveView& view,
                                            const OcclusionSettings& settings) {
  if (view.half_size_outputs == VK_FALSE) {
    return {};
  }
  if (!settings.half_resolution) {
    return invalid(sentence_begin(view) +
                   " has half_size_outputs, which needs half_resolution in its settings.");
  }
  if (view.multi_bounce.image != VK_NULL_HANDLE) {
    return invalid(sentence_begin(view) +
                   " has half_size_outputs and an image of multi-bounce, which is made from "
                   "visibility of full size; leave one of them out.");
  }
  return {};
}

MotionConvention motion_convention(const AlcoveView& view) {
  MotionConvention result{{view.motion_scale[0], view.motion_scale[1]},
                          {view.motion_offset[0], view.motion_offset[1]}};
  if (result.scale[0] == 0.0f && result.scale[1] == 0.0f) {
    result.scale = {1.0f, 1.0f};
  }
  return result;
}

tl::expected<Textures, Failure> import_images(framegraph::Graph& graph, ImageTable& images,
                                              const AlcoveView& view,
                                              const OcclusionSettings& settings) {
  // The format needs no more channels than are read.
  const ImageRole roughness{"roughness", Kind::colour,
                            std::min(settings.roughness_channel, 3u) + 1};
  const auto encoding = normal_encoding(view);
  if (!encoding) {
    return tl::unexpected(encoding.error());
  }
  const auto channel = visibility_channel(view);
  if (!channel) {
    return tl::unexpected(channel.error());
  }
  const bool half_size = view.half_size_outputs != VK_FALSE;
  const ImageRole normals = normals_role(*encoding);
  const ImageRole visibility = visibility_role(*channel, half_size);
  const ImageRole bent_normal{"bent normals", Kind::signed_colour, 3, true, false, half_size};
  const ImageRole specular{"specular occlusion", Kind::colour, 1, true, false, half_size};
  Textures textures;
  textures.inputs.normals_in_view_space = view.normals_in_view_space != VK_FALSE;
  textures.inputs.normal_encoding = *encoding;
  textures.inputs.normals_forward_z = view.normals_forward_z != VK_FALSE;
  textures.inputs.motion_convention = motion_convention(view);
  textures.inputs.visibility_channel = *channel;
  textures.inputs.half_size_outputs = half_size;
  struct Import {
    const ImageRole& role;
    const AlcoveImage& image;
    Texture& texture;
  };
  // The length of the array makes sure that kImagesOfAView is right.
  const Import imports[ImageTable::kImagesOfAView] = {
      {kDepth, view.depth, textures.inputs.depth_ndc},
      {normals, view.normals, textures.inputs.normals},
      {kMotion, view.motion, textures.inputs.motion},
      {roughness, view.roughness, textures.inputs.roughness},
      {kBackDepth, view.back_depth, textures.inputs.back_depth_ndc},
      {kSecondDepth, view.second_depth, textures.inputs.second_depth_ndc},
      {kAlbedo, view.albedo, textures.albedo},
      {visibility, view.visibility, textures.inputs.into.visibility},
      {bent_normal, view.bent_normal, textures.inputs.into.bent_normal},
      {specular, view.specular, textures.inputs.into.specular},
      {kMultiBounce, view.multi_bounce, textures.multi_bounce}};
  for (const Import& import : imports) {
    auto texture = images.import(graph, import.role, import.image, view.depth, view.id);
    if (!texture) {
      return tl::unexpected(std::move(texture.error()));
    }
    import.texture = *texture;
  }
  return textures;
}

tl::expected<void, Failure> add_passes(const Frame& frame, const Textures& textures,
                                       const AlcoveView& view, const OcclusionSettings& settings) {
  const auto outputs = add_occlusion(frame, textures.inputs, settings, ViewName(view.id));
  if (!outputs) {
    return tl::unexpected(failure_of(outputs.error(), sentence_begin(view)));
  }
  if (!textures.multi_bounce) {
    return {};
  }
  const auto multi_bounce =
      add_multi_bounce(frame,
                       {outputs->visibility, textures.albedo, textures.multi_bounce,
                        textures.inputs.into.visibility ? textures.inputs.visibility_channel
                                                        : VisibilityChannel::all},
                       settings.precision);
  if (!multi_bounce) {
    return tl::unexpected(failure_of(multi_bounce.error(), sentence_begin(view)));
  }
  return {};
}

}  // namespace

ViewName::ViewName(std::uint32_t id) {
  std::snprintf(text_.data(), text_.size(), "view %u", static_cast<unsigned>(id));
}

tl::expected<void, Failure> add_view(framegraph::Graph& graph, Kernels& kernels, ImageTable& images,
                                     const AlcoveView& view, const AlcoveFrame& described,
                                     bool prepare, PixelObserver* observer) {
  auto given = to_settings(view.settings);
  if (!given) {
    return tl::unexpected(std::move(given.error()));
  }
  OcclusionSettings& settings = *given;
  const bool reset = view.reset_history != VK_FALSE;
  auto right =
      check_given(view).and_then([&] { return check_hidden(view, settings); }).and_then([&] {
        return check_half_size(view, settings);
      });
  if (!right) {
    return right;
  }
  auto textures = import_images(graph, images, view, settings);
  if (!textures) {
    return tl::unexpected(std::move(textures.error()));
  }
  const Occlusion& into = textures->inputs.into;
  settings.visibility = into.visibility || textures->multi_bounce;
  settings.bent_normal = bool(into.bent_normal);
  if (!into.specular) {
    settings.specular = Specular::none;
  }
  if (reset) {
    graph.reset_history(ViewName(view.id));
  }
  Frame frame{graph,
              kernels,
              to_view(view.camera),
              described.index,
              to_view(view.previous_camera),
              reset ? 0 : view.static_frames};
  frame.prepare = prepare;
  frame.largest_size = {view.largest_width, view.largest_height};
  if (!reset) {
    frame.previous_size = {view.previous_width, view.previous_height};
  }
  auto added = add_passes(frame, *textures, view, settings);
  if (added && observer != nullptr) {
    added = observer->add(frame, view, textures->inputs.depth_ndc, textures->inputs.normals,
                          described.slot);
  }
  return added;
}

}  // namespace alcove::passes
