#include "alcove/passes/apply.h"

#include <array>
#include <cstddef>
#include <span>
#include <utility>

#include "apply_parameters.h"
#include "graph/bindings.h"
#include "graph/check_inputs.h"
#include "maths/spherical_harmonics.h"
#include "work/number_text.h"
#include "work/output_format.h"
#include "work/view_parameters.h"

namespace alcove::passes {

using framegraph::RecordContext;
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
  if (settings.precision == Precision::unorm8) {
    return refusal("Probe light was asked for in 8 bits, which end at 1; use float16 or float32.");
  }
  return {};
}

tl::expected<void, Error> check_probe(const Frame& frame, const ApplyInputs& inputs) {
  if (!inputs.harmonics) {
    return refusal("The pass probe light needs a texture of harmonics; it was given none.");
  }
  const VkExtent3D harmonics = frame.graph.extent(inputs.harmonics);
  if (harmonics.width != maths::kHarmonics || harmonics.height != 1) {
    return refusal("The pass probe light was given harmonics of " +
                   std::to_string(harmonics.width) + "x" + std::to_string(harmonics.height) +
                   " texels; it needs " + std::to_string(maths::kHarmonics) + "x1.");
  }
  if (inputs.map) {
    const VkExtent3D map = frame.graph.extent(inputs.map);
    if (map.width != map.height || map.width == 0) {
      return refusal("The pass probe light was given an environment map of " +
                     std::to_string(map.width) + "x" + std::to_string(map.height) +
                     " texels; it must be square.");
    }
  }
  return {};
}

// A list of inputs on the stack, so that a steady frame allocates no memory for it.
class NamedInputs {
 public:
  void add(const NamedInput& input) { inputs_.at(count_++) = input; }
  operator std::span<const NamedInput>() const { return std::span(inputs_).first(count_); }

 private:
  std::array<NamedInput, 9> inputs_;
  std::size_t count_ = 0;
};

// Returns the inputs that must have the size of the depth texture, with their names. Optional
// inputs that are null are left out.
NamedInputs named_inputs(const ApplyInputs& inputs) {
  NamedInputs named;
  named.add({"linear depth", inputs.depth});
  named.add({"normals", inputs.normals});
  named.add({"albedo", inputs.albedo});
  for (const NamedInput& input :
       {NamedInput{"roughness", inputs.roughness}, NamedInput{"metallic", inputs.metallic},
        NamedInput{"visibility", inputs.visibility}, NamedInput{"bent normals", inputs.bent_normal},
        NamedInput{"specular occlusion", inputs.specular_occlusion},
        NamedInput{"light", inputs.light}}) {
    if (input.texture) {
      named.add(input);
    }
  }
  return named;
}

tl::expected<Kernel, Error> kernel_of(const Frame& frame, const ApplyInputs& inputs,
                                      const ApplySettings& settings) {
  const bool bounces = settings.multi_bounce && (inputs.visibility || inputs.specular_occlusion);
  const auto constants = std::to_array<NamedConstant>(
      {{"kBentNormal", flag(bool(inputs.bent_normal))},
       {"kVisibility", flag(bool(inputs.visibility))},
       {"kMultiBounce", flag(bounces)},
       {"kLight", flag(bool(inputs.light))},
       {"kParts", flag(settings.parts)},
       {"kRoughnessTexture", flag(bool(inputs.roughness))},
       {"kRoughnessChannel", channel_if(bool(inputs.roughness), settings.roughness_channel)},
       {"kMetallicTexture", flag(bool(inputs.metallic))},
       {"kMetallicChannel", channel_if(bool(inputs.metallic), settings.metallic_channel)},
       {"kSpecularOcclusion", flag(bool(inputs.specular_occlusion))}});
  return frame.kernels.get(inputs.map ? Shader::apply_specular : Shader::apply, constants);
}

Texture write_light(const Frame& frame, framegraph::PassBuilder& pass, const char* name,
                    Texture depth, Precision precision) {
  const Texture light = frame.graph.create_texture(
      name, {colour_format(precision), framegraph::Extent::relative(depth)});
  return pass.write(light, framegraph::access::storage_write_compute, {},
                    framegraph::Contents::discard);
}

