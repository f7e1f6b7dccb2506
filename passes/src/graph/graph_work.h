// Adds the dispatches of a list of work to a render graph.
#pragma once

#include <array>
#include <memory_resource>
#include <string>
#include <string_view>

#include "alcove/passes/work.h"

namespace alcove::passes {

// Assumptions about the histories of a list.
enum class Histories : std::uint8_t {
  of_graph,   // the graph's histories are declared, and it knows whether they are valid
  moving,     // valid, and the camera has moved
  unchanged,  // valid, and nothing has moved
};

// A list of work whose resources are textures of a graph. A description fills list(); add() then
// creates the transients and adds a pass for each dispatch.
class GraphWork {
 public:
  // `history_name` is the name of the view's histories in the graph. Without a name, the list must
  // have no histories.
  GraphWork(const Frame& frame, std::string_view history_name, Histories histories);
  GraphWork(const GraphWork&) = delete;
  GraphWork& operator=(const GraphWork&) = delete;

  WorkList& list() { return list_; }
  const WorkFrame& frame() const { return work_frame_; }

  // Returns the handle in the list of a texture of the graph. Null stays null.
  framegraph::Texture import(framegraph::Texture texture);
  // Returns the texture of the graph for a handle of the list, after add().
  framegraph::Texture texture(framegraph::Texture listed) const;

  // Creates the pipelines of all dispatches.
  [[nodiscard]] tl::expected<void, Error> create_pipelines();
  // Adds all dispatches to the graph. Call create_pipelines() first.
  void add();

 private:
  bool declare_history(HistoryRole role, const WorkList::History& history);
  void add(const AlcoveWorkDispatch& dispatch, Kernel kernel);
  void declare_accesses(framegraph::PassBuilder& pass, const AlcoveWorkDispatch& dispatch);

  const Frame& frame_;
  std::string_view history_name_;
  Histories histories_;
  WorkFrame work_frame_;
  AlcoveWork work_;
  WorkList list_;
  std::array<framegraph::Texture, ALCOVE_MAX_WORK_RESOURCES> textures_;  // parallel to resources
  std::array<Kernel, ALCOVE_MAX_WORK_DISPATCHES> kernels_;
  std::array<bool, ALCOVE_MAX_WORK_HISTORIES> declared_{};  // by HistoryRole
};

// The name of a history in the graph. The text is stored in the object, so that a frame that
// repeats an earlier one allocates no memory.
class HistoryName {
 public:
  HistoryName(std::string_view view, HistoryRole role);
  operator std::string_view() const { return text_; }

 private:
  std::array<std::byte, 128> room_;
  std::pmr::monotonic_buffer_resource memory_{room_.data(), room_.size()};
  std::pmr::string text_{&memory_};
};

inline constexpr std::array kHistoryRoles{HistoryRole::visibility, HistoryRole::depth,
                                          HistoryRole::bent_normal, HistoryRole::lobe};

}  // namespace alcove::passes
