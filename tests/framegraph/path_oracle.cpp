#include "path_oracle.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "trace.h"

namespace alcove::framegraph {
namespace {

// The stages whose next commands an operation's effects have reached.
struct Spread {
  // For each queue: the stages whose later commands are ordered after the operation, and the stages
  // for which the writes of the operation are also available.
  VkPipelineStageFlags2 after[kQueueClasses] = {};
  VkPipelineStageFlags2 available[kQueueClasses] = {};
};

struct Sight {
  std::size_t queue;
  VkPipelineStageFlags2 stages;
  VkAccessFlags2 access;
};

class Oracle {
 public:
  Oracle(const GraphDescription& graph, const Plan& plan)
      : graph_(graph), plan_(plan), trace_(trace_of(graph, plan)) {}

  std::string run() const {
    for (std::size_t y = 0; y < trace_.operations.size(); ++y) {
      for (std::size_t x = 0; x < y; ++x) {
        if (!conflict(x, y) || ordered(x, y)) continue;
        return describe(trace_.operations[x])
            .append(" and ")
            .append(describe(trace_.operations[y]));
      }
    }
    return "";
  }

 private:
  bool overlap(std::uint32_t a, std::uint32_t b) const {
    const Placement& x = plan_.placements[a];
    const Placement& y = plan_.placements[b];
    return x.heap != kNone && x.heap == y.heap && x.offset < y.offset + y.size &&
           y.offset < x.offset + x.size;
  }

  bool conflict(std::size_t x_index, std::size_t y_index) const {
    const Operation& x = trace_.operations[x_index];
    const Operation& y = trace_.operations[y_index];
    const bool leaves = y.departs && (x.queue != y.queue || (x.stages & ~y.stages) != 0);
    if (!x.writes && !y.writes && !leaves) return false;
    if (x.unordered && y.unordered && x.queue == y.queue && x.resource == y.resource &&
        x.stages == y.stages && x.access == y.access && x.frame == y.frame &&
        !is_between(x_index, y_index))
      return false;
    // The accesses of one pass, and the layout changes of one command, are not ordered among each
    // other.
    if (x.queue == y.queue && x.step == y.step && (x.change != nullptr) == (y.change != nullptr))
      return false;
    const bool external = graph_.resources[x.resource].external != kNone;
    if (external && x.frame != y.frame) return false;
    return (x.resource == y.resource && x.sub == y.sub) ||
           (x.resource != y.resource && overlap(x.resource, y.resource));
  }

  // Returns whether the subresource of y is used between x and y by an operation other than an
  // unordered write with the same access.
  bool is_between(std::size_t x_index, std::size_t y_index) const {
    const Operation& y = trace_.operations[y_index];
    for (std::size_t i = x_index + 1; i < y_index; ++i) {
      const Operation& z = trace_.operations[i];
      if (z.resource == y.resource && z.sub == y.sub &&
          !(z.unordered && z.stages == y.stages && z.access == y.access && z.queue == y.queue))
        return true;
    }
    return false;
  }

  // Returns whether the bytes of one resource include all bytes of another.
  bool holds(std::uint32_t outer, std::uint32_t inner) const {
    const Placement& x = plan_.placements[outer];
    const Placement& y = plan_.placements[inner];
    return overlap(outer, inner) && x.offset <= y.offset && x.offset + x.size >= y.offset + y.size;
  }

  // Returns whether an operation between the two takes the place of `x`, so that `y` only has to
  // follow that operation: a write to the same subresource, a read if `y` writes, or another
  // resource that took all the bytes.
  bool superseded(std::size_t x_index, std::size_t y_index) const {
    const Operation& x = trace_.operations[x_index];
    const Operation& y = trace_.operations[y_index];
    for (std::size_t i = x_index + 1; i < y_index; ++i) {
      const Operation& z = trace_.operations[i];
      if (z.resource != y.resource && z.writes && holds(z.resource, y.resource)) return true;
      if (z.resource != y.resource || z.sub != y.sub) continue;
      if (z.step == y.step && z.change == nullptr && y.change == nullptr) continue;
      if (z.writes || (y.writes && x.writes)) return true;
    }
    return false;
  }

  bool covers(const Transition& t, const Operation& o) const {
    return t.resource == kNone || t.resource == o.resource || overlap(t.resource, o.resource);
  }

  // Returns whether from each stage of x a path of barriers and semaphores leads to y.
  bool ordered(std::size_t x_index, std::size_t y_index) const {
    const Operation& x = trace_.operations[x_index];
    const Operation& y = trace_.operations[y_index];
    const bool same = x.resource == y.resource && x.sub == y.sub;
    // The accesses of y to which the writes of x must be visible. If there are none, y only has to
    // come after x.
    VkAccessFlags2 sees = 0;
    if (x.writes && same && y.change == nullptr && !superseded(x_index, y_index)) sees = y.access;
    if (x.change) return Walk(*this, x_index, 0).reaches(y, sees);
    for (VkPipelineStageFlags2 left = x.stages; left != 0; left &= left - 1)
      if (!Walk(*this, x_index, left & (~left + 1)).reaches(y, sees)) return false;
    return true;
  }

