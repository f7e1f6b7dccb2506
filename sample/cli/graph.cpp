#include <array>
#include <iostream>
#include <memory>
#include <span>
#include <string>

#include "alcove/alcove_work.h"
#include "alcove/framegraph/compile.h"
#include "alcove/framegraph/print.h"
#include "cli/commands.h"
#include "cli/open_session.h"
#include "render/surfaces.h"
#include "support/result.h"

namespace alcove::sample {
namespace {

AlcoveViewInfo view_of(const Session& session, const Options& options) {
  return view_info(
      gbuffer_view(session.camera, session.camera, {options.view.width, options.view.height}));
}

// Declares the frame of the occlusion, with placeholders for the images of the g-buffer.
Result<void> declare(framegraph::Graph& graph, const Session& session, const Options& options) {
  const auto extent = framegraph::Extent::absolute(options.view.width, options.view.height);
  const auto texture = [&](const char* name, VkFormat format) {
    auto pass = graph.add_pass(name);
    const framegraph::Texture filled =
        pass.write(graph.create_texture(name, {format, extent}),
                   framegraph::access::color_attachment, {}, framegraph::Contents::discard);
    pass.record([](framegraph::RecordContext&) {});
    return filled;
  };
  const HiddenDepths hidden = hidden_depths_of(session.settings);
  Surfaces surfaces;
  surfaces.normals = options.view.normals;
  if (!options.occlusion.roughness.empty())
    surfaces.roughness = options.occlusion.roughness.front();
  surfaces.gbuffer.depth = texture("depth", VK_FORMAT_R32_SFLOAT);
  surfaces.gbuffer.normal = texture("normals", kNormalFormat);
  surfaces.gbuffer.albedo = texture("albedo and roughness", kAlbedoFormat);
  if (hidden.back_faces)
    surfaces.gbuffer.back_depth = texture("back-face depth", VK_FORMAT_R32_SFLOAT);
  if (hidden.second_layer)
    surfaces.gbuffer.second_depth = texture("second depth", VK_FORMAT_R32_SFLOAT);
  ALCOVE_TRY(const auto outputs, add_occlusion(graph, *session.gpu, view_of(session, options), 0,
                                               surfaces, session.settings));
  for (const framegraph::Texture output :
       {outputs.visibility, outputs.bent_normal, outputs.specular})
    if (output) graph.output(output);
  return {};
}

// Returns a text that a function of the library writes.
template <typename Write>
std::string text_of(const Write& write) {
  std::string text(write(nullptr, 0) + 1, '\0');
  text.resize(write(text.data(), text.size()));
  return text;
}

// Prints the work of the occlusion as data, and the pipelines that its frames can need.
Result<void> print_work(const Session& session, const Options& options) {
  const OcclusionSettings& settings = session.settings;
  AlcoveWorkInfo info{.struct_size = sizeof info, .view = view_of(session, options)};
  info.view.settings = &settings;
  const auto add = [&](bool wanted, AlcoveImageRole role, VkFormat format) {
    if (wanted) {
      info.images[role] = {static_cast<std::uint32_t>(format), options.view.width,
                           options.view.height};
    }
  };
  const HiddenDepths hidden = hidden_depths_of(settings);
  add(true, ALCOVE_IMAGE_DEPTH, VK_FORMAT_R32_SFLOAT);
  add(options.view.normals != NormalSource::depth, ALCOVE_IMAGE_NORMALS, kNormalFormat);
  add(hidden.back_faces, ALCOVE_IMAGE_BACK_DEPTH, VK_FORMAT_R32_SFLOAT);
  add(hidden.second_layer, ALCOVE_IMAGE_SECOND_DEPTH, VK_FORMAT_R32_SFLOAT);
  add(settings.visibility, ALCOVE_IMAGE_VISIBILITY, VK_FORMAT_R8_UNORM);
  add(settings.bent_normal, ALCOVE_IMAGE_BENT_NORMAL, VK_FORMAT_R8G8B8A8_SNORM);
  add(settings.specular != ALCOVE_SPECULAR_NONE, ALCOVE_IMAGE_SPECULAR, VK_FORMAT_R8_UNORM);
  const auto work = std::make_unique<AlcoveWork>();
  char message[ALCOVE_MAX_MESSAGE];
  std::array<AlcoveWorkPipeline, ALCOVE_MAX_WORK_PIPELINES> pipelines;
  std::uint32_t count = pipelines.size();
  if (alcoveDescribeWork(&info, work.get(), message) != ALCOVE_SUCCESS ||
      alcoveListPipelines(&info, &count, pipelines.data(), message) != ALCOVE_SUCCESS)
    return tl::unexpected(std::string(message));
  std::cout << text_of([&](char* text, std::size_t size) {
    return alcovePrintWork(work.get(), text, size);
  }) << "pipelines of all frames\n";
  for (const AlcoveWorkPipeline& pipeline : std::span(pipelines).first(count)) {
    std::cout << "  " << pipeline.shader << ":";
    for (const auto& [id, value] : std::span(pipeline.constants).first(pipeline.constant_count))
      std::cout << " " << id << "=" << value;
    std::cout << "\n";
  }
  return {};
}

}  // namespace

Result<std::string> plan_text(const Session& session, const Options& options) {
  framegraph::Graph graph;
  ALCOVE_TRY_VOID(declare(graph, session, options));
  const framegraph::GraphDescription& description = graph.description();
  const auto plan = framegraph::compile(description, session.gpu->executor().limits());
  if (!plan) return tl::unexpected(framegraph::to_string(plan.error()));
  const bool dot = options.graph_format == GraphFormat::dot;
  return dot ? framegraph::print_dot(description, *plan)
             : framegraph::print_text(description, *plan);
}

Result<void> run_graph(const Options& options) {
  ALCOVE_TRY(const auto session, open_session(options));
  if (options.graph_format == GraphFormat::work) return print_work(session, options);
  return plan_text(session, options).map([](const std::string& text) { std::cout << text; });
}

}  // namespace alcove::sample
