#include "alcove/passes/work.h"
#include "normals_parameters.h"
#include "work/bindings.h"
#include "work/check_inputs.h"
#include "work/view_parameters.h"

namespace alcove::passes {

using framegraph::Texture;

tl::expected<Texture, Error> describe_normals(WorkList& list, const WorkFrame& frame,
                                              Texture depth) {
  if (auto good = check_inputs(list, "normals", {{"linear depth", depth}}); !good)
    return tl::unexpected(std::move(good.error()));
  const VkExtent2D size = list.size(depth);
  const auto projection = projection_of(frame.view, size);
  if (!projection) return tl::unexpected(projection.error());
  const Texture normals = list.add(ALCOVE_RESOURCE_KIND_TRANSIENT, "normals from depth",
                                   VK_FORMAT_R16G16B16A16_SFLOAT, size);
  const NamedTexture images[] = {{"depth_image", depth}, {"normal_image", normals}};
  const NamedConstant constants[] = {{"kPerspective", flag(is_perspective(*projection))}};
  const maths::NormalsParameters parameters{maths::vec4(
      maths::ray_per_px(*projection), projection->uv_to_slope.z, projection->uv_to_slope.w)};
  return list
      .dispatch({.label = "normals",
                 .shader = Shader::normals,
                 .constants = constants,
                 .images = images,
                 .parameters = bytes_of(parameters),
                 .size = {size.width, size.height, 1}})
      .map([&] { return normals; });
}

}  // namespace alcove::passes
