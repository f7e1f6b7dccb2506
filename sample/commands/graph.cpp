#include <iostream>

#include "alcove/framegraph/compile.h"
#include "alcove/framegraph/print.h"
#include "commands/commands.h"
#include "options/settings.h"
#include "render/frame_renderer.h"
#include "render/surfaces.h"
#include "scene/load_scene.h"

namespace alcove::sample {
namespace {

// The occlusion's frame as the sample declares it, with images that stand for an engine's.
tl::expected<void, std::string> declare(framegraph::Graph& graph, Gpu& gpu, const Options& options,
                                        const passes::OcclusionSettings& settings) {
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
      camera_matrices(Camera{}, options.view.width, options.view.height);
  passes::View view;
  view.clip_from_view = to_matrix(matrices.clip_from_view);
  const passes::Frame frame{graph, gpu.kernels(), view, 0, view};
  passes::OcclusionInputs inputs{.depth_ndc = texture("depth", VK_FORMAT_R32_SFLOAT)};
  if (options.occlusion.normals != NormalSource::kDepth) {
    inputs.normals = texture("normals", kNormalFormat);
  }
  if (passes::needs_back_depth(settings.estimator, settings.thickness_unit)) {
    inputs.back_depth_ndc = texture("back-face depth", VK_FORMAT_R32_SFLOAT);
  }
  if (passes::needs_second_depth(settings.estimator, settings.depth_layers)) {
    inputs.second_depth_ndc = texture("second depth", VK_FORMAT_R32_SFLOAT);
  }
  const auto outputs = passes::add_occlusion(frame, inputs, settings);
  if (!outputs) {
    return tl::unexpected(outputs.error().message);
  }
  graph.output(outputs->visibility);
  if (outputs->bent_normal) {
    graph.output(outputs->bent_normal);
  }
  return {};
}

}  // namespace

tl::expected<void, std::string> run_graph(const Options& options) {
  const auto scene = load_scene(options.scene);
  if (!scene) {
    return tl::unexpected(scene.error());
  }
  const auto settings = occlusion_settings(options.occlusion, *scene);
  if (!settings) {
    return tl::unexpected(settings.error());
  }
  auto gpu = Gpu::create({.validation = options.validation, .index = options.device});
  if (!gpu) {
    return tl::unexpected(gpu.error());
  }
  framegraph::Graph graph;
  if (auto declared = declare(graph, **gpu, options, *settings); !declared) {
    return tl::unexpected(declared.error());
  }
  const framegraph::GraphDescription& description = graph.description();
  const auto plan = framegraph::compile(description, (*gpu)->executor().limits());
  if (!plan) {
    return tl::unexpected(framegraph::to_string(plan.error()));
  }
  switch (options.graph_format) {
    case GraphFormat::kJson:
      std::cout << framegraph::print_json(description, *plan);
      break;
    case GraphFormat::kDot:
      std::cout << framegraph::print_dot(description, *plan);
      break;
    default:
      std::cout << framegraph::print_text(description, *plan);
  }
  return {};
}

}  // namespace alcove::sample
