// The verifier's checks of single accesses, and of how a frame ends.
#include <algorithm>

#include "verify_replay.h"

namespace alcove::framegraph::verifier {
namespace {

template <typename Subs, typename Function>
void for_each_of_range(Subs& subs, const ResourceRecord& record, const Range& range, Function&& f) {
  std::uint32_t index = 0;
  if (record.kind == ResourceKind::buffer) {
    f(subs[0], index);
    return;
  }
  for (std::uint32_t layer = 0; layer < range.layers; ++layer) {
    for (std::uint32_t mip = 0; mip < range.mips; ++mip)
      f(subs[(range.base_layer + layer) * record.mips + range.base_mip + mip], index++);
  }
}

}  // namespace

void Replay::check_access(std::uint32_t position, std::uint32_t access_index) {
  const AccessRecord& access = graph_.accesses[access_index];
  const auto queue = static_cast<std::uint8_t>(plan_.passes[position].queue);
  check_shared_memory(access, queue);
  for_each_of_range(resources_[access.resource].subs, graph_.resources[access.resource],
                    access.range, [&](Sub& sub, std::uint32_t i) {
                      const std::uint32_t expected = expected_[access_index][i];
                      check_state(access, sub, queue);
                      if (access.flags & kWrite)
                        check_write(access, expected, sub, queue);
                      else
                        check_read(access, expected, sub, queue);
                    });
}

void Replay::check_state(const AccessRecord& access, const Sub& sub, std::uint8_t queue) {
  const ResourceRecord& record = graph_.resources[access.resource];
  if (record.kind == ResourceKind::texture && sub.layout != access.layout)
    fail(name(access.resource) + " is in layout " + std::to_string(sub.layout) + ", needed is " +
         std::to_string(access.layout));
  if (sub.released) fail(name(access.resource) + " is used between release and acquire");
  // A buffer whose contents are thrown away can be taken by anybody.
  const bool taken = record.kind == ResourceKind::buffer && (access.flags & kDiscard);
  if (!taken && sub.family != kNone && sub.family != family(queue))
    fail(name(access.resource) + " is used by a queue family that does not own it");
}

void Replay::check_read(const AccessRecord& access, std::uint32_t expected, const Sub& sub,
                        std::uint8_t queue) {
  const ResourceRecord& record = graph_.resources[access.resource];
  // What a history slot holds before it was ever written is nobody's business.
  const bool any = record.origin == Origin::history && expected == kGarbage;
  if (!any && (sub.content != expected || sub.spoiled))
    fail("the read of " + name(access.resource) + " does not find what was written for it");
  for (const Piece& piece : sub.writes) {
    if (!ordered(piece, queue, access.stages))
      fail("the read of " + name(access.resource) + " does not come after its write");
    else if (!visible(piece, queue, access.stages, access.access))
      fail("the read of " + name(access.resource) + " comes after its write, but cannot see it");
  }
}

void Replay::check_write(const AccessRecord& access, std::uint32_t expected, Sub& sub,
                         std::uint8_t queue) {
  for (const Piece& piece : sub.reads) {
    if (!ordered(piece, queue, access.stages))
      fail("the write of " + name(access.resource) + " overtakes a read");
  }
  // A write right after a write must see it; after reads it comes after those, and what it reads
  // itself it must see.
  const Accesses seen = sub.reads.empty()         ? access.access
                        : access.flags & kDiscard ? Accesses{0}
                                                  : reads_of(access.access);
  for (const Piece& piece : sub.writes) {
    if (!available(piece, queue, access.stages) || !visible(piece, queue, access.stages, seen))
      fail("the write of " + name(access.resource) + " overtakes a write, or cannot see it");
  }
  if (access.flags & kDiscard) {
    sub.spoiled = false;
    return;
  }
  if (expected == kGarbage || (sub.content == expected && !sub.spoiled)) return;
  if (reads_of(access.access) != 0)
    fail("the update of " + name(access.resource) + " does not find what was written for it");
  sub.spoiled = true;
}

// Whoever had these bytes before must be done.
void Replay::check_shared_memory(const AccessRecord& access, std::uint8_t queue) {
  const auto& own = resources_[access.resource].subs;
  const bool first =
      std::all_of(own.begin(), own.end(), [](const Sub& sub) { return sub.content == kGarbage; });
  const Accesses writes = first ? access.access & ~reads_of(access.access) : Accesses{0};
  for (std::uint32_t other : resources_[access.resource].overlapping) {
    for (const Sub& theirs : resources_[other].subs) {
      for (const Piece& piece : theirs.reads) {
        if (!ordered(piece, queue, access.stages))
          fail(name(access.resource) + " takes the memory of " + name(other) +
               " before its last read");
      }
      for (const Piece& piece : theirs.writes) {
        if (!available(piece, queue, access.stages) ||
            (theirs.reads.empty() && !visible(piece, queue, access.stages, writes)))
          fail(name(access.resource) + " takes the memory of " + name(other) +
               " before its last write is done");
      }
    }
  }
}

void Replay::apply_access(std::uint32_t position, std::uint32_t access_index) {
  const AccessRecord& access = graph_.accesses[access_index];
  const auto queue = static_cast<std::uint8_t>(plan_.passes[position].queue);
  for_each_of_range(resources_[access.resource].subs, graph_.resources[access.resource],
                    access.range, [&](Sub& sub, std::uint32_t) {
                      if (access.flags & kWrite) {
                        sub.reads.clear();
                        sub.writes.clear();
                        sub.content = access_index;
                        sub.family = family(queue);
                        append_pieces(sub.writes, queue, access.stages, access.access);
                      } else {
                        append_pieces(sub.reads, queue, access.stages, 0);
                      }
                    });
  if (!(access.flags & kWrite)) return;
  // Its bytes are nobody else's now.
  for (std::uint32_t other : resources_[access.resource].overlapping) {
    for (Sub& theirs : resources_[other].subs) theirs.content = kGarbage;
  }
}

void Replay::end_frame() {
  where_ = "at the end of the frame";
  for (std::uint32_t r = 0; r < resources_.size(); ++r) {
    const ResourceRecord& record = graph_.resources[r];
    if (record.external != kNone && graph_.externals[record.external].has_final_state)
      check_final_state(r);
  }
  for (const OutputRecord& output : graph_.outputs) {
    const auto& subs = resources_[output.resource].subs;
    for (std::size_t i = 0; i < subs.size(); ++i) {
      const std::uint32_t expected = last_[output.resource][i];
      if (expected == kGarbage) continue;
      if (subs[i].content != expected || subs[i].spoiled)
        fail("output " + name(output.resource) + " does not hold what was written for it");
    }
  }
  for (const FinalState& final : plan_.finals) check_final(final);
}

void Replay::check_final_state(std::uint32_t resource) {
  const ResourceRecord& record = graph_.resources[resource];
  const State& final_state = graph_.externals[record.external].final_state;
  const auto queue = static_cast<std::uint8_t>(QueueClass::graphics);
  for (std::size_t i = 0; i < resources_[resource].subs.size(); ++i) {
    const Sub& sub = resources_[resource].subs[i];
    const std::uint32_t expected = last_[resource][i];
    if (record.kind == ResourceKind::texture && sub.layout != final_state.layout)
      fail(name(resource) + " is left in layout " + std::to_string(sub.layout) +
           ", its final_state is " + std::to_string(final_state.layout));
    if (expected != kGarbage && (sub.content != expected || sub.spoiled))
      fail(name(resource) + " does not leave with what was written for it");
    if (sub.released || (sub.family != kNone && sub.family != family(queue)))
      fail(name(resource) + " is left with another queue family than it came with");
    for (const Piece& piece : sub.reads) {
      // Whoever has it next waits for its own stages alone, or for what they come after.
      const bool waited_for = !is_write(final_state.access) && piece.queue == queue &&
                              (piece.stage & ~expand_stages(final_state.stages)) == 0;
      if (!waited_for && !ordered(piece, queue, final_state.stages))
        fail(name(resource) + " leaves before its last read is done");
    }
    for (const Piece& piece : sub.writes) {
      if (!ordered(piece, queue, final_state.stages) ||
          !visible(piece, queue, final_state.stages, final_state.access))
        fail(name(resource) + " leaves before its last write can be seen");
    }
  }
}

// The next frame arrives in what this one claims to leave.
void Replay::check_final(const FinalState& final) {
  if (final.resource >= resources_.size()) {
    fail("the final state of a resource that was not declared");
    return;
  }
  const Stages stages = expand_stages(final.state.stages);
  for (const Sub& sub : resources_[final.resource].subs) {
    if (graph_.resources[final.resource].kind == ResourceKind::texture &&
        sub.layout != final.state.layout)
      fail(name(final.resource) + " is said to be left in another layout than it is");
    for (const Piece& piece : sub.reads) {
      if (piece.stage & ~stages) fail(name(final.resource) + " is read by a stage not told of");
    }
    check_final_writes(final, sub);
    if (sub.family != kNone && sub.family != family(static_cast<std::uint8_t>(final.queue)))
      fail(name(final.resource) + " is said to be owned by another queue than it is");
  }
}

void Replay::check_final_writes(const FinalState& final, const Sub& sub) {
  const Stages stages = expand_stages(final.state.stages);
  const Accesses accesses = expand_accesses(final.state.access);
  const auto queue = static_cast<std::uint8_t>(final.queue);
  for (const Piece& piece : sub.writes) {
    if (is_write(accesses)) {
      if (sub.reads.empty() && ((piece.stage & ~stages) || (piece.writes & ~accesses)))
        fail(name(final.resource) + " is written in a way not told of");
    } else if (!several_queues_ && stages != 0) {
      const bool seen = accesses == 0 ? (piece.available[queue] & stages) != 0
                                      : available(piece, queue, final.state.stages) &&
                                            visible(piece, queue, final.state.stages, accesses);
      if (!seen) fail(name(final.resource) + " is said to be seen by what does not see it");
    }
  }
}

}  // namespace alcove::framegraph::verifier
