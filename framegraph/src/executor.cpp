#include "alcove/framegraph/executor.h"

#include <algorithm>

#ifdef ALCOVE_FRAMEGRAPH_VERIFIES
#include "alcove/framegraph/verify.h"
#endif
#include "plan_cache.h"
#include "submitter.h"
#include "workspace.h"

namespace alcove::framegraph {
namespace {

tl::unexpected<Errors> failure(ErrorCode code, std::string message) {
  return tl::unexpected(Errors{{code, std::move(message)}});
}

// The queues that a frame may use: one for record(), all of the device for submit().
enum class Queues : std::uint8_t { one, all };

}  // namespace

struct Executor::Implementation {
  explicit Implementation(const ExecutorOptions& executor_options) : options(executor_options) {}

  tl::expected<CachedPlan*, Errors> plan_for(const Graph& graph, Queues queues, bool& compiled);
  tl::expected<void, Errors> find_physical(const Graph& graph, CachedPlan& cached);
  VkResult find_external(const Graph& graph, CachedPlan& cached, std::uint32_t resource);
  tl::expected<FrameReport, Errors> prepare(Graph& graph, const FrameInfo& info, Queues queues,
                                            CachedPlan*& cached);
  tl::expected<void, Errors> check_slot(std::uint32_t slot) const;
  tl::expected<void, Errors> check_call(const FrameInfo& info) const;
  tl::expected<void, Errors> adopt(Graph& graph) const;
  bool starts_anew(const CachedPlan& cached) const;
  tl::expected<FrameReport, Errors> record(Graph& graph, VkCommandBuffer commands,
                                           const FrameInfo& info);
  void finish(Graph& graph, const CachedPlan& cached);
  void give_up(std::uint32_t slot);
  void begin_frame(const FrameInfo& info);
  void create_timestamps();
  void forget_timestamps(std::uint32_t slot);
  // Returns the timestamps of a slot and queue, or null if timestamps are off there.
  Timestamps* timestamps_of(std::size_t slot, std::size_t queue) {
    return timestamps[slot * kQueueClasses + queue].get();
  }

  ExecutorOptions options;
  DeviceContext device;
  Compiler compiler;
  PlanCache plans[2];  // by Queues
  std::unique_ptr<Pool> pool;
  std::unique_ptr<Recorder> recorder;
  std::vector<std::unique_ptr<Timestamps>> timestamps;  // by slot and queue class; may be null
  std::vector<PassTiming> timings;                      // the last result of timings()
  std::vector<std::uint64_t> slot_frames;               // last frame recorded with each slot
  std::uint64_t frame = 0;
  std::uint64_t finished = 0;
  const CachedPlan* before = nullptr;  // the plan of the frame before
  std::uint64_t before_generation = 0;
  bool records = false;  // A frame is being recorded: callbacks may run.
  std::shared_ptr<const char> life = std::make_shared<const char>('\0');
  std::unique_ptr<Submitter> submitter;  // destroyed first: it waits for the device
};

// One call of record() or submit(). If the frame does not run in the end, the destructor calls
// give_up().
struct Executor::Attempt {
  Attempt(Implementation& implementation, Graph& of, const FrameInfo& with)
      : self(implementation), graph(of), info(with) {
    self.records = true;
    self.begin_frame(info);
  }
  ~Attempt() {
    self.records = false;
    if (!runs) self.give_up(info.slot);
  }
  Attempt(const Attempt&) = delete;
  Attempt& operator=(const Attempt&) = delete;

