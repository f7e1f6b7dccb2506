#include "alcove/passes/gtao.h"

#include <array>
#include <cmath>
#include <span>

#include "check_inputs.h"
#include "gtao_parameters.h"
#include "maths/slice_line.h"
#include "output_format.h"
#include "search_phase.h"
#include "view_parameters.h"

namespace alcove::passes {

using framegraph::RecordContext;
using framegraph::Texture;

namespace {

bool is_share(float value) { return value >= 0.0f && value <= 1.0f; }

bool has_thickness(Estimator estimator) {
  return estimator == Estimator::bitmask || estimator == Estimator::connected;
}

tl::expected<void, Error> check_occluders(const GtaoSettings& settings) {
  if (!(settings.thickness >= 0.0f) || !std::isfinite(settings.thickness) ||
      !is_share(settings.fill)) {
    return tl::unexpected(Error{"The thickness is " + std::to_string(settings.thickness) +
                                " and the fill " + std::to_string(settings.fill) +
                                "; the first must be at least 0 and finite, the second 0 to 1."});
  }
  if (!is_share(settings.blend) || !is_share(settings.falloff)) {
    return tl::unexpected(Error{"The blend is " + std::to_string(settings.blend) +
                                " and the falloff " + std::to_string(settings.falloff) +
                                "; each must be 0 to 1."});
  }
  if (settings.falloff > 0.0f && has_thickness(settings.estimator)) {
    return tl::unexpected(Error{
        "The falloff is " + std::to_string(settings.falloff) +
        ", but only horizons and the heuristic have one: a sector is occluded or it is not."});
  }
  return {};
}

tl::expected<void, Error> check(const GtaoSettings& settings) {
  if (!(settings.radius > 0.0f) || !std::isfinite(settings.radius)) {
    return tl::unexpected(Error{"The occlusion radius is " + std::to_string(settings.radius) +
                                "; it must be a length over 0 in the scene's units."});
  }
  if (settings.steps < 2 || settings.steps > 64) {
    return tl::unexpected(
        Error{"There are " + std::to_string(settings.steps) + " steps; there must be 2 to 64."});
  }
  if (settings.depth_layers < 1 || settings.depth_layers > 2) {
    return tl::unexpected(Error{"There are " + std::to_string(settings.depth_layers) +
                                " layers of depth; there must be 1 or 2."});
  }
  return check_search(settings.divisor, settings.slices)
      .and_then([&] { return check_roughness(settings.roughness, settings.roughness_channel); })
      .and_then([&] { return check_occluders(settings); });
}

// The textures that the pass writes, made for the graph but not yet written.
OcclusionSignal create_signal(const Frame& frame, Texture depth, const GtaoSettings& settings) {
  const auto size = framegraph::Extent::relative(depth, settings.divisor);
  OcclusionSignal result{
      .divisor = settings.divisor, .slices = settings.slices, .lobe = settings.lobe};
  result.signal =
      frame.graph.create_texture("occlusion signal", {signal_format(settings.lobe), size});
  if (settings.bent_normal) {
    result.bent = frame.graph.create_texture("bent signal", {kBentSignalFormat, size});
  }
  return result;
}

// Threads for `blocks`: with groups by pattern a whole number of block_by_pattern()'s.
VkExtent3D searches(VkExtent3D blocks, bool by_pattern) {
  const std::uint32_t whole = by_pattern ? 32 : 1;
  return {(blocks.width + whole - 1) / whole * whole, (blocks.height + whole - 1) / whole * whole,
          1};
}

}  // namespace

bool needs_back_depth(Estimator estimator, ThicknessUnit unit) {
  return has_thickness(estimator) && unit == ThicknessUnit::back_faces;
}

bool needs_second_depth(Estimator estimator, std::uint32_t depth_layers) {
  return has_thickness(estimator) && depth_layers > 1;
}

tl::expected<OcclusionSignal, Error> add_gtao(const Frame& frame, const GtaoInputs& inputs,
                                              const GtaoSettings& settings) {
  if (auto good = check(settings); !good) {
    return tl::unexpected(good.error());
  }
  const bool rough = settings.lobe && inputs.roughness;
  const bool by_back_faces = needs_back_depth(settings.estimator, settings.thickness_unit);
  const bool two_layers = needs_second_depth(settings.estimator, settings.depth_layers);
  const std::array<NamedInput, 5> needed{
      {{"line depth", inputs.line_depth},
       {"normals", inputs.normals},
       {"roughness", rough ? inputs.roughness : inputs.normals},
       {"back-face depth", by_back_faces ? inputs.back_line_depth : inputs.line_depth},
       {"second depth", two_layers ? inputs.second_line_depth : inputs.line_depth}}};
  if (auto good = check_inputs(frame.graph, "gtao", needed); !good) {
    return tl::unexpected(good.error());
  }
  const auto projection = projection_of(frame, frame.view, inputs.line_depth);
  if (!projection) {
    return tl::unexpected(projection.error());
  }
  const bool of_distance = settings.thickness_unit == ThicknessUnit::distance;
  const bool by_pattern = settings.parts.grouping == Grouping::pattern;
  const std::array constants{settings.slices,
                             settings.steps,
                             static_cast<std::uint32_t>(settings.bent_normal),
                             static_cast<std::uint32_t>(settings.estimator),
                             settings.divisor,
                             static_cast<std::uint32_t>(settings.pattern),
                             static_cast<std::uint32_t>(is_perspective(*projection)),
                             static_cast<std::uint32_t>(rough),
                             settings.roughness_channel,
                             static_cast<std::uint32_t>(settings.weighting == Weighting::uniform),
                             static_cast<std::uint32_t>(settings.falloff > 0.0f),
                             static_cast<std::uint32_t>(of_distance),
                             static_cast<std::uint32_t>(by_back_faces),
                             static_cast<std::uint32_t>(settings.parts.snapping),
                             static_cast<std::uint32_t>(by_pattern),
                             static_cast<std::uint32_t>(two_layers),
                             static_cast<std::uint32_t>(settings.parts.continuation),
                             static_cast<std::uint32_t>(settings.parts.unseen)};
  const auto kernel =
      frame.kernels.get(settings.lobe ? Shader::gtao_lobe : Shader::gtao, constants);
  if (!kernel) {
    return tl::unexpected(kernel.error());
  }

  OcclusionSignal result = create_signal(frame, inputs.line_depth, settings);
  auto pass = frame.graph.add_pass("gtao");
  pass.read(inputs.line_depth, framegraph::access::storage_read_compute);
  pass.read(inputs.normals, framegraph::access::sampled_compute);
  const auto& stored = framegraph::access::storage_write_compute;
  result.signal = pass.write(result.signal, stored, {}, framegraph::Contents::discard);
  if (settings.bent_normal) {
    result.bent = pass.write(result.bent, stored, {}, framegraph::Contents::discard);
  }
  if (rough) {
    pass.read(inputs.roughness, framegraph::access::sampled_compute);
  }
  if (by_back_faces) {
    pass.read(inputs.back_line_depth, framegraph::access::storage_read_compute);
  }
  if (two_layers) {
    pass.read(inputs.second_line_depth, framegraph::access::storage_read_compute);
  }
  const SearchPhase phase = search_phase(settings.divisor, frame.index);
  const maths::vec2 per_px = maths::ray_per_px(*projection);
  const maths::GtaoParameters parameters{
      view_from_normal(frame, inputs.normals_in_view_space),
      maths::vec4(per_px, projection->uv_to_slope.z, projection->uv_to_slope.w),
      maths::vec2(static_cast<float>(phase.x), static_cast<float>(phase.y)),
      settings.radius,
      frame.index,
      settings.thickness * (of_distance ? 1.0f : settings.radius),
      settings.fill,
      settings.blend,
      settings.falloff,
      settings.roughness};
  pass.record([&kernels = frame.kernels, kernel = *kernel, inputs, result, parameters, rough,
               by_back_faces, two_layers, by_pattern](RecordContext& context) {
    const VkImageView line = context.view(inputs.line_depth);
    const VkImageView normals = context.view(inputs.normals);
    const VkImageView signal = context.view(result.signal);
    const std::array views{line,
                           normals,
                           signal,
                           result.bent ? context.view(result.bent) : signal,
                           by_back_faces ? context.view(inputs.back_line_depth) : line,
                           two_layers ? context.view(inputs.second_line_depth) : line,
                           rough ? context.view(inputs.roughness) : normals};
    // Without a lobe the last binding does not exist.
    const std::span<const VkImageView> bound(views.data(), views.size() - (result.lobe ? 0 : 1));
    kernels.dispatch(context, kernel, bound, bytes_of(parameters),
                     searches(context.extent(result.signal), by_pattern));
  });
  return result;
}

}  // namespace alcove::passes
