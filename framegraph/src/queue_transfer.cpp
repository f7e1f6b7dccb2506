// Moves resources from one queue to another. A semaphore wait between the two submissions orders
// the uses. If the queues are of different families, there is also an ownership release after the
// last pass of the first submission, and an acquire before the pass that uses the resource next.
#include <algorithm>

#include "synchronise.h"

namespace alcove::framegraph {

// Orders the access after the uses on another queue. Returns true if a queue ownership transfer was
// added. The transfer also changes the layout, so that the access needs no other barrier.
bool Synchroniser::change_queue(std::uint32_t position, const AccessRecord& access, UseState& state,
                                const Range& range) {
  const auto family = [this](QueueClass queue) {
    return limits_.queue_families[static_cast<std::size_t>(queue)];
  };
  const bool same_family = family(state.queue) == family(queue_);
  const bool texture = graph_.resources[access.resource].kind == ResourceKind::texture;
  const bool keeps = state.used && !(access.flags & kDiscard) &&
                     (!texture || state.layout != VK_IMAGE_LAYOUT_UNDEFINED);
  if (!keeps || same_family) {
    acquire_without_release(position, state, same_family);
    return false;
  }
  const Transition release = release_of(access, state, range);
  s_.releases.push_back(
      {releasing_submission(state), static_cast<std::uint32_t>(s_.releases.size()), release});
  Transition& acquire = next_image(kBeforeFrame, position);
  acquire = release;
  acquire.src_stages = waited_stages(access);
  acquire.src_access = 0;
  acquire.dst_stages = access.stages;
  acquire.dst_access = access.access;
  merge_neighbours();
  record_transition(position, access, state);
  return true;
}

// Returns the submission that releases the subresource: the last one that uses it on its queue.
std::uint32_t Synchroniser::releasing_submission(const UseState& state) const {
  const std::int32_t time = std::max(state.read_time, state.write_time);
  if (time >= 0) return plan_.passes[static_cast<std::size_t>(time / 2)].submission;
  const std::uint32_t opening = workspace_.queues.opening[static_cast<std::size_t>(state.queue)];
  if (opening != kNone) return opening;
  // A subresource of the history that no pass of this frame used is transferred at the end of the
  // frame. Any submission on its queue may release it.
  const auto own = std::find_if(
      plan_.submissions.begin(), plan_.submissions.end(),
      [&state](const Submission& submission) { return submission.queue == state.queue; });
  return static_cast<std::uint32_t>(own - plan_.submissions.begin());
}

// Moves a resource to the current queue without an ownership transfer: the queues are of the same
// family, or the contents are discarded, so that the layout can change from
// VK_IMAGE_LAYOUT_UNDEFINED.
void Synchroniser::acquire_without_release(std::uint32_t position, UseState& state,
                                           bool same_family) {
  UseState taken;
  taken.queue = queue_;
  taken.by_wait = 1;
  taken.used = state.used;
  taken.layout = same_family ? state.layout : VK_IMAGE_LAYOUT_UNDEFINED;
  if (state.reuses_memory) {
    // The resource that occupied this memory before may have been used on the current queue, where
    // no semaphore wait orders its use before this one.
    taken.reuses_memory = 1;
    taken.frame_before = state.frame_before;
    wait_for_frame_before(position, state.frame_before);
    taken.write_stages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    taken.write_access = VK_ACCESS_2_MEMORY_WRITE_BIT;
  } else {
    // The wait covers all commands, but not the host.
    taken.seen_stages = ~VkPipelineStageFlags2{VK_PIPELINE_STAGE_2_HOST_BIT};
    taken.seen_access = kEveryAccess;
  }
  state = taken;
}

Transition Synchroniser::release_of(const AccessRecord& access, const UseState& state,
                                    const Range& range) const {
  const bool texture = graph_.resources[access.resource].kind == ResourceKind::texture;
  Transition release;
  release.src_stages = state.read_stages != 0 ? state.read_stages : state.write_stages;
  release.src_access = state.read_stages != 0 ? 0 : state.write_access;
  release.resource = access.resource;
  release.range = range;
  release.old_layout = texture ? state.layout : VK_IMAGE_LAYOUT_UNDEFINED;
  release.new_layout = texture ? access.layout : VK_IMAGE_LAYOUT_UNDEFINED;
  release.src_queue = state.queue;
  release.dst_queue = queue_;
  if (release.src_stages == 0) release.src_stages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  return release;
}

// Adds the releases after the last passes of their submissions.
void Synchroniser::add_releases() {
  std::sort(s_.releases.begin(), s_.releases.end(), [](const auto& a, const auto& b) {
    return a.submission != b.submission ? a.submission < b.submission : a.number < b.number;
  });
  for (const auto& release : s_.releases) {
    Submission& submission = plan_.submissions[release.submission];
    if (submission.batch_count == 0) {
      submission.first_batch = static_cast<std::uint32_t>(plan_.batches.size());
      submission.batch_count = 1;
      plan_.batches.push_back({static_cast<std::uint32_t>(plan_.transitions.size()), 0});
    }
    plan_.transitions.push_back(release.transition);
    ++plan_.batches.back().count;
  }
  s_.releases.clear();
}

}  // namespace alcove::framegraph
