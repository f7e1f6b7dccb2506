#include <string>
#include <utility>

#include "alcove/passes/setting_names.h"
#include "alcove/passes/work.h"
#include "gtso_parameters.h"
#include "work/bindings.h"
#include "work/check_inputs.h"
#include "work/output_format.h"
#include "work/view_parameters.h"

namespace alcove::passes {

using framegraph::Texture;

namespace {

tl::expected<void, Error> check(const WorkList& list, const GtsoInputs& inputs,
                                const OcclusionSettings& settings) {
  if (auto good = validate(settings); !good) {
    return good;
  }
  if (!specular_reads_bent_normal(settings)) {
    return tl::unexpected(Error{"The pass specular occlusion has the setting 'specular' " +
                                std::string(name_of(settings.specular)) +
                                "; it must be table or cone."});
  }
  return check_inputs(
      list, "specular occlusion",
      {{"visibility", inputs.visibility},
       {"normals", inputs.normals},
       {"linear depth", inputs.depth},
       {"bent normals", inputs.bent_normal},
       {"roughness", or_else(inputs.roughness, inputs.visibility)},
       {"a texture for specular occlusion", or_else(inputs.into, inputs.visibility)}});
}

}  // namespace

tl::expected<Texture, Error> describe_gtso(WorkList& list, const WorkFrame& frame,
                                           const GtsoInputs& inputs,
                                           const OcclusionSettings& settings) {
  if (auto good = check(list, inputs, settings); !good) {
    return tl::unexpected(std::move(good.error()));
  }
  const VkExtent2D size = list.size(inputs.depth);
  const auto projection = projection_of(frame.view, size);
  if (!projection) {
    return tl::unexpected(projection.error());
  }
  const Texture result = given_or_added(list, inputs.into, "specular occlusion",
                                        scalar_format(settings.precision), size);
  const bool textured = bool(inputs.roughness);
  const NamedConstant constants[] = {
      {"kRoughnessTexture", flag(textured)},
      {"kRoughnessChannel", channel_if(textured, settings.roughness_channel)},
      {"kNormalEncoding", static_cast<std::uint32_t>(inputs.normal_encoding)},
      {"kVisibilityChannel", channel_index(inputs.visibility_channel)}};
  const NamedTexture images[] = {{"visibility_image", inputs.visibility},
                                 {"bent_normal_image", inputs.bent_normal},
                                 {"normal_image", inputs.normals},
                                 {"depth_image", inputs.depth},
                                 {"roughness_image", or_else(inputs.roughness, inputs.visibility)},
                                 {"result_image", result}};
  const maths::GtsoParameters parameters{
      *projection,
      view_from_normal(frame.view, inputs.normals_in_view_space, inputs.normals_forward_z),
      settings.roughness};
  return list
      .dispatch(
          {.label = "specular occlusion",
           .shader = settings.specular == Specular::table ? Shader::gtso_by_table : Shader::gtso,
           .constants = constants,
           .images = images,
           .parameters = bytes_of(parameters),
           .size = {size.width, size.height, 1}})
      .map([&] { return result; });
}

}  // namespace alcove::passes
