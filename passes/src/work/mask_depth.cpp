#include "alcove/passes/setting_table.h"
#include "depth_copy_parameters.h"
#include "work/bindings.h"
#include "work/interleave_offset.h"

namespace alcove::passes {

namespace {

// The copies have the size of the whole images, so that all inputs are read at the same positions.
ResourceHandle add_copy(const ViewInputs& view, const char* name) {
  return view.list.add_transient(name, VK_FORMAT_R32_SFLOAT,
                                 view.list.size(view.image(ALCOVE_IMAGE_DEPTH)));
}

maths::DepthCopyParameters copy_parameters(const ViewInputs& view) {
  return {.first = maths::uvec2(view.read.x, view.read.y),
          .size = maths::uvec2(view.size.width, view.size.height)};
}

ResourceHandle describe_resolve(const ViewInputs& view) {
  const ResourceHandle resolved = add_copy(view, "depth");
  const NamedImage images[] = {{"depth_image", view.image(ALCOVE_IMAGE_DEPTH)},
                               {"copy_image", resolved}};
  view.list.dispatch({.label = "resolve depth",
                      .shader = Shader::resolve_depth,
                      .images = images,
                      .parameters = bytes_of(copy_parameters(view)),
                      .size = {view.size.width, view.size.height, 1}});
  return resolved;
}

Depths describe_mask(const ViewInputs& view, ResourceHandle depth) {
  const ResourceHandle mask = view.image(ALCOVE_IMAGE_MASK);
  maths::DepthCopyParameters parameters = copy_parameters(view);
  parameters.not_receiving = view.info.not_receiving;
  parameters.not_occluding = view.info.not_occluding;
  parameters.sky = view.projection.reversed ? 0.0f : 1.0f;
  const Depths depths{.all = depth,
                      .receivers = add_copy(view, "receivers"),
                      .occluders = add_copy(view, "depth of occluders")};
  const NamedImage images[] = {{"depth_image", depth},
                               {"mask_image", mask},
                               {"receiver_image", depths.receivers},
                               {"occluder_image", depths.occluders}};
  view.list.dispatch({.label = "mask depth",
                      .shader = view.list.format(mask) == VK_FORMAT_R8_UINT
                                    ? Shader::mask_depth_integer
                                    : Shader::mask_depth,
                      .images = images,
                      .parameters = bytes_of(parameters),
                      .size = {view.size.width, view.size.height, 1}});
  return depths;
}

// Copies one of each 2x2 pixels of the area that is read: that with the parity of the traced
// pixels.
ResourceHandle describe_half(const ViewInputs& view, ResourceHandle depth) {
  const VkExtent2D size{(view.size.width + 1) / 2, (view.size.height + 1) / 2};
  const InterleaveOffset traced = interleave_offset_of(view.settings.tile_size, view.index);
  maths::DepthCopyParameters parameters = copy_parameters(view);
  const maths::ivec2 parity = maths::uvec2(traced.x % 2, traced.y % 2);
  parameters.first += parity;
  parameters.size -= parity;
  const ResourceHandle half = view.list.add_transient("half depth", VK_FORMAT_R32_SFLOAT, size);
  const NamedImage images[] = {{"depth_image", depth}, {"copy_image", half}};
  view.list.dispatch({.label = "halve depth",
                      .shader = Shader::halve_depth,
                      .images = images,
                      .parameters = bytes_of(parameters),
                      .size = {size.width, size.height, 1}});
  return half;
}

}  // namespace

Depths describe_depths(const ViewInputs& view) {
  const ResourceHandle input = view.image(ALCOVE_IMAGE_DEPTH);
  const ResourceHandle depth = view.list.samples(input) > 1 ? describe_resolve(view) : input;
  const AlcoveSettings& settings = view.settings;
  Depths depths =
      view.image(ALCOVE_IMAGE_MASK) ? describe_mask(view, depth) : Depths{depth, depth, depth};
  if (settings.tile_size == 8 && !needs_back_depth(settings) && !needs_second_depth(settings))
    depths.halved = describe_half(view, depths.occluders);
  return depths;
}

}  // namespace alcove::passes
