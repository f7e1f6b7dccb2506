#include <string>
#include <utility>

#include "alcove/passes/setting_names.h"
#include "alcove/passes/work.h"
#include "gtso_parameters.h"
#include "work/areas.h"
#include "work/bindings.h"
#include "work/check_inputs.h"
#include "work/output_format.h"
#include "work/view_parameters.h"

namespace alcove::passes {

using framegraph::Texture;

namespace {

tl::expected<void, Error> check(const WorkList& list, const WorkFrame& frame,
                                const GtsoInputs& inputs, const OcclusionSettings& settings) {
  if (auto good = validate(settings); !good) return good;
  if (!specular_reads_bent_normal(settings)) {
    return tl::unexpected(Error{"The pass specular occlusion has the setting 'specular' " +
                                std::string(name_of(settings.specular)) + "; it must be table."});
  }
  if (has_areas(frame)) {
    const AlcoveArea written = written_area(frame, list.size(inputs.depth));
    const VkExtent2D size{written.width, written.height};
    for (const NamedInput& output :
         {NamedInput{"visibility", inputs.visibility},
          {"bent normals", inputs.bent_normal},
          {"specular occlusion", or_else(inputs.into, inputs.visibility)}})
      if (auto good = check_output(frame, size, list.size(output.texture), output.name); !good)
        return good;
    return check_areas(frame.areas,
                       list.size(inputs.roughness ? inputs.roughness : inputs.normals));
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
  if (auto good = check(list, frame, inputs, settings); !good)
    return tl::unexpected(std::move(good.error()));
  const VkExtent2D size = list.size(inputs.depth);
  const auto projection = projection_of(frame.view, size);
  if (!projection) return tl::unexpected(projection.error());
  const AlcoveArea written = written_area(frame, size);
  const VkExtent2D results{written.width, written.height};
  const Texture result =
      given_or_added(list, inputs.into, "specular occlusion", scalar_format(settings.precision),
                     output_size(frame, results));
  const bool textured = bool(inputs.roughness);
  const NamedConstant constants[] = {
      {"kRoughnessTexture", flag(textured)},
      {"kRoughnessChannel", channel_if(textured, settings.roughness_channel)},
      {"kNormalEncoding", static_cast<std::uint32_t>(inputs.normal_convention.encoding)},
      {"kAreas", flag(has_areas(frame))}};
  const NamedTexture images[] = {{"visibility_image", inputs.visibility},
                                 {"bent_normal_image", inputs.bent_normal},
                                 {"normal_image", inputs.normals},
                                 {"depth_image", inputs.depth},
                                 {"roughness_image", or_else(inputs.roughness, inputs.visibility)},
                                 {"result_image", result}};
  // Normals that were computed from depth have the size of the area that is read.
  const AlcoveArea& read = frame.areas.read;
  const VkExtent2D whole = list.size(inputs.normals);
  const bool cropped = whole.width == size.width && whole.height == size.height;
  const auto x = static_cast<int>(frame.areas.output_x) - static_cast<int>(written.x);
  const auto y = static_cast<int>(frame.areas.output_y) - static_cast<int>(written.y);
  const maths::GtsoParameters parameters{
      maths::uvec4(cropped ? 0u : read.x, cropped ? 0u : read.y, read.x, read.y),
      maths::ivec4(written.x, written.y, x, y),
      *projection,
      view_from_normal(frame.view, inputs.normal_convention),
      maths::uvec2(results.width, results.height),
      settings.roughness};
  return list
      .dispatch({.label = "specular occlusion",
                 .shader = Shader::gtso,
                 .constants = constants,
                 .images = images,
                 .parameters = bytes_of(parameters),
                 .size = {results.width, results.height, 1}})
      .map([&] { return result; });
}

}  // namespace alcove::passes
