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
constexpr Stages kBuild = VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR |
                          VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_COPY_BIT_KHR;
constexpr Stages kDispatch =
    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_RAY_TRACING_SHADER_BIT_KHR;
constexpr Stages kCommands = kGraphics | kTransfer | kDispatch | kBuild;
// Stages of any queue.
constexpr Stages kAnyQueue =
    VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT |
    VK_PIPELINE_STAGE_2_TOP_OF_PIPE_BIT | VK_PIPELINE_STAGE_2_BOTTOM_OF_PIPE_BIT |
    VK_PIPELINE_STAGE_2_HOST_BIT | VK_PIPELINE_STAGE_2_COPY_BIT;
constexpr Stages kMeta =
    VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT |
    VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT | VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT |
    VK_PIPELINE_STAGE_2_PRE_RASTERIZATION_SHADERS_BIT | VK_PIPELINE_STAGE_2_TOP_OF_PIPE_BIT |
    VK_PIPELINE_STAGE_2_BOTTOM_OF_PIPE_BIT;

constexpr Accesses kWrites =
    VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT |
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT |
    VK_ACCESS_2_HOST_WRITE_BIT | VK_ACCESS_2_TRANSFORM_FEEDBACK_WRITE_BIT_EXT |
    VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR |
    VK_ACCESS_2_TRANSFORM_FEEDBACK_COUNTER_WRITE_BIT_EXT;
constexpr Accesses kReads =
    VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT | VK_ACCESS_2_INDEX_READ_BIT |
    VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT | VK_ACCESS_2_UNIFORM_READ_BIT |
    VK_ACCESS_2_SHADER_SAMPLED_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT |
    VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT |
    VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_HOST_READ_BIT |
    VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR |
    VK_ACCESS_2_TRANSFORM_FEEDBACK_COUNTER_READ_BIT_EXT |
    VK_ACCESS_2_CONDITIONAL_RENDERING_READ_BIT_EXT |
    VK_ACCESS_2_FRAGMENT_SHADING_RATE_ATTACHMENT_READ_BIT_KHR;

// Returns the lowest bit of a mask, or 0 if no bit is set.
constexpr std::uint64_t lowest(std::uint64_t mask) { return mask & (~mask + 1); }

// Accesses and the stages that can make them ("Supported access types" of the specification).
constexpr struct {
  Accesses accesses;
  Stages stages;
} kSupported[] = {
    {VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT, VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT},
    {VK_ACCESS_2_INDEX_READ_BIT, VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT},
    {VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT, VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT},
    {VK_ACCESS_2_UNIFORM_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT |
         VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
     kPreRasterization | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | kDispatch},
    // The inputs of a build are read as storage.
    {VK_ACCESS_2_SHADER_STORAGE_READ_BIT,
     kPreRasterization | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | kDispatch | kBuild},
    {VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR, kBuild},
    {VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR,
     kPreRasterization | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | kDispatch | kBuild},
    {VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
     VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT},
    {VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
     VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT},
    {VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT, kTransfer | kBuild},
    {VK_ACCESS_2_HOST_READ_BIT | VK_ACCESS_2_HOST_WRITE_BIT, VK_PIPELINE_STAGE_2_HOST_BIT}};

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

bool supports(QueueClass queue, Stages stages) {
  constexpr Stages kCompute =
      kDispatch | kBuild | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_2_CLEAR_BIT;
  if (queue == QueueClass::graphics) return true;
  return (stages & ~(queue == QueueClass::compute ? kAnyQueue | kCompute : kAnyQueue)) == 0;
}

bool supports(Stages stages, Accesses accesses) {
  return std::all_of(std::begin(kSupported), std::end(kSupported), [&](const auto& row) {
    return (accesses & row.accesses) == 0 || (expand_stages(stages) & row.stages) != 0;
  });
}

Barrier barrier_of(const Transition& t, QueueClass queue) {
  return {static_cast<std::uint8_t>(queue), expand_stages(t.src_stages),
          expand_accesses(t.src_access),    expand_stages(t.dst_stages),
          expand_accesses(t.dst_access),    t.resource == kNone};
}

void HappensBefore::signal(std::uint8_t queue, std::uint32_t submission) {
  if (signals_.size() <= submission) signals_.resize(submission + 1);
  signals_[submission] = steps_.size();
  steps_.push_back({Step::Kind::signal, queue, 0, {}});
}

void HappensBefore::wait(std::uint8_t queue, std::uint32_t submission, Stages stages) {
  const Barrier after{queue, 0, 0, expand_stages(stages), ~Accesses{0}, true};
  steps_.push_back({Step::Kind::wait, queue, signals_[submission], {after}});
}

