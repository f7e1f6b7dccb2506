#include "c/view.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "c/settings.h"
#include "diagnose/pixel_observer.h"
#include "graph/add_view.h"

namespace alcove::passes {
namespace {

using framegraph::Texture;
using Kind = ImageRole::Kind;

constexpr ImageRole kDepth{.name = "depth", .kind = Kind::depth, .may_have_samples = true};
constexpr ImageRole kMask{"mask", Kind::mask};
constexpr ImageRole kMotion{"motion vectors", Kind::signed_colour, 2};
constexpr ImageRole kBackDepth{"back-face depth", Kind::depth};
constexpr ImageRole kSecondDepth{"second depth", Kind::depth};
constexpr ImageRole kAlbedo{"albedo", Kind::colour, 3};
constexpr ImageRole kVisibility{"visibility", Kind::colour, 1, true};
constexpr ImageRole kBentNormal{"bent normals", Kind::signed_colour, 3, true};
constexpr ImageRole kSpecular{"specular occlusion", Kind::colour, 1, true};
constexpr ImageRole kMultiBounce{"multi-bounce", Kind::colour, 3, true};

tl::expected<void, Failure> check_given(const AlcoveView& view) {
  const auto lacks = [&](const char* what) {
    return invalid(view_name(view) + " has no image " + what);
  };
  const auto given = [](const AlcoveImage& image) { return image.image != VK_NULL_HANDLE; };
  if (!given(view.depth)) return lacks("of depth, which everything is made from.");
  if (given(view.multi_bounce) && !given(view.albedo))
    return lacks("of albedo, which multi-bounce is made from.");
  if (!given(view.visibility) && !given(view.bent_normal) && !given(view.specular) &&
      !given(view.multi_bounce))
    return lacks("to write to; give one of visibility, bent_normal, specular and multi_bounce.");
  return {};
}

// Checks the images that only some settings need.
tl::expected<void, Failure> check_hidden(const AlcoveView& view,
                                         const OcclusionSettings& settings) {
  if (needs_back_depth(settings) && view.back_depth.image == VK_NULL_HANDLE) {
    return invalid(view_name(view) +
                   " has no image of back_depth, which its settings' thickness_unit needs.");
  }
  if (needs_second_depth(settings) && view.second_depth.image == VK_NULL_HANDLE) {
    return invalid(view_name(view) +
                   " has no image of second_depth, which its settings' depth_layers need; give it, "
                   "or set depth_layers to 1.");
  }
  return {};
}

// Returns a value of an enum of C as that of C++, whose last value is `last`.
template <typename Ours, typename Theirs>
tl::expected<Ours, Failure> to_enum(const AlcoveView& view, const char* field, Theirs value,
                                    Ours last) {
  const std::uint32_t number = number_of(value);
  if (number > static_cast<std::uint32_t>(last)) {
    return invalid(view_name(view) + ": AlcoveView::" + field + " is " + std::to_string(number) +
                   ", which is none of its values.");
  }
  return static_cast<Ours>(number);
}

ImageRole normals_role(NormalEncoding encoding) {
  const bool packed =
      encoding == NormalEncoding::unsigned_xyz || encoding == NormalEncoding::unsigned_octahedral;
  const bool two =
      encoding == NormalEncoding::octahedral || encoding == NormalEncoding::unsigned_octahedral;
  return {"normals", packed ? Kind::colour : Kind::signed_colour, two ? 2u : 3u};
}

MotionConvention motion_convention(const AlcoveView& view) {
  MotionConvention result{{view.motion_scale[0], view.motion_scale[1]},
                          {view.motion_offset[0], view.motion_offset[1]}};
  if (result.scale[0] == 0.0f && result.scale[1] == 0.0f) result.scale = {1.0f, 1.0f};
  return result;
}

tl::expected<ViewInputs, Failure> import_images(const AlcoveView& view,
                                                const OcclusionSettings& settings,
                                                const ImageImporter& importer) {
  // The format needs no more channels than are read.
  const ImageRole roughness{"roughness", Kind::colour,
                            std::min(settings.roughness_channel, 3u) + 1};
  const auto encoding =
      to_enum(view, "normal_encoding", view.normal_encoding, NormalEncoding::unsigned_octahedral);
  if (!encoding) return tl::unexpected(encoding.error());
  const ImageRole normals = normals_role(*encoding);
  ViewInputs inputs;
  inputs.occlusion.depth_format = view.depth_format;
  inputs.occlusion.normal_convention = {*encoding, view.normals_in_view_space != VK_FALSE,
                                        view.normals_forward_z != VK_FALSE};
  inputs.occlusion.motion_convention = motion_convention(view);
  inputs.occlusion.not_receiving = view.not_receiving;
  inputs.occlusion.not_occluding = view.not_occluding;
  struct Import {
    const ImageRole& role;
    const AlcoveImage& image;
    Texture& texture;
  };
  // The length of the array makes sure that kImagesOfAView is right.
  const Import imports[ImageTable::kImagesOfAView] = {
      {kDepth, view.depth, inputs.occlusion.depth_ndc},
      {normals, view.normals, inputs.occlusion.normals},
      {kMotion, view.motion, inputs.occlusion.motion},
      {roughness, view.roughness, inputs.occlusion.roughness},
      {kBackDepth, view.back_depth, inputs.occlusion.back_depth_ndc},
      {kSecondDepth, view.second_depth, inputs.occlusion.second_depth_ndc},
      {kAlbedo, view.albedo, inputs.albedo},
      {kMask, view.mask, inputs.occlusion.mask},
      {kVisibility, view.visibility, inputs.occlusion.into.visibility},
      {kBentNormal, view.bent_normal, inputs.occlusion.into.bent_normal},
      {kSpecular, view.specular, inputs.occlusion.into.specular},
      {kMultiBounce, view.multi_bounce, inputs.multi_bounce}};
  for (const Import& import : imports) {
    auto texture = importer.import(importer.user, import.role, import.image, view);
    if (!texture) return tl::unexpected(std::move(texture.error()));
    import.texture = *texture;
  }
  return inputs;
}

}  // namespace

std::string view_name(const AlcoveView& view) { return "View " + std::to_string(view.id); }

View to_view(const AlcoveCamera& camera) {
  View result;
  std::copy_n(camera.clip_from_view, 16, result.clip_from_view.begin());
  std::copy_n(camera.view_from_world, 16, result.view_from_world.begin());
  return result;
}

ViewName::ViewName(std::uint32_t id) {
  std::snprintf(text_.data(), text_.size(), "view %u", static_cast<unsigned>(id));
}

tl::expected<ViewSetup, Failure> set_up(const AlcoveView& view, const ImageImporter& importer) {
  auto given = to_settings(view.settings);
  if (!given) return tl::unexpected(std::move(given.error()));
  OcclusionSettings& settings = *given;
  auto right = check_given(view).and_then([&] { return check_hidden(view, settings); });
  if (!right) return tl::unexpected(std::move(right.error()));
  auto inputs = import_images(view, settings, importer);
  if (!inputs) return tl::unexpected(std::move(inputs.error()));
  const Occlusion& into = inputs->occlusion.into;
  settings.visibility = into.visibility || inputs->multi_bounce;
  settings.bent_normal = bool(into.bent_normal);
  if (!into.specular) settings.specular = Specular::none;
  return ViewSetup{*inputs, settings};
}

tl::expected<void, Failure> add_view(framegraph::Graph& graph, Kernels& kernels, ImageTable& images,
                                     const AlcoveView& view, const AlcoveFrame& described,
                                     bool prepare, PixelObserver* observer) {
  struct Import {
    framegraph::Graph& graph;
    ImageTable& images;
  } target{graph, images};
  const auto setup = set_up(
      view, {[](void* user, const ImageRole& role, const AlcoveImage& image, const AlcoveView& of) {
               const Import& to = *static_cast<Import*>(user);
               return to.images.import(to.graph, role, image, of);
             },
             &target});
  if (!setup) return tl::unexpected(setup.error());
  const bool reset = view.reset_history != VK_FALSE;
  if (reset) graph.reset_history(ViewName(view.id));
  Frame frame{graph,
              kernels,
              to_view(view.camera),
              described.index,
              to_view(view.previous_camera),
              reset ? 0 : view.static_frames};
  frame.prepare = prepare;
  frame.areas = to_areas(view);
  frame.largest_size = {view.largest_width, view.largest_height};
  if (!reset) frame.previous_size = {view.previous_width, view.previous_height};
  const auto added = passes::add_view(frame, setup->inputs, setup->settings, ViewName(view.id));
  if (!added) return tl::unexpected(failure_of(added.error(), view_name(view)));
  if (observer == nullptr || view.depth.samples > 1) return {};
  return observer->add(frame, view, setup->inputs.occlusion, described.slot)
      .map_error([](const Error& error) { return failure_of(error, "View"); });
}

}  // namespace alcove::passes
