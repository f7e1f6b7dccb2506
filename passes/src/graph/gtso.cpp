#include "alcove/passes/gtso.h"

#include <array>
#include <string>
#include <utility>

#include "alcove/passes/setting_names.h"
#include "graph/bindings.h"
#include "graph/check_inputs.h"
#include "graph/write_result.h"
#include "gtso_parameters.h"
#include "work/output_format.h"
#include "work/view_parameters.h"

namespace alcove::passes {

using framegraph::RecordContext;
using framegraph::Texture;

namespace {

tl::expected<void, Error> check(const Frame& frame, const GtsoInputs& inputs,
                                const OcclusionSettings& settings) {
  if (auto good = validate(settings); !good) {
    return good;
  }
  if (!specular_reads_bent_normal(settings)) {
    return tl::unexpected(Error{"The pass specular occlusion has the setting 'specular' " +
                                std::string(name_of(settings.specular)) +
                                "; it must be table or cone."});
  }
  const auto or_visibility = [&](bool needed, Texture texture) {
    return needed ? texture : inputs.visibility;
  };
  const std::array<NamedInput, 6> named{
      {{"visibility", inputs.visibility},
       {"normals", inputs.normals},
       {"linear depth", inputs.depth},
       {"bent normals", inputs.bent_normal},
       {"roughness", or_visibility(bool(inputs.roughness), inputs.roughness)},
       {"a texture for specular occlusion", or_visibility(bool(inputs.into), inputs.into)}}};
  return check_inputs(frame.graph, "specular occlusion", named);
}

void declare_reads(framegraph::PassBuilder& pass, const GtsoInputs& inputs) {
  for (const Texture texture :
       {inputs.visibility, inputs.bent_normal, inputs.normals, inputs.depth, inputs.roughness}) {
    if (texture) {
      pass.read(texture, framegraph::access::sampled_compute);
    }
  }
}

}  // namespace

tl::expected<Texture, Error> add_gtso(const Frame& frame, const GtsoInputs& inputs,
                                      const OcclusionSettings& settings) {
  if (auto good = check(frame, inputs, settings); !good) {
    return tl::unexpected(std::move(good.error()));
  }
  const auto projection = projection_of(frame, frame.view, inputs.depth);
  if (!projection) {
    return tl::unexpected(projection.error());
  }
  const bool textured = bool(inputs.roughness);
  const auto constants = std::to_array<NamedConstant>(
      {{"kRoughnessTexture", flag(textured)},
       {"kRoughnessChannel", channel_if(textured, settings.roughness_channel)},
       {"kNormalEncoding", static_cast<std::uint32_t>(inputs.normal_encoding)},
       {"kVisibilityChannel", channel_index(inputs.visibility_channel)}});
  const auto kernel = frame.kernels.get(
      settings.specular == Specular::table ? Shader::gtso_by_table : Shader::gtso, constants);
  if (!kernel) {
    return tl::unexpected(kernel.error());
  }
  Texture result = given_or_created(
      frame.graph, inputs.into, "specular occlusion",
      {scalar_format(settings.precision), framegraph::Extent::relative(inputs.depth)});
  auto pass = frame.graph.add_pass("specular occlusion");
  declare_reads(pass, inputs);
  result = write_result(frame.graph, pass, result);
  const maths::GtsoParameters parameters{
      *projection, view_from_normal(frame, inputs.normals_in_view_space, inputs.normals_forward_z),
      settings.roughness};
  pass.record([&kernels = frame.kernels, kernel = *kernel, inputs, result,
               parameters](RecordContext& context) {
    const auto views = std::to_array<NamedView>(
        {{"visibility_image", context.view(inputs.visibility)},
         {"bent_normal_image", context.view(inputs.bent_normal)},
         {"normal_image", context.view(inputs.normals)},
         {"depth_image", context.view(inputs.depth)},
         {"roughness_image", view_or(context, inputs.roughness, inputs.visibility)},
         {"result_image", context.view(result)}});
    kernels.dispatch(context, kernel, views, bytes_of(parameters), context.extent(result));
  });
  return result;
}

}  // namespace alcove::passes
