#include "gtso_parameters.h"
#include "work/bindings.h"
#include "work/output_format.h"

namespace alcove::passes {

void describe_gtso(const ViewInputs& view, const OutputImages& results, ResourceHandle linear_depth,
                   ResourceHandle normals) {
  const ResourceHandle roughness = view.image(ALCOVE_IMAGE_ROUGHNESS);
  const NormalConvention convention = normals_of(view);
  const NamedConstant constants[] = {
      {"kRoughnessTexture", flag(bool(roughness))},
      {"kRoughnessChannel", channel_if(bool(roughness), view.settings.roughness_channel)},
      {"kNormalEncoding", static_cast<std::uint32_t>(convention.encoding)},
      {"kAreas", flag(view.in_part)}};
  const NamedImage images[] = {{"visibility_image", results.visibility},
                               {"bent_normal_image", results.bent_normal},
                               {"normal_image", normals},
                               {"depth_image", linear_depth},
                               {"roughness_image", or_else(roughness, results.visibility)},
                               {"result_image", view.image(ALCOVE_IMAGE_SPECULAR)}};
  const AlcoveArea& written = view.written;
  // Normals that were computed from depth have the size of the area that is read.
  const bool image = bool(view.image(ALCOVE_IMAGE_NORMALS));
  const auto x = static_cast<int>(view.info.output_x) - static_cast<int>(written.x);
  const auto y = static_cast<int>(view.info.output_y) - static_cast<int>(written.y);
  const maths::GtsoParameters parameters{
      maths::uvec4(image ? view.read.x : 0u, image ? view.read.y : 0u, view.read.x, view.read.y),
      maths::ivec4(written.x, written.y, x, y),
      view.projection,
      view_from_normal(view.info.camera, convention),
      maths::uvec2(written.width, written.height),
      view.settings.roughness};
  view.list.dispatch({.label = "specular occlusion",
                      .shader = Shader::gtso,
                      .constants = constants,
                      .images = images,
                      .parameters = bytes_of(parameters),
                      .size = {written.width, written.height, 1}});
}

}  // namespace alcove::passes
