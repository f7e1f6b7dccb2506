#include <functional>
#include <iostream>
#include <memory>

#include "alcove/framegraph/compile.h"
#include "alcove/framegraph/print.h"
#include "alcove/passes/work.h"
#include "cli/commands.h"
#include "cli/open_session.h"
#include "render/surfaces.h"

namespace alcove::sample {
namespace {

using MakeTexture = std::function<framegraph::Texture(const char* name, VkFormat format)>;

// The images of the g-buffer, with placeholders that `texture` makes.
Surfaces placeholders(const Session& session, const Options& options, const MakeTexture& texture) {
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
  return surfaces;
}

passes::View view_of(const Session& session, const Options& options) {
  const CameraMatrices matrices =
      camera_matrices(session.camera, options.view.width, options.view.height);
  passes::View view;
  view.clip_from_view = to_matrix(matrices.clip_from_view);
  view.view_from_world = to_matrix(matrices.view_from_world);
  return view;
}

// Declares the frame of the occlusion.
tl::expected<void, std::string> declare(framegraph::Graph& graph, Session& session,
                                        const Options& options) {
  const auto extent = framegraph::Extent::absolute(options.view.width, options.view.height);
  const Surfaces surfaces = placeholders(session, options, [&](const char* name, VkFormat format) {
    auto pass = graph.add_pass(name);
    const framegraph::Texture filled =
        pass.write(graph.create_texture(name, {format, extent}),
                   framegraph::access::color_attachment, {}, framegraph::Contents::discard);
    pass.record([](framegraph::RecordContext&) {});
    return filled;
  });
  const auto outputs =
      passes::add_occlusion({graph, session.gpu->kernels(), view_of(session, options)},
                            occlusion_inputs(surfaces), with_roughness(session.settings, surfaces));
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

// Prints the work of the occlusion as data.
tl::expected<void, std::string> print_work(const Session& session, const Options& options) {
  const VkExtent2D size{options.view.width, options.view.height};
  const auto work = std::make_unique<AlcoveWork>();
  passes::WorkList list(*work);
  const Surfaces surfaces = placeholders(session, options, [&](const char* name, VkFormat format) {
    return list.add(ALCOVE_RESOURCE_KIND_INPUT, name, format, size);
  });
  const passes::OcclusionSettings settings = with_roughness(session.settings, surfaces);
  passes::OcclusionInputs inputs = occlusion_inputs(surfaces);
  const auto output = [&](bool wanted, const char* name, VkFormat format) {
    return wanted ? list.add(ALCOVE_RESOURCE_KIND_OUTPUT, name, format, size)
                  : framegraph::Texture{};
  };
  inputs.into = {output(settings.visibility, "visibility", VK_FORMAT_R8_UNORM),
                 output(settings.bent_normal, "bent normals", VK_FORMAT_R8G8B8A8_SNORM),
                 output(settings.specular != passes::Specular::none, "specular occlusion",
                        VK_FORMAT_R8_UNORM)};
  const auto outputs =
      passes::describe_occlusion(list, {.view = view_of(session, options)}, inputs, settings);
  if (!outputs) {
    return tl::unexpected(outputs.error().message);
  }
  std::cout << passes::print_work(*work);
  return {};
}

}  // namespace

tl::expected<void, std::string> run_graph(const Options& options) {
  auto session = open_session(options);
  if (!session) {
    return tl::unexpected(session.error());
  }
  if (options.graph_format == GraphFormat::kWork) {
    return print_work(*session, options);
  }
  framegraph::Graph graph;
  if (auto declared = declare(graph, *session, options); !declared) {
    return tl::unexpected(declared.error());
  }
  const framegraph::GraphDescription& description = graph.description();
  const auto plan = framegraph::compile(description, session->gpu->executor().limits());
  if (!plan) {
    return tl::unexpected(framegraph::to_string(plan.error()));
  }
  const bool dot = options.graph_format == GraphFormat::kDot;
  std::cout << (dot ? framegraph::print_dot(description, *plan)
                    : framegraph::print_text(description, *plan));
  return {};
}

}  // namespace alcove::sample