bool HappensBefore::Part::is_before(const Barrier& barrier) const {
  return (barrier.queue == queue && (barrier.src & source) != 0) ||
         (barrier.src & ordered[barrier.queue]) != 0;
}

// `covers` says whether the memory dependency of the barrier covers the operation's resource.
bool HappensBefore::Part::is_available_by(const Barrier& barrier, bool covers) const {
  if (write == 0) return is_before(barrier);
  const bool direct = barrier.queue == queue && (barrier.src & source) != 0;
  return (direct && covers && (barrier.src_access & write) != 0) ||
         (barrier.src & available[barrier.queue]) != 0;
}

bool HappensBefore::Reach::is_seen(std::uint8_t by, Stages stages, Accesses accesses) const {
  for (; stages != 0; stages &= stages - 1) {
    Accesses unseen = accesses;
    for (const Sight& sight : visible)
      if (sight.queue == by && (sight.stages & lowest(stages))) unseen &= ~sight.accesses;
    if (unseen != 0) return false;
  }
  return true;
}

// Adds the second scope of a barrier that waits for the part.
void HappensBefore::Reach::add(const Barrier& barrier, bool makes_available) {
  ordered[barrier.queue] |= barrier.dst;
  if (!makes_available) return;
  available[barrier.queue] |= barrier.dst;
  if (barrier.memory) visible.push_back({barrier.queue, barrier.dst, barrier.dst_access});
}

// Follows the steps from `from` on. A signal comes after all earlier work of its queue and after
// everything that is ordered before that work, and makes the writes of all of these available. They
// are visible after a wait for it.
void HappensBefore::follow(std::size_t from, Reach& reach) const {
  std::vector<std::size_t> signals;  // that come after the part
  for (std::size_t i = from; i < steps_.size(); ++i) {
    const Step& step = steps_[i];
    if (step.kind == Step::Kind::signal) {
      if (step.queue == reach.queue || reach.ordered[step.queue] != 0) signals.push_back(i);
    } else if (step.kind == Step::Kind::wait) {
      if (std::find(signals.begin(), signals.end(), step.signal) != signals.end())
        reach.add(step.barriers[0], true);
    } else {
      const Part before = reach;
      for (const Barrier& barrier : step.barriers)
        if (before.is_before(barrier))
          reach.add(barrier, before.is_available_by(barrier, barrier.memory));
    }
  }
}

template <typename Function>
bool HappensBefore::all_parts(const Operation& operation, const Function& f) const {
  const auto holds = [&](Stages stage, Accesses write) {
    Reach reach{{operation.queue, stage, write}, {}};
    if (operation.is_change)
      reach.add({operation.queue, 0, 0, operation.stages, operation.seen_by, true}, true);
    follow(operation.time, reach);
    return f(reach);
  };
  if (operation.is_change) return holds(operation.stages, 0);
  for (Stages stages = operation.stages; stages != 0; stages &= stages - 1) {
    Accesses writes = operation.writes;
    do {
      if (!holds(lowest(stages), lowest(writes))) return false;
      writes &= writes - 1;
    } while (writes != 0);
  }
  return true;
}

bool HappensBefore::is_before(const Operation& operation, const Barrier& barrier) const {
  return all_parts(operation, [&](const Reach& reach) { return reach.is_before(barrier); });
}

bool HappensBefore::is_available_by(const Operation& operation, const Barrier& barrier) const {
  return all_parts(operation,
                   [&](const Reach& reach) { return reach.is_available_by(barrier, true); });
}

bool HappensBefore::is_ordered(const Operation& operation, std::uint8_t queue,
                               Stages stages) const {
  const Stages bits = expand_stages(stages);
  return all_parts(operation,
                   [&](const Reach& reach) { return (bits & ~reach.ordered[queue]) == 0; });
}

bool HappensBefore::is_available(const Operation& operation, std::uint8_t queue,
                                 Stages stages) const {
  const Stages bits = expand_stages(stages);
  return all_parts(operation,
                   [&](const Reach& reach) { return (bits & ~reach.available[queue]) == 0; });
}

bool HappensBefore::is_visible(const Operation& operation, std::uint8_t queue, Stages stages,
                               Accesses accesses) const {
  return all_parts(operation, [&](const Reach& reach) {
    return reach.is_seen(queue, expand_stages(stages), expand_accesses(accesses));
  });
}

}  // namespace alcove::framegraph::verifier
