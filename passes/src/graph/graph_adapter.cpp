#include "graph/graph_adapter.h"

#include <algorithm>
#include <cstdio>

namespace alcove::passes {

using framegraph::Access;
using framegraph::Contents;
using framegraph::Graph;
using framegraph::RecordContext;
using framegraph::Texture;

namespace {

bool is_image(const AlcoveWorkBinding& binding) {
  return binding.type == ALCOVE_BINDING_TYPE_FETCHED_IMAGE ||
         binding.type == ALCOVE_BINDING_TYPE_STORAGE_IMAGE;
}

Access access_of(const AlcoveWorkBinding& binding) {
  if (binding.type != ALCOVE_BINDING_TYPE_STORAGE_IMAGE) return framegraph::access::sampled_compute;
  if (binding.access == ALCOVE_WORK_ACCESS_READ) return framegraph::access::storage_read_compute;
  return binding.access == ALCOVE_WORK_ACCESS_WRITE
             ? framegraph::access::storage_write_compute
             : framegraph::access::storage_read_write_compute;
}

// Returns whether a pass that overwrites `texture` must keep its earlier contents: those of an
// import, of which the pass may write a part, as may earlier passes of the frame.
bool has_other_contents(const Graph& graph, Texture texture) {
  const framegraph::GraphDescription& declared = graph.description();
  if (texture.index >= declared.resources.size()) return false;
  const framegraph::ResourceRecord& record = declared.resources[texture.index];
  return record.origin == framegraph::Origin::imported &&
         (texture.version > 0 || declared.externals[record.external].has_contents != 0);
}

// The callback of a pass: it records one dispatch.
struct RecordDispatch {
  Pipelines::State* pipelines = nullptr;
  Pipeline pipeline;
  std::array<std::uint32_t, 3> groups{};
  std::uint32_t image_count = 0;
  std::uint32_t parameter_bytes = 0;
  std::array<Texture, ALCOVE_MAX_WORK_BINDINGS> images;
  std::array<std::byte, ALCOVE_MAX_WORK_PARAMETER_BYTES> parameters;

