#include "trace.h"

#include <utility>

namespace alcove::framegraph {
namespace {

constexpr VkAccessFlags2 kMeta = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
// The stages in which the commands of these tests run.
constexpr VkPipelineStageFlags2 kCommandStages =
    VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT |
    VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT |
    VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT |
    VK_PIPELINE_STAGE_2_COPY_BIT | VK_PIPELINE_STAGE_2_CLEAR_BIT;

class Tracer {
 public:
  Tracer(const GraphDescription& graph, const Plan& plan) : graph_(graph), plan_(plan) {}

  Trace run() {
    for (std::uint32_t frame = 0; frame < 2; ++frame) unroll(frame);
    return std::move(trace_);
  }

 private:
  void unroll(std::uint32_t frame) {
    for (std::uint32_t r = 0; r < graph_.resources.size(); ++r) {
      const std::uint32_t external = graph_.resources[r].external;
      if (external == kNone) continue;
      const ExternalRecord& record = graph_.externals[external];
      outside(r, record.initial_state, frame, static_cast<std::size_t>(record.queue));
    }
    for (std::uint32_t s = 0; s < plan_.submissions.size(); ++s) unroll_submission(s, frame);
    for (std::uint32_t r = 0; r < graph_.resources.size(); ++r) {
      const std::uint32_t external = graph_.resources[r].external;
      if (external != kNone && graph_.externals[external].has_final_state &&
          plan_.placements[r].first != kNone)
        depart(r, graph_.externals[external].final_state, frame);
    }
  }

  void unroll_submission(std::uint32_t index, std::uint32_t frame) {
    const Submission& submission = plan_.submissions[index];
    Step step;
    step.queue = static_cast<std::size_t>(submission.queue);
    step.kind = Step::Kind::begins;
    const auto first = frame * static_cast<std::uint32_t>(plan_.submissions.size());
    for (std::uint32_t w = 0; w < submission.wait_count; ++w) {
      step.waits.push_back(plan_.waits[submission.first_wait + w]);
      step.waits.back().submission += first;
    }
    for (std::uint32_t other = 0; other < plan_.submissions.size() && frame == 1; ++other) {
      const auto queue = static_cast<unsigned>(plan_.submissions[other].queue);
      if (submission.frame_before & (1u << queue))
        step.waits.push_back({other, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT});
    }
    trace_.steps.push_back(step);
    for (std::uint32_t p = 0; p < submission.pass_count; ++p)
      unroll_pass(plan_.passes[submission.first_pass + p], frame);
    batches(submission.first_batch, submission.batch_count, step.queue, frame);
    step.kind = Step::Kind::ends;
    step.submission = first + index;
    trace_.steps.push_back(step);
  }

  void unroll_pass(const PlannedPass& planned, std::uint32_t frame) {
    const auto queue = static_cast<std::size_t>(planned.queue);
    batches(planned.first_batch, planned.batch_count, queue, frame);
    const auto accesses = graph_.pass_accesses(planned.pass);
    for (std::size_t i = 0; i < accesses.size(); ++i)
      if (plan_.live_accesses[graph_.passes[planned.pass].first_access + i])
        add_access(accesses[i], queue, frame);
  }

  void outside(std::uint32_t resource, const State& state, std::uint32_t frame, std::size_t queue) {
    const ResourceRecord& r = graph_.resources[resource];
    AccessRecord access;
    access.stages = state.stages;
    access.access = state.access;
    access.flags = plain_access(state.access) & kWriteMask ? kWrite : 0u;
    access.resource = resource;
    access.range = {0, static_cast<std::uint16_t>(r.mips), 0, static_cast<std::uint16_t>(r.layers)};
    if (state.stages == 0) return;
    add_access(access, queue, frame);
  }

  void depart(std::uint32_t resource, const State& final_state, std::uint32_t frame) {
    const std::size_t first = trace_.operations.size();
    outside(resource, final_state, frame, static_cast<std::size_t>(QueueClass::graphics));
    for (std::size_t i = first; i < trace_.operations.size(); ++i)
      trace_.operations[i].departs = true;
  }

  void add_access(const AccessRecord& access, std::size_t queue, std::uint32_t frame) {
    Operation operation;
    operation.queue = queue;
    operation.stages = plain(access.stages);
    operation.access = plain_access(access.access);
    operation.writes = (access.flags & kWrite) != 0;
    operation.unordered = (access.flags & kUnordered) != 0;
    add(operation, access.resource, access.range, frame);
  }

  void add(Operation operation, std::uint32_t resource, const Range& range, std::uint32_t frame) {
    const ResourceRecord& r = graph_.resources[resource];
    operation.resource = resource;
    operation.frame = frame;
    operation.step = static_cast<std::uint32_t>(trace_.steps.size());
    if (r.kind == ResourceKind::buffer) {
      trace_.operations.push_back(operation);
      return;
    }
    for (std::uint32_t layer = range.base_layer; layer < range.base_layer + range.layers; ++layer) {
      for (std::uint32_t mip = range.base_mip; mip < range.base_mip + range.mips; ++mip) {
        operation.sub = layer * r.mips + mip;
        trace_.operations.push_back(operation);
      }
    }
  }

  void batches(std::uint32_t first, std::uint32_t count, std::size_t queue, std::uint32_t frame) {
    for (std::uint32_t b = first; b < first + count; ++b) {
      const Batch& batch = plan_.batches[b];
      Step step;
      step.queue = queue;
      step.operations_before = trace_.operations.size();
      step.steps_before = static_cast<std::uint32_t>(trace_.steps.size());
      for (std::uint32_t t = batch.first; t < batch.first + batch.count; ++t)
        step.barriers.push_back(&plan_.transitions[t]);
      trace_.steps.push_back(step);
      for (const Transition* t : step.barriers)
        if (t->resource != kNone) add_change(*t, queue, frame);
    }
  }

  void add_change(const Transition& t, std::size_t queue, std::uint32_t frame) {
    Operation change;
    change.queue = queue;
    change.writes = true;
    change.change = &t;
    change.stages = plain(t.dst_stages);
    change.access = plain_access(t.dst_access);
    change.releases = t.src_queue != t.dst_queue && static_cast<std::size_t>(t.src_queue) == queue;
    add(change, t.resource, t.range, frame);
  }

  const GraphDescription& graph_;
  const Plan& plan_;
  Trace trace_;
};

}  // namespace

VkPipelineStageFlags2 plain(VkPipelineStageFlags2 stages) {
  if (!(stages & VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT)) return stages;
  return (stages & ~VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT) | kCommandStages;
}

VkAccessFlags2 plain_access(VkAccessFlags2 access) {
  if (access & VK_ACCESS_2_MEMORY_WRITE_BIT) access |= kWriteMask;
  if (access & VK_ACCESS_2_MEMORY_READ_BIT) access |= ~(kWriteMask | kMeta);
  return access & ~kMeta;
}

Trace trace_of(const GraphDescription& graph, const Plan& plan) {
  return Tracer(graph, plan).run();
}

}  // namespace alcove::framegraph
