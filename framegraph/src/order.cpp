// Order: the order of declaration, unless another order lowers the memory peak.
//
// The other order is built greedily: of the passes whose inputs are ready, the next one is the pass
// after which the fewest bytes are live, or the earliest declared one among equals. If no order
// could have a lower peak, none is built. compile() schedules both orders and uses the one that
// takes fewer bytes.
#include <algorithm>

#include "workspace.h"

namespace alcove::framegraph {
namespace {

class Orderer {
 public:
  Orderer(const GraphDescription& graph, const Limits& limits, Workspace& workspace,
          const Plan& plan)
      : graph_(graph), limits_(limits), workspace_(workspace), plan_(plan), s_(workspace.reorder) {}

  bool run() {
    const std::size_t live = plan_.passes.size();
    if (limits_.ordering != Ordering::lower_peak || !limits_.alias || live < 3 ||
        live > limits_.reorder_passes)
      return false;
    s_.declared.clear();
    for (std::uint32_t pass = 0; pass < graph_.passes.size(); ++pass) {
      if (plan_.cull_reasons[pass].is_live()) s_.declared.push_back(pass);
    }
    measure();
    std::int64_t floor = 0;
    const std::int64_t peak = peak_as_declared(floor);
    // All resources of one pass are live at the same time in any order of passes. `floor` is the
    // largest sum of one pass. If the peak is no higher than that, no order is better.
    if (peak <= floor) return false;
    find_edges();
    return list_greedily(peak) < peak && s_.order.size() == live;
  }

 private:
  // Finds the size of each transient in bytes and the number of passes that use it.
  void measure() {
    s_.bytes.assign(graph_.resources.size(), 0);
    s_.uses.assign(graph_.resources.size(), 0);
    s_.seen.assign(graph_.resources.size(), kNone);
    for (const std::uint32_t r : workspace_.transients)
      s_.bytes[r] = static_cast<std::int64_t>(plan_.placements[r].size);
    for (const std::uint32_t pass : s_.declared) {
      for_each_live(graph_, plan_, pass, [&](const AccessRecord& access) {
        if (s_.bytes[access.resource] == 0 || s_.seen[access.resource] == pass) return;
        s_.seen[access.resource] = pass;
        ++s_.uses[access.resource];
      });
    }
    // The memory of an output is in use until the end of the frame.
    for (const OutputRecord& output : graph_.outputs) ++s_.uses[output.resource];
  }

  // The change of memory by one pass: the bytes that become live when it runs (`gained`), the bytes
  // that are free after it (`freed`), and the bytes of all transients that it uses (`own`).
  struct Step {
    std::int64_t gained = 0;
    std::int64_t freed = 0;
    std::int64_t own = 0;
  };
  Step step(std::uint32_t pass) {
    Step result;
    ++stamp_;
    for_each_live(graph_, plan_, pass, [&](const AccessRecord& access) {
      const std::uint32_t r = access.resource;
      if (s_.bytes[r] == 0 || s_.stamp[r] == stamp_) return;
      s_.stamp[r] = stamp_;
      result.own += s_.bytes[r];
      if (!s_.begun[r]) result.gained += s_.bytes[r];
      if (s_.left[r] == 1) result.freed += s_.bytes[r];
    });
    return result;
  }

  void begin_walk() {
    s_.left = s_.uses;
    s_.begun.assign(graph_.resources.size(), 0);
    s_.stamp.resize(std::max(s_.stamp.size(), graph_.resources.size()));
    std::fill(s_.stamp.begin(), s_.stamp.end(), 0u);
    stamp_ = 0;
  }

  void take(std::uint32_t pass) {
    ++stamp_;
    for_each_live(graph_, plan_, pass, [&](const AccessRecord& access) {
      if (s_.stamp[access.resource] == stamp_) return;
      s_.stamp[access.resource] = stamp_;
      s_.begun[access.resource] = 1;
      if (s_.left[access.resource] != 0) --s_.left[access.resource];
    });
  }

  std::int64_t peak_as_declared(std::int64_t& floor) {
    begin_walk();
    std::int64_t live = 0;
    std::int64_t peak = 0;
    for (const std::uint32_t pass : s_.declared) {
      const Step s = step(pass);
      floor = std::max(floor, s.own);
      peak = std::max(peak, live + s.gained);
      live += s.gained - s.freed;
      take(pass);
    }
    return peak;
  }

