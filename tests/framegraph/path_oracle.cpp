#include "path_oracle.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace alcove::framegraph {
namespace {

constexpr VkAccessFlags2 kWriteMask =
    VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
    VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;

// An access of a pass, a layout change, or what came before or comes after the frame.
struct Operation {
  std::uint32_t resource = 0;
  std::uint32_t sub = 0;
  VkPipelineStageFlags2 stages = 0;
  VkAccessFlags2 access = 0;
  bool writes = false;
  bool discards = false;
  std::uint32_t frame = 0;
  std::uint32_t step = 0;  // barriers of steps at or above this come after it
  const Transition* change = nullptr;
};

// The barriers recorded by one command; several frames' worth are numbered through.
struct Step {
  std::vector<const Transition*> barriers;
};

class Oracle {
 public:
  Oracle(const GraphDescription& graph, const Plan& plan) : graph_(graph), plan_(plan) {}

  std::string run() {
    for (std::uint32_t frame = 0; frame < 2; ++frame) unroll(frame);
    for (std::size_t y = 0; y < operations_.size(); ++y) {
      for (std::size_t x = 0; x < y; ++x) {
        if (!conflict(x, y) || ordered(x, y)) continue;
        return describe(operations_[x]).append(" and ").append(describe(operations_[y]));
      }
    }
    return "";
  }

 private:
  void unroll(std::uint32_t frame) {
    for (std::uint32_t r = 0; r < graph_.resources.size(); ++r) {
      const std::uint32_t external = graph_.resources[r].external;
      if (external != kNone) outside(r, graph_.externals[external].arrival, frame);
    }
    for (const PlannedPass& planned : plan_.passes) {
      batches(planned.first_batch, planned.batch_count, frame);
      const auto accesses = graph_.pass_accesses(planned.pass);
      for (std::size_t i = 0; i < accesses.size(); ++i) {
        if (plan_.live_accesses[graph_.passes[planned.pass].first_access + i])
          add_access(accesses[i], frame);
      }
    }
    for (const Submission& s : plan_.submissions) batches(s.first_batch, s.batch_count, frame);
    for (std::uint32_t r = 0; r < graph_.resources.size(); ++r) {
      const std::uint32_t external = graph_.resources[r].external;
      if (external != kNone && graph_.externals[external].has_departure &&
          plan_.placements[r].first != kNone)
        outside(r, graph_.externals[external].departure, frame);
    }
  }

  void outside(std::uint32_t resource, const State& state, std::uint32_t frame) {
    AccessRecord access;
    access.stages = state.stages;
    access.access = state.access;
    access.flags = state.access & kWriteMask ? kWrite : 0u;
    access.resource = resource;
    access.range = whole(resource);
    if (state.stages != 0) add_access(access, frame);
  }

  Range whole(std::uint32_t resource) const {
    const ResourceRecord& r = graph_.resources[resource];
    return {0, static_cast<std::uint16_t>(r.mips), 0, static_cast<std::uint16_t>(r.layers)};
  }

  void add_access(const AccessRecord& access, std::uint32_t frame) {
    Operation operation;
    operation.stages = access.stages;
    operation.access = access.access;
    operation.writes = (access.flags & kWrite) != 0;
    operation.discards = (access.flags & kDiscard) != 0;
    add(operation, access.resource, access.range, frame);
  }

  void add(Operation operation, std::uint32_t resource, const Range& range, std::uint32_t frame) {
    const ResourceRecord& r = graph_.resources[resource];
    operation.resource = resource;
    operation.frame = frame;
    operation.step = static_cast<std::uint32_t>(steps_.size());
    if (r.kind == ResourceKind::buffer) {
      operations_.push_back(operation);
      return;
    }
    for (std::uint32_t layer = range.base_layer; layer < range.base_layer + range.layers; ++layer) {
      for (std::uint32_t mip = range.base_mip; mip < range.base_mip + range.mips; ++mip) {
        operation.sub = layer * r.mips + mip;
        operations_.push_back(operation);
      }
    }
  }

  void batches(std::uint32_t first, std::uint32_t count, std::uint32_t frame) {
    for (std::uint32_t b = first; b < first + count; ++b) {
      const Batch& batch = plan_.batches[b];
      Step step;
      for (std::uint32_t t = batch.first; t < batch.first + batch.count; ++t)
        step.barriers.push_back(&plan_.transitions[t]);
      steps_.push_back(step);
      for (const Transition* t : step.barriers) {
        if (t->resource == kNone) continue;
        Operation change;
        change.writes = change.discards = true;
        change.change = t;
        change.stages = t->dst_stages;
        change.access = t->dst_access;
        add(change, t->resource, t->range, frame);
      }
    }
  }

  bool overlap(std::uint32_t a, std::uint32_t b) const {
    const Placement& x = plan_.placements[a];
    const Placement& y = plan_.placements[b];
    return x.heap != kNone && x.heap == y.heap && x.offset < y.offset + y.size &&
           y.offset < x.offset + x.size;
  }

