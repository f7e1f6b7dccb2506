#include "work/upsample.h"

#include <array>
#include <cmath>

#include "maths/half_texel.h"
#include "upsample_parameters.h"
#include "work/areas.h"
#include "work/bindings.h"
#include "work/output_format.h"
#include "work/view_parameters.h"

namespace alcove::passes {

using framegraph::Texture;

namespace {

// Distance from a texel's tangent plane, in pixels, at which the texel's weight falls to 0.25.
// Fitted to the error over the development views (`alcove compare --set half_resolution=true`).
constexpr float kTolerancePx = 1.0f;

std::array<NamedConstant, 6> constants_of(const WorkFrame& frame, const UpsampleInputs& inputs,
                                          const Occlusion& result,
                                          const OcclusionSettings& settings,
                                          const maths::Projection& projection) {
  const std::uint32_t encoding =
      result.bent_normal ? encoding_of(inputs.normals, inputs.normal_convention.encoding) : 0u;
  return {{{"kPerspective", flag(is_perspective(projection))},
           {"kVisibility", flag(bool(result.visibility))},
           {"kShaped", flag(settings.power != 1.0f || settings.intensity != 1.0f)},
           {"kNormalEncoding", encoding},
           {"kReversed", flag(is_reversed(projection))},
           {"kAreas", flag(has_areas(frame))}}};
}

maths::UpsampleParameters parameters_of(const WorkList& list, const WorkFrame& frame,
                                        const UpsampleInputs& inputs,
                                        const OcclusionSettings& settings,
                                        const maths::Projection& projection, VkExtent2D read) {
  // The textures are of the largest size.
  const VkExtent2D stored = list.size(inputs.half);
  const maths::vec2 per_px = maths::ray_per_px(projection);
  maths::UpsampleParameters parameters{};
  set_areas(parameters, frame, read);
  parameters.to_outputs = maths::ivec2(frame.areas.output_x, frame.areas.output_y) -
                          maths::ivec2(parameters.written.x, parameters.written.y);
  parameters.normal_from_view =
      maths::transpose(view_from_normal(frame.view, inputs.normal_convention));
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

tl::expected<Occlusion, Error> describe_upsample(WorkList& list, const WorkFrame& frame,
                                                 const UpsampleInputs& inputs,
                                                 const Occlusion& result,
                                                 const OcclusionSettings& settings) {
  const VkExtent2D read = read_size(frame, list.size(inputs.depth_ndc));
  const auto projection = projection_of(frame.view, read);
  if (!projection) return tl::unexpected(projection.error());
  const NamedTexture images[] = {
      {"half_image", inputs.half},
      {"half_depth_image", inputs.half_depth},
      {"depth_image", inputs.depth_ndc},
      {"normal_image", or_else(inputs.normals, inputs.depth_ndc)},
      {"residual_image", inputs.residuals},
      {"visibility_image", or_unused(list, result.visibility, scalar_format(settings.precision))},
      {"bent_normal_image", result.bent_normal},
      {"lobe_image", inputs.lobes},
      {"specular_image", result.specular}};
  // An invocation of the upsampling computes the pixels between the centres of four texels, of
  // which the first lies one pixel before the image.
  const AlcoveArea area = written_area(frame, read);
  const auto invocations = [&](std::uint32_t begin, std::uint32_t size) {
    return (begin + size) / 2 - (begin + 1) / 2 + 1;
  };
  return list
      .dispatch(
          {.label = "upsample",
           .shader = variant(Shader::upsample, bool(result.bent_normal), bool(result.specular)),
           .constants = constants_of(frame, inputs, result, settings, *projection),
           .images = images,
           .parameters = bytes_of(parameters_of(list, frame, inputs, settings, *projection, read)),
           .size = {invocations(area.x, area.width), invocations(area.y, area.height), 1}})
      .map([&] { return result; });
}

}  // namespace alcove::passes
