// Linear depth and normals from depth. The search and the filter read the depth buffer itself.
#include "linear_depth_parameters.h"
#include "normals_parameters.h"
#include "work/bindings.h"

namespace alcove::passes {

ResourceHandle describe_linear_depth(const ViewInputs& view, ResourceHandle depth) {
  // The format has 32 bits because a half float ends at 65504, and its steps are visible as bands
  // at grazing angles.
  const ResourceHandle linear =
      view.list.add_transient("linear depth", VK_FORMAT_R32_SFLOAT, view.size);
  const NamedImage images[] = {{"depth_ndc_image", depth}, {"linear_depth_image", linear}};
  view.list.dispatch({.label = "linear depth",
                      .shader = Shader::linear_depth,
                      .images = images,
                      .parameters = bytes_of(maths::LinearDepthParameters{
                          view.projection, maths::uvec2(view.read.x, view.read.y)}),
                      .size = {view.size.width, view.size.height, 1}});
  return linear;
}

ResourceHandle describe_normals(const ViewInputs& view, ResourceHandle linear_depth) {
  const ResourceHandle normals =
      view.list.add_transient("normals from depth", VK_FORMAT_R16G16B16A16_SFLOAT, view.size);
  const maths::Projection& projection = view.projection;
  const NamedImage images[] = {{"depth_image", linear_depth}, {"normal_image", normals}};
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
