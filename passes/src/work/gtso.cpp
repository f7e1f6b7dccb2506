#include "gtso_parameters.h"
#include "work/bindings.h"

namespace alcove::passes {

void describe_gtso(const ViewInputs& view, ResourceHandle depth, const OutputImages& results) {
  const ResourceHandle roughness = view.image(ALCOVE_IMAGE_ROUGHNESS);
  const maths::Projection& projection = view.projection;
  const NamedConstant constants[] = {
      {"kRoughnessTexture", flag(bool(roughness))},
      {"kRoughnessChannel", channel_if(bool(roughness), view.settings.roughness_channel)},
      {"kNormalEncoding", encoding_of(view)},
      {"kAreas", flag(view.in_part)},
      {"kPerspective", flag(projection.perspective)},
      {"kReversed", flag(projection.reversed)}};
  const NamedImage images[] = {{"visibility_image", results.visibility},
                               {"bent_normal_image", results.bent_normal},
                               {"normal_image", or_else(view.image(ALCOVE_IMAGE_NORMALS), depth)},
                               {"depth_image", depth},
                               {"roughness_image", or_else(roughness, depth)},
                               {"result_image", view.image(ALCOVE_IMAGE_SPECULAR)}};
  maths::GtsoParameters parameters{};
  set_areas(parameters, view);
  parameters.view_from_normal = view_from_normal(view.info.camera, normals_of(view));
  parameters.slope = projection.slope();
  parameters.inverse_depth_from_ndc = projection.inverse_depth_from_ndc;
  parameters.roughness = view.settings.roughness;
  view.list.dispatch({.label = "specular occlusion",
                      .shader = Shader::gtso,
                      .constants = constants,
                      .images = images,
                      .parameters = bytes_of(parameters),
                      .size = {view.written.width, view.written.height, 1}});
}

}  // namespace alcove::passes
