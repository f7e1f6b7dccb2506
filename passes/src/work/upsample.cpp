#include <array>
#include <cmath>

#include "alcove/passes/setting_table.h"
#include "maths/half_texel.h"
#include "upsample_parameters.h"
#include "work/bindings.h"
#include "work/output_format.h"

namespace alcove::passes {

namespace {

// Distance from a texel's tangent plane, in pixels, at which the texel's weight falls to 0.25.
// Fitted to the error over the development views (`alcove compare --set half_resolution=true`).
constexpr float kTolerancePx = 1.0f;

std::array<NamedConstant, 6> constants_of(const ViewInputs& view) {
  const AlcoveSettings& settings = view.settings;
  return {{{"kPerspective", flag(view.projection.perspective)},
           {"kVisibility", flag(view.visibility())},
           {"kShaped", flag(settings.power != 1.0f || settings.intensity != 1.0f)},
           {"kNormalEncoding", view.bent_normal() ? encoding_of(view) : 0u},
           {"kReversed", flag(view.projection.reversed)},
           {"kAreas", flag(view.in_part)}}};
}

maths::UpsampleParameters parameters_of(const ViewInputs& view, VkExtent2D stored) {
  const maths::Projection& projection = view.projection;
  const maths::vec2 per_px = projection.ray_per_px();
  maths::UpsampleParameters parameters{};
  set_areas(parameters, view);
  parameters.normal_from_view =
      maths::transpose(view_from_normal(view.info.camera, normals_of(view)));
  parameters.slope = projection.slope();
  parameters.inverse_depth_from_ndc = projection.inverse_depth_from_ndc;
  parameters.pixel_uv = 1.0f / projection.size_px;
  parameters.texel_uv = 1.0f / maths::vec2(stored.width, stored.height);
  parameters.half_pixel_per_tilt =
      (projection.perspective ? -0.5f : 0.5f) * maths::kLargestTilt * per_px;
  parameters.tolerance = 1.0f / (kTolerancePx * std::abs(per_px.y));
  parameters.power = view.settings.power;
  parameters.intensity = view.settings.intensity;
  return parameters;
}

}  // namespace

void describe_upsample(const ViewInputs& view, ResourceHandle depth, const HalfTexels& texels,
                       const OutputImages& results) {
  const ResourceHandle normals =
      results.bent_normal ? view.image(ALCOVE_IMAGE_NORMALS) : ResourceHandle{};
  const NamedImage images[] = {
      {"half_image", texels.half},
      {"half_depth_image", texels.depth},
      {"depth_image", depth},
      {"normal_image", or_else(normals, depth)},
      {"residual_image", texels.residuals},
      {"visibility_image",
       or_unused(view, results.visibility,
                 output_format(ALCOVE_IMAGE_VISIBILITY, view.settings.precision))},
      {"bent_normal_image", results.bent_normal},
      {"lobe_image", texels.lobes},
      {"specular_image", results.specular}};
  // An invocation of the upsampling computes the pixels between the centres of four texels, of
  // which the first lies one pixel before the image.
  const auto invocations = [&](std::uint32_t begin, std::uint32_t size) {
    return (begin + size) / 2 - (begin + 1) / 2 + 1;
  };
  const AlcoveArea& area = view.written;
  view.list.dispatch(
      {.label = "upsample",
       .shader = variant(Shader::upsample, view.bent_normal(), view.lobe()),
       .constants = constants_of(view),
       .images = images,
       // The textures are of the largest size.
       .parameters = bytes_of(parameters_of(view, view.list.size(texels.half))),
       .size = {invocations(area.x, area.width), invocations(area.y, area.height), 1}});
}

}  // namespace alcove::passes
