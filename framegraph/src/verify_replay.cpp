#include "verify_replay.h"

#include <algorithm>

namespace alcove::framegraph::verifier {

Replay::Replay(const GraphDescription& graph, const Limits& limits, const Plan& plan,
               Errors& errors)
    : graph_(graph), limits_(limits), plan_(plan), errors_(errors) {}

void Replay::run() {
  resources_.resize(graph_.resources.size());
  for (std::uint32_t r = 0; r < graph_.resources.size(); ++r) {
    const ResourceRecord& record = graph_.resources[r];
    resources_[r].subs.resize(record.kind == ResourceKind::texture ? record.mips * record.layers
                                                                   : 1);
  }
  find_overlaps();
  find_expected();
  for (int frame = 0; frame < 2 && errors_.empty(); ++frame) {
    begin_frame(frame == 0);
    set_in_.assign(plan_.sets.size(), kNone);
    for (std::uint32_t s = 0; s < plan_.submissions.size(); ++s) submission(s);
    end_frame();
    signals_ += static_cast<std::uint32_t>(plan_.submissions.size());
  }
}

void Replay::find_overlaps() {
  for (std::uint32_t a = 0; a < graph_.resources.size(); ++a) {
    const Placement& x = plan_.placements[a];
    if (x.heap == kNone) continue;
    for (std::uint32_t b = 0; b < graph_.resources.size(); ++b) {
      const Placement& y = plan_.placements[b];
      if (a != b && x.heap == y.heap && x.offset < y.offset + y.size &&
          y.offset < x.offset + x.size)
        resources_[a].overlapping.push_back(b);
    }
  }
}

// What each access must find, from the declaration alone: the last write declared before it.
void Replay::find_expected() {
  std::vector<std::vector<std::uint32_t>> content(graph_.resources.size());
  for (std::uint32_t r = 0; r < graph_.resources.size(); ++r) {
    const std::uint32_t external = graph_.resources[r].external;
    const bool full = external != kNone && graph_.externals[external].has_contents;
    content[r].assign(resources_[r].subs.size(), full ? kInitial : kGarbage);
  }
  expected_.resize(graph_.accesses.size());
  for (std::uint32_t i = 0; i < graph_.accesses.size(); ++i) {
    const AccessRecord& access = graph_.accesses[i];
    for_each_sub(access.resource, access.range, [&](Sub& sub) {
      std::uint32_t& there =
          content[access.resource]
                 [static_cast<std::size_t>(&sub - resources_[access.resource].subs.data())];
      expected_[i].push_back(there);
      if (!(access.flags & kWrite)) return;
      there = plan_.live_accesses[i] ? i : kMissing;
    });
  }
  last_ = std::move(content);
}

// Transients hold nothing, imports arrive as declared. Where queues other than graphics take part,
// a frame begins when all of the frame before is done; else commands just follow each other.
void Replay::begin_frame(bool first) {
  where_ = first ? "at the start of the frame" : "at the start of the next frame";
  several_queues_ =
      std::any_of(plan_.submissions.begin(), plan_.submissions.end(),
                  [](const Submission& s) { return s.queue != QueueClass::graphics; });
  if (several_queues_) for_each_piece([](Piece& piece) { join(piece); });
  for (std::uint32_t r = 0; r < resources_.size(); ++r) {
    const ResourceRecord& record = graph_.resources[r];
    for (Sub& sub : resources_[r].subs) {
      sub.content = kGarbage;
      sub.spoiled = sub.released = false;
      sub.family = kNone;
      if (record.external == kNone) continue;
      const ExternalRecord& external = graph_.externals[record.external];
      const auto queue = static_cast<std::uint8_t>(external.queue);
      sub.writes.clear();
      sub.reads.clear();
      arrive(sub, queue, external.initial_state);
      sub.layout = external.initial_state.layout;
      if (!external.has_contents) continue;
      sub.content = kInitial;
      sub.family = family(queue);
    }
  }
}

// What was written before is seen by those who read it since, and by nobody else yet. Where no
// access is told, none sees it, and it came before some of the stages only: all must be waited for.
void Replay::arrive(Sub& sub, std::uint8_t queue, const State& initial_state) {
  if (is_write(initial_state.access)) {
    append_pieces(sub.writes, queue, initial_state.stages, initial_state.access);
    return;
  }
  const Stages stages = expand_stages(initial_state.stages);
  const Accesses seen = expand_accesses(initial_state.access);
  for (Stages left = seen == 0 ? stages : 0; left != 0; left &= left - 1)
    sub.writes.push_back(change_piece(queue, left & (~left + 1), 0));
  if (seen != 0) sub.writes.push_back(change_piece(queue, stages, seen));
  append_pieces(sub.reads, queue, initial_state.stages, 0);
}

void Replay::submission(std::uint32_t index) {
  const Submission& submission = plan_.submissions[index];
  const auto queue = static_cast<std::uint8_t>(submission.queue);
  for (std::uint32_t w = 0; w < submission.wait_count; ++w) {
    const Wait& wait_for = plan_.waits[submission.first_wait + w];
    for_each_piece(
        [&](Piece& piece) { wait(piece, queue, signals_ + wait_for.submission, wait_for.stages); });
  }
  for (std::uint32_t p = 0; p < submission.pass_count; ++p) {
    const PlannedPass& planned = plan_.passes[submission.first_pass + p];
    where_ = std::string("before pass '").append(graph_.pass_name(planned.pass)).append("'");
    batches(planned.first_batch, planned.batch_count, index);
    where_ = std::string("in pass '").append(graph_.pass_name(planned.pass)).append("'");
    pass(submission.first_pass + p);
    set_events(planned, index);
  }
  where_ = "after the last pass";
  batches(submission.first_batch, submission.batch_count, index);
  for_each_piece([&](Piece& piece) { signal(piece, queue, signals_ + index); });
}

void Replay::batches(std::uint32_t first, std::uint32_t count, std::uint32_t submission) {
  for (std::uint32_t b = first; b < first + count; ++b) {
    if (plan_.batches[b].event != kNone) wait_for_event(plan_.batches[b], submission);
    batch(plan_.batches[b], plan_.submissions[submission].queue);
  }
}

void Replay::set_events(const PlannedPass& planned, std::uint32_t submission) {
  for (std::uint32_t event = planned.first_set; event < planned.first_set + planned.set_count;
       ++event) {
    set_in_[event] = submission;
    const Batch& batch = plan_.batches[plan_.sets[event]];
    for (std::uint32_t i = batch.first; i < batch.first + batch.count; ++i) {
      const Scopes scopes = scopes_of(plan_.transitions[i], planned.queue);
      for_each_piece([&](Piece& piece) { capture(piece, scopes, i); });
    }
  }
}

void Replay::wait_for_event(const Batch& batch, std::uint32_t submission) {
  if (set_in_[batch.event] == kNone)
    fail("an event is waited for that nothing has set: it would hang");
  else if (set_in_[batch.event] != submission)
    fail("an event is waited for in another submission than it was set in");
}

Reach Replay::reach_of(const Piece& piece, const Batch& batch, std::uint32_t transition,
                       const Scopes& scopes, bool memory) const {
  return batch.event == kNone ? reach(piece, scopes, memory) : captured(piece, transition, memory);
}

// The transitions of a batch do not see each other: all are checked, then all apply.
void Replay::batch(const Batch& batch, QueueClass queue) {
  for (std::uint32_t i = batch.first; i < batch.first + batch.count; ++i) {
    const Transition& t = plan_.transitions[i];
    if (t.resource == kNone) continue;
    const Scopes scopes = scopes_of(t, queue);
    for_each_sub(t.resource, t.range, [&](Sub& sub) {
      check_order_of_change(batch, i, scopes, sub);
      check_state_of_change(t, scopes, sub);
    });
  }
  for (std::uint32_t r = 0; r < resources_.size(); ++r) {
    for (Sub& sub : resources_[r].subs) {
      for (Piece& piece : sub.writes) apply_batch(batch, queue, r, piece);
      for (Piece& piece : sub.reads) apply_batch(batch, queue, r, piece);
    }
  }
  for (std::uint32_t i = batch.first; i < batch.first + batch.count; ++i) {
    const Transition& t = plan_.transitions[i];
    if (t.resource != kNone) change(t, queue);
  }
}

// An image barrier's memory side covers the bytes of its image, whoever wrote them.
void Replay::apply_batch(const Batch& batch, QueueClass queue, std::uint32_t resource,
                         Piece& piece) {
  Piece after = piece;
  for (std::uint32_t i = batch.first; i < batch.first + batch.count; ++i) {
    const Transition& t = plan_.transitions[i];
    bool memory = t.resource == kNone;
    if (!memory) {
      const auto& others = resources_[t.resource].overlapping;
      memory = std::find(others.begin(), others.end(), resource) != others.end();
    }
    const Scopes scopes = scopes_of(t, queue);
    Piece by_this = piece;
    apply(by_this, scopes, reach_of(piece, batch, i, scopes, memory), memory);
    for (std::size_t q = 0; q < kQueueClasses; ++q) {
      after.after[q] |= by_this.after[q];
      after.available[q] |= by_this.available[q];
    }
    for (std::size_t g = piece.grants.size(); g < by_this.grants.size(); ++g)
      after.grants.push_back(by_this.grants[g]);
  }
  piece = std::move(after);
}

// Whether everything that was done to the subresource and its bytes comes before the change.
void Replay::check_order_of_change(const Batch& batch, std::uint32_t transition,
                                   const Scopes& scopes, const Sub& sub) {
  const std::uint32_t resource = plan_.transitions[transition].resource;
  const auto reached = [&](const Piece& piece) {
    return reach_of(piece, batch, transition, scopes, true);
  };
  const auto is_done = [&](const Piece& piece) {
    const Reach r = reached(piece);
    return r.before && r.available;
  };
  for (const Piece& piece : sub.reads) {
    if (!reached(piece).before) fail("a layout change of " + name(resource) + " overtakes a read");
  }
  for (const Piece& piece : sub.writes) {
    if (!is_done(piece))
      fail("a layout change of " + name(resource) +
           " overtakes a write, or does not make it available");
  }
  for (std::uint32_t other : resources_[resource].overlapping) {
    for (const Sub& theirs : resources_[other].subs) {
      for (const Piece& piece : theirs.reads) {
        if (!reached(piece).before)
          fail(name(resource) + " takes the memory of " + name(other) + " before its last read");
      }
      for (const Piece& piece : theirs.writes) {
        if (!is_done(piece))
          fail(name(resource) + " takes the memory of " + name(other) +
               " before its last write is done");
      }
    }
  }
}

// Whether the subresource is in the layout and with the owner that the change expects.
void Replay::check_state_of_change(const Transition& t, const Scopes& scopes, const Sub& sub) {
  const auto queue = scopes.queue;
  const bool transfer = family(static_cast<std::uint8_t>(t.src_queue)) !=
                        family(static_cast<std::uint8_t>(t.dst_queue));
  const bool acquires = transfer && queue == static_cast<std::uint8_t>(t.dst_queue);
  const bool texture = graph_.resources[t.resource].kind == ResourceKind::texture;
  if (texture && t.old_layout != VK_IMAGE_LAYOUT_UNDEFINED && t.old_layout != sub.layout)
    fail("a change of " + name(t.resource) + " expects layout " + std::to_string(t.old_layout) +
         ", but it is in " + std::to_string(sub.layout));
  if (acquires && (!sub.released || sub.released_to != family(queue) ||
                   (texture && sub.released_layout != t.new_layout)))
    fail(name(t.resource) + " is acquired by a queue family to which it was not released so");
  if (!acquires && sub.released) fail(name(t.resource) + " is used between release and acquire");
  if (!transfer && sub.family != kNone && sub.family != family(queue) &&
      t.old_layout != VK_IMAGE_LAYOUT_UNDEFINED)
    fail(name(t.resource) + " is changed by a queue family that does not own it");
}

void Replay::change(const Transition& t, QueueClass on) {
  const Scopes scopes = scopes_of(t, on);
  const std::uint32_t src = family(static_cast<std::uint8_t>(t.src_queue));
  const std::uint32_t dst = family(static_cast<std::uint8_t>(t.dst_queue));
  const bool releases = src != dst && on == t.src_queue;
  for_each_sub(t.resource, t.range, [&](Sub& sub) {
    sub.reads.clear();
    sub.writes.clear();
    sub.writes.push_back(change_piece(scopes.queue, scopes.dst, scopes.dst_access));
    if (releases) {
      // Nothing on this queue follows it; the submission's signal does.
      sub.writes.back() = Piece{};
      sub.writes.back().queue = scopes.queue;
      sub.writes.back().stage = ~Stages{0};
      sub.released = true;
      sub.released_to = dst;
      sub.released_layout = t.new_layout;
      return;
    }
    sub.released = false;
    sub.family = family(scopes.queue);
    if (graph_.resources[t.resource].kind != ResourceKind::texture) return;
    if (t.old_layout == VK_IMAGE_LAYOUT_UNDEFINED) sub.content = kGarbage;
    sub.layout = t.new_layout;
  });
}

void Replay::pass(std::uint32_t position) {
  const std::uint32_t pass = plan_.passes[position].pass;
  const std::uint32_t first = graph_.passes[pass].first_access;
  const auto count = static_cast<std::uint32_t>(graph_.pass_accesses(pass).size());
  for (std::uint32_t i = first; i < first + count; ++i) {
    if (plan_.live_accesses[i]) check_access(position, i);
  }
  for (std::uint32_t i = first; i < first + count; ++i) {
    if (plan_.live_accesses[i]) apply_access(position, i);
  }
}

template <typename Function>
void Replay::for_each_piece(Function&& f) {
  for (Resource& resource : resources_) {
    for (Sub& sub : resource.subs) {
      for (Piece& piece : sub.writes) f(piece);
      for (Piece& piece : sub.reads) f(piece);
    }
  }
}

template <typename Function>
void Replay::for_each_sub(std::uint32_t resource, const Range& range, Function&& f) {
  const ResourceRecord& record = graph_.resources[resource];
  if (record.kind == ResourceKind::buffer) {
    f(resources_[resource].subs[0]);
    return;
  }
  for (std::uint32_t layer = 0; layer < range.layers; ++layer) {
    for (std::uint32_t mip = 0; mip < range.mips; ++mip)
      f(resources_[resource].subs[(range.base_layer + layer) * record.mips + range.base_mip + mip]);
  }
}

void Replay::fail(const std::string& what) {
  errors_.push_back({ErrorCode::verification, where_ + ": " + what, VK_SUCCESS, kNone, kNone, 0});
}

std::string Replay::name(std::uint32_t resource) const {
  return std::string("'").append(graph_.resource_name(resource)).append("'");
}

std::uint32_t Replay::family(std::uint8_t queue) const { return limits_.queue_families[queue]; }

}  // namespace alcove::framegraph::verifier
