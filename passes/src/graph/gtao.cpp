#include "alcove/passes/gtao.h"

#include <algorithm>
#include <array>
#include <utility>

#include "graph/bindings.h"
#include "graph/check_inputs.h"
#include "gtao_parameters.h"
#include "maths/slice_line.h"
#include "maths/visibility_bitmask.h"
#include "work/interleave_offset.h"
#include "work/output_format.h"
#include "work/view_parameters.h"

namespace alcove::passes {

using framegraph::RecordContext;
using framegraph::Texture;

namespace {

bool has_lobe(const OcclusionSettings& settings) { return settings.specular == Specular::slices; }

// The textures that the pass writes, made for the graph but not yet written.
RawOcclusionTextures create_raw_occlusion(const Frame& frame, Texture depth,
                                          const OcclusionSettings& settings) {
  const auto size = framegraph::Extent::relative(depth, settings.tile_size);
  RawOcclusionTextures result{
      .tile_size = settings.tile_size, .slices = settings.slices, .lobe = has_lobe(settings)};
  result.raw_occlusion =
      frame.graph.create_texture("raw occlusion", {raw_format(result.lobe), size});
  if (needs_bent_normal(settings)) {
    result.bent = frame.graph.create_texture("bent-normal residual", {kBentRawFormat, size});
  }
  return result;
}

// The optional inputs that the shader reads with the given settings.
struct Reads {
  bool roughness = false;
  bool back_faces = false;
  bool second_layer = false;
};

Reads reads_of(const GtaoInputs& inputs, const OcclusionSettings& settings) {
  return {has_lobe(settings) && inputs.roughness, needs_back_depth(settings),
          needs_second_depth(settings)};
}

tl::expected<void, Error> check_textures(const Frame& frame, const GtaoInputs& inputs,
                                         const Reads& reads) {
  const std::array<NamedInput, 5> needed{
      {{"depth", inputs.depth_ndc},
       {"normals", inputs.normals},
       {"roughness", reads.roughness ? inputs.roughness : inputs.normals},
       {"back-face depth", reads.back_faces ? inputs.back_depth_ndc : inputs.depth_ndc},
       {"second depth", reads.second_layer ? inputs.second_depth_ndc : inputs.depth_ndc}}};
  return check_inputs(frame.graph, "gtao", needed);
}

// Larger radii than this, in scene units, are treated as this radius. The shader measures lengths
// in radii, and the squares of such lengths would underflow.
constexpr float kLargestRadius = 1e12f;

// Returns whether the thickness is a fraction of the occluder's distance.
bool of_distance(const OcclusionSettings& settings) {
  return has_thickness(settings.advanced.estimator) &&
         settings.advanced.thickness_unit == ThicknessUnit::distance;
}

std::array<NamedConstant, 20> constants_of(const GtaoInputs& inputs,
                                           const OcclusionSettings& settings, const Reads& reads,
                                           const maths::Projection& projection) {
  const AdvancedSettings& advanced = settings.advanced;
  return {{{"kSliceCount", settings.slices},
           {"kStepCount", settings.steps},
           {"kBentNormal", flag(needs_bent_normal(settings))},
           {"kEstimator", static_cast<std::uint32_t>(advanced.estimator)},
           {"kTileSize", settings.tile_size},
           {"kPattern", static_cast<std::uint32_t>(advanced.pattern)},
           {"kPerspective", flag(is_perspective(projection))},
           {"kRoughnessTexture", flag(reads.roughness)},
           {"kRoughnessChannel", channel_if(reads.roughness, settings.roughness_channel)},
           {"kUniformWeight", flag(advanced.weighting == Weighting::uniform)},
           {"kFalloff", flag(advanced.falloff > 0.0f)},
           {"kThicknessOfDistance", flag(of_distance(settings))},
           {"kBackFaces", flag(reads.back_faces)},
           {"kSnapToTexels", flag(advanced.snap_to_texels)},
           {"kSecondLayer", flag(reads.second_layer)},
           {"kExtrapolation", flag(advanced.extrapolation)},
           {"kUnobserved", flag(advanced.unobserved)},
           {"kNormalEncoding", static_cast<std::uint32_t>(inputs.normal_encoding)},
           {"kReversed", flag(is_reversed(projection))},
           {"kInfiniteFar", flag(has_infinite_far(projection))}}};
}

void declare_accesses(framegraph::PassBuilder& pass, const GtaoInputs& inputs, const Reads& reads,
                      RawOcclusionTextures& result) {
  const auto& sampled = framegraph::access::sampled_compute;
  const auto& stored = framegraph::access::storage_write_compute;
  pass.read(inputs.depth_ndc, sampled);
  pass.read(inputs.normals, sampled);
  result.raw_occlusion =
      pass.write(result.raw_occlusion, stored, {}, framegraph::Contents::discard);
  if (result.bent) {
    result.bent = pass.write(result.bent, stored, {}, framegraph::Contents::discard);
  }
  if (reads.roughness) {
    pass.read(inputs.roughness, sampled);
  }
  if (reads.back_faces) {
    pass.read(inputs.back_depth_ndc, sampled);
  }
  if (reads.second_layer) {
    pass.read(inputs.second_depth_ndc, sampled);
  }
}

maths::GtaoParameters parameters_of(const Frame& frame, const GtaoInputs& inputs,
                                    const OcclusionSettings& settings,
                                    const maths::Projection& projection) {
  const float radius = std::min(settings.radius, kLargestRadius);
  const InterleaveOffset interleave_offset = interleave_offset_of(settings.tile_size, frame.index);
  const maths::DepthStep step = depth_step(projection, inputs.depth_format != VK_FORMAT_UNDEFINED
                                                           ? inputs.depth_format
                                                           : frame.graph.format(inputs.depth_ndc));
  return {
      view_from_normal(frame, inputs.normals_in_view_space, inputs.normals_forward_z),
      maths::vec4(maths::ray_per_px(projection), projection.uv_to_slope.z,
                  projection.uv_to_slope.w),
      inverse_depth_from_ndc(projection),
      maths::vec2(static_cast<float>(interleave_offset.x), static_cast<float>(interleave_offset.y)),
      radius,
      frame.index,
      settings.thickness * (of_distance(settings) ? 1.0f : radius),
      maths::hidden_exponent(settings.hidden_occlusion),
      settings.advanced.blend,
      settings.advanced.falloff,
      settings.roughness,
      step.constant,
      step.per_inverse_depth};
}

// Returns the image views of a dispatch. Every binding needs a view, so that an image that the
// settings do not use is replaced by another image of the same type.
std::array<NamedView, 7> views_of(RecordContext& context, const GtaoInputs& inputs,
                                  const Reads& reads, const RawOcclusionTextures& result) {
  const VkImageView depth = context.view(inputs.depth_ndc);
  const VkImageView normals = context.view(inputs.normals);
  const VkImageView raw_occlusion = context.view(result.raw_occlusion);
  return {{{"depth_image", depth},
           {"normal_image", normals},
           {"raw_image", raw_occlusion},
           {"bent_image", result.bent ? context.view(result.bent) : raw_occlusion},
           {"back_image", reads.back_faces ? context.view(inputs.back_depth_ndc) : depth},
           {"second_image", reads.second_layer ? context.view(inputs.second_depth_ndc) : depth},
           {"roughness_image", reads.roughness ? context.view(inputs.roughness) : normals}}};
}

}  // namespace

tl::expected<RawOcclusionTextures, Error> add_gtao(const Frame& frame, const GtaoInputs& inputs,
                                                   const OcclusionSettings& settings) {
  const Reads reads = reads_of(inputs, settings);
  auto good = validate(settings).and_then([&] { return check_textures(frame, inputs, reads); });
  if (!good) {
    return tl::unexpected(std::move(good.error()));
  }
  const auto projection = projection_of(frame, frame.view, inputs.depth_ndc);
  if (!projection) {
    return tl::unexpected(projection.error());
  }
  const auto kernel = frame.kernels.get(has_lobe(settings) ? Shader::gtao_specular : Shader::gtao,
                                        constants_of(inputs, settings, reads, *projection));
  if (!kernel) {
    return tl::unexpected(kernel.error());
  }
  RawOcclusionTextures result = create_raw_occlusion(frame, inputs.depth_ndc, settings);
  auto pass = frame.graph.add_pass("gtao");
  declare_accesses(pass, inputs, reads, result);
  pass.record(
      [&kernels = frame.kernels, kernel = *kernel, inputs, result, reads,
       parameters = parameters_of(frame, inputs, settings, *projection)](RecordContext& context) {
        kernels.dispatch(context, kernel, views_of(context, inputs, reads, result),
                         bytes_of(parameters), context.extent(result.raw_occlusion));
      });
  return result;
}

}  // namespace alcove::passes
