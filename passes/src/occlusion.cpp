#include "alcove/passes/occlusion.h"

#include <utility>

#include "alcove/passes/inverse_depth.h"

namespace alcove::passes {
namespace {

// The model of a Specular; not for none or slices.
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

// Linear depth, which neither searches nor filters read.
tl::expected<framegraph::Texture, Error> add_linear(const Frame& frame,
                                                    const OcclusionInputs& inputs,
                                                    const OcclusionSettings& settings) {
  const bool read = settings.linear_depth || by_model(settings.specular) || !inputs.normals;
  return read ? add_linear_depth(frame, inputs.depth_ndc, 1, 0.0f)
              : tl::expected<framegraph::Texture, Error>(framegraph::Texture{});
}

// Line depth of what the first surface hides (back faces, a second layer); null where `read` says
// that the settings do not read it, or it was not given.
tl::expected<framegraph::Texture, Error> add_hidden_inverse_depth(const Frame& frame,
                                                                  framegraph::Texture depth_ndc,
                                                                  bool read,
                                                                  std::string_view name) {
  return read && depth_ndc ? add_inverse_depth(frame, depth_ndc, name)
                           : tl::expected<framegraph::Texture, Error>(framegraph::Texture{});
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
  result.power = settings.power;
  result.intensity = settings.intensity;
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
                   .normal_encoding =
                       inputs.normals ? inputs.normal_encoding : NormalEncoding::signed_xyz,
                   .normals_forward_z = inputs.normals && inputs.normals_forward_z,
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
      settings.tile_size = 4;
      settings.steps = 8;
      settings.history_frames = 32;
      break;
    case Quality::medium:
      settings.tile_size = 2;
      settings.steps = 10;
      settings.history_frames = 32;
      break;
    case Quality::high:
      settings.tile_size = 2;
      settings.slices = 2;
      settings.steps = 16;
      settings.history_frames = 32;
      break;
    case Quality::ultra:
      settings.tile_size = 2;
      settings.slices = 4;
      settings.steps = 24;
      settings.history_frames = 32;
      break;
    case Quality::reference:
      settings.estimator = Estimator::horizons;
      settings.slices = 32;
      settings.steps = 64;
      settings.filter_radius = 0;
      settings.precision = Precision::float32;
      break;
  }
  return settings;
}

tl::expected<OcclusionOutputs, Error> add_occlusion(const Frame& frame,
                                                    const OcclusionInputs& inputs,
                                                    const OcclusionSettings& settings,
                                                    std::string_view history_name) {
  const auto depth = add_linear(frame, inputs, settings);
  if (!depth) {
    return tl::unexpected(depth.error());
  }
  framegraph::Texture normals = inputs.normals;
  const bool in_view_space = inputs.normals_in_view_space || !normals;
  // Those that are made from depth are plain vectors with the camera along -Z.
  const NormalEncoding encoding = normals ? inputs.normal_encoding : NormalEncoding::signed_xyz;
  const bool forward_z = normals && inputs.normals_forward_z;
  if (!normals) {
    auto made = add_normals(frame, *depth);
    if (!made) {
      return tl::unexpected(std::move(made.error()));
    }
    normals = *made;
  }
  const auto line = add_inverse_depth(frame, inputs.depth_ndc);
  if (!line) {
    return tl::unexpected(line.error());
  }
  const auto back_line = add_hidden_inverse_depth(
      frame, inputs.back_depth_ndc, needs_back_depth(settings.estimator, settings.thickness_unit),
      "back inverse depth");
  const auto second_line = add_hidden_inverse_depth(
      frame, inputs.second_depth_ndc, needs_second_depth(settings.estimator, settings.depth_layers),
      "second inverse depth");
  if (!back_line || !second_line) {
    return tl::unexpected(back_line ? second_line.error() : back_line.error());
  }
  const auto raw_occlusion = add_gtao(frame,
                                      {.inverse_depth = *line,
                                       .normals = normals,
                                       .normals_in_view_space = in_view_space,
                                       .roughness = inputs.roughness,
                                       .back_inverse_depth = *back_line,
                                       .second_inverse_depth = *second_line,
                                       .depth_format = frame.graph.format(inputs.depth_ndc),
                                       .normal_encoding = encoding,
                                       .normals_forward_z = forward_z},
                                      gtao_settings(settings));
  if (!raw_occlusion) {
    return tl::unexpected(raw_occlusion.error());
  }
  const auto filtered = add_reconstruct(frame,
                                        {.raw_occlusion = *raw_occlusion,
                                         .inverse_depth = *line,
                                         .normals = normals,
                                         .normals_in_view_space = in_view_space,
                                         .motion = inputs.motion,
                                         .roughness = inputs.roughness,
                                         .into = inputs.into,
                                         .normal_encoding = encoding,
                                         .normals_forward_z = forward_z,
                                         .motion_convention = inputs.motion_convention},
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
