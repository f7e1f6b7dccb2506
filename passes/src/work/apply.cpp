#include <array>
#include <string>
#include <utility>

#include "alcove/passes/work.h"
#include "apply_parameters.h"
#include "maths/spherical_harmonics.h"
#include "work/areas.h"
#include "work/bindings.h"
#include "work/check_inputs.h"
#include "work/number_text.h"
#include "work/output_format.h"
#include "work/view_parameters.h"

namespace alcove::passes {

using framegraph::Texture;

namespace {

tl::unexpected<Error> refusal(std::string message) {
  return tl::unexpected(Error{std::move(message)});
}

tl::expected<void, Error> check_settings(const ApplySettings& settings) {
  if (!(settings.roughness >= 0.0f && settings.roughness <= 1.0f)) {
    return refusal("The roughness of probe light is " + number_text(settings.roughness) +
                   "; it must be 0 to 1.");
  }
  if (!(settings.metallic >= 0.0f && settings.metallic <= 1.0f)) {
    return refusal("The metallic of probe light is " + number_text(settings.metallic) +
                   "; it must be 0 to 1.");
  }
  for (const auto& [name, channel] : {std::pair("Roughness", settings.roughness_channel),
                                      std::pair("Metallic", settings.metallic_channel)}) {
    if (channel > 3) {
      return refusal(name + std::string(" is asked from channel ") + std::to_string(channel) +
                     " of its texture; channels are 0 to 3.");
    }
  }
  if (settings.precision == Precision::unorm8)
    return refusal("Probe light was asked for in 8 bits, which end at 1; use float16 or float32.");
  return {};
}

tl::expected<void, Error> check_probe(const WorkList& list, const ApplyInputs& inputs) {
  if (!inputs.harmonics)
    return refusal("The pass probe light needs a texture of harmonics; it was given none.");
  const VkExtent2D harmonics = list.size(inputs.harmonics);
  if (harmonics.width != maths::kHarmonics || harmonics.height != 1) {
    return refusal("The pass probe light was given harmonics of " +
                   std::to_string(harmonics.width) + "x" + std::to_string(harmonics.height) +
                   " texels; it needs " + std::to_string(maths::kHarmonics) + "x1.");
  }
  if (inputs.map) {
    const VkExtent2D map = list.size(inputs.map);
    if (map.width != map.height || map.width == 0) {
      return refusal("The pass probe light was given an environment map of " +
                     std::to_string(map.width) + "x" + std::to_string(map.height) +
                     " texels; it must be square.");
    }
  }
  return {};
}

// Checks the inputs that must have the size of the depth texture. Optional ones may be null.
tl::expected<void, Error> check_textures(const WorkList& list, const ApplyInputs& inputs) {
  const auto optional = [&](Texture texture) { return or_else(texture, inputs.depth); };
  return check_inputs(list, "probe light",
                      {{"linear depth", inputs.depth},
                       {"normals", inputs.normals},
                       {"albedo", inputs.albedo},
                       {"roughness", optional(inputs.roughness)},
                       {"metallic", optional(inputs.metallic)},
                       {"visibility", optional(inputs.visibility)},
                       {"bent normals", optional(inputs.bent_normal)},
                       {"specular occlusion", optional(inputs.specular_occlusion)},
                       {"light", optional(inputs.light)}});
}

std::array<NamedConstant, 10> constants_of(const ApplyInputs& inputs,
                                           const ApplySettings& settings) {
  const bool bounces = settings.multi_bounce && (inputs.visibility || inputs.specular_occlusion);
  return {{{"kBentNormal", flag(bool(inputs.bent_normal))},
           {"kVisibility", flag(bool(inputs.visibility))},
           {"kMultiBounce", flag(bounces)},
           {"kLight", flag(bool(inputs.light))},
           {"kParts", flag(settings.parts)},
           {"kRoughnessTexture", flag(bool(inputs.roughness))},
           {"kRoughnessChannel", channel_if(bool(inputs.roughness), settings.roughness_channel)},
           {"kMetallicTexture", flag(bool(inputs.metallic))},
           {"kMetallicChannel", channel_if(bool(inputs.metallic), settings.metallic_channel)},
           {"kSpecularOcclusion", flag(bool(inputs.specular_occlusion))}}};
}

// Returns the inputs without those that a purely diffuse surface does not use.
ApplyInputs without_specular(ApplyInputs inputs) {
  inputs.roughness = inputs.metallic = inputs.specular_occlusion = {};
  return inputs;
}

maths::ApplyParameters parameters_of(const WorkList& list, const WorkFrame& frame,
                                     const ApplyInputs& inputs, const ApplySettings& settings,
                                     const maths::Projection& projection) {
  const maths::mat4 world_from_view(
      glm::transpose(maths::mat3(to_rigid(frame.view.view_from_world))));
  maths::ApplyParameters parameters{
      projection, world_from_view,
      inputs.normals_in_view_space ? world_from_view : maths::mat4(1.0f)};
  if (inputs.map) {
    parameters.map = {static_cast<float>(list.size(inputs.map).width),
                      static_cast<float>(list.mips(inputs.map))};
  }
  parameters.roughness = settings.roughness;
  parameters.metallic = settings.metallic;
  return parameters;
}

}  // namespace

tl::expected<AppliedLight, Error> describe_apply(WorkList& list, const WorkFrame& frame,
                                                 const ApplyInputs& given,
                                                 const ApplySettings& settings) {
  const ApplyInputs inputs = given.map ? given : without_specular(given);
  if (has_areas(frame))
    return tl::unexpected(Error{"Probe light is computed for whole images; it was given areas."});
  auto good =
      check_settings(settings).and_then([&] { return check_textures(list, inputs); }).and_then([&] {
        return check_probe(list, inputs);
      });
  if (!good) return tl::unexpected(std::move(good.error()));
  const VkExtent2D size = list.size(inputs.depth);
  const auto projection = projection_of(frame.view, size);
  if (!projection) return tl::unexpected(projection.error());
  const auto create = [&](const char* name) {
    return list.add(ALCOVE_RESOURCE_KIND_TRANSIENT, name, colour_format(settings.precision), size);
  };
  AppliedLight result;
  result.lit = create("lit");
  if (settings.parts) result.diffuse = create("diffuse light");
  if (settings.parts && inputs.map) result.specular = create("specular light");
  // An optional image that is null is replaced by another image, which the shader does not read.
  const NamedTexture images[] = {
      {"depth_image", inputs.depth},
      {"normal_image", inputs.normals},
      {"albedo_image", inputs.albedo},
      {"bent_normal_image", or_else(inputs.bent_normal, inputs.normals)},
      {"visibility_image", or_else(inputs.visibility, inputs.albedo)},
      {"light_image", or_else(inputs.light, inputs.albedo)},
      {"harmonics_image", inputs.harmonics},
      {"lit_image", result.lit},
      {"diffuse_image", or_else(result.diffuse, result.lit)},
      {"specular_image", or_else(result.specular, result.lit)},
      {"roughness_image", or_else(inputs.roughness, inputs.albedo)},
      {"metallic_image", or_else(inputs.metallic, inputs.albedo)},
      {"specular_occlusion_image", or_else(inputs.specular_occlusion, inputs.albedo)},
      {"map_image", or_else(inputs.map, inputs.albedo)}};
  return list
      .dispatch({.label = "probe light",
                 .shader = inputs.map ? Shader::apply_specular : Shader::apply,
                 .constants = constants_of(inputs, settings),
                 .images = images,
                 .parameters = bytes_of(parameters_of(list, frame, inputs, settings, *projection)),
                 .size = {size.width, size.height, 1}})
      .map([&] { return result; });
}

}  // namespace alcove::passes
