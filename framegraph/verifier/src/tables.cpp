#include <algorithm>
#include <bit>
#include <iterator>
#include <set>
#include <utility>

#include "replay.h"

namespace alcove::framegraph::verifier {
namespace {

class Tables {
 public:
  Tables(const GraphDescription& graph, const Limits& limits, const Plan& plan, Errors& errors)
      : graph_(graph), limits_(limits), plan_(plan), errors_(errors) {}

  bool run() {
    if (plan_.placements.size() != graph_.resources.size() ||
        plan_.contents.size() != graph_.accesses.size() ||
        plan_.cull_reasons.size() != graph_.passes.size()) {
      fail("the plan is of another graph: its tables have other sizes");
      return false;
    }
    check_passes();
    check_submissions();
    check_batches();
    if (!errors_.empty()) return false;  // indices may be wrong
    check_lifetimes();
    for (std::uint32_t r = 0; r < graph_.resources.size(); ++r) check_placement(r);
    check_overlaps();
    return true;
  }

 private:
  void fail(std::string message) {
    errors_.push_back({ErrorCode::verification, std::move(message), VK_SUCCESS, kNone, kNone, 0});
  }
  std::string name(std::uint32_t resource) const {
    return std::string("'").append(graph_.resource_name(resource)).append("'");
  }

  std::uint32_t family(std::uint32_t position) const {
    return limits_.queue_families[static_cast<std::size_t>(plan_.passes[position].queue)];
  }

  void check_passes() {
    std::vector<std::uint32_t> seen(graph_.passes.size(), 0);
    std::uint32_t next[kQueueClasses] = {};
    for (const PlannedPass& planned : plan_.passes) {
      if (planned.pass >= graph_.passes.size())
        return fail("the plan runs a pass that was not declared");
      if (seen[planned.pass]++) fail("the plan runs a pass twice");
      const auto queue = static_cast<std::size_t>(planned.queue);
      if (queue >= kQueueClasses || (queue != 0 && limits_.queue_families[queue] == kNone))
        return fail("a pass runs on a queue that the device does not have");
      if (planned.pass < std::exchange(next[queue], planned.pass))
        fail("passes of a queue run in another order than declared");
    }
    for (std::uint32_t pass = 0; pass < graph_.passes.size(); ++pass) {
      if ((graph_.passes[pass].flags & kSideEffect) && !seen[pass])
        fail(std::string("pass '").append(graph_.pass_name(pass)) +
             "' has a side effect but was culled");
      if (plan_.cull_reasons[pass].is_live() != (seen[pass] != 0))
        fail(std::string("pass '").append(graph_.pass_name(pass)) +
             "' runs and is said to be culled, or the reverse");
    }
  }

  void check_submissions() {
    std::size_t passes = 0;
    for (std::uint32_t s = 0; s < plan_.submissions.size(); ++s) {
      const Submission& submission = plan_.submissions[s];
      std::uint32_t position = submission.first_pass;
      for (std::uint32_t left = submission.pass_count; left > 0; --left, ++passes) {
        if (position >= plan_.passes.size()) return fail("a submission has passes out of range");
        const PlannedPass& planned = plan_.passes[position];
        if (planned.queue != submission.queue)
          fail("a pass is submitted to another queue than it was planned for");
        if (planned.submission != s || planned.next <= position)
          return fail("a pass is in another submission than planned, or they are not in order");
        position = planned.next;
      }
      if (submission.pass_count != 0 && position != kNone)
        return fail("a pass falls out of its submission");
      if (submission.first_wait + submission.wait_count > plan_.waits.size())
        return fail("a submission's waits are out of range");
      for (std::uint32_t w = 0; w < submission.wait_count; ++w)
        if (plan_.waits[submission.first_wait + w].submission >= s)
          fail("a submission waits for itself or a later one: it would hang");
    }
    if (passes != plan_.passes.size()) fail("a pass is in no submission");
    const std::uint32_t final = plan_.final_submission;
    if (final != kNone && (final >= plan_.submissions.size() ||
                           plan_.submissions[final].queue != QueueClass::graphics))
      fail("the final submission is not one of the graphics queue");
  }

  void check_batches() {
    for (const Batch& batch : plan_.batches)
      if (batch.count > plan_.transitions.size() ||
          batch.first > plan_.transitions.size() - batch.count)
        fail("a batch's transitions are out of range");
    const auto check = [this](std::uint32_t batch) {
      if (batch != kNone && batch >= plan_.batches.size()) fail("a batch is out of range");
    };
    for (const PlannedPass& planned : plan_.passes) check(planned.batch);
    for (const Submission& s : plan_.submissions) check(s.end_batch);
    check(plan_.final_batch);
    for (const Transition& t : plan_.transitions) {
      if (t.resource == kNone) continue;
      if (t.resource >= graph_.resources.size())
        return fail("a transition is of a resource that was not declared");
      const ResourceRecord& r = graph_.resources[t.resource];
      if (r.kind != ResourceKind::texture ||
          (t.range.mips == 0 || t.range.layers == 0 || t.range.base_mip + t.range.mips > r.mips ||
           t.range.base_layer + t.range.layers > r.layers))
        fail("a transition of " + name(t.resource) + " is out of its mips or layers");
    }
  }

