#include "alcove/framegraph/executor.h"

#include <algorithm>

#include "alcove/framegraph/verify.h"
#include "plan_cache.h"
#include "recorder.h"

namespace alcove::framegraph {
namespace {

constexpr VkBufferUsageFlags kEveryBufferUsage =
    VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
    VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
    VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT |
    VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;

}  // namespace

struct Executor::Implementation {
  explicit Implementation(const ExecutorOptions& wanted) : options(wanted) {}

  tl::expected<CachedPlan*, Errors> plan_for(const Graph& graph, bool& compiled);
  tl::expected<void, Errors> find_physical(const Graph& graph, CachedPlan& cached);
  VkResult find_external(const Graph& graph, CachedPlan& cached, std::uint32_t resource);
  tl::expected<FrameReport, Errors> prepare(Graph& graph, const FrameInfo& frame,
                                            CachedPlan*& cached);
  void finish(Graph& graph, const CachedPlan& cached);
  void begin_frame(const FrameInfo& info);

  ExecutorOptions options;
  DeviceContext device;
  Compiler compiler;
  PlanCache plans;
  std::unique_ptr<Pool> pool;
  std::unique_ptr<Recorder> recorder;
  std::vector<std::unique_ptr<Timestamps>> timestamps;  // by slot
  std::vector<std::uint64_t> slot_frames;               // last frame recorded with each slot
  std::uint64_t frame = 0;
  std::uint64_t finished = 0;
  const CachedPlan* before = nullptr;  // the plan of the frame before
  std::uint64_t before_generation = 0;
};

tl::expected<Executor, Errors> Executor::create(const DeviceHandles& device,
                                                const ExecutorOptions& options) {
  auto made = std::make_unique<Implementation>(options);
  made->options.frames_in_flight = std::clamp(options.frames_in_flight, 1u, 8u);
  if (auto opened = open(made->device, device); !opened)
    return tl::unexpected(std::move(opened.error()));
  made->device.limits.ordering = options.ordering;
  made->device.limits.alias = options.alias;
  made->device.limits.split_barriers = options.split_barriers;
  made->pool = std::make_unique<Pool>(made->device);
  made->recorder = std::make_unique<Recorder>(made->device, *made->pool);
  made->slot_frames.resize(made->options.frames_in_flight);
  for (std::uint32_t i = 0; i < made->options.frames_in_flight; ++i)
    made->timestamps.push_back(std::make_unique<Timestamps>(made->device));
  return Executor(std::move(made));
}

Executor::Executor(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
Executor::Executor(Executor&&) noexcept = default;
Executor& Executor::operator=(Executor&&) noexcept = default;
Executor::~Executor() = default;

tl::expected<CachedPlan*, Errors> Executor::Implementation::plan_for(const Graph& graph,
                                                                     bool& compiled) {
  const GraphDescription& description = graph.description();
  compiled = false;
  if (CachedPlan* cached = plans.find(description)) return cached;
  CachedPlan& room = plans.room(frame);
  if (before == &room) before = nullptr;
  // Passes of one command buffer run on one queue.
  Limits limits = device.limits;
  limits.queue_families[1] = limits.queue_families[2] = kNone;
  if (auto done = compiler.compile(description, limits, room.plan); !done)
    return tl::unexpected(std::move(done.error()));
  Errors errors;
  for (const PlannedPass& planned : room.plan.passes) {
    if (description.passes[planned.pass].flags & kHasCallback) continue;
    errors.push_back({ErrorCode::missing_callback,
                      std::string("pass '")
                          .append(description.pass_name(planned.pass))
                          .append("' is live but has nothing to record: call PassBuilder::record"),
                      VK_SUCCESS, planned.pass, kNone, 0});
  }
  if (!errors.empty()) return tl::unexpected(std::move(errors));
  if (options.verify) {
    if (auto right = verify(description, limits, room.plan); !right)
      return tl::unexpected(std::move(right.error()));
  }
  plans.keep(room, description);
  compiled = true;
  return &room;
}

VkResult Executor::Implementation::find_external(const Graph& graph, CachedPlan& cached,
                                                 std::uint32_t resource) {
  const GraphDescription& description = graph.description();
  const ResourceRecord& record = description.resources[resource];
  const ImportHandles& handles = graph.imports()[record.external];
  Physical*& found = cached.physical[resource];
  if (record.origin == Origin::imported) {
    found = &pool->import(record, handles);
    return VK_SUCCESS;
  }
  const HistoryEntry& entry = graph.histories().entries()[handles.history];
  // Made for all that it could be used for, so that it need never be made again, contents lost,
  // when a later frame uses it otherwise.
  const VkFlags usage =
      record.kind == ResourceKind::buffer
          ? kEveryBufferUsage
          : device.limits.formats.query(device.limits.formats.context, record.format) &
                ~(VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSIENT_ATTACHMENT_BIT);
  return pool->history(handles.history, entry.generation, entry.physical(record.slot), record,
                       usage, description.resource_name(resource), frame, found);
}

tl::expected<void, Errors> Executor::Implementation::find_physical(const Graph& graph,
                                                                   CachedPlan& cached) {
  const GraphDescription& description = graph.description();
  cached.physical.resize(description.resources.size());
  if (const VkResult result = pool->reserve(cached.plan, frame))
    return tl::unexpected(vulkan_error(result, "the frame's transients cannot be allocated"));
  const bool again = cached.generation == pool->generation();
  for (std::uint32_t r = 0; r < description.resources.size(); ++r) {
    const ResourceRecord& record = description.resources[r];
    const Placement& placement = cached.plan.placements[r];
    VkResult result = VK_SUCCESS;
    if (placement.first == kNone && record.origin != Origin::imported) {
      cached.physical[r] = nullptr;
      continue;
    }
    if (record.origin != Origin::transient)
      result = find_external(graph, cached, r);
    else if (!again)
      result = pool->transient(record, cached.plan, placement, description.resource_name(r),
                               cached.physical[r]);
    if (result != VK_SUCCESS)
      return tl::unexpected(vulkan_error(
          result, std::string("'").append(description.resource_name(r)) + "' cannot be created"));
    cached.physical[r]->last_frame = frame;
  }
  cached.generation = pool->generation();
  return {};
}

void Executor::Implementation::begin_frame(const FrameInfo& info) {
  finished = std::max(finished, slot_frames[info.slot]);
  ++frame;
  slot_frames[info.slot] = frame;
  pool->collect(finished, frame);
}

tl::expected<FrameReport, Errors> Executor::Implementation::prepare(Graph& graph,
                                                                    const FrameInfo& info,
                                                                    CachedPlan*& cached) {
  if (info.slot >= slot_frames.size()) {
    Errors errors(1);
    errors[0].message = "frame slot " + std::to_string(info.slot) + " is not below the " +
                        std::to_string(slot_frames.size()) +
                        " frames in flight: raise ExecutorOptions::frames_in_flight";
    return tl::unexpected(std::move(errors));
  }
  begin_frame(info);
  FrameReport report;
  auto found = plan_for(graph, report.compiled);
  if (!found) return tl::unexpected(std::move(found.error()));
  cached = *found;
  if (auto done = find_physical(graph, *cached); !done)
    return tl::unexpected(std::move(done.error()));
  cached->last_frame = frame;
  report.plan = &cached->plan;
  for (const Heap& heap : cached->plan.heaps) {
    report.memory.aliased += heap.size;
    report.memory.unaliased += heap.unaliased;
    report.memory.lower_bound += heap.lower_bound;
  }
  report.memory.history = pool->history_size();
  report.memory.allocated = pool->allocated();
  return report;
}

// Histories move on: slot 0 becomes slot 1 where it was written.
void Executor::Implementation::finish(Graph& graph, const CachedPlan& cached) {
  const GraphDescription& description = graph.description();
  for (const FinalState& final : cached.plan.finals) {
    const ResourceRecord& record = description.resources[final.resource];
    HistoryEntry& entry = graph.histories().entry(graph.imports()[record.external].history);
    HistorySlot& slot = entry.slots[entry.physical(record.slot)];
    slot.state = final.state;
    slot.queue = final.queue;
    if (record.slot == 0 && final.written) slot.validity = HistoryValidity::valid;
  }
  for (const FinalState& final : cached.plan.finals) {
    const ResourceRecord& record = description.resources[final.resource];
    if (record.slot != 0 || !final.written) continue;
    HistoryEntry& entry = graph.histories().entry(graph.imports()[record.external].history);
    // The oldest slot is the next to be written.
    entry.head = (entry.head + record.slots - 1) % record.slots;
  }
}

tl::expected<FrameReport, Errors> Executor::record(Graph& graph, VkCommandBuffer commands,
                                                   const FrameInfo& info) {
  Implementation& self = *implementation_;
  CachedPlan* cached = nullptr;
  auto report = self.prepare(graph, info, cached);
  if (!report) return report;
  Timestamps* timestamps = self.options.timestamps ? self.timestamps[info.slot].get() : nullptr;
  if (timestamps) {
    const VkResult result =
        timestamps->begin_frame(commands, static_cast<std::uint32_t>(cached->plan.passes.size()));
    if (result != VK_SUCCESS)
      return tl::unexpected(vulkan_error(result, "timestamps cannot be created"));
  }
  Recorder& recorder = *self.recorder;
  recorder.begin(graph, cached->plan, cached->physical, self.options.check_uses, info.slot);
  // A plan expects its own leavings in memory; another plan's need a barrier of their own.
  if (self.before != cached || self.before_generation != self.pool->generation())
    recorder.full_barrier(commands);
  recorder.submission(cached->plan.submissions[0], commands, timestamps);
  self.before = cached;
  self.before_generation = self.pool->generation();
  self.finish(graph, *cached);
  if (!recorder.errors().empty()) return tl::unexpected(std::move(recorder.errors()));
  return report;
}

std::span<const PassTiming> Executor::timings(std::uint32_t slot) {
  if (slot >= implementation_->timestamps.size() || !implementation_->options.timestamps) return {};
  return implementation_->timestamps[slot]->read();
}

void Executor::forget(VkImage image) {
  implementation_->pool->forget(image, implementation_->frame);
}

const VulkanFunctions& Executor::functions() const { return implementation_->device.vk; }
const Limits& Executor::limits() const { return implementation_->device.limits; }

}  // namespace alcove::framegraph
