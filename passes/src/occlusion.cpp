#include "alcove/passes/occlusion.h"

#include <utility>

#include "alcove/passes/inverse_depth.h"

namespace alcove::passes {
namespace {

// Adds linear depth if an output, specular occlusion or normals from depth need it.
tl::expected<framegraph::Texture, Error> add_linear(const Frame& frame,
                                                    const OcclusionInputs& inputs,
                                                    const OcclusionSettings& settings) {
  const bool read =
      settings.linear_depth || specular_reads_bent_normal(settings) || !inputs.normals;
  return read ? add_linear_depth(frame, inputs.depth_ndc)
              : tl::expected<framegraph::Texture, Error>(framegraph::Texture{});
}

// Adds the inverse depth of back faces or of the second layer. Returns null if the settings do not
// read it, or if it was not given.
tl::expected<framegraph::Texture, Error> add_hidden_inverse_depth(const Frame& frame,
                                                                  framegraph::Texture depth_ndc,
                                                                  bool read,
                                                                  std::string_view name) {
  return read && depth_ndc ? add_inverse_depth(frame, depth_ndc, name)
                           : tl::expected<framegraph::Texture, Error>(framegraph::Texture{});
}

// Adds specular occlusion from visibility and bent normals to `outputs`.
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
                  settings)
      .map([&](framegraph::Texture specular) {
        outputs.specular = specular;
        return outputs;
      });
}

}  // namespace

tl::expected<OcclusionOutputs, Error> add_occlusion(const Frame& frame,
                                                    const OcclusionInputs& inputs,
                                                    const OcclusionSettings& settings,
                                                    std::string_view history_name) {
  if (auto good = validate(settings); !good) {
    return tl::unexpected(std::move(good.error()));
  }
  const auto depth = add_linear(frame, inputs, settings);
  if (!depth) {
    return tl::unexpected(depth.error());
  }
  framegraph::Texture normals = inputs.normals;
  const bool in_view_space = inputs.normals_in_view_space || !normals;
  // Normals from depth are signed vectors in a view space with the camera along -Z.
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
  const auto back_line = add_hidden_inverse_depth(frame, inputs.back_depth_ndc,
                                                  needs_back_depth(settings), "back inverse depth");
  const auto second_line = add_hidden_inverse_depth(
      frame, inputs.second_depth_ndc, needs_second_depth(settings), "second inverse depth");
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
                                      settings);
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
                                        settings, history_name);
  if (!filtered) {
    return tl::unexpected(filtered.error());
  }
  const OcclusionOutputs outputs{filtered->visibility, filtered->bent_normal, filtered->specular,
                                 *depth, normals};
  return specular_reads_bent_normal(settings)
             ? add_model(frame, outputs, inputs, in_view_space, settings)
             : tl::expected<OcclusionOutputs, Error>(outputs);
}

}  // namespace alcove::passes
