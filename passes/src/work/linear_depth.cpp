#include "alcove/passes/work.h"
#include "linear_depth_parameters.h"
#include "work/areas.h"
#include "work/check_inputs.h"
#include "work/view_parameters.h"

namespace alcove::passes {

using framegraph::Texture;

tl::expected<Texture, Error> describe_linear_depth(WorkList& list, const WorkFrame& frame,
                                                   Texture depth_ndc) {
  if (auto good = check_inputs(list, "linear depth", {{"depth", depth_ndc}}); !good)
    return tl::unexpected(std::move(good.error()));
  if (auto good = check_areas(frame.areas, list.size(depth_ndc)); !good)
    return tl::unexpected(std::move(good.error()));
  const VkExtent2D size = read_size(frame, list.size(depth_ndc));
  const auto projection = projection_of(frame.view, size);
  if (!projection) return tl::unexpected(projection.error());
  const Texture depth =
      list.add(ALCOVE_RESOURCE_KIND_TRANSIENT, "linear depth", VK_FORMAT_R32_SFLOAT, size);
  const NamedTexture images[] = {{"depth_ndc_image", depth_ndc}, {"linear_depth_image", depth}};
  return list
      .dispatch({.label = "linear depth",
                 .shader = Shader::linear_depth,
                 .images = images,
                 .parameters = bytes_of(maths::LinearDepthParameters{
                     *projection, maths::uvec2(frame.areas.read.x, frame.areas.read.y)}),
                 .size = {size.width, size.height, 1}})
      .map([&] { return depth; });
}

}  // namespace alcove::passes
