#include <iostream>

#include "alcove/framegraph/compile.h"
#include "alcove/framegraph/print.h"
#include "cli/commands.h"
#include "cli/open_session.h"
#include "render/surfaces.h"

namespace alcove::sample {
namespace {

// Declares the frame of the occlusion, with placeholders for the images of the g-buffer.
tl::expected<void, std::string> declare(framegraph::Graph& graph, const Session& session,
                                        const Options& options) {
  const auto extent = framegraph::Extent::absolute(options.view.width, options.view.height);
  const auto texture = [&](const char* name, VkFormat format) {
    auto pass = graph.add_pass(name);
    const framegraph::Texture filled =
        pass.write(graph.create_texture(name, {format, extent}),
                   framegraph::access::color_attachment, {}, framegraph::Contents::discard);
    pass.record([](framegraph::RecordContext&) {});
    return filled;
  };
  const CameraMatrices matrices =
      camera_matrices(session.camera, options.view.width, options.view.height);
  passes::View view;
  view.clip_from_view = to_matrix(matrices.clip_from_view);
  view.view_from_world = to_matrix(matrices.view_from_world);
  const HiddenDepths hidden = hidden_depths_of(session.settings);
  Surfaces surfaces;
  surfaces.normals = options.occlusion.normals;
  if (!options.occlusion.roughness.empty()) {
    surfaces.roughness = options.occlusion.roughness.front();
  }
  surfaces.gbuffer.depth = texture("depth", VK_FORMAT_R32_SFLOAT);
  surfaces.gbuffer.normal = texture("normals", kNormalFormat);
  surfaces.gbuffer.albedo = texture("albedo and roughness", kAlbedoFormat);
  if (hidden.back_faces) {
    surfaces.back_depth = texture("back-face depth", VK_FORMAT_R32_SFLOAT);
  }
  if (hidden.second_layer) {
    surfaces.second_depth = texture("second depth", VK_FORMAT_R32_SFLOAT);
  }
  const auto outputs =
      passes::add_occlusion({graph, session.gpu->kernels(), view}, occlusion_inputs(surfaces),
                            with_roughness(session.settings, surfaces));
  if (!outputs) {
    return tl::unexpected(outputs.error().message);
  }
  for (const framegraph::Texture output :
       {outputs->visibility, outputs->bent_normal, outputs->specular}) {
    if (output) {
      graph.output(output);
    }
  }
  return {};
}

}  // namespace

tl::expected<std::string, std::string> plan_text(const Session& session, const Options& options) {
  framegraph::Graph graph;
  if (auto declared = declare(graph, session, options); !declared) {
    return tl::unexpected(declared.error());
  }
  const framegraph::GraphDescription& description = graph.description();
  const auto plan = framegraph::compile(description, session.gpu->executor().limits());
  if (!plan) {
    return tl::unexpected(framegraph::to_string(plan.error()));
  }
  const bool dot = options.graph_format == GraphFormat::kDot;
  return dot ? framegraph::print_dot(description, *plan)
             : framegraph::print_text(description, *plan);
}

tl::expected<void, std::string> run_graph(const Options& options) {
  const auto session = open_session(options);
  if (!session) {
    return tl::unexpected(session.error());
  }
  return plan_text(*session, options).map([](const std::string& text) { std::cout << text; });
}

}  // namespace alcove::sample