  void operator()(RecordContext& context) const {
    std::array<VkImageView, ALCOVE_MAX_WORK_BINDINGS> views;
    for (std::uint32_t i = 0; i < image_count; ++i) {
      // The constants say whether a history is read. One that is not is bound all the same.
      static_cast<void>(context.validity(images[i]));
      views[i] = context.view(images[i]);
    }
    pipelines->dispatch(context, pipeline, std::span<const VkImageView>(views).first(image_count),
                        std::span(parameters).first(parameter_bytes), groups);
  }
};

}  // namespace

HistoryName::HistoryName(std::uint32_t view_id, HistoryRole role) {
  std::snprintf(text_.data(), text_.size(), "%s of view %u",
                kHistoryNames.at(static_cast<std::size_t>(role)), static_cast<unsigned>(view_id));
}

AlcoveWorkInfo work_info(const Graph& graph, const AlcoveViewInfo& info, std::uint32_t index,
                         const ViewTextures& textures) {
  AlcoveWorkInfo result{.struct_size = sizeof(AlcoveWorkInfo), .view = info, .index = index};
  const auto& resources = graph.description().resources;
  for (std::size_t role = 0; role < textures.size(); ++role) {
    const Texture texture = textures[role];
    if (!texture) continue;
    const VkExtent3D size = graph.extent(texture);
    result.images[role] = {
        static_cast<std::uint32_t>(graph.format(texture)), size.width, size.height,
        texture.index < resources.size() ? std::uint32_t{resources[texture.index].samples} : 1u};
  }
  return result;
}

GraphAdapter::GraphAdapter(Graph& graph, Pipelines& pipelines, std::uint32_t view_id)
    : graph_(graph), pipelines_(pipelines.state()), view_id_(view_id), list_(pipelines_.scratch) {
  list_.set_history_source({[](void* user, HistoryRole role, const WorkBuilder::History& history) {
                              return static_cast<GraphAdapter*>(user)->declare_history(role,
                                                                                       history);
                            },
                            this});
}

bool GraphAdapter::declare_history(HistoryRole role, const WorkBuilder::History& history) {
  declared_.at(static_cast<std::size_t>(role)) = true;
  const VkExtent2D size = list_.size(history.current);
  const framegraph::TextureHistory texture_history = graph_.create_texture_history(
      HistoryName(view_id_, role),
      {list_.format(history.current), framegraph::Extent::absolute(size.width, size.height)});
  textures_[history.previous.index] = texture_history.previous();
  textures_[history.current.index] = texture_history.current;
  return texture_history.validity == framegraph::HistoryValidity::valid;
}

tl::expected<void, Error> GraphAdapter::add() {
  const AlcoveWork& work = list_.work();
  const std::span dispatches(work.dispatches, work.dispatch_count);
  std::array<Pipeline, ALCOVE_MAX_WORK_DISPATCHES> pipelines;
  for (std::size_t i = 0; i < dispatches.size(); ++i) {
    auto pipeline =
        pipelines_.get(shader_of_name(dispatches[i].shader),
                       std::span(dispatches[i].constants).first(dispatches[i].constant_count));
    if (!pipeline) return tl::unexpected(std::move(pipeline.error()));
    pipelines[i] = *pipeline;
  }
  for (std::uint32_t i = 0; i < work.resource_count; ++i) {
    const AlcoveWorkResource& resource = work.resources[i];
    if (resource.kind == ALCOVE_RESOURCE_KIND_TRANSIENT) {
      textures_[i] = graph_.create_texture(
          resource.name, {static_cast<VkFormat>(resource.format),
                          framegraph::Extent::absolute(resource.width, resource.height)});
    }
  }
  for (std::size_t i = 0; i < dispatches.size(); ++i) add(dispatches[i], pipelines[i]);
  return {};
}

void GraphAdapter::reset_other_histories() {
  for (const HistoryRole role : kHistoryRoles)
    if (!declared_.at(static_cast<std::size_t>(role)))
      graph_.reset_history(HistoryName(view_id_, role));
}

void GraphAdapter::add(const AlcoveWorkDispatch& dispatch, Pipeline pipeline) {
  auto pass = graph_.add_pass(dispatch.label);
  declare_accesses(pass, dispatch);
  RecordDispatch callback;
  callback.pipelines = &pipelines_;
  callback.pipeline = pipeline;
  std::ranges::copy(dispatch.groups, callback.groups.begin());
  for (const AlcoveWorkBinding& binding :
       std::span(dispatch.bindings).first(dispatch.binding_count)) {
    if (is_image(binding)) callback.images[callback.image_count++] = textures_[binding.resource];
  }
  callback.parameter_bytes = dispatch.parameter_bytes;
  std::ranges::copy(std::as_bytes(std::span(dispatch.parameters).first(dispatch.parameter_bytes)),
                    callback.parameters.begin());
  pass.record(callback);
}

// Declares one access for each texture, which combines all bindings of it.
void GraphAdapter::declare_accesses(framegraph::PassBuilder& pass,
                                    const AlcoveWorkDispatch& dispatch) {
  const auto bindings = std::span(dispatch.bindings).first(dispatch.binding_count);
  for (auto binding = bindings.begin(); binding != bindings.end(); ++binding) {
    const auto is_same = [&](const AlcoveWorkBinding& other) {
      return is_image(other) && textures_[other.resource] == textures_[binding->resource];
    };
    if (!is_image(*binding) || std::any_of(bindings.begin(), binding, is_same)) continue;
    Access access = access_of(*binding);
    std::uint32_t ways = binding->access;
    for (auto other = binding + 1; other != bindings.end(); ++other) {
      if (is_same(*other)) {
        access = access | access_of(*other);
        ways |= other->access;
      }
    }
    Texture& texture = textures_[binding->resource];
    if ((ways & ALCOVE_WORK_ACCESS_WRITE) == 0) {
      pass.read(texture, access);
      continue;
    }
    const bool keeps = (ways & ALCOVE_WORK_ACCESS_READ) != 0 || has_other_contents(graph_, texture);
    texture = pass.write(texture, access, {}, keeps ? Contents::keep : Contents::discard);
  }
}

}  // namespace alcove::passes
