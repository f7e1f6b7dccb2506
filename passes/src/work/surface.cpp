// Linear depth and normals from depth. The search and the filter read the depth buffer itself.
#include "linear_depth_parameters.h"
#include "normals_parameters.h"
#include "work/bindings.h"

namespace alcove::passes {

using framegraph::Texture;

Texture describe_linear_depth(const ViewWork& view, Texture depth) {
  // The format has 32 bits because a half float ends at 65504, and its steps are visible as bands
  // at grazing angles.
  const Texture linear = view.list.add_transient("linear depth", VK_FORMAT_R32_SFLOAT, view.size);
  const NamedTexture images[] = {{"depth_ndc_image", depth}, {"linear_depth_image", linear}};
  view.list.dispatch({.label = "linear depth",
                      .shader = Shader::linear_depth,
                      .images = images,
                      .parameters = bytes_of(maths::LinearDepthParameters{
                          view.projection, maths::uvec2(view.read.x, view.read.y)}),
                      .size = {view.size.width, view.size.height, 1}});
  return linear;
}

Texture describe_normals(const ViewWork& view, Texture linear_depth) {
  const Texture normals =
      view.list.add_transient("normals from depth", VK_FORMAT_R16G16B16A16_SFLOAT, view.size);
  const maths::Projection& projection = view.projection;
  const NamedTexture images[] = {{"depth_image", linear_depth}, {"normal_image", normals}};
  const NamedConstant constants[] = {{"kPerspective", flag(is_perspective(projection))}};
  const maths::NormalsParameters parameters{maths::vec4(
      maths::ray_per_px(projection), projection.uv_to_slope.z, projection.uv_to_slope.w)};
  view.list.dispatch({.label = "normals",
                      .shader = Shader::normals,
                      .constants = constants,
                      .images = images,
                      .parameters = bytes_of(parameters),
                      .size = {view.size.width, view.size.height, 1}});
  return normals;
}

}  // namespace alcove::passes
