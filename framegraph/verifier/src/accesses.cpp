// The verifier's checks of single accesses, and of how a frame ends.
#include <algorithm>

#include "replay.h"

namespace alcove::framegraph::verifier {

void Replay::check_access(std::uint32_t position, std::uint32_t access_index) {
  const AccessRecord& access = graph_.accesses[access_index];
  const auto queue = static_cast<std::uint8_t>(plan_.passes[position].queue);
  take_memory(access.resource);
  constexpr Accesses kDrawn = VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT |
                              VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
                              VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT |
                              VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
  bool fresh = false;
  bool has_contents = false;
  std::size_t expected = first_expected_[access_index];
  for_each_sub(access.resource, access.range, [&](Sub& sub) {
    fresh |= sub.fresh;
    has_contents |= expected_[expected] != kGarbage;
    if (access.kind() == ResourceKind::texture && sub.layout != access.layout)
      fail(name(access.resource) + " is in layout " + std::to_string(sub.layout) + ", needed is " +
           std::to_string(access.layout));
    if (access.flags & kWrite)
      check_write(access, expected_[expected++], sub, queue);
    else
      check_read(access, expected_[expected++], sub, queue);
  });
  has_contents = has_contents && !(access.flags & kDiscard) && (access.access & kDrawn) != 0;
  if (has_contents != ((plan_.contents[access_index] & kHasContents) != 0))
    fail("the pass " + std::string(has_contents ? "does not load" : "loads nothing from") + " " +
         name(access.resource));
  if (fresh) check_former(access, queue);
}

void Replay::check_read(const AccessRecord& access, std::uint32_t expected, const Sub& sub,
                        std::uint8_t queue) {
  const ResourceRecord& record = graph_.resources[access.resource];
  // A history slot that was never written has undefined contents, which any access may find.
  const bool any = record.origin == Origin::history && expected == kGarbage;
  if (!any && (sub.content != expected || sub.spoiled))
    fail("the read of " + name(access.resource) + " does not find what was written for it");
  for (const Operation& write : sub.last.writes)
    if (!order_.is_ordered(write, queue, access.stages))
      fail("the read of " + name(access.resource) + " does not come after its write");
    else if (!order_.is_visible(write, queue, access.stages, access.access))
      fail("the read of " + name(access.resource) + " comes after its write, but cannot see it");
}

void Replay::check_write(const AccessRecord& access, std::uint32_t expected, Sub& sub,
                         std::uint8_t queue) {
  for (const Operation& read : sub.last.reads)
    if (!order_.is_ordered(read, queue, access.stages))
      fail("the write of " + name(access.resource) + " overtakes a read");
  // The earlier write must be visible even if the reads of it are ordered before this write: they
  // may have read only a part of what the two write.
  for (const Operation& write : sub.last.writes)
    if (!order_.is_available(write, queue, access.stages) ||
        !order_.is_visible(write, queue, access.stages, access.access))
      fail("the write of " + name(access.resource) + " overtakes a write, or cannot see it");
  if (access.flags & kDiscard) {
    sub.spoiled = false;
    return;
  }
  if (expected == kGarbage || (sub.content == expected && !sub.spoiled)) return;
  if (reads_of(access.access) != 0)
    fail("the update of " + name(access.resource) + " does not find what was written for it");
  sub.spoiled = true;
}

// The uses by resources that occupied the memory before must be done.
void Replay::check_former(const AccessRecord& access, std::uint8_t queue) {
  const Accesses writes = access.access & ~reads_of(access.access);
  for (const Former& former : resources_[access.resource].former) {
    const bool right = former.writes
                           ? order_.is_available(former.operation, queue, access.stages) &&
                                 (former.read_since ||
                                  order_.is_visible(former.operation, queue, access.stages, writes))
                           : order_.is_ordered(former.operation, queue, access.stages);
    if (!right)
      fail(name(access.resource) + " takes the memory of " + name(former.resource) +
           " before its last " + (former.writes ? "write is done" : "read"));
  }
}

void Replay::apply_access(std::uint32_t position, std::uint32_t access_index) {
  const AccessRecord& access = graph_.accesses[access_index];
  const auto queue = static_cast<std::uint8_t>(plan_.passes[position].queue);
  const Accesses accesses = expand_accesses(access.access);
  Operation operation{false, queue, order_.now(), expand_stages(access.stages), 0, 0};
  resources_[access.resource].used = true;
  if (access.flags & kWrite) operation.writes = accesses & ~reads_of(accesses);
  for_each_sub(access.resource, access.range, [&](Sub& sub) {
    sub.fresh = false;
    if (!(access.flags & kWrite)) {
      sub.last.reads.push_back(operation);
      return;
    }
    sub.content = access_index;
    sub.written = true;
    sub.last.reads.clear();
    sub.last.writes.assign(1, operation);
  });
}

void Replay::end_frame() {
  where_ = "at the end of the frame";
  for (std::uint32_t r = 0; r < resources_.size(); ++r) {
    const ResourceRecord& record = graph_.resources[r];
    if (record.origin != Origin::imported) continue;
    const ExternalRecord& external = graph_.externals[record.external];
    if (external.has_final_state) check_final_state(r);
  }
  for (const OutputRecord& output : graph_.outputs)
    if (!holds(output.resource))
      fail("output " + name(output.resource) + " does not hold what was written for it");
  check_histories();
}

// Returns whether a resource has the contents that the declaration has written to it.
bool Replay::holds(std::uint32_t resource) const {
  const std::vector<Sub>& subs = resources_[resource].subs;
  return std::all_of(subs.begin(), subs.end(), [](const Sub& sub) {
    return sub.declared == kGarbage || (sub.content == sub.declared && !sub.spoiled);
  });
}

void Replay::check_final_state(std::uint32_t resource) {
  const ResourceRecord& record = graph_.resources[resource];
  const State& final_state = graph_.externals[record.external].final_state;
  const auto queue = static_cast<std::uint8_t>(QueueClass::graphics);
  if (!holds(resource)) fail(name(resource) + " does not leave with what was written for it");
  for (const Sub& sub : resources_[resource].subs) {
    if (record.kind == ResourceKind::texture && sub.layout != final_state.layout)
      fail(name(resource) + " is left in layout " + std::to_string(sub.layout) +
           ", its final_state is " + std::to_string(final_state.layout));
    for (const Operation& read : sub.last.reads) {
      // Work after the frame waits only for the stages of the final state. Reads in other stages
      // must therefore be ordered before them.
      Operation rest = read;
      if (!is_write(final_state.access) && read.queue == queue)
        rest.stages &= ~expand_stages(final_state.stages);
      if (rest.stages != 0 && !order_.is_ordered(rest, queue, final_state.stages))
        fail(name(resource) + " leaves before its last read is done");
    }
    for (const Operation& write : sub.last.writes)
      if (!order_.is_ordered(write, queue, final_state.stages) ||
          !order_.is_visible(write, queue, final_state.stages, final_state.access))
        fail(name(resource) + " leaves before its last write can be seen");
  }
}

// Checks that the plan names the final state of each history slot that the frame uses, and no
// other, whether the frame wrote it, and that it holds what the declaration has written to it: the
// next frame may read it.
void Replay::check_histories() {
  std::vector<std::uint32_t> finals(resources_.size(), 0);
  for (const FinalState& final : plan_.finals) {
    if (final.resource >= resources_.size())
      return fail("the final state of a resource that was not declared");
    check_final(final);
    ++finals[final.resource];
    const auto& subs = resources_[final.resource].subs;
    const auto written =
        std::count_if(subs.begin(), subs.end(), [](const Sub& s) { return s.written; });
    const bool whole = static_cast<std::size_t>(written) == subs.size();
    if (final.written != (written == 0 ? WriteCoverage::nothing
                          : whole      ? WriteCoverage::whole
                                       : WriteCoverage::part))
      fail(name(final.resource) + " is said to be written in another part than it is");
    if (!holds(final.resource))
      fail(name(final.resource) + " does not hold what was written for the next frame");
  }
  for (std::uint32_t r = 0; r < resources_.size(); ++r) {
    const bool used = graph_.resources[r].origin == Origin::history && resources_[r].used;
    if (finals[r] != (used ? 1u : 0u))
      fail(name(r) + " has " + std::to_string(finals[r]) + " final states");
  }
}

// Checks that each history ends the frame in the state that the plan names, because the next frame
// starts from that state, and that a barrier after the stages of that state, on the queue that the
// plan names, comes after all work on it, because the next frame begins with such a barrier.
void Replay::check_final(const FinalState& final) {
  const Stages stages = expand_stages(final.state.stages);
  const auto queue = static_cast<std::uint8_t>(final.queue);
  const auto check_order = [&](const Operation& operation) {
    if (stages == 0)
      fail(name(final.resource) + " is used, but its final state names no stage to wait for");
    else if (operation.queue != queue &&
             !order_.is_before(operation, {queue, stages, 0, 0, 0, true}))
      fail(name(final.resource) + " is left on a queue that does not wait for its last use");
  };
  for (const Sub& sub : resources_[final.resource].subs) {
    if (sub.layout != final.state.layout)
      fail(name(final.resource) + " is said to be left in another layout than it is");
    for (const Operation& read : sub.last.reads) {
      if (read.queue == queue && (read.stages & ~stages) != 0)
        fail(name(final.resource) + " is read by a stage not told of");
      check_order(read);
    }
    for (const Operation& write : sub.last.writes) {
      check_order(write);
      check_final_write(final, write, !sub.last.reads.empty());
    }
  }
}

void Replay::check_final_write(const FinalState& final, const Operation& write, bool is_read) {
  const Stages stages = expand_stages(final.state.stages);
  const Accesses accesses = expand_accesses(final.state.access);
  const auto queue = static_cast<std::uint8_t>(final.queue);
  if (is_write(accesses)) {
    const bool told = is_read || write.is_change || write.queue != queue ||
                      ((write.stages & ~stages) == 0 && (write.writes & ~accesses) == 0);
    if (!told) fail(name(final.resource) + " is written in a way not told of");
  } else if (stages != 0) {
    const bool seen = accesses == 0
                          ? order_.is_available_by(write, {queue, stages, 0, 0, 0, true})
                          : order_.is_available(write, queue, final.state.stages) &&
                                order_.is_visible(write, queue, final.state.stages, accesses);
    if (!seen) fail(name(final.resource) + " is said to be seen by what does not see it");
  }
}

}  // namespace alcove::framegraph::verifier
