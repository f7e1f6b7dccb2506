#include "work/mask_depth.h"

#include <string>

#include "depth_copy_parameters.h"
#include "work/areas.h"
#include "work/check_inputs.h"
#include "work/view_parameters.h"

namespace alcove::passes {

using framegraph::Texture;

namespace {

// The copies have the size of the whole images, so that all inputs are read at the same positions.
Texture add_copy(WorkList& list, Texture depth, const char* name) {
  return list.add(ALCOVE_RESOURCE_KIND_TRANSIENT, name, VK_FORMAT_R32_SFLOAT, list.size(depth));
}

maths::DepthCopyParameters copy_parameters(const WorkFrame& frame, VkExtent2D whole) {
  const VkExtent2D size = read_size(frame, whole);
  return {.first = maths::uvec2(frame.areas.read.x, frame.areas.read.y),
          .size = maths::uvec2(size.width, size.height)};
}

tl::expected<Texture, Error> describe_resolve(WorkList& list, const WorkFrame& frame,
                                              Texture depth) {
  const Texture resolved = add_copy(list, depth, "depth");
  const maths::DepthCopyParameters parameters = copy_parameters(frame, list.size(depth));
  const NamedTexture images[] = {{"depth_image", depth}, {"resolved_image", resolved}};
  return list
      .dispatch({.label = "resolve depth",
                 .shader = Shader::resolve_depth,
                 .images = images,
                 .parameters = bytes_of(parameters),
                 .size = {static_cast<std::uint32_t>(parameters.size.x),
                          static_cast<std::uint32_t>(parameters.size.y), 1}})
      .map([&] { return resolved; });
}

tl::expected<void, Error> check_mask(const WorkList& list, const OcclusionInputs& inputs,
                                     Texture depth) {
  const VkFormat format = list.format(inputs.mask);
  if (format != VK_FORMAT_R8_UNORM && format != VK_FORMAT_R8_UINT) {
    return tl::unexpected(Error{
        "The mask of surfaces must have the format VK_FORMAT_R8_UNORM or VK_FORMAT_R8_UINT."});
  }
  const std::uint32_t bits = inputs.not_receiving | inputs.not_occluding;
  if (bits == 0 || bits > 255) {
    return tl::unexpected(
        Error{"The mask of surfaces is read with the bits " + std::to_string(inputs.not_receiving) +
              " of surfaces that do not receive and " + std::to_string(inputs.not_occluding) +
              " of surfaces that do not occlude; give at least one bit, and values up to 255."});
  }
  return check_inputs(list, "mask depth", {{"depth", depth}, {"mask", inputs.mask}});
}

tl::expected<Depths, Error> describe_mask(WorkList& list, const WorkFrame& frame,
                                          const OcclusionInputs& inputs, Texture depth) {
  if (auto good = check_mask(list, inputs, depth); !good)
    return tl::unexpected(std::move(good.error()));
  maths::DepthCopyParameters parameters = copy_parameters(frame, list.size(depth));
  const auto projection = projection_of(frame.view, read_size(frame, list.size(depth)));
  if (!projection) return tl::unexpected(projection.error());
  parameters.not_receiving = inputs.not_receiving;
  parameters.not_occluding = inputs.not_occluding;
  parameters.sky = is_reversed(*projection) ? 0.0f : 1.0f;
  const Depths made{.all = depth,
                    .receivers = add_copy(list, depth, "receivers"),
                    .occluders = add_copy(list, depth, "depth of occluders")};
  const NamedTexture images[] = {{"depth_image", depth},
                                 {"mask_image", inputs.mask},
                                 {"receiver_image", made.receivers},
                                 {"occluder_image", made.occluders}};
  return list
      .dispatch({.label = "mask depth",
                 .shader = list.format(inputs.mask) == VK_FORMAT_R8_UINT
                               ? Shader::mask_depth_integer
                               : Shader::mask_depth,
                 .images = images,
                 .parameters = bytes_of(parameters),
                 .size = {static_cast<std::uint32_t>(parameters.size.x),
                          static_cast<std::uint32_t>(parameters.size.y), 1}})
      .map([&] { return made; });
}

}  // namespace

tl::expected<Depths, Error> describe_depths(WorkList& list, const WorkFrame& frame,
                                            const OcclusionInputs& inputs) {
  const Texture given = inputs.depth_ndc;
  if (auto good = check_areas(frame.areas, list.size(given)); given && !good)
    return tl::unexpected(std::move(good.error()));
  const auto depth = list.samples(given) > 1 ? describe_resolve(list, frame, given)
                                             : tl::expected<Texture, Error>(given);
  return depth.and_then([&](Texture single) {
    return inputs.mask ? describe_mask(list, frame, inputs, single)
                       : tl::expected<Depths, Error>(Depths{single, single, single});
  });
}

}  // namespace alcove::passes
