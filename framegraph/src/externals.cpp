// Imports and histories: their states at the start of the frame, and how the frame leaves them.
#include "synchronise.h"

namespace alcove::framegraph {
namespace {

// Records in `state` that earlier writes are already visible to the read accesses of an initial
// state, and not to other stages and accesses.
void record_visibility(UseState& state, const State& initial_state) {
  const bool every_access = (initial_state.access & VK_ACCESS_2_MEMORY_READ_BIT) != 0;
  const bool every_stage = (initial_state.stages & VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT) != 0;
  state.write_stages = initial_state.stages;
  state.write_time = kBeforeFrame;
  state.seen_access = every_access ? kEveryAccess : initial_state.access;
  if (every_access && every_stage)
    state.seen_stages = ~VkPipelineStageFlags2{VK_PIPELINE_STAGE_2_HOST_BIT};
  else if (initial_state.access != 0)
    state.seen_stages = initial_state.stages;
}

void record_external(UseState& state, const ExternalRecord& external) {
  const State& initial_state = external.initial_state;
  if (initial_state.access & kWriteBits) {
    state.write_stages = initial_state.stages;
    state.write_access = initial_state.access & kWriteBits;
    state.write_time = kBeforeFrame;
  } else {
    state.read_stages = initial_state.stages;
    state.read_time = kBeforeFrame;
    if (initial_state.stages != 0) record_visibility(state, initial_state);
  }
  if (!external.has_contents) return;
  state.layout = initial_state.layout;
}

}  // namespace

void Synchroniser::apply_initial_states() {
  if (graph_.externals.empty()) return;
  const auto& first = workspace_.first_sub;
  for (std::uint32_t r = 0; r < graph_.resources.size(); ++r) {
    if (graph_.resources[r].external == kNone) continue;
    const ExternalRecord& external = graph_.externals[graph_.resources[r].external];
    UseState state;
    record_external(state, external);
    if (family(external.queue) != kNone) state.owner = external.queue;
    for (std::uint32_t sub = first[r]; sub < first[r + 1]; ++sub) {
      states_on(state.owner)[sub] = state;
      tell_other_queues(sub, state);
    }
  }
  s_.written.assign(subs_, 0);
  for (const PlannedPass& planned : plan_.passes) {
    for (const AccessRecord& access : graph_.pass_accesses(planned.pass)) {
      if (!(access.flags & kWrite) || graph_.resources[access.resource].origin != Origin::history)
        continue;
      for_each_sub(graph_, workspace_, access, [&](std::uint32_t sub) { s_.written[sub] = 1; });
    }
  }
}

void Synchroniser::apply_final_states() {
  const auto end = static_cast<std::uint32_t>(plan_.passes.size());
  const std::uint32_t last = workspace_.final_submission;
  if (several()) {
    if (last != kNone && plan_.submissions[last].pass_count == 0) begin_submission(last);
    earliest_ = batch_time(end) - 1;
  }
  for (std::uint32_t r = 0; r < graph_.resources.size() && !graph_.externals.empty(); ++r) {
    const ResourceRecord& resource = graph_.resources[r];
    if (resource.external == kNone) continue;
    const ExternalRecord& external = graph_.externals[resource.external];
    const bool used = plan_.placements[r].first != kNone;
    set_queue(QueueClass::graphics);
    if (external.has_final_state) {
      end_reads(r, external.final_state);
      use(end, use_outside_frame(r, external.final_state));
    }
    if (used && resource.origin == Origin::history) leave_history_slot(r);
  }
  plan_.final_submission = last;
  plan_.final_batch = batch_time_ == batch_time(end) && !plan_.batches.empty()
                          ? static_cast<std::uint32_t>(plan_.batches.size() - 1)
                          : kNone;
}

// Orders the reads of an import before its final state. Work after the frame waits only for the
// stages of the final state, so that a barrier from the reading stages to those stages is added. It
// is not needed if the final state brings a layout change or a write, which wait for the reads
// anyway.
void Synchroniser::end_reads(std::uint32_t resource, const State& final_state) {
  const bool texture = graph_.resources[resource].kind == ResourceKind::texture;
  if ((final_state.access & kWriteBits) != 0 || final_state.stages == 0 ||
      (final_state.stages & VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT) != 0)
    return;
  const std::uint32_t last = workspace_.first_sub[resource + 1];
  Transition wanted;
  wanted.dst_stages = final_state.stages;
  for (std::uint32_t sub = workspace_.first_sub[resource]; sub < last; ++sub)
    if (!texture || states_[sub].layout == final_state.layout)
      wanted.src_stages |= states_[sub].read_stages & ~final_state.stages;
  if (wanted.src_stages == 0) return;
  // Finds the last read in another stage, which may come before other reads.
  const Placement& placement = plan_.placements[resource];
  std::int32_t time = kBeforeFrame;
  for (std::uint32_t p = placement.first; placement.first != kNone && p <= placement.last; ++p) {
    for (const AccessRecord& access : graph_.pass_accesses(plan_.passes[p].pass))
      if (access.resource == resource && (access.stages & ~final_state.stages) != 0)
        time = pass_time(p);
  }
  add_memory(time, static_cast<std::uint32_t>(plan_.passes.size()), wanted);
}

AccessRecord Synchroniser::use_outside_frame(std::uint32_t resource, const State& state) const {
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

// Finds the state in which the frame leaves a history slot, and changes layouts at the end of the
// frame if the subresources of the slot would be left in different ones.
void Synchroniser::leave_history_slot(std::uint32_t resource) {
  const std::uint32_t first = workspace_.first_sub[resource];
  const std::uint32_t last = workspace_.first_sub[resource + 1];
  FinalState final{resource, {}, QueueClass::graphics, WriteCoverage::nothing};
  if (several()) final.queue = workspace_.queues.last_queue[resource];
  set_queue(final.queue);
  std::uint32_t written = 0;
  bool alike = true;
  bool seen_alike = true;
  const UseState& lead = states_[first];
  bool elsewhere = false;
  for (std::uint32_t sub = first; sub < last; ++sub) {
    const UseState& state = states_[sub];
    elsewhere = elsewhere || is_used_elsewhere(sub);
    alike = alike && state.layout == lead.layout;
    seen_alike = seen_alike && state.read_stages == lead.read_stages &&
                 state.seen_stages == lead.seen_stages && state.seen_access == lead.seen_access;
    // A change on another queue was waited for by all commands.
    final.state.stages |= state.read_stages != 0    ? state.read_stages
                          : state.write_stages != 0 ? state.write_stages
                          : state.by_wait
                              ? VkPipelineStageFlags2{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT}
                              : 0;
    if (state.read_stages == 0) final.state.access |= state.write_access;
    written += s_.written[sub];
  }
  if (written != 0)
    final.written = written == last - first ? WriteCoverage::whole : WriteCoverage::part;
  // If the last write is visible to the same accesses in all subresources, these accesses become
  // part of the final state.
  if (final.state.access == 0 && seen_alike && (lead.read_stages & ~lead.seen_stages) == 0)
    final.state.access = reads_in(lead.seen_access);
  final.state.layout = lead.layout;
  if (!alike) {
    final.state = {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT,
                   VK_IMAGE_LAYOUT_GENERAL};
    use(static_cast<std::uint32_t>(plan_.passes.size()), use_outside_frame(resource, final.state));
  }
  if (elsewhere) add_stages(final.state.stages);
  plan_.finals.push_back(final);
}

}  // namespace alcove::framegraph