  void add_edge(std::uint32_t from, std::uint32_t to) {
    if (from == kNone || from == to) return;
    s_.edges.push_back({to, s_.first_edge[from]});
    s_.first_edge[from] = static_cast<std::uint32_t>(s_.edges.size() - 1);
    ++s_.waiting[to];
  }

  // Finds which passes must come before which: a read follows the last write; a write follows the
  // last write and all reads since; passes with side effects keep their declared order.
  void find_edges() {
    s_.edges.clear();
    s_.first_edge.assign(graph_.passes.size(), kNone);
    s_.waiting.assign(graph_.passes.size(), 0);
    s_.writer.assign(workspace_.first_sub.back(), kNone);
    s_.first_reader.assign(workspace_.first_sub.back(), kNone);
    s_.readers.clear();
    std::uint32_t last_effect = kNone;
    for (const std::uint32_t pass : s_.declared) {
      for_each_live(graph_, plan_, pass, [&](const AccessRecord& access) {
        for_each_sub(graph_, workspace_, access,
                     [&](std::uint32_t sub) { depend(pass, sub, access.flags & kWrite); });
      });
      if ((graph_.passes[pass].flags & kSideEffect) == 0) continue;
      add_edge(last_effect, pass);
      last_effect = pass;
    }
  }

  void depend(std::uint32_t pass, std::uint32_t sub, bool writes) {
    add_edge(s_.writer[sub], pass);
    if (!writes) {
      s_.readers.push_back({pass, s_.first_reader[sub]});
      s_.first_reader[sub] = static_cast<std::uint32_t>(s_.readers.size() - 1);
      return;
    }
    for (std::uint32_t i = s_.first_reader[sub]; i != kNone; i = s_.readers[i].next)
      add_edge(s_.readers[i].pass, pass);
    s_.first_reader[sub] = kNone;
    s_.writer[sub] = pass;
  }

  std::int64_t list_greedily(std::int64_t limit) {
    begin_walk();
    s_.order.clear();
    s_.ready.clear();
    for (const std::uint32_t pass : s_.declared) {
      if (s_.waiting[pass] == 0) s_.ready.push_back(pass);
    }
    std::int64_t live = 0;
    std::int64_t peak = 0;
    while (!s_.ready.empty()) {
      const std::size_t chosen = choose(live, peak);
      const std::uint32_t pass = s_.ready[chosen];
      s_.ready.erase(s_.ready.begin() + static_cast<std::ptrdiff_t>(chosen));
      const Step s = step(pass);
      peak = std::max(peak, live + s.gained);
      if (peak >= limit) return peak;
      live += s.gained - s.freed;
      take(pass);
      s_.order.push_back(pass);
      for (std::uint32_t e = s_.first_edge[pass]; e != kNone; e = s_.edges[e].next) {
        const std::uint32_t follower = s_.edges[e].pass;
        if (--s_.waiting[follower] == 0) s_.ready.push_back(follower);
      }
    }
    return peak;
  }

  // Returns the index of the ready pass that runs next: the one after which the fewest bytes are
  // live. Passes that do not raise the peak so far are preferred to those that do.
  std::size_t choose(std::int64_t live, std::int64_t peak) {
    std::size_t best = 0;
    bool best_below = false;
    std::int64_t best_leaves = 0;
    for (std::size_t i = 0; i < s_.ready.size(); ++i) {
      const Step s = step(s_.ready[i]);
      const bool below = live + s.gained <= peak;
      const std::int64_t leaves = s.gained - s.freed;
      const bool better =
          i == 0 || (below && !best_below) ||
          (below == best_below &&
           (leaves < best_leaves || (leaves == best_leaves && s_.ready[i] < s_.ready[best])));
      if (!better) continue;
      best = i;
      best_below = below;
      best_leaves = leaves;
    }
    return best;
  }

  const GraphDescription& graph_;
  const Limits& limits_;
  Workspace& workspace_;
  const Plan& plan_;
  Workspace::Reorder& s_;
  std::uint32_t stamp_ = 0;
};

}  // namespace

void order_as_declared(Workspace& workspace, const Plan& plan) {
  workspace.order.resize(plan.cull_reasons.size());
  std::size_t live = 0;
  for (std::uint32_t pass = 0; pass < plan.cull_reasons.size(); ++pass) {
    workspace.order[live] = pass;
    live += plan.cull_reasons[pass].is_live();
  }
  workspace.order.resize(live);
}

bool find_lower_order(const GraphDescription& graph, const Limits& limits, Workspace& workspace,
                      const Plan& plan) {
  return Orderer(graph, limits, workspace, plan).run();
}

}  // namespace alcove::framegraph
