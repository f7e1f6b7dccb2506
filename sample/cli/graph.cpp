#include <iostream>
#include <memory>

#include "alcove/framegraph/compile.h"
#include "alcove/framegraph/print.h"
#include "alcove/passes/work.h"
#include "cli/commands.h"
#include "cli/open_session.h"
#include "render/surfaces.h"
#include "support/result.h"

namespace alcove::sample {
namespace {

passes::Frame frame_of(framegraph::Graph& graph, const Session& session, const Options& options) {
  return pass_frame(
      graph, *session.gpu,
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
  surfaces.normals = options.occlusion.normals;
  if (!options.occlusion.roughness.empty())
    surfaces.roughness = options.occlusion.roughness.front();
  surfaces.gbuffer.depth = texture("depth", VK_FORMAT_R32_SFLOAT);
  surfaces.gbuffer.normal = texture("normals", kNormalFormat);
  surfaces.gbuffer.albedo = texture("albedo and roughness", kAlbedoFormat);
  if (hidden.back_faces)
    surfaces.gbuffer.back_depth = texture("back-face depth", VK_FORMAT_R32_SFLOAT);
  if (hidden.second_layer)
    surfaces.gbuffer.second_depth = texture("second depth", VK_FORMAT_R32_SFLOAT);
  ALCOVE_TRY(const auto outputs,
             add_occlusion(frame_of(graph, session, options), surfaces, session.settings));
  for (const framegraph::Texture output :
       {outputs.visibility, outputs.bent_normal, outputs.specular})
    if (output) graph.output(output);
  return {};
}

// Prints the work of the occlusion as data.
Result<void> print_work(const Session& session, const Options& options) {
  const auto work = std::make_unique<AlcoveWork>();
  passes::WorkList list(*work);
  const auto image = [&](bool wanted, AlcoveResourceKind kind, const char* name, VkFormat format) {
    return wanted ? list.add(kind, name, format, {options.view.width, options.view.height})
                  : framegraph::Texture{};
  };
  const auto input = [&](bool wanted, const char* name, VkFormat format) {
    return image(wanted, ALCOVE_RESOURCE_KIND_INPUT, name, format);
  };
  const auto output = [&](bool wanted, const char* name, VkFormat format) {
    return image(wanted, ALCOVE_RESOURCE_KIND_OUTPUT, name, format);
  };
  const passes::OcclusionSettings& settings = session.settings;
  const HiddenDepths hidden = hidden_depths_of(settings);
  const bool given_normals = options.occlusion.normals != NormalSource::depth;
  const passes::OcclusionInputs inputs{
      .depth_ndc = input(true, "depth", VK_FORMAT_R32_SFLOAT),
      .normals = input(given_normals, "normals", kNormalFormat),
      .back_depth_ndc = input(hidden.back_faces, "back-face depth", VK_FORMAT_R32_SFLOAT),
      .second_depth_ndc = input(hidden.second_layer, "second depth", VK_FORMAT_R32_SFLOAT),
      .into = {output(settings.visibility, "visibility", VK_FORMAT_R8_UNORM),
               output(settings.bent_normal, "bent normals", VK_FORMAT_R8G8B8A8_SNORM),
               output(settings.specular != passes::Specular::none, "specular occlusion",
                      VK_FORMAT_R8_UNORM)}};
  framegraph::Graph graph;
  const auto outputs = passes::describe_occlusion(
      list, {.view = frame_of(graph, session, options).view}, inputs, settings);
  if (!outputs) return tl::unexpected(outputs.error().message);
  std::cout << passes::print_work(*work);
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