  bool conflict(std::size_t x_index, std::size_t y_index) const {
    const Operation& x = operations_[x_index];
    const Operation& y = operations_[y_index];
    if (!x.writes && !y.writes) return false;
    // One pass's accesses, and one command's changes, are not ordered among themselves.
    if (x.step == y.step && (x.change != nullptr) == (y.change != nullptr)) return false;
    const bool external = graph_.resources[x.resource].external != kNone;
    if (external && x.frame != y.frame) return false;
    return (x.resource == y.resource && x.sub == y.sub) ||
           (x.resource != y.resource && overlap(x.resource, y.resource));
  }

  // Whether something between the two does to the same subresource what makes `y` follow it
  // instead of `x`: a write for any, a read for a write.
  bool superseded(std::size_t x_index, std::size_t y_index) const {
    const Operation& x = operations_[x_index];
    const Operation& y = operations_[y_index];
    for (std::size_t i = x_index + 1; i < y_index; ++i) {
      const Operation& z = operations_[i];
      if (z.resource != y.resource || z.sub != y.sub) continue;
      if (z.step == y.step && z.change == nullptr && y.change == nullptr) continue;
      if (z.writes || (y.writes && x.writes)) return true;
    }
    return false;
  }

  bool covers(const Transition& t, const Operation& o) const {
    return t.resource == kNone || t.resource == o.resource || overlap(t.resource, o.resource);
  }

  // Walks the barriers between the two, from each stage of x.
  bool ordered(std::size_t x_index, std::size_t y_index) const {
    const Operation& x = operations_[x_index];
    const Operation& y = operations_[y_index];
    const bool same = x.resource == y.resource && x.sub == y.sub;
    // What y must see of x, beyond coming after it.
    VkAccessFlags2 sees = 0;
    if (x.writes && same && y.change == nullptr && !superseded(x_index, y_index)) sees = y.access;
    if (x.change) return reaches(x, y, x.stages, x.access, true, sees);
    for (VkPipelineStageFlags2 left = x.stages; left != 0; left &= left - 1) {
      if (!reaches(x, y, left & (~left + 1), 0, false, sees)) return false;
    }
    return true;
  }

  bool reaches(const Operation& x, const Operation& y, VkPipelineStageFlags2 from,
               VkAccessFlags2 seen_by, bool is_change, VkAccessFlags2 sees) const {
    // Stages that come after x, and those after which x is available besides; what they see.
    VkPipelineStageFlags2 after = is_change ? from : 0;
    VkPipelineStageFlags2 available = is_change ? from : 0;
    const VkAccessFlags2 writes = x.writes && !is_change ? x.access & kWriteMask : 0;
    struct Sight {
      VkPipelineStageFlags2 stages;
      VkAccessFlags2 access;
    };
    std::vector<Sight> sights;
    if (is_change) sights.push_back({from, seen_by});
    for (std::uint32_t s = x.step; s < y.step; ++s) {
      VkPipelineStageFlags2 next_after = after;
      VkPipelineStageFlags2 next_available = available;
      for (const Transition* t : steps_[s].barriers) {
        const bool direct = !is_change && (t->src_stages & from) != 0;
        const bool chained = (t->src_stages & after) != 0;
        if (s + 1 == y.step && y.change != nullptr && y.change != t) {
          // A change of this very command does not follow on its other barriers.
          continue;
        }
        const bool makes_available = (t->src_stages & available) != 0 ||
                                     (writes == 0 && (direct || chained)) ||
                                     (direct && covers(*t, x) && (writes & ~t->src_access) == 0);
        if (y.change == t && s + 1 == y.step)
          return (direct || chained) && (!x.writes || makes_available);
        if (!direct && !chained) continue;
        next_after |= t->dst_stages;
        if (!makes_available) continue;
        next_available |= t->dst_stages;
        const bool shows =
            t->resource == kNone || (t->resource != x.resource && overlap(t->resource, x.resource));
        if (shows) sights.push_back({t->dst_stages, t->dst_access});
      }
      after = next_after;
      available = next_available;
    }
    if (y.stages & ~(x.writes ? available : after)) return false;
    for (VkPipelineStageFlags2 left = y.stages; left != 0; left &= left - 1) {
      VkAccessFlags2 seen = 0;
      for (const Sight& sight : sights) {
        if (sight.stages & left & (~left + 1)) seen |= sight.access;
      }
      if (sees & ~seen) return false;
    }
    return true;
  }

  std::string describe(const Operation& o) const {
    return std::string(o.change   ? "change of "
                       : o.writes ? "write of "
                                  : "read of ")
        .append(graph_.resource_name(o.resource))
        .append(" after step ")
        .append(std::to_string(o.step));
  }

  const GraphDescription& graph_;
  const Plan& plan_;
  std::vector<Step> steps_;
  std::vector<Operation> operations_;
};

}  // namespace

std::string find_unordered_pair(const GraphDescription& graph, const Plan& plan) {
  return Oracle(graph, plan).run();
}

}  // namespace alcove::framegraph
