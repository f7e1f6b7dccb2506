// Adds the dispatches of a list of work to a render graph.
#pragma once

#include <array>
#include <string_view>

#include "alcove/passes/graph.h"
#include "vulkan/pipeline_state.h"
#include "work/describe_view.h"

namespace alcove::passes {

// A list of work whose resources are textures of a graph. A description fills list(); add() then
// creates the transients and adds a pass for each dispatch. The list is that of the pipelines
// (Pipelines::State::scratch), so only one object may exist at a time.
class GraphAdapter {
 public:
  GraphAdapter(framegraph::Graph& graph, Pipelines& pipelines, std::uint32_t view_id);
  GraphAdapter(const GraphAdapter&) = delete;
  GraphAdapter& operator=(const GraphAdapter&) = delete;

  WorkBuilder& list() { return list_; }
  // The texture of the graph for a resource of the list. Those of the engine are set before add().
  framegraph::Texture& texture(ResourceHandle listed) { return textures_.at(listed.index); }

  // Creates the pipelines of all dispatches, and adds the dispatches to the graph.
  [[nodiscard]] tl::expected<void, Error> add();

  // Resets the histories that the list does not have: they will be out of date when they are wanted
  // again.
  void reset_other_histories();

 private:
  bool declare_history(HistoryRole role, const WorkBuilder::History& history);
  void add(const AlcoveWorkDispatch& dispatch, Pipeline pipeline);
  void declare_accesses(framegraph::PassBuilder& pass, const AlcoveWorkDispatch& dispatch);

  framegraph::Graph& graph_;
  Pipelines::State& pipelines_;
  std::uint32_t view_id_;
  WorkBuilder list_;
  std::array<framegraph::Texture, ALCOVE_MAX_WORK_RESOURCES> textures_;  // parallel to resources
  std::array<bool, ALCOVE_MAX_WORK_HISTORIES> declared_{};               // by HistoryRole
};

// Describes a view with textures of a graph.
[[nodiscard]] AlcoveWorkInfo work_info(const framegraph::Graph& graph, const AlcoveViewInfo& info,
                                       std::uint32_t index, const ViewTextures& textures);

// The name of a view's history in the graph. The text is stored in the object, so that a frame that
// repeats an earlier one allocates no memory.
class HistoryName {
 public:
  HistoryName(std::uint32_t view_id, HistoryRole role);
  operator std::string_view() const { return text_.data(); }

 private:
  std::array<char, 40> text_{};  // "bent-normal history of view 4294967295"
};

inline constexpr std::array kHistoryRoles{HistoryRole::visibility, HistoryRole::depth,
                                          HistoryRole::bent_normal, HistoryRole::lobe};

}  // namespace alcove::passes
