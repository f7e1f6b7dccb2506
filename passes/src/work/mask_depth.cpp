#include "depth_copy_parameters.h"
#include "work/bindings.h"

namespace alcove::passes {

using framegraph::Texture;

namespace {

// The copies have the size of the whole images, so that all inputs are read at the same positions.
Texture add_copy(const ViewWork& view, const char* name) {
  return view.list.add_transient(name, VK_FORMAT_R32_SFLOAT,
                                 view.list.size(view.image(ALCOVE_IMAGE_DEPTH)));
}

maths::DepthCopyParameters copy_parameters(const ViewWork& view) {
  return {.first = maths::uvec2(view.read.x, view.read.y),
          .size = maths::uvec2(view.size.width, view.size.height)};
}

Texture describe_resolve(const ViewWork& view) {
  const Texture resolved = add_copy(view, "depth");
  const NamedTexture images[] = {{"depth_image", view.image(ALCOVE_IMAGE_DEPTH)},
                                 {"resolved_image", resolved}};
  view.list.dispatch({.label = "resolve depth",
                      .shader = Shader::resolve_depth,
                      .images = images,
                      .parameters = bytes_of(copy_parameters(view)),
                      .size = {view.size.width, view.size.height, 1}});
  return resolved;
}

Depths describe_mask(const ViewWork& view, Texture depth) {
  const Texture mask = view.image(ALCOVE_IMAGE_MASK);
  maths::DepthCopyParameters parameters = copy_parameters(view);
  parameters.not_receiving = view.info.not_receiving;
  parameters.not_occluding = view.info.not_occluding;
  parameters.sky = is_reversed(view.projection) ? 0.0f : 1.0f;
  const Depths made{.all = depth,
                    .receivers = add_copy(view, "receivers"),
                    .occluders = add_copy(view, "depth of occluders")};
  const NamedTexture images[] = {{"depth_image", depth},
                                 {"mask_image", mask},
                                 {"receiver_image", made.receivers},
                                 {"occluder_image", made.occluders}};
  view.list.dispatch({.label = "mask depth",
                      .shader = view.list.format(mask) == VK_FORMAT_R8_UINT
                                    ? Shader::mask_depth_integer
                                    : Shader::mask_depth,
                      .images = images,
                      .parameters = bytes_of(parameters),
                      .size = {view.size.width, view.size.height, 1}});
  return made;
}

}  // namespace

Depths describe_depths(const ViewWork& view) {
  const Texture given = view.image(ALCOVE_IMAGE_DEPTH);
  const Texture depth = view.list.samples(given) > 1 ? describe_resolve(view) : given;
  return view.image(ALCOVE_IMAGE_MASK) ? describe_mask(view, depth) : Depths{depth, depth, depth};
}

}  // namespace alcove::passes