  void check_lifetimes() {
    for (std::uint32_t position = 0; position < plan_.passes.size(); ++position) {
      for (const AccessRecord& access : graph_.pass_accesses(plan_.passes[position].pass)) {
        const Placement& placement = plan_.placements[access.resource];
        if (placement.first == kNone || position < placement.first || position > placement.last)
          fail(name(access.resource) + " is used at position " + std::to_string(position) +
               ", outside its lifetime");
        if (access.usage & ~placement.usage)
          fail(name(access.resource) + " is made without a usage that a pass needs");
        if (placement.first < plan_.passes.size() && !placement.concurrent &&
            family(position) != family(placement.first))
          fail(name(access.resource) + " is made for one of the queue families that use it");
      }
    }
    for (const OutputRecord& output : graph_.outputs) {
      const Placement& placement = plan_.placements[output.resource];
      if (placement.first != kNone && placement.last + 1 < plan_.passes.size() &&
          graph_.resources[output.resource].origin == Origin::transient)
        fail("output " + name(output.resource) + " does not live to the end of the frame");
    }
  }

  void check_placement(std::uint32_t r) {
    const Placement& placement = plan_.placements[r];
    if (graph_.resources[r].origin != Origin::transient || placement.first == kNone) return;
    if (placement.heap >= plan_.heaps.size()) {
      fail(name(r) + " is used but has no memory");
      return;
    }
    const MemoryRequirements requirements =
        limits_.memory(graph_.resources[r], placement.usage, placement.concurrent);
    if (requirements.result != VK_SUCCESS) {
      errors_.push_back({ErrorCode::vulkan,
                         "the device does not say how much memory " + name(r) + " needs",
                         requirements.result, kNone, r, 0});
      return;
    }
    if (!std::has_single_bit(requirements.alignment) ||
        placement.offset % requirements.alignment != 0)
      fail(name(r) + " is not aligned");
    if (placement.size < requirements.size) fail(name(r) + " has too few bytes");
    const Heap& heap = plan_.heaps[placement.heap];
    if (placement.size > heap.size || placement.offset > heap.size - placement.size)
      fail(name(r) + " reaches beyond its heap");
    if (heap.memory_types == 0 || heap.memory_types & ~requirements.memory_types)
      fail(name(r) + " lies in a heap whose memory types it does not allow");
  }

  // Resources whose lifetimes overlap must not share a byte, and a buffer and an image must not
  // share a page of bufferImageGranularity. Visits resources in order of first use and compares
  // each one with its two neighbours in memory among the resources that are live at that time.
  void check_overlaps() {
    std::vector<std::uint32_t> order;
    for (std::uint32_t r = 0; r < graph_.resources.size(); ++r)
      if (plan_.placements[r].heap < plan_.heaps.size() && plan_.placements[r].size != 0)
        order.push_back(r);
    std::vector<std::uint32_t> ending = order;
    const auto& placements = plan_.placements;
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return placements[a].first < placements[b].first;
    });
    std::sort(ending.begin(), ending.end(), [&](std::uint32_t a, std::uint32_t b) {
      return placements[a].last < placements[b].last;
    });
    std::vector<std::set<std::pair<VkDeviceSize, std::uint32_t>>> live(plan_.heaps.size());
    std::vector<VkDeviceSize> bytes(plan_.heaps.size());
    std::vector<VkDeviceSize> most(plan_.heaps.size());
    std::size_t ended = 0;
    for (const std::uint32_t r : order) {
      for (; placements[ending[ended]].last < placements[r].first; ++ended) {
        const Placement& end = placements[ending[ended]];
        live[end.heap].erase({end.offset, ending[ended]});
        bytes[end.heap] -= end.size;
      }
      const std::uint32_t heap = placements[r].heap;
      most[heap] = std::max(most[heap], bytes[heap] += placements[r].size);
      auto& neighbours = live[heap];
      const auto at = neighbours.insert({placements[r].offset, r}).first;
      if (at != neighbours.begin()) check_neighbours(std::prev(at)->second, r);
      if (std::next(at) != neighbours.end()) check_neighbours(r, std::next(at)->second);
    }
    for (std::size_t heap = 0; heap < most.size(); ++heap)
      if (plan_.heaps[heap].lower_bound != most[heap])
        fail("the lower bound of a heap is not the most bytes that are live at once");
  }

  void check_neighbours(std::uint32_t a, std::uint32_t b) {
    if (meet(a, b, 1)) fail(name(a) + " and " + name(b) + " live together on the same bytes");
    if (graph_.resources[a].kind != graph_.resources[b].kind &&
        meet(a, b, std::max(limits_.buffer_image_granularity, VkDeviceSize{1})))
      fail(name(a) + " and " + name(b) + " share a page of the buffer-image granularity");
  }

  bool meet(std::uint32_t a, std::uint32_t b, VkDeviceSize page) const {
    const Placement& x = plan_.placements[a];
    const Placement& y = plan_.placements[b];
    return x.offset / page <= (y.offset + y.size - 1) / page &&
           y.offset / page <= (x.offset + x.size - 1) / page;
  }

  const GraphDescription& graph_;
  const Limits& limits_;
  const Plan& plan_;
  Errors& errors_;
};

}  // namespace

bool check_tables(const GraphDescription& graph, const Limits& limits, const Plan& plan,
                  Errors& errors) {
  return Tables(graph, limits, plan, errors).run();
}

}  // namespace alcove::framegraph::verifier
