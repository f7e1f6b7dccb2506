#include "plan_cache.h"

#include <algorithm>

namespace alcove::framegraph {

CachedPlan* PlanCache::find(const GraphDescription& graph) {
  if (last_ && same_declaration(last_->declaration, graph)) return last_;
  const std::uint64_t key = hash(graph);
  for (auto& cached : plans_) {
    if (cached->key == key && same_declaration(cached->declaration, graph)) {
      last_ = cached.get();
      return last_;
    }
  }
  return nullptr;
}

CachedPlan& PlanCache::room(std::uint64_t frame) {
  CachedPlan* room = nullptr;
  if (plans_.size() < capacity_) {
    plans_.push_back(std::make_unique<CachedPlan>());
    room = plans_.back().get();
  } else {
    room = std::min_element(plans_.begin(), plans_.end(), [](const auto& a, const auto& b) {
             return a->last_frame < b->last_frame;
           })->get();
  }
  room->declaration = {};
  room->key.reset();
  room->generation = 0;
  room->last_frame = frame;
  last_ = nullptr;
  return *room;
}

void PlanCache::keep(CachedPlan& plan, const GraphDescription& graph) {
  plan.declaration = graph;
  // Names are valid until the graph is reset only.
  plan.declaration.pass_names.clear();
  plan.declaration.resource_names.clear();
  plan.key = hash(graph);
  last_ = &plan;
}

}  // namespace alcove::framegraph
