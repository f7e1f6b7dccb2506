#include "alcove/passes/graph.h"
#include "graph/graph_adapter.h"
#include "surface_parameters.h"
#include "work/bindings.h"
#include "work/shader_table.h"

namespace alcove::passes {

using framegraph::Graph;
using framegraph::Texture;

tl::expected<void, Error> add_view(Graph& graph, Pipelines& pipelines, const AlcoveViewInfo& info,
                                   std::uint32_t index, ViewTextures& textures) {
  if (info.reset_history != 0) graph.reset_history(HistoryName(info.id, HistoryRole::visibility));
  GraphAdapter work(graph, pipelines, info.id);
  const AlcoveWorkInfo described = work_info(graph, info, index, textures);
  if (auto done = describe_view(work.list(), described); !done) return done;
  const AlcoveWork& list = work.list().work();
  for (std::uint32_t i = 0; i < list.resource_count; ++i)
    if (list.resources[i].role != ALCOVE_WORK_NONE)
      work.texture({i}) = textures.at(list.resources[i].role);
  if (auto added = work.add(); !added) return added;
  work.reset_other_histories();
  for (std::uint32_t i = 0; i < list.resource_count; ++i)
    if (list.resources[i].role != ALCOVE_WORK_NONE)
      textures.at(list.resources[i].role) = work.texture({i});
  return {};
}

tl::expected<void, Error> prepare_view(const Graph& graph, Pipelines& pipelines,
                                       const AlcoveViewInfo& info, const ViewTextures& textures) {
  const auto needed =
      list_pipelines(pipelines.state().scratch, work_info(graph, info, 0, textures));
  if (!needed) return tl::unexpected(needed.error());
  for (const AlcoveWorkPipeline& pipeline : *needed) {
    const auto result =
        pipelines.state().get(shader_of_name(pipeline.shader),
                              std::span(pipeline.constants).first(pipeline.constant_count));
    if (!result) return tl::unexpected(result.error());
  }
  return {};
}

void drop_view(Graph& graph, std::uint32_t id) {
  for (const HistoryRole role : kHistoryRoles) graph.drop_history(HistoryName(id, role));
}

tl::expected<SurfaceTextures, Error> add_surface(Graph& graph, Pipelines& pipelines,
                                                 const AlcoveCamera& camera, Texture depth) {
  GraphAdapter work(graph, pipelines, 0);
  const VkExtent2D size{graph.extent(depth).width, graph.extent(depth).height};
  const auto projection = projection_of(camera, size);
  if (!projection) return tl::unexpected(projection.error());
  WorkBuilder& list = work.list();
  const ResourceHandle input =
      list.add(ALCOVE_RESOURCE_KIND_INPUT, "depth", graph.format(depth), size);
  work.texture(input) = depth;
  // Linear depth has 32 bits because a half float ends at 65504, and its steps are visible as bands
  // at grazing angles.
  const ResourceHandle linear_depth =
      list.add_transient("linear depth", VK_FORMAT_R32_SFLOAT, size);
  const ResourceHandle normals =
      list.add_transient("normals from depth", VK_FORMAT_R16G16B16A16_SFLOAT, size);
  const NamedImage images[] = {
      {"depth_image", input}, {"linear_depth_image", linear_depth}, {"normal_image", normals}};
  const NamedConstant constants[] = {{"kPerspective", flag(projection->perspective)},
                                     {"kReversed", flag(projection->reversed)}};
  list.dispatch({.label = "surface",
                 .shader = Shader::surface,
                 .constants = constants,
                 .images = images,
                 .parameters = bytes_of(maths::SurfaceParameters{
                     projection->slope(), projection->inverse_depth_from_ndc}),
                 .size = {size.width, size.height, 1}});
  return list.result().and_then([&] { return work.add(); }).map([&] {
    return SurfaceTextures{work.texture(linear_depth), work.texture(normals)};
  });
}

}  // namespace alcove::passes