void declare_reads(framegraph::PassBuilder& pass, const ApplyInputs& inputs) {
  const auto& sampled = framegraph::access::sampled_compute;
  const NamedInputs named = named_inputs(inputs);
  for (const NamedInput& input : std::span<const NamedInput>(named)) {
    pass.read(input.texture, sampled);
  }
  pass.read(inputs.harmonics, sampled);
  if (inputs.map) {
    pass.read(inputs.map, sampled);
  }
}

// Returns the inputs without those that a purely diffuse surface does not use.
ApplyInputs without_specular(ApplyInputs inputs) {
  inputs.roughness = inputs.metallic = inputs.specular_occlusion = {};
  return inputs;
}

maths::ApplyParameters parameters_of(const Frame& frame, const ApplyInputs& inputs,
                                     const ApplySettings& settings,
                                     const maths::Projection& projection) {
  const maths::mat4 world_from_view(
      glm::transpose(maths::mat3(to_rigid(frame.view.view_from_world))));
  maths::ApplyParameters parameters{
      projection, world_from_view,
      inputs.normals_in_view_space ? world_from_view : maths::mat4(1.0f)};
  if (inputs.map) {
    const auto& described = frame.graph.description().resources[inputs.map.index];
    parameters.map = {static_cast<float>(described.width), static_cast<float>(described.mips)};
  }
  parameters.roughness = settings.roughness;
  parameters.metallic = settings.metallic;
  return parameters;
}

}  // namespace

tl::expected<AppliedLight, Error> add_apply(const Frame& frame, const ApplyInputs& given,
                                            const ApplySettings& settings) {
  const ApplyInputs inputs = given.map ? given : without_specular(given);
  auto good =
      check_settings(settings)
          .and_then([&] { return check_inputs(frame.graph, "probe light", named_inputs(inputs)); })
          .and_then([&] { return check_probe(frame, inputs); });
  if (!good) {
    return tl::unexpected(std::move(good.error()));
  }
  const auto projection = projection_of(frame, frame.view, inputs.depth);
  if (!projection) {
    return tl::unexpected(projection.error());
  }
  const auto kernel = kernel_of(frame, inputs, settings);
  if (!kernel) {
    return tl::unexpected(kernel.error());
  }
  auto pass = frame.graph.add_pass("probe light");
  declare_reads(pass, inputs);
  AppliedLight result;
  result.lit = write_light(frame, pass, "lit", inputs.depth, settings.precision);
  if (settings.parts) {
    result.diffuse = write_light(frame, pass, "diffuse light", inputs.depth, settings.precision);
  }
  if (settings.parts && inputs.map) {
    result.specular = write_light(frame, pass, "specular light", inputs.depth, settings.precision);
  }
  pass.record([&kernels = frame.kernels, kernel = *kernel, inputs, result,
               parameters =
                   parameters_of(frame, inputs, settings, *projection)](RecordContext& context) {
    // An optional image that is null is replaced by another image, which the shader does not read.
    const auto views = std::to_array<NamedView>(
        {{"depth_image", context.view(inputs.depth)},
         {"normal_image", context.view(inputs.normals)},
         {"albedo_image", context.view(inputs.albedo)},
         {"bent_normal_image", view_or(context, inputs.bent_normal, inputs.normals)},
         {"visibility_image", view_or(context, inputs.visibility, inputs.albedo)},
         {"light_image", view_or(context, inputs.light, inputs.albedo)},
         {"harmonics_image", context.view(inputs.harmonics)},
         {"lit_image", context.view(result.lit)},
         {"diffuse_image", view_or(context, result.diffuse, result.lit)},
         {"specular_image", view_or(context, result.specular, result.lit)},
         {"roughness_image", view_or(context, inputs.roughness, inputs.albedo)},
         {"metallic_image", view_or(context, inputs.metallic, inputs.albedo)},
         {"specular_occlusion_image", view_or(context, inputs.specular_occlusion, inputs.albedo)},
         {"map_image", view_or(context, inputs.map, inputs.albedo)}});
    kernels.dispatch(context, kernel, views, bytes_of(parameters), context.extent(result.lit));
  });
  return result;
}

}  // namespace alcove::passes
