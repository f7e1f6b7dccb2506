// Compiled plans, found again by the declarations themselves.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "alcove/framegraph/compile.h"
#include "pool.h"

namespace alcove::framegraph {

struct CachedPlan {
  std::optional<std::uint64_t> key;  // the hash of the declaration; none until the plan is kept
  GraphDescription declaration;      // names are those of the frame that made it
  Plan plan;
  std::uint64_t last_frame = 0;
  // The transients' physical side, right for one generation of the pool.
  std::uint64_t generation = 0;
  std::vector<Physical*> physical;
};

class PlanCache {
 public:
  // At least 1; before the first plan.
  void set_capacity(std::size_t capacity) { capacity_ = capacity; }
  // A plan for these declarations; null when they were not seen lately. The last one is tried
  // first, without hashing.
  CachedPlan* find(const GraphDescription& graph);
  // Room for a new one, replacing the one unused for longest; it counts only once kept.
  CachedPlan& room(std::uint64_t frame);
  void keep(CachedPlan& plan, const GraphDescription& graph);

 private:
  std::size_t capacity_ = 1;
  std::vector<std::unique_ptr<CachedPlan>> plans_;
  CachedPlan* last_ = nullptr;
};

}  // namespace alcove::framegraph
