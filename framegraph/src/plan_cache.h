// A cache of compiled plans, looked up by the frame's declaration.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "alcove/framegraph/compile.h"
#include "pool.h"

namespace alcove::framegraph {

struct CachedPlan {
  std::optional<std::uint64_t> key;  // hash of the declaration; empty until the plan is kept
  GraphDescription declaration;      // without names
  Plan plan;
  std::uint64_t last_frame = 0;
  // The images and buffers of the transients. They are valid for one generation of the pool.
  std::uint64_t generation = 0;
  std::vector<Physical*> physical;
  // The imports and the history slots that passes use.
  std::vector<std::uint32_t> externals;
  std::uint64_t last_mark = 0;  // the last frame that wrote Physical::last_frame of the transients
};

class PlanCache {
 public:
  // Sets the largest number of plans, at least 1. Call it before the first plan is compiled.
  void set_capacity(std::size_t capacity) { capacity_ = capacity; }
  // Returns the plan of an equal declaration, or null if the cache has none. The plan that was
  // returned last is compared first, without hashing.
  CachedPlan* find(const GraphDescription& graph);
  // Returns an entry for a new plan. If the cache is full, the entry is that of the plan that was
  // unused for longest. find() finds the entry only after keep() was called for it.
  CachedPlan& room(std::uint64_t frame);
  void keep(CachedPlan& plan, const GraphDescription& graph);

 private:
  std::size_t capacity_ = 1;
  std::vector<std::unique_ptr<CachedPlan>> plans_;
  CachedPlan* last_ = nullptr;
};

}  // namespace alcove::framegraph
