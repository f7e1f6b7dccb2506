#include "replay.h"

#include <algorithm>
#include <utility>

namespace alcove::framegraph::verifier {

void Replay::run() {
  resources_.resize(graph_.resources.size());
  for (std::uint32_t r = 0; r < graph_.resources.size(); ++r) {
    const ResourceRecord& record = graph_.resources[r];
    resources_[r].subs.resize(record.kind == ResourceKind::texture ? record.mips * record.layers
                                                                   : 1);
  }
  memory_.resize(plan_.heaps.size());
  find_expected();
  check_stores();
  for (int frame = 0; frame < 2 && errors_.empty(); ++frame) {
    where_ = frame == 0 ? "at the start of the frame" : "at the start of the next frame";
    begin_frame();
    for (std::uint32_t s = 0; s < plan_.submissions.size(); ++s) submission(s);
    end_frame();
  }
}

// Finds the contents that each access must find: those of the last write that is declared before
// it. Uses the declaration alone and not the plan.
void Replay::find_expected() {
  for (std::uint32_t r = 0; r < graph_.resources.size(); ++r) {
    const std::uint32_t external = graph_.resources[r].external;
    if (external == kNone || !graph_.externals[external].has_contents) continue;
    for (Sub& sub : resources_[r].subs) sub.declared = kInitial;
  }
  for (std::uint32_t pass = 0; pass < graph_.passes.size(); ++pass) {
    for (const AccessRecord& access : graph_.pass_accesses(pass)) {
      const auto index = static_cast<std::uint32_t>(first_expected_.size());
      first_expected_.push_back(expected_.size());
      for_each_sub(access.resource, access.range, [&](Sub& sub) {
        expected_.push_back(sub.declared);
        if (access.flags & kWrite)
          sub.declared = plan_.cull_reasons[pass].is_live() ? index : kMissing;
      });
    }
  }
}

// Checks that the plan calls each write needed whose result a pass that runs reads, or somebody
// after the frame. Goes through the declaration backwards and follows which contents are needed.
void Replay::check_stores() {
  for (std::uint32_t r = 0; r < resources_.size(); ++r)
    for (Sub& sub : resources_[r].subs) sub.needed = graph_.resources[r].external != kNone;
  for (const OutputRecord& output : graph_.outputs)
    for (Sub& sub : resources_[output.resource].subs) sub.needed = true;
  auto pass = static_cast<std::uint32_t>(graph_.passes.size());
  while (pass-- > 0) {
    if (!plan_.cull_reasons[pass].is_live()) continue;
    for (const AccessRecord& access : graph_.pass_accesses(pass)) {
      const auto index = static_cast<std::size_t>(&access - graph_.accesses.data());
      bool is_needed = false;
      for_each_sub(access.resource, access.range, [&](Sub& sub) {
        is_needed = is_needed || sub.needed;
        if (access.flags & kDiscard)
          sub.needed = false;
        else if (reads_of(access.access) != 0)
          sub.needed = true;
      });
      if ((access.flags & kWrite) && is_needed && !(plan_.contents[index] & kIsNeeded))
        fail("what pass '" + std::string(graph_.pass_name(pass)) + "' writes to " +
             name(access.resource) + " is not stored, but needed");
    }
  }
}

// Sets the contents and states at the start of a frame: transients have no contents, and imports
// and histories are in the state that the graph declares. Histories were used in an earlier frame,
// and imports may have been used after it.
void Replay::begin_frame() {
  begin(Origin::transient);
  begin(Origin::history);
  for (std::uint8_t queue = 0; queue < kQueueClasses; ++queue)
    order_.signal(queue, end_signal(queue));
  begin(Origin::imported);
}

void Replay::begin(Origin origin) {
  for (std::uint32_t r = 0; r < resources_.size(); ++r) {
    const ResourceRecord& record = graph_.resources[r];
    if (record.origin != origin) continue;
    resources_[r].used = false;
    for (Sub& sub : resources_[r].subs) {
      sub.content = kGarbage;
      sub.spoiled = sub.written = false;
      if (record.external == kNone) continue;
      const ExternalRecord& external = graph_.externals[record.external];
      sub.last = {};
      apply_initial_state(sub, static_cast<std::uint8_t>(external.queue), external.initial_state);
      sub.layout = external.initial_state.layout;
      if (external.has_contents) sub.content = kInitial;
    }
  }
}

// Sets the state of a subresource that comes from outside the frame. Earlier writes are visible to
// the read accesses of the initial state and to nothing else. An initial state without access bits
// only names stages: later work must wait for all of them, and no write is visible yet.
void Replay::apply_initial_state(Sub& sub, std::uint8_t queue, const State& initial_state) {
  const Stages stages = expand_stages(initial_state.stages);
  const Accesses accesses = expand_accesses(initial_state.access);
  const std::size_t time = order_.now();
  if (is_write(accesses)) {
    const Accesses writes = accesses & ~reads_of(accesses);
    if (stages != 0) sub.last.writes.push_back({false, queue, time, stages, writes, 0});
    return;
  }
  // Creates one operation for each stage.
  for (Stages left = accesses == 0 ? stages : 0; left != 0; left &= left - 1)
    sub.last.writes.push_back({true, queue, time, left & (~left + 1), 0, 0});
  if (accesses != 0) sub.last.writes.push_back({true, queue, time, stages, 0, accesses});
  if (stages != 0) sub.last.reads.push_back({false, queue, time, stages, 0, 0});
}

void Replay::submission(std::uint32_t index) {
  const Submission& submission = plan_.submissions[index];
  const auto queue = static_cast<std::uint8_t>(submission.queue);
  for (std::uint8_t other = 0; other < kQueueClasses; ++other)
    if ((submission.frame_before & (1u << other)) != 0)
      order_.wait(queue, end_signal(other), VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
  for (std::uint32_t w = submission.first_wait; w < submission.first_wait + submission.wait_count;
       ++w) {
    const Wait& wait = plan_.waits[w];
    if (!supports(submission.queue, wait.stages))
      fail("a submission waits in a stage that its queue cannot run");
    order_.wait(queue, wait.submission, wait.stages);
  }
  std::uint32_t position = submission.first_pass;
  for (std::uint32_t left = submission.pass_count; left > 0; --left) {
    const PlannedPass& planned = plan_.passes[position];
    where_ = std::string("before pass '").append(graph_.pass_name(planned.pass)).append("'");
    batch(planned.batch, submission.queue);
    where_ = std::string("in pass '").append(graph_.pass_name(planned.pass)).append("'");
    pass(position);
    position = planned.next;
  }
  where_ = "after the last pass";
  batch(submission.end_batch, submission.queue);
  if (index == plan_.final_submission) batch(plan_.final_batch, submission.queue);
  order_.signal(queue, index);
}

// Applies the barriers of a batch. They are not ordered among each other, so that all of them are
// checked before any takes effect.
void Replay::batch(std::uint32_t index, QueueClass queue) {
  if (index == kNone) return;
  const Batch& batch = plan_.batches[index];
  barriers_.clear();
  for (std::uint32_t i = batch.first; i < batch.first + batch.count; ++i) {
    const Transition& t = plan_.transitions[i];
    barriers_.push_back(barrier_of(t, queue));
    if (!supports(queue, t.src_stages | t.dst_stages))
      fail("a barrier has a stage that its queue cannot run");
    if (!supports(t.src_stages, t.src_access) || !supports(t.dst_stages, t.dst_access))
      fail("a barrier has an access that none of its stages can make");
    if (t.resource == kNone) continue;
    take_memory(t.resource);
    for_each_sub(t.resource, t.range, [&](Sub& sub) {
      check_order_of_change(t.resource, barriers_.back(), sub);
      check_layout_of_change(t, sub);
    });
  }
  order_.apply(barriers_);
  for (std::uint32_t i = batch.first; i < batch.first + batch.count; ++i)
    if (plan_.transitions[i].resource != kNone) change(plan_.transitions[i], queue);
}

// Checks that every earlier use of the subresource, and of the bytes that it occupies, is ordered
// before the layout change. The memory dependency of an image barrier covers the bytes of its
// image, including those that another resource wrote. A barrier over some mips or layers is taken
// to cover all of these bytes, because Vulkan does not say which bytes a mip or layer occupies.
void Replay::check_order_of_change(std::uint32_t resource, const Barrier& barrier, const Sub& sub) {
  for (const Operation& read : sub.last.reads)
    if (!order_.is_before(read, barrier))
      fail("a layout change of " + name(resource) + " overtakes a read");
  for (const Operation& write : sub.last.writes) {
    if (!order_.is_available_by(write, barrier))
      fail("a layout change of " + name(resource) +
           " overtakes a write, or does not make it available");
  }
  if (!sub.fresh) return;
  for (const Former& former : resources_[resource].former) {
    if (former.writes ? !order_.is_available_by(former.operation, barrier)
                      : !order_.is_before(former.operation, barrier))
      fail(name(resource) + " takes the memory of " + name(former.resource) + " before its last " +
           (former.writes ? "write is done" : "read"));
  }
}

void Replay::check_layout_of_change(const Transition& t, Sub& sub) {
  if (std::exchange(sub.changed, order_.now() + 1) == order_.now() + 1)
    fail("one command changes the layout of " + name(t.resource) + " twice");
  if (t.old_layout != VK_IMAGE_LAYOUT_UNDEFINED && t.old_layout != sub.layout)
    fail("a change of " + name(t.resource) + " expects layout " + std::to_string(t.old_layout) +
         ", but it is in " + std::to_string(sub.layout));
}

void Replay::change(const Transition& t, QueueClass on) {
  const Barrier barrier = barrier_of(t, on);
  const std::size_t time = order_.now();
  for_each_sub(t.resource, t.range, [&](Sub& sub) {
    sub.last = {};
    sub.fresh = false;
    sub.last.writes.push_back({true, barrier.queue, time, barrier.dst, 0, barrier.dst_access});
    if (t.old_layout == VK_IMAGE_LAYOUT_UNDEFINED) sub.content = kGarbage;
    sub.layout = t.new_layout;
  });
}

// Makes a transient the owner of its bytes, from its first use until another resource takes them.
// The contents of the previous owners are lost. It is enough to wait for the owners immediately
// before, because these in turn waited for the owners before them.
void Replay::take_memory(std::uint32_t resource) {
  const Placement& placement = plan_.placements[resource];
  Resource& taker = resources_[resource];
  if (placement.heap == kNone || taker.has_memory) return;
  taker.has_memory = true;
  taker.former.clear();
  Memory& memory = memory_[placement.heap];
  const VkDeviceSize begin = placement.offset;
  const VkDeviceSize end = begin + placement.size;
  bool had_bytes = false;
  for (auto at = memory.upper_bound(begin); at != memory.end() && at->second.begin < end;) {
    const Bytes bytes = at->second;
    const VkDeviceSize bytes_end = at->first;
    at = memory.erase(at);
    if (bytes.resource == resource)
      had_bytes = true;
    else
      keep_former(taker, bytes.resource);
    if (bytes.begin < begin) memory[begin] = bytes;
    if (bytes_end > end) at = memory.insert({bytes_end, {end, bytes.resource}}).first;
  }
  memory[end] = {begin, resource};
  for (Sub& sub : taker.subs) {
    sub.fresh = true;
    if (!had_bytes) sub.last = {};
  }
}

void Replay::keep_former(Resource& taker, std::uint32_t resource) {
  Resource& giver = resources_[resource];
  giver.has_memory = false;
  // Adds an entry only if it differs from the last one, because the mips and layers of one access
  // usually have one entry in common.
  const auto keep = [&taker](const Former& former) {
    if (taker.former.empty() || taker.former.back() != former) taker.former.push_back(former);
  };
  for (Sub& sub : giver.subs) {
    sub.content = kGarbage;
    for (const Operation& read : sub.last.reads) keep({resource, read, false, false});
  }
  for (const Sub& sub : giver.subs)
    for (const Operation& write : sub.last.writes)
      keep({resource, write, true, !sub.last.reads.empty()});
}

void Replay::pass(std::uint32_t position) {
  const std::uint32_t pass = plan_.passes[position].pass;
  const std::uint32_t first = graph_.passes[pass].first_access;
  const auto count = static_cast<std::uint32_t>(graph_.pass_accesses(pass).size());
  for (std::uint32_t i = first; i < first + count; ++i) check_access(position, i);
  for (std::uint32_t i = first; i < first + count; ++i) apply_access(position, i);
}

void Replay::fail(const std::string& what) {
  errors_.push_back({ErrorCode::verification, where_ + ": " + what, VK_SUCCESS, kNone, kNone, 0});
}

std::string Replay::name(std::uint32_t resource) const {
  return std::string("'").append(graph_.resource_name(resource)).append("'");
}

}  // namespace alcove::framegraph::verifier

tl::expected<void, alcove::framegraph::Errors> alcove::framegraph::verify(
    const GraphDescription& graph, const Limits& limits, const Plan& plan) {
  Errors errors;
  if (verifier::check_tables(graph, limits, plan, errors))
    verifier::Replay(graph, limits, plan, errors).run();
  if (!errors.empty()) return tl::unexpected(std::move(errors));
  return {};
}
