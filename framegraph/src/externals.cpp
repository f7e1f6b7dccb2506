// What comes from outside the frame and goes there again: how imports and histories arrive, and how
// they are left.
#include "synchronise.h"

namespace alcove::framegraph {
namespace {

void note_external(UseState& state, const ExternalRecord& external) {
  const State& arrival = external.arrival;
  if (arrival.access & kWriteBits) {
    state.write_stages = arrival.stages;
    state.write_access = arrival.access & kWriteBits;
    state.write_time = kBeforeFrame;
  } else {
    state.read_stages = arrival.stages;
    state.read_time = kBeforeFrame;
  }
  if (!external.has_contents) return;
  state.layout = arrival.layout;
  state.used = 1;
}

}  // namespace

void Synchroniser::arrive() {
  if (graph_.externals.empty()) return;
  const auto& first = workspace_.first_sub;
  for (std::uint32_t r = 0; r < graph_.resources.size(); ++r) {
    if (graph_.resources[r].external == kNone) continue;
    const ExternalRecord& external = graph_.externals[graph_.resources[r].external];
    for (std::uint32_t sub = first[r]; sub < first[r + 1]; ++sub) {
      s_.states[sub] = {};
      note_external(s_.states[sub], external);
      const auto queue = static_cast<std::size_t>(external.queue);
      if (limits_.queue_families[queue] != kNone) s_.states[sub].queue = external.queue;
    }
  }
}

void Synchroniser::depart() {
  const auto end = static_cast<std::uint32_t>(plan_.passes.size());
  if (workspace_.several_queues) earliest_ = batch_time(end) - 1;
  for (std::uint32_t r = 0; r < graph_.resources.size() && !graph_.externals.empty(); ++r) {
    queue_ = QueueClass::graphics;
    const ResourceRecord& resource = graph_.resources[r];
    if (resource.external == kNone) continue;
    const ExternalRecord& external = graph_.externals[resource.external];
    const bool used = plan_.placements[r].first != kNone;
    if (external.has_departure && used) end_reads(r, external.departure);
    if (external.has_departure && (used || external.departure.layout != external.arrival.layout))
      use(end, outside_use(r, external.departure));
    if (used && resource.origin == Origin::history) leave(r);
  }
  if (batch_time_ == batch_time(end) && !plan_.batches.empty()) {
    Submission& last = plan_.submissions.back();
    last.first_batch = static_cast<std::uint32_t>(plan_.batches.size() - 1);
    last.batch_count = 1;
  }
  if (!s_.releases.empty()) add_releases();
}

// Whoever has it next waits for its own uses alone, so these come after reads that they do not
// cover. A change or a write does by itself.
void Synchroniser::end_reads(std::uint32_t resource, const State& departure) {
  const bool texture = graph_.resources[resource].kind == ResourceKind::texture;
  if ((departure.access & kWriteBits) != 0 || departure.stages == 0 ||
      (departure.stages & VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT) != 0)
    return;
  const std::uint32_t last = workspace_.first_sub[resource + 1];
  for (std::uint32_t sub = workspace_.first_sub[resource]; sub < last; ++sub) {
    const UseState& state = s_.states[sub];
    if (state.queue != queue_ || (texture && state.layout != departure.layout)) continue;
    Transition wanted;
    wanted.src_stages = state.read_stages & ~departure.stages;
    wanted.dst_stages = departure.stages;
    if (wanted.src_stages != 0)
      add_memory(state.read_time, static_cast<std::uint32_t>(plan_.passes.size()), wanted);
  }
}

AccessRecord Synchroniser::outside_use(std::uint32_t resource, const State& state) const {
  const ResourceRecord& record = graph_.resources[resource];
  AccessRecord access;
  access.stages = state.stages;
  access.access = state.access;
  access.layout = state.layout;
  access.resource = resource;
  access.flags = (state.access & kWriteBits ? kWrite : 0u) |
                 (record.kind == ResourceKind::buffer ? kOnBuffer : 0u);
  access.range = {0, static_cast<std::uint16_t>(record.mips), 0,
                  static_cast<std::uint16_t>(record.layers)};
  return access;
}

// How a history slot is left: all of it in one layout.
void Synchroniser::leave(std::uint32_t resource) {
  const std::uint32_t first = workspace_.first_sub[resource];
  const std::uint32_t last = workspace_.first_sub[resource + 1];
  FinalState final{resource, {}, QueueClass::graphics, 0};
  bool one_layout = true;
  for (std::uint32_t sub = first; sub < last; ++sub) {
    const UseState& state = s_.states[sub];
    one_layout = one_layout && state.layout == s_.states[first].layout &&
                 state.queue == s_.states[first].queue;
    final.state.stages |= state.read_stages != 0 ? state.read_stages : state.write_stages;
    if (state.read_stages == 0) final.state.access |= state.write_access;
    final.written |= s_.last_uses[sub].write_stages != 0;
  }
  final.state.layout = s_.states[first].layout;
  if (workspace_.several_queues) {
    // Other queues' uses are not followed apart.
    final.state.stages = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    if (final.written) final.state.access = VK_ACCESS_2_MEMORY_WRITE_BIT;
  }
  final.queue = one_layout ? s_.states[first].queue : QueueClass::graphics;
  if (!one_layout) {
    final.state = {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT,
                   VK_IMAGE_LAYOUT_GENERAL};
    use(static_cast<std::uint32_t>(plan_.passes.size()), outside_use(resource, final.state));
  }
  plan_.finals.push_back(final);
}

}  // namespace alcove::framegraph
