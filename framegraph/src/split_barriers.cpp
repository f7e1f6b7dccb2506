// Split barriers: batches with passes between what they wait for and what waits become events.
#include <utility>

#include "synchronise.h"

namespace alcove::framegraph {

// The pass after which all is there that a pass's batch waits for, if others run between the two.
std::uint32_t Synchroniser::set_position(std::uint32_t position) const {
  const PlannedPass& planned = plan_.passes[position];
  if (planned.batch_count == 0 || !can_split(plan_.batches[planned.first_batch])) return kNone;
  const std::int32_t latest = s_.latest[planned.first_batch];
  const std::uint32_t floor = plan_.submissions[planned.submission].first_pass;
  if (latest < static_cast<std::int32_t>(2 * floor)) return kNone;
  const auto after = static_cast<std::uint32_t>(latest) / 2;
  return after + 1 < position ? after : kNone;
}

void Synchroniser::split() {
  const auto count = static_cast<std::uint32_t>(plan_.passes.size());
  for (std::uint32_t position = 0; position < count; ++position) {
    const std::uint32_t after = set_position(position);
    if (after != kNone) ++plan_.passes[after].set_count;
  }
  std::uint32_t events = 0;
  for (PlannedPass& planned : plan_.passes) {
    planned.first_set = events;
    events += std::exchange(planned.set_count, 0);
  }
  plan_.sets.resize(events);
  for (std::uint32_t position = 0; position < count; ++position) {
    const std::uint32_t after = set_position(position);
    if (after == kNone) continue;
    const std::uint32_t event = plan_.passes[after].first_set + plan_.passes[after].set_count++;
    plan_.sets[event] = plan_.passes[position].first_batch;
    plan_.batches[plan_.passes[position].first_batch].event = event;
  }
}

// Events are of one queue family, and not for the host.
bool Synchroniser::can_split(const Batch& batch) const {
  for (std::uint32_t i = batch.first; i < batch.first + batch.count; ++i) {
    const Transition& t = plan_.transitions[i];
    if (((t.src_stages | t.dst_stages) & VK_PIPELINE_STAGE_2_HOST_BIT) != 0) return false;
    if (t.src_queue != t.dst_queue) return false;
  }
  return true;
}

}  // namespace alcove::framegraph