  Implementation& self;
  Graph& graph;
  FrameInfo info;
  bool runs = false;
};

tl::expected<Executor, Errors> Executor::create(const DeviceHandles& device,
                                                const ExecutorOptions& options) {
  auto implementation = std::make_unique<Implementation>(options);
  implementation->options.frames_in_flight = std::clamp(options.frames_in_flight, 1u, 8u);
#ifdef ALCOVE_FRAMEGRAPH_VERIFIES
  if (implementation->options.verify == nullptr) implementation->options.verify = verify;
#endif
  if (auto opened = open(implementation->device, device); !opened)
    return tl::unexpected(std::move(opened.error()));
  implementation->device.limits.alias = options.alias;
  for (PlanCache& plans : implementation->plans)
    plans.set_capacity(std::clamp(options.cached_plans, 1u, 4096u));
  implementation->pool = std::make_unique<Pool>(implementation->device);
  implementation->recorder =
      std::make_unique<Recorder>(implementation->device, *implementation->pool);
  implementation->slot_frames.resize(implementation->options.frames_in_flight);
  implementation->submitter =
      std::make_unique<Submitter>(implementation->device, implementation->options.frames_in_flight);
  implementation->create_timestamps();
  return Executor(std::move(implementation));
}

void Executor::Implementation::create_timestamps() {
  timestamps.resize(options.frames_in_flight * kQueueClasses);
  for (std::size_t i = 0; i < timestamps.size() && options.timestamps; ++i) {
    const std::size_t queue = i % kQueueClasses;
    const std::uint32_t bits = device.timestamp_bits[queue];
    // A queue with transfers only cannot reset query pools.
    if (queue != static_cast<std::size_t>(QueueClass::transfer) && bits != 0)
      timestamps[i] = std::make_unique<Timestamps>(device, bits);
  }
}

Executor::Executor(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
Executor::Executor(Executor&&) noexcept = default;
Executor& Executor::operator=(Executor&&) noexcept = default;
Executor::~Executor() = default;

tl::expected<CachedPlan*, Errors> Executor::Implementation::plan_for(const Graph& graph,
                                                                     Queues queues,
                                                                     bool& compiled) {
  const GraphDescription& description = graph.description();
  compiled = false;
  PlanCache& cache = plans[static_cast<std::size_t>(queues)];
  if (CachedPlan* cached = cache.find(description)) return cached;
  CachedPlan& room = cache.room(frame);
  if (before == &room) before = nullptr;
  Limits limits = device.limits;
  if (queues == Queues::one) limits.queue_families[1] = limits.queue_families[2] = kNone;
  if (auto done = compiler.compile(description, limits, room.plan); !done)
    return tl::unexpected(std::move(done.error()));
  if (options.verify != nullptr) {
    if (auto right = options.verify(description, limits, room.plan); !right)
      return tl::unexpected(std::move(right.error()));
  }
  room.externals.clear();
  for (std::uint32_t r = 0; r < description.resources.size(); ++r) {
    const Origin origin = description.resources[r].origin;
    if (origin == Origin::imported ||
        (origin == Origin::history && room.plan.placements[r].first != kNone))
      room.externals.push_back(r);
  }
  cache.keep(room, description);
  compiled = true;
  return &room;
}

VkResult Executor::Implementation::find_external(const Graph& graph, CachedPlan& cached,
                                                 std::uint32_t resource) {
  const GraphDescription& description = graph.description();
  const ResourceRecord& record = description.resources[resource];
  const ImportHandles& handles = graph.imports_[record.external];
  Physical*& physical = cached.physical[resource];
  if (record.origin == Origin::imported) {
    physical = &pool->import(record, handles);
    return VK_SUCCESS;
  }
  const HistoryEntry& entry = graph.histories().entries()[handles.history];
  return pool->history(graph.histories(), handles.history, entry.physical(record.slot), record,
                       history_usage(device.limits, record), description.resource_name(resource),
                       physical);
}

// Finds the images and buffers of the frame. Those of transients stay the same until the pool
// changes, so that an unchanged frame only looks up imports and histories.
tl::expected<void, Errors> Executor::Implementation::find_physical(const Graph& graph,
                                                                   CachedPlan& cached) {
  const GraphDescription& description = graph.description();
  if (const VkResult result = pool->reserve(cached.plan, frame))
    return tl::unexpected(vulkan_error(result, "the frame's transients cannot be allocated"));
  const bool again = cached.generation == pool->generation();
  if (!again) cached.physical.assign(description.resources.size(), nullptr);
  const auto failed = [&](VkResult result, std::uint32_t r) {
    const bool history = description.resources[r].origin == Origin::history;
    return tl::unexpected(vulkan_error(
        result, std::string(history ? "the history '" : "'").append(description.resource_name(r)) +
                    "' cannot be created"));
  };
  for (const std::uint32_t r : cached.externals) {
    if (const VkResult result = find_external(graph, cached, r)) return failed(result, r);
    cached.physical[r]->last_frame = frame;
  }
  if (again && frame < cached.last_mark + kFramesUntilEviction / 2) return {};
  for (std::uint32_t r = 0; r < description.resources.size(); ++r) {
    const Placement& placement = cached.plan.placements[r];
    if (placement.heap == kNone) continue;
    if (!again) {
      const VkResult result = pool->transient(description.resources[r], cached.plan, placement,
                                              description.resource_name(r), cached.physical[r]);
      if (result != VK_SUCCESS) return failed(result, r);
    }
    cached.physical[r]->last_frame = frame;
  }
  cached.last_mark = frame;
  cached.generation = pool->generation();
  return {};
}

void Executor::Implementation::begin_frame(const FrameInfo& info) {
  finished = std::max(finished, slot_frames[info.slot]);
  ++frame;
  slot_frames[info.slot] = frame;
  pool->collect(finished, frame);
}

tl::expected<void, Errors> Executor::Implementation::check_slot(std::uint32_t slot) const {
  if (slot < slot_frames.size()) return {};
  return failure(ErrorCode::misuse, std::string("frame slot ").append(std::to_string(slot)) +
                                        " is not below the " + std::to_string(slot_frames.size()) +
                                        " frames in flight: raise "
                                        "ExecutorOptions::frames_in_flight");
}

tl::expected<void, Errors> Executor::Implementation::check_call(const FrameInfo& info) const {
  if (records)
    return failure(
        ErrorCode::misuse,
        "record() or submit() was called from a recording callback of the same executor: "
        "call it after the frame is recorded, or use a second executor");
  return check_slot(info.slot);
}

// Binds the graph to this executor, which holds the contents of its histories.
tl::expected<void, Errors> Executor::Implementation::adopt(Graph& graph) const {
  const std::shared_ptr<const char> other = graph.executor_.lock();
  if (other && other != life)
    return failure(ErrorCode::misuse,
                   "the graph was recorded by another executor, which holds its histories: use one "
                   "executor for a graph, or destroy the other one first");
  if (graph.lost_executor())
    return failure(
        ErrorCode::misuse,
        "the executor that holds the graph's histories was destroyed after the frame was "
        "declared: call Graph::reset and declare it again");
  if (graph.recorded_)
    return failure(ErrorCode::misuse,
                   "the frame was recorded before: call Graph::reset and declare the next one");
  if (!other) graph.executor_ = life;
  return {};
}

// Returns whether the frame must begin with a barrier over all memory. It must if the previous
// frame had another plan, because the barriers of a plan assume that the same plan ran before.
bool Executor::Implementation::starts_anew(const CachedPlan& cached) const {
  return before != &cached || before_generation != pool->generation();
}

tl::expected<FrameReport, Errors> Executor::Implementation::prepare(Graph& graph,
                                                                    const FrameInfo& info,
                                                                    Queues queues,
                                                                    CachedPlan*& cached) {
  if (auto right = adopt(graph); !right) return tl::unexpected(std::move(right.error()));
  pool->retire_histories(graph.histories(), frame);
  FrameReport report;
  auto plan = plan_for(graph, queues, report.compiled);
  if (!plan) return tl::unexpected(std::move(plan.error()));
  cached = *plan;
  if (auto done = find_physical(graph, *cached); !done)
    return tl::unexpected(std::move(done.error()));
  cached->last_frame = frame;
  recorder->begin({&graph, &cached->plan, &cached->physical, options.check_uses,
                   starts_anew(*cached), info.slot});
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

// Moves the histories on to the next frame: slot 0 becomes slot 1 if it was written.
void Executor::Implementation::finish(Graph& graph, const CachedPlan& cached) {
  before = &cached;
  before_generation = pool->generation();
  graph.recorded_ = true;
  graph.leave_histories(cached.plan.finals);
}

void Executor::Implementation::forget_timestamps(std::uint32_t slot) {
  for (std::size_t q = 0; q < kQueueClasses; ++q)
    if (Timestamps* times = timestamps_of(slot, q)) times->forget();
}

// Undoes the beginning of a frame that will not run. Earlier frames may still be running.
void Executor::Implementation::give_up(std::uint32_t slot) {
  slot_frames[slot] = finished;
  before = nullptr;
  forget_timestamps(slot);
}

tl::expected<FrameReport, Errors> Executor::Implementation::record(Graph& graph,
                                                                   VkCommandBuffer commands,
                                                                   const FrameInfo& info) {
  CachedPlan* cached = nullptr;
  auto report = prepare(graph, info, Queues::one, cached);
  if (!report) return report;
  Timestamps* times = timestamps_of(info.slot, 0);
  if (times) {
    const VkResult result =
        times->begin_frame(commands, static_cast<std::uint32_t>(cached->plan.passes.size()));
    if (result != VK_SUCCESS)
      return tl::unexpected(vulkan_error(result, "timestamps cannot be created"));
  }
  if (starts_anew(*cached)) recorder->full_barrier(commands);
  recorder->submission(0, commands, times);
  if (!recorder->errors().empty()) return tl::unexpected(std::move(recorder->errors()));
  finish(graph, *cached);
  return report;
}

tl::expected<FrameReport, Errors> Executor::record(Graph& graph, VkCommandBuffer commands,
                                                   const FrameInfo& info) {
  Implementation& self = *implementation_;
  if (auto right = self.check_call(info); !right) return tl::unexpected(std::move(right.error()));
  Attempt attempt(self, graph, info);
  auto report = self.record(graph, commands, info);
  attempt.runs = report.has_value();
  return report;
}

void Executor::discard(Graph& graph, const FrameInfo& info) {
  if (!implementation_->check_call(info)) return;
  graph.histories().undo();
  implementation_->give_up(info.slot);
}

tl::expected<FrameReport, Errors> Executor::submit(Graph& graph, const FrameInfo& info) {
  Implementation& self = *implementation_;
  if (auto right = self.check_call(info); !right) return tl::unexpected(std::move(right.error()));
  if (self.device.handles.queues[0].queue == VK_NULL_HANDLE)
    return failure(ErrorCode::no_queue,
                   "the executor has no graphics queue to submit to: set DeviceHandles::queues[0]");
  if (auto waited = wait(info.slot); !waited) return tl::unexpected(std::move(waited.error()));
  Attempt attempt(self, graph, info);
  CachedPlan* cached = nullptr;
  auto report = self.prepare(graph, info, Queues::all, cached);
  if (!report) return report;
  Timestamps* timestamps[kQueueClasses] = {};
  for (std::size_t q = 0; q < kQueueClasses; ++q) timestamps[q] = self.timestamps_of(info.slot, q);
  self.forget_timestamps(info.slot);
  // Everything is recorded before anything is submitted, so that an error while recording leaves
  // the device untouched.
  VkResult result = self.submitter->record(cached->plan, *self.recorder, info.slot, timestamps,
                                           self.starts_anew(*cached));
  if (result == VK_SUCCESS && !self.recorder->errors().empty())
    return tl::unexpected(std::move(self.recorder->errors()));
  if (result == VK_SUCCESS) result = self.submitter->submit(cached->plan, info);
  if (result != VK_SUCCESS) {
    // A frame that was submitted in part may have written to any history, in any stage.
    attempt.runs = self.submitter->stopped_midway();
    if (attempt.runs) {
      HistoryTable& histories = graph.histories();
      histories.invalidate_all();
      for (std::uint32_t i = 0; i < histories.entries().size(); ++i)
        for (HistorySlot& slot : histories.entry(i).slots)
          slot.state = {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT};
    }
    graph.recorded_ = attempt.runs;
    self.before = nullptr;
    return tl::unexpected(vulkan_error(result, "the frame cannot be submitted"));
  }
  attempt.runs = true;
  self.finish(graph, *cached);
  return report;
}

tl::expected<void, Errors> Executor::wait(std::uint32_t slot) {
  if (auto right = implementation_->check_slot(slot); !right) return right;
  if (const VkResult result = implementation_->submitter->wait(slot))
    return tl::unexpected(vulkan_error(result, "waiting for a frame failed"));
  return {};
}

std::span<const PassTiming> Executor::timings(std::uint32_t slot) {
  Implementation& self = *implementation_;
  self.timings.clear();
  if (slot >= self.slot_frames.size()) return {};
  for (std::size_t q = 0; q < kQueueClasses; ++q) {
    if (Timestamps* times = self.timestamps_of(slot, q)) {
      const auto read = times->read();
      self.timings.insert(self.timings.end(), read.begin(), read.end());
    }
  }
  return self.timings;
}

void Executor::forget(VkImage image) {
  implementation_->pool->forget(image, implementation_->frame);
}

const VulkanFunctions& Executor::functions() const { return implementation_->device.vk; }
const Limits& Executor::limits() const { return implementation_->device.limits; }

}  // namespace alcove::framegraph
