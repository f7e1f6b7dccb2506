#include <utility>

#include "alcove/passes/work.h"
#include "work/bindings.h"
#include "work/mask_depth.h"
#include "work/view_parameters.h"
#include "work/view_work.h"

namespace alcove::passes {
namespace {

// Adds linear depth if an output or specular occlusion needs it.
tl::expected<framegraph::Texture, Error> describe_linear(WorkList& list, const WorkFrame& frame,
                                                         framegraph::Texture depth_ndc,
                                                         const OcclusionSettings& settings) {
  const bool read = settings.linear_depth || specular_reads_bent_normal(settings);
  return read ? describe_linear_depth(list, frame, depth_ndc)
              : tl::expected<framegraph::Texture, Error>(framegraph::Texture{});
}

// Adds specular occlusion from visibility and bent normals to `outputs`.
tl::expected<OcclusionOutputs, Error> describe_model(WorkList& list, const WorkFrame& frame,
                                                     OcclusionOutputs outputs,
                                                     const OcclusionInputs& inputs,
                                                     const OcclusionSettings& settings) {
  return describe_gtso(
             list, frame,
             {.visibility = outputs.visibility,
              .bent_normal = outputs.bent_normal,
              .normals = outputs.normals,
              .depth = outputs.linear_depth,
              .roughness = inputs.roughness,
              .normal_convention = inputs.normals ? inputs.normal_convention : kOwnNormals,
              .into = inputs.into.specular},
             settings)
      .map([&](framegraph::Texture specular) {
        outputs.specular = specular;
        return outputs;
      });
}

}  // namespace

tl::expected<OcclusionOutputs, Error> describe_occlusion(WorkList& list, const WorkFrame& frame,
                                                         const OcclusionInputs& inputs,
                                                         const OcclusionSettings& settings) {
  if (auto good = validate(settings); !good) return tl::unexpected(std::move(good.error()));
  const auto depths = describe_depths(list, frame, inputs);
  if (!depths) return tl::unexpected(depths.error());
  const VkFormat depth_format = stored_format(list, inputs.depth_ndc, inputs.depth_format);
  const auto depth = describe_linear(list, frame, depths->all, settings);
  if (!depth) return tl::unexpected(depth.error());
  framegraph::Texture normals = inputs.normals;
  if (!normals && specular_reads_bent_normal(settings)) {
    auto made = describe_normals(list, frame, *depth);
    if (!made) return tl::unexpected(std::move(made.error()));
    normals = *made;
  }
  GtaoInputs search{inputs};
  search.depth_ndc = depths->occluders;
  search.depth_format = depth_format;
  if (inputs.mask) search.receiver_depth_ndc = depths->receivers;
  const auto raw_occlusion = describe_gtao(list, frame, search, settings);
  if (!raw_occlusion) return tl::unexpected(raw_occlusion.error());
  ReconstructInputs filter{inputs, *raw_occlusion};
  filter.depth_ndc = depths->receivers;
  filter.depth_format = depth_format;
  const auto filtered = describe_reconstruct(list, frame, filter, settings);
  if (!filtered) return tl::unexpected(filtered.error());
  const OcclusionOutputs outputs{filtered->visibility, filtered->bent_normal, filtered->specular,
                                 *depth, normals};
  return specular_reads_bent_normal(settings)
             ? describe_model(list, frame, outputs, inputs, settings)
             : tl::expected<OcclusionOutputs, Error>(outputs);
}

tl::expected<OcclusionOutputs, Error> describe_view(WorkList& list, const WorkFrame& frame,
                                                    const ViewInputs& inputs,
                                                    const OcclusionSettings& settings) {
  auto outputs = describe_occlusion(list, frame, inputs.occlusion, settings);
  if (!outputs || !inputs.multi_bounce) return outputs;
  return describe_multi_bounce(list, frame,
                               {outputs->visibility, inputs.albedo, inputs.multi_bounce},
                               settings.precision)
      .map([&](framegraph::Texture) { return *outputs; });
}

}  // namespace alcove::passes
