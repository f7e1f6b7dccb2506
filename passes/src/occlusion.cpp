#include "alcove/passes/occlusion.h"

#include <utility>

#include "alcove/passes/line_depth.h"

namespace alcove::passes {
namespace {

// How deep one surface may run across two texels of the depth pyramid, in parts of the radius.
constexpr float kPyramidReach = 0.1f;

// Of a Specular that is neither none nor slices.
SpecularModel model_of(Specular specular) {
  switch (specular) {
    case Specular::cone:
      return SpecularModel::cone;
    case Specular::smooth_cone:
      return SpecularModel::smooth_cone;
    case Specular::lagarde:
      return SpecularModel::lagarde;
    default:
      return SpecularModel::table;
  }
}

bool by_model(Specular specular) {
  return specular != Specular::none && specular != Specular::slices;
}

GtaoSettings gtao_settings(const OcclusionSettings& settings) {
  GtaoSettings result{static_cast<const SearchSettings&>(settings)};
  result.bent_normal = settings.bent_normal ||
                       (by_model(settings.specular) && settings.specular != Specular::lagarde);
  result.lobe = settings.specular == Specular::slices;
  result.roughness = settings.roughness;
  result.roughness_channel = settings.roughness_channel;
  return result;
}

ReconstructSettings reconstruct_settings(const OcclusionSettings& settings) {
  ReconstructSettings result{static_cast<const FilterSettings&>(settings)};
  result.visibility = settings.visibility || by_model(settings.specular);
  result.roughness = settings.roughness;
  result.roughness_channel = settings.roughness_channel;
  result.precision = settings.precision;
  return result;
}

// Specular occlusion from what was found, into `outputs`.
tl::expected<OcclusionOutputs, Error> add_model(const Frame& frame, OcclusionOutputs outputs,
                                                const OcclusionInputs& inputs, bool in_view_space,
                                                const OcclusionSettings& settings) {
  return add_gtso(frame,
                  {.visibility = outputs.visibility,
                   .bent_normal = outputs.bent_normal,
                   .normals = outputs.normals,
                   .depth = outputs.linear_depth,
                   .roughness = inputs.roughness,
                   .normals_in_view_space = in_view_space,
                   .into = inputs.into.specular},
                  {.model = model_of(settings.specular),
                   .roughness = settings.roughness,
                   .roughness_channel = settings.roughness_channel,
                   .precision = settings.precision})
      .map([&](framegraph::Texture specular) {
        outputs.specular = specular;
        return outputs;
      });
}

}  // namespace

OcclusionSettings quality_settings(Quality quality, float radius) {
  OcclusionSettings settings;
  settings.radius = radius;
  switch (quality) {
    case Quality::low:
      settings.divisor = 4;
      settings.steps = 8;
      settings.history_frames = 32;
      break;
    case Quality::medium:
      settings.divisor = 2;
      settings.steps = 10;
      settings.history_frames = 32;
      break;
    case Quality::high:
      settings.steps = 12;
      settings.history_frames = 32;
      break;
    case Quality::ultra:
      settings.steps = 24;
      settings.fill = 0.42f;
      settings.history_frames = 32;
      break;
    case Quality::reference:
      settings.estimator = Estimator::horizons;
      settings.slices = 32;
      settings.steps = 64;
      settings.filter_reach = 0;
      settings.precision = Precision::float32;
      break;
  }
  return settings;
}

tl::expected<OcclusionOutputs, Error> add_occlusion(const Frame& frame,
                                                    const OcclusionInputs& inputs,
                                                    const OcclusionSettings& settings,
                                                    std::string_view history_name) {
  const auto depth = add_depth_pyramid(frame, inputs.depth_ndc, settings.depth_mips,
                                       kPyramidReach * settings.radius);
  if (!depth) {
    return tl::unexpected(depth.error());
  }
  framegraph::Texture normals = inputs.normals;
  const bool in_view_space = inputs.normals_in_view_space || !normals;
  if (!normals) {
    auto made = add_normals(frame, *depth);
    if (!made) {
      return tl::unexpected(std::move(made.error()));
    }
    normals = *made;
  }
  const auto line = add_line_depth(frame, inputs.depth_ndc);
  if (!line) {
    return tl::unexpected(line.error());
  }
  framegraph::Texture back_line;
  if (inputs.back_depth_ndc && needs_back_depth(settings.estimator, settings.thickness_unit)) {
    auto made = add_line_depth(frame, inputs.back_depth_ndc, "back line depth");
    if (!made) {
      return tl::unexpected(std::move(made.error()));
    }
    back_line = *made;
  }
  framegraph::Texture second_line;
  if (inputs.second_depth_ndc && needs_second_depth(settings.estimator, settings.depth_layers)) {
    auto made = add_line_depth(frame, inputs.second_depth_ndc, "second line depth");
    if (!made) {
      return tl::unexpected(std::move(made.error()));
    }
    second_line = *made;
  }
  const auto signal =
      add_gtao(frame, {*line, normals, in_view_space, inputs.roughness, back_line, second_line},
               gtao_settings(settings));
  if (!signal) {
    return tl::unexpected(signal.error());
  }
  const auto filtered = add_reconstruct(
      frame, {*signal, *line, normals, in_view_space, inputs.motion, inputs.roughness, inputs.into},
      reconstruct_settings(settings), history_name);
  if (!filtered) {
    return tl::unexpected(filtered.error());
  }
  const OcclusionOutputs outputs{filtered->visibility, filtered->bent_normal, filtered->specular,
                                 *depth, normals};
  return by_model(settings.specular) ? add_model(frame, outputs, inputs, in_view_space, settings)
                                     : tl::expected<OcclusionOutputs, Error>(outputs);
}

}  // namespace alcove::passes
