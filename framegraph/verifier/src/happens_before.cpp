#include "happens_before.h"

#include <algorithm>

namespace alcove::framegraph::verifier {
namespace {

constexpr Stages kVertexInput =
    VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT | VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT;
constexpr Stages kPreRasterization =
    VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_TESSELLATION_CONTROL_SHADER_BIT |
    VK_PIPELINE_STAGE_2_TESSELLATION_EVALUATION_SHADER_BIT |
    VK_PIPELINE_STAGE_2_GEOMETRY_SHADER_BIT | VK_PIPELINE_STAGE_2_TASK_SHADER_BIT_EXT |
    VK_PIPELINE_STAGE_2_MESH_SHADER_BIT_EXT;
constexpr Stages kTransfer = VK_PIPELINE_STAGE_2_COPY_BIT | VK_PIPELINE_STAGE_2_RESOLVE_BIT |
                             VK_PIPELINE_STAGE_2_BLIT_BIT | VK_PIPELINE_STAGE_2_CLEAR_BIT;
constexpr Stages kGraphics =
    VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT | kVertexInput | kPreRasterization |
    VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT |
    VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT |
    VK_PIPELINE_STAGE_2_TRANSFORM_FEEDBACK_BIT_EXT |
    VK_PIPELINE_STAGE_2_CONDITIONAL_RENDERING_BIT_EXT |
    VK_PIPELINE_STAGE_2_FRAGMENT_SHADING_RATE_ATTACHMENT_BIT_KHR;
constexpr Stages kCommands = kGraphics | kTransfer | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT |
                             VK_PIPELINE_STAGE_2_RAY_TRACING_SHADER_BIT_KHR |
                             VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR |
                             VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_COPY_BIT_KHR;
constexpr Stages kMeta =
    VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT |
    VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT |
    VK_PIPELINE_STAGE_2_PRE_RASTERIZATION_SHADERS_BIT | VK_PIPELINE_STAGE_2_TOP_OF_PIPE_BIT |
    VK_PIPELINE_STAGE_2_BOTTOM_OF_PIPE_BIT;

constexpr Accesses kWrites =
    VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT |
    VK_ACCESS_2_HOST_WRITE_BIT | VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR |
    VK_ACCESS_2_TRANSFORM_FEEDBACK_WRITE_BIT_EXT |
    VK_ACCESS_2_TRANSFORM_FEEDBACK_COUNTER_WRITE_BIT_EXT;
constexpr Accesses kReads =
    VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT | VK_ACCESS_2_INDEX_READ_BIT |
    VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT | VK_ACCESS_2_UNIFORM_READ_BIT |
    VK_ACCESS_2_INPUT_ATTACHMENT_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT |
    VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT |
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_TRANSFER_READ_BIT |
    VK_ACCESS_2_HOST_READ_BIT | VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR |
    VK_ACCESS_2_SHADER_BINDING_TABLE_READ_BIT_KHR |
    VK_ACCESS_2_TRANSFORM_FEEDBACK_COUNTER_READ_BIT_EXT |
    VK_ACCESS_2_CONDITIONAL_RENDERING_READ_BIT_EXT |
    VK_ACCESS_2_FRAGMENT_SHADING_RATE_ATTACHMENT_READ_BIT_KHR;

}  // namespace

Stages expand_stages(Stages stages) {
  Stages plain = stages & ~kMeta;
  if (stages & VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT) plain |= kCommands;
  if (stages & VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT) plain |= kGraphics;
  if (stages & VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT) plain |= kTransfer;
  if (stages & VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT) plain |= kVertexInput;
  if (stages & VK_PIPELINE_STAGE_2_PRE_RASTERIZATION_SHADERS_BIT) plain |= kPreRasterization;
  return plain;
}

Accesses expand_accesses(Accesses accesses) {
  Accesses plain = accesses & (kWrites | kReads);
  if (accesses & VK_ACCESS_2_MEMORY_READ_BIT) plain |= kReads;
  if (accesses & VK_ACCESS_2_MEMORY_WRITE_BIT) plain |= kWrites;
  if (accesses & VK_ACCESS_2_SHADER_READ_BIT)
    plain |= VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT;
  if (accesses & VK_ACCESS_2_SHADER_WRITE_BIT) plain |= VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
  return plain;
}

bool is_write(Accesses accesses) { return (expand_accesses(accesses) & kWrites) != 0; }

Accesses reads_of(Accesses accesses) { return expand_accesses(accesses) & kReads; }

Barrier barrier_of(const Transition& t, QueueClass queue) {
  return {static_cast<std::uint8_t>(queue), expand_stages(t.src_stages),
          expand_accesses(t.src_access),    expand_stages(t.dst_stages),
          expand_accesses(t.dst_access),    t.resource == kNone};
}

namespace {

std::vector<std::uint64_t> bits_of(std::uint64_t mask) {
  std::vector<std::uint64_t> bits;
  for (; mask != 0; mask &= mask - 1) bits.push_back(mask & (~mask + 1));
  return bits;
}

// Returns whether f(i) is true for the index i of each of the bits that `mask` contains.
template <typename Function>
bool all_bits(const std::vector<std::uint64_t>& bits, std::uint64_t mask, const Function& f) {
  for (std::size_t i = 0; i < bits.size(); ++i)
    if ((mask & bits[i]) && !f(i)) return false;
  return true;
}

}  // namespace

HappensBefore::HappensBefore(Stages stages, Accesses accesses, std::uint32_t queues)
    : stages_(bits_of(stages)),
      writes_(bits_of(accesses & kWrites)),
      accesses_(bits_of(accesses)),
      places_(queues * stages_.size()),
      ordered_(places_ * places_),
      available_(places_ * writes_.size() * places_),
      visible_(places_ * (writes_.size() + 1) * places_ * accesses_.size()) {}

template <typename Function>
bool HappensBefore::all_stages(Stages stages, Function&& f) const {
  return all_bits(stages_, stages, f);
}

template <typename Function>
bool HappensBefore::any_stage(Stages stages, Function&& f) const {
  return !all_stages(stages, [&](std::size_t i) { return !f(i); });
}

template <typename Function>
bool HappensBefore::all_writes(Accesses writes, Function&& f) const {
  return all_bits(writes_, writes, f);
}

template <typename Function>
bool HappensBefore::holds(const Operation& operation, Function&& f) const {
  const auto at = [&](std::size_t stage) { return f(place(operation.queue, stage)); };
  return operation.kind == Operation::Kind::access ? all_stages(operation.stages, at)
                                                   : any_stage(operation.stages, at);
}

void HappensBefore::apply(std::span<const Barrier> barriers) {
  if (scopes_.size() < barriers.size()) scopes_.resize(barriers.size());
  for (std::size_t i = 0; i < barriers.size(); ++i) reach(barriers[i], scopes_[i]);
  for (std::size_t i = 0; i < barriers.size(); ++i) spread(barriers[i], scopes_[i]);
}

// Finds the operations that a barrier waits for: those in its first scope, and all operations that
// are ordered before these.
void HappensBefore::reach(const Barrier& barrier, ScopeTimes& scope) const {
  scope.ordered.assign(places_, 0);
  scope.available.assign(places_ * writes_.size(), 0);
  all_stages(barrier.src, [&](std::size_t stage) {
    const std::size_t through = place(barrier.queue, stage);
    for (std::size_t source = 0; source < places_; ++source) {
      const bool direct = source == through;
      Time& before = scope.ordered[source];
      before = std::max(before, direct ? now_ : ordered(source, through));
      for (std::size_t write = 0; write < writes_.size(); ++write) {
        const bool made = direct && barrier.memory && (barrier.src_access & writes_[write]) != 0;
        Time& there = scope.available[source * writes_.size() + write];
        there = std::max(there, made ? now_ : available(source, write, through));
      }
    }
    return true;
  });
}

void HappensBefore::spread(const Barrier& barrier, const ScopeTimes& scope) {
  const auto raise = [](Time& time, Time to) { time = std::max(time, to); };
  all_stages(barrier.dst, [&](std::size_t stage) {
    const std::size_t to = place(barrier.queue, stage);
    for (std::size_t source = 0; source < places_; ++source) {
      raise(ordered(source, to), scope.ordered[source]);
      for (std::size_t write = 0; write <= writes_.size(); ++write) {
        const bool writes = write < writes_.size();
        const Time time =
            writes ? scope.available[source * writes_.size() + write] : scope.ordered[source];
        if (writes) raise(available(source, write, to), time);
        if (!barrier.memory) continue;
        Time* const seen = visible(source, write, to);
        for (std::size_t a = 0; a < accesses_.size(); ++a)
          if (barrier.dst_access & accesses_[a]) raise(seen[a], time);
      }
    }
    return true;
  });
}

// Records a semaphore signal. It comes after all earlier work of its queue and after everything
// that is ordered before that work, and makes the writes of all of these available.
void HappensBefore::signal(std::uint8_t queue, std::uint32_t submission) {
  if (signalled_.size() <= submission) signalled_.resize(submission + 1);
  std::vector<Time>& times = signalled_[submission];
  times.assign(places_, 0);
  for (std::size_t source = 0; source < places_; ++source) {
    if (source / stages_.size() == queue) times[source] = now_;
    for (std::size_t stage = 0; stage < stages_.size(); ++stage)
      times[source] = std::max(times[source], ordered(source, place(queue, stage)));
  }
}

void HappensBefore::wait(std::uint8_t queue, std::uint32_t submission, Stages stages) {
  // Everything that came before the signal is available and visible after the wait.
  const std::vector<Time>& times = signalled_[submission];
  ScopeTimes all{times, {}};
  for (const Time time : times) all.available.insert(all.available.end(), writes_.size(), time);
  spread({queue, 0, 0, expand_stages(stages), ~Accesses{0}, true}, all);
}

bool HappensBefore::is_before(const Operation& operation, const Barrier& barrier) const {
  if (operation.kind == Operation::Kind::release && operation.queue == barrier.queue &&
      barrier.src != 0)
    return true;
  return holds(operation, [&](std::size_t source) {
    return any_stage(barrier.src, [&](std::size_t stage) {
      const std::size_t through = place(barrier.queue, stage);
      return source == through || ordered(source, through) >= operation.time;
    });
  });
}

bool HappensBefore::is_available_by(const Operation& operation, const Barrier& barrier) const {
  if (operation.writes == 0) return is_before(operation, barrier);
  return holds(operation, [&](std::size_t source) {
    return all_writes(operation.writes, [&](std::size_t write) {
      return any_stage(barrier.src, [&](std::size_t stage) {
        const std::size_t through = place(barrier.queue, stage);
        return (source == through && (barrier.src_access & writes_[write])) ||
               available(source, write, through) >= operation.time;
      });
    });
  });
}

bool HappensBefore::is_ordered(const Operation& operation, std::uint8_t queue,
                               Stages stages) const {
  return all_stages(expand_stages(stages), [&](std::size_t stage) {
    return is_own(operation, queue, stages_[stage]) || holds(operation, [&](std::size_t source) {
             return ordered(source, place(queue, stage)) >= operation.time;
           });
  });
}

bool HappensBefore::is_available(const Operation& operation, std::uint8_t queue,
                                 Stages stages) const {
  if (operation.writes == 0) return is_ordered(operation, queue, stages);
  return all_stages(expand_stages(stages), [&](std::size_t stage) {
    return holds(operation, [&](std::size_t source) {
      return all_writes(operation.writes, [&](std::size_t write) {
        return available(source, write, place(queue, stage)) >= operation.time;
      });
    });
  });
}

bool HappensBefore::is_visible(const Operation& operation, std::uint8_t queue, Stages stages,
                               Accesses accesses) const {
  const Accesses wanted = expand_accesses(accesses);
  const auto sees = [&](std::size_t source, std::size_t write, std::size_t to, std::size_t access) {
    return visible(source, write, to)[access] >= operation.time;
  };
  return all_stages(expand_stages(stages), [&](std::size_t stage) {
    const std::size_t to = place(queue, stage);
    for (std::size_t a = 0; a < accesses_.size(); ++a) {
      if (!(wanted & accesses_[a])) continue;
      if (is_own(operation, queue, stages_[stage]) && (operation.seen_by & accesses_[a])) continue;
      const bool seen = holds(operation, [&](std::size_t source) {
        if (operation.writes == 0) return sees(source, writes_.size(), to, a);
        return all_writes(operation.writes,
                          [&](std::size_t write) { return sees(source, write, to, a); });
      });
      if (!seen) return false;
    }
    return true;
  });
}

bool HappensBefore::is_before_any(const Operation& operation, std::uint8_t queue,
                                  Stages stages) const {
  return any_stage(expand_stages(stages), [&](std::size_t stage) {
    return is_available(operation, queue, stages_[stage]);
  });
}

}  // namespace alcove::framegraph::verifier