  // Follows the steps after one stage of an operation, or after a layout change.
  class Walk {
   public:
    Walk(const Oracle& oracle, std::size_t from, VkPipelineStageFlags2 stage)
        : oracle_(oracle), x_(oracle.trace_.operations[from]), from_(from), stage_(stage) {
      if (x_.change) {
        now_.after[x_.queue] = now_.available[x_.queue] = x_.stages;
        sights_.push_back({x_.queue, x_.stages, x_.access});
      } else if (x_.writes) {
        writes_ = x_.access & kWriteMask;
      }
    }

    bool reaches(const Operation& y, VkAccessFlags2 sees) {
      for (std::uint32_t s = x_.step; s < y.step; ++s) {
        before_.push_back(now_);
        const Step& step = oracle_.trace_.steps[s];
        const bool changes = s + 1 == y.step && y.change != nullptr && y.queue == step.queue;
        if (changes && step.kind == Step::Kind::barriers) return reaches_change(step, *y.change);
        if (step.kind == Step::Kind::barriers)
          pass_barriers(step);
        else if (step.kind == Step::Kind::ends)
          pass_end(step);
        else
          pass_begin(step);
      }
      const VkPipelineStageFlags2 there = x_.writes ? now_.available[y.queue] : now_.after[y.queue];
      return (y.stages & ~there) == 0 && is_seen(y, sees);
    }

   private:
    struct Reach {
      bool before = false;
      bool available = false;
    };
    // Returns whether x is in the first scope of a barrier.
    Reach reach(const Step& step, const Transition& t) const {
      const VkPipelineStageFlags2 src = plain(t.src_stages);
      Spread known;
      if (step.steps_before >= x_.step) {
        const std::size_t index = step.steps_before - x_.step;
        known = index < before_.size() ? before_[index] : now_;
      }
      const bool direct = x_.change == nullptr && x_.queue == step.queue &&
                          from_ < step.operations_before && (src & stage_) != 0;
      // A barrier before x does not affect it.
      const bool chained = from_ < step.operations_before && (src & known.after[step.queue]) != 0;
      if (!direct && !chained) return {};
      return {true, (src & known.available[step.queue]) != 0 || writes_ == 0 ||
                        (direct && oracle_.covers(t, x_) &&
                         (writes_ & ~plain_access(t.src_access)) == 0)};
    }

    bool reaches_change(const Step& step, const Transition& change) const {
      const Reach r = reach(step, change);
      return r.before && (!x_.writes || r.available);
    }

    // The barriers of one command are not ordered among each other.
    void pass_barriers(const Step& step) {
      Spread next = now_;
      for (const Transition* t : step.barriers) {
        const Reach r = reach(step, *t);
        if (!r.before) continue;
        next.after[step.queue] |= plain(t->dst_stages);
        if (!r.available) continue;
        next.available[step.queue] |= plain(t->dst_stages);
        const bool shows = t->resource == kNone || (t->resource != x_.resource &&
                                                    oracle_.overlap(t->resource, x_.resource));
        if (shows)
          sights_.push_back({step.queue, plain(t->dst_stages), plain_access(t->dst_access)});
      }
      now_ = next;
    }

    // A semaphore signal comes after all earlier work of its queue and makes all of it available.
    void pass_end(const Step& step) {
      const bool own = x_.queue == step.queue && (x_.change == nullptr || x_.releases);
      if (own || now_.after[step.queue] != 0) signalled_.push_back(step.submission);
    }

    void pass_begin(const Step& step) {
      for (const Wait& wait : step.waits) {
        if (std::find(signalled_.begin(), signalled_.end(), wait.submission) == signalled_.end())
          continue;
        now_.after[step.queue] |= plain(wait.stages);
        now_.available[step.queue] |= plain(wait.stages);
        sights_.push_back({step.queue, plain(wait.stages), ~VkAccessFlags2{0}});
      }
    }

    bool is_seen(const Operation& y, VkAccessFlags2 sees) const {
      for (VkPipelineStageFlags2 left = y.stages; left != 0; left &= left - 1) {
        VkAccessFlags2 seen = 0;
        for (const Sight& sight : sights_)
          if (sight.queue == y.queue && (sight.stages & left & (~left + 1))) seen |= sight.access;
        if (sees & ~seen) return false;
      }
      return true;
    }

    const Oracle& oracle_;
    const Operation& x_;
    std::size_t from_;
    VkPipelineStageFlags2 stage_;
    VkAccessFlags2 writes_ = 0;
    Spread now_;
    std::vector<Spread> before_;  // for each step from x's step on: the spread before that step
    std::vector<Sight> sights_;
    std::vector<std::uint32_t> signalled_;
  };

  std::string describe(const Operation& o) const {
    return std::string(o.change   ? "change of "
                       : o.writes ? "write of "
                                  : "read of ")
        .append(graph_.resource_name(o.resource))
        .append(" after step ")
        .append(std::to_string(o.step))
        .append(" on queue ")
        .append(std::to_string(o.queue));
  }

  const GraphDescription& graph_;
  const Plan& plan_;
  const Trace trace_;
};

}  // namespace

std::string find_unordered_pair(const GraphDescription& graph, const Plan& plan) {
  return Oracle(graph, plan).run();
}

}  // namespace alcove::framegraph
