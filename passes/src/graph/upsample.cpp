#include "graph/upsample.h"

#include <array>
#include <cmath>

#include "graph/bindings.h"
#include "graph/write_result.h"
#include "maths/half_texel.h"
#include "upsample_parameters.h"
#include "work/view_parameters.h"

namespace alcove::passes {

using framegraph::RecordContext;
using framegraph::Texture;

namespace {

// Distance from a texel's tangent plane, in pixels, at which the texel's weight falls to 0.25.
// Fitted to the error over the development views (`alcove compare --set half_resolution=true`).
constexpr float kTolerancePx = 1.0f;

Shader shader_of(const UpsampleInputs& inputs, const Occlusion& result) {
  if (inputs.half_size_results) {
    return result.specular ? Shader::half_output_specular : Shader::half_output;
  }
  return result.specular ? Shader::upsample_specular : Shader::upsample;
}

tl::expected<Kernel, Error> get_kernel(const Frame& frame, const UpsampleInputs& inputs,
                                       const Occlusion& result, const OcclusionSettings& settings,
                                       const maths::Projection& projection) {
  const std::uint32_t encoding =
      result.bent_normal ? static_cast<std::uint32_t>(inputs.normal_encoding) : 0u;
  const auto constants = std::to_array<NamedConstant>(
      {{"kPerspective", flag(is_perspective(projection))},
       {"kVisibility", flag(bool(result.visibility))},
       {"kShaped", flag(settings.power != 1.0f || settings.intensity != 1.0f)},
       {"kBentNormal", flag(bool(result.bent_normal))},
       {"kNormalEncoding", encoding},
       {"kReversed", flag(is_reversed(projection))},
       {"kKeepsChannels", flag(inputs.visibility_channel != VisibilityChannel::all)},
       {"kVisibilityChannel", channel_index(inputs.visibility_channel)}});
  return frame.kernels.get(shader_of(inputs, result), constants);
}

void declare_accesses(const Frame& frame, framegraph::PassBuilder& pass,
                      const UpsampleInputs& inputs, Occlusion& result) {
  const auto& sampled = framegraph::access::sampled_compute;
  pass.read(inputs.half, sampled);
  if (!inputs.half_size_results) {
    pass.read(inputs.half_depth, sampled);
  }
  pass.read(inputs.depth_ndc, sampled);
  if (result.bent_normal) {
    pass.read(inputs.normals, sampled);
    pass.read(inputs.residuals, sampled);
  }
  if (result.specular) {
    pass.read(inputs.lobes, sampled);
  }
  if (result.visibility) {
    result.visibility =
        write_channel(frame.graph, pass, result.visibility, inputs.visibility_channel);
  }
  for (Texture* const written : {&result.bent_normal, &result.specular}) {
    if (*written) {
      *written = write_result(frame.graph, pass, *written);
    }
  }
}

maths::UpsampleParameters parameters_of(const Frame& frame, const UpsampleInputs& inputs,
                                        const OcclusionSettings& settings,
                                        const maths::Projection& projection) {
  // The textures are of the largest size.
  const VkExtent3D stored = frame.graph.extent(inputs.half);
  const maths::vec2 per_px = maths::ray_per_px(projection);
  maths::UpsampleParameters parameters{};
  parameters.normal_from_view = maths::transpose(
      view_from_normal(frame, inputs.normals_in_view_space, inputs.normals_forward_z));
  parameters.slope = maths::vec4(per_px, projection.uv_to_slope.z, projection.uv_to_slope.w);
  parameters.inverse_depth_from_ndc = inverse_depth_from_ndc(projection);
  parameters.pixel_uv = 1.0f / projection.size_px;
  parameters.texel_uv = 1.0f / maths::vec2(stored.width, stored.height);
  parameters.half_pixel_per_tilt =
      (is_perspective(projection) ? -0.5f : 0.5f) * maths::kLargestTilt * per_px;
  parameters.tolerance = 1.0f / (kTolerancePx * std::abs(per_px.y));
  parameters.power = settings.power;
  parameters.intensity = settings.intensity;
  return parameters;
}

}  // namespace

tl::expected<Occlusion, Error> add_upsample(const Frame& frame, const UpsampleInputs& inputs,
                                            const Occlusion& result,
                                            const OcclusionSettings& settings) {
  const auto projection = projection_of(frame, frame.view, inputs.depth_ndc);
  if (!projection) {
    return tl::unexpected(projection.error());
  }
  const auto kernel = get_kernel(frame, inputs, result, settings, *projection);
  if (!kernel) {
    return tl::unexpected(kernel.error());
  }
  Occlusion out = result;
  auto pass =
      frame.graph.add_pass(inputs.half_size_results ? "half-resolution output" : "upsample");
  declare_accesses(frame, pass, inputs, out);
  pass.record(
      [&kernels = frame.kernels, kernel = *kernel, inputs, out,
       parameters = parameters_of(frame, inputs, settings, *projection)](RecordContext& context) {
        const Texture written = out.visibility    ? out.visibility
                                : out.bent_normal ? out.bent_normal
                                                  : out.specular;
        const bool keeps = inputs.visibility_channel != VisibilityChannel::all;
        const auto views = std::to_array<NamedView>(
            {{"half_image", context.view(inputs.half)},
             {"half_depth_image",
              context.view(inputs.half_size_results ? inputs.half : inputs.half_depth)},
             {"depth_image", context.view(inputs.depth_ndc)},
             {"normal_image",
              view_or(context, out.bent_normal ? inputs.normals : Texture{}, inputs.depth_ndc)},
             {"residual_image",
              view_or(context, out.bent_normal ? inputs.residuals : Texture{}, inputs.half)},
             {"visibility_image", view_or(context, out.visibility, written)},
             {"bent_normal_image", view_or(context, out.bent_normal, written)},
             {"kept_image", context.view(keeps ? out.visibility : inputs.depth_ndc)},
             {"lobe_image", view_or(context, inputs.lobes, inputs.half)},
             {"specular_image", view_or(context, out.specular, written)}});
        // One invocation of the upsampling computes the pixels between the centres of four texels.
        // One more row and column of invocations is therefore needed.
        const std::uint32_t more = inputs.half_size_results ? 0 : 1;
        kernels.dispatch(context, kernel, views, bytes_of(parameters),
                         {inputs.half_size.width + more, inputs.half_size.height + more, 1});
      });
  return out;
}

}  // namespace alcove::passes
