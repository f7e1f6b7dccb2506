// Runs graphs on a Vulkan device that the caller created. The device must have version 1.3, or
// version 1.2 with VK_KHR_synchronization2. The feature synchronization2 must be enabled. submit()
// also needs timelineSemaphore, even with a single queue. Passes that call
// RecordContext::begin_rendering() also need dynamicRendering.
//
//   frame:  wait for the fence of frame slot s;  graph.reset(); declare;  begin commands
//           executor.record(graph, commands, {s});  end commands, submit with the fence of slot s
//
// Frame slots are numbered 0 to frames_in_flight - 1; each frame in flight uses another one. Plans
// and physical resources are cached: for a frame that was declared before, the executor compiles
// and allocates nothing. Only one thread at a time may call an executor.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <tl/expected.hpp>

#include "alcove/framegraph/compile.h"
#include "alcove/framegraph/error.h"
#include "alcove/framegraph/graph.h"
#include "alcove/framegraph/host_services.h"
#include "alcove/framegraph/plan.h"
#include "alcove/framegraph/vulkan_functions.h"

namespace alcove::framegraph {

struct QueueHandle {
  VkQueue queue = VK_NULL_HANDLE;
  std::uint32_t family = kNone;
};

// The caller's device. It must outlive the executor. `queues` is indexed by QueueClass. The entry
// for graphics is required; an executor that only uses record() needs its queue family and no queue
// handle. The other queues may be null.
struct DeviceHandles {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;
  QueueHandle queues[kQueueClasses];
  bool debug_utils = false;  // VK_EXT_debug_utils is enabled on the instance
  HostServices host;         // the caller's allocators and log
};

// Checks a plan against the declaration and the limits that it was made for.
using PlanCheck = tl::expected<void, Errors>(const GraphDescription&, const Limits&, const Plan&);

struct ExecutorOptions {
  std::uint32_t frames_in_flight = 2;  // frame slots, 1 to 8
  bool timestamps = true;              // GPU time of each pass, on queues that have timestamps
  bool alias = true;
  // The number of compiled plans that are cached, 1 to 4096. record() and submit() have a cache of
  // this size each. A frame whose declaration has a cached plan is not compiled again. When a cache
  // is full, the plan that was unused for longest is replaced. A plan takes a few hundred bytes per
  // pass and per resource.
  std::uint32_t cached_plans = 64;
  // A function that checks each new plan when it is compiled, or null. Pass framegraph::verify()
  // from verify.h (library alcove::framegraph_verifier). Debug builds of this library use that
  // function if `verify` is null.
  PlanCheck* verify = nullptr;
#ifdef NDEBUG
  bool check_uses = false;  // undeclared uses in callbacks are errors
#else
  bool check_uses = true;
#endif
};

// A semaphore of the caller's that submit() waits for or signals. The wait comes before the frame's
// first work on `queue`, the signal after its last work there. If the frame runs nothing on that
// queue, the frame's first submission waits, and its last submission signals.
struct QueueSemaphore {
  VkSemaphore semaphore = VK_NULL_HANDLE;
  std::uint64_t value = 0;  // of a timeline semaphore; a binary one ignores it
  VkPipelineStageFlags2 stages =
      VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;  // that wait, or are waited for
  QueueClass queue = QueueClass::graphics;
};

struct FrameInfo {
  // The number of the frame in flight. The device must have finished the last frame with this slot.
  std::uint32_t slot = 0;
  // Semaphores for submit(). record() ignores them, because its caller submits the commands. For a
  // swapchain image, add the semaphore of vkAcquireNextImageKHR to `waits`, with the queue that
  // uses the image first and the stages of access::acquired(). Add the semaphore that
  // vkQueuePresentKHR waits for to `signals`, with the graphics queue, because the graphics queue
  // brings imports into their final states.
  std::span<const QueueSemaphore> waits = {};
  std::span<const QueueSemaphore> signals = {};
};

// Memory of a frame's transients in bytes, summed over all heaps.
struct MemoryStatistics {
  VkDeviceSize aliased = 0;      // with transients that share memory
  VkDeviceSize unaliased = 0;    // if each transient had memory of its own
  VkDeviceSize lower_bound = 0;  // most bytes that are live at the same time
  VkDeviceSize history = 0;      // of all history slots
  VkDeviceSize allocated = 0;    // all device memory of the executor, with what it will free soon
};

struct FrameReport {
  const Plan* plan = nullptr;  // valid until the next record() or submit()
  MemoryStatistics memory;
  bool compiled = false;  // false when the plan came from the cache
};

struct PassTiming {
  std::string_view name;
  std::uint32_t pass = kNone;  // PassBuilder::index()
  double milliseconds = 0.0;
};

class Executor {
 public:
  [[nodiscard]] static tl::expected<Executor, Errors> create(const DeviceHandles& device,
                                                             const ExecutorOptions& options = {});
  Executor(Executor&&) noexcept;
  Executor& operator=(Executor&&) noexcept;
  // The device must have finished all recorded frames. The destructor waits for submitted ones.
  ~Executor();

  // Records the declared frame, once, into `commands`, a primary command buffer of the graphics
  // queue family that is in the recording state and outside a render pass. All passes are recorded
  // into it, whatever their queue class. The caller must submit the command buffers in the order in
  // which they were recorded, once each, to one queue. If the declaration is invalid, nothing is
  // recorded. An error that is found while recording (an undeclared use, or no more memory) leaves
  // `commands` incomplete: discard it. After any error, the histories have the contents that they
  // had before the frame, except that a history which the frame declared with another description,
  // or reset, has no contents.
  [[nodiscard]] tl::expected<FrameReport, Errors> record(Graph& graph, VkCommandBuffer commands,
                                                         const FrameInfo& frame = {});
  // Undoes the effects of recording a frame, if its commands will not be submitted. Call it before
  // any other function of this graph or executor. The graph and the executor are then as if that
  // frame had not been declared or recorded. Without this call, the histories would be treated as
  // if the frame had written them. To record the frame again, declare it again.
  void discard(Graph& graph, const FrameInfo& frame = {});

  // Records the frame and submits it to the queues of the device. The work of a queue is collected
  // into one vkQueueSubmit2 until another queue has to wait for it. Before recording, submit()
  // waits for the frame that was last submitted with this slot. If a callback fails, nothing is
  // submitted. If you use both record() and
  // submit() on one executor, you must synchronise their frames yourself. After the device is lost,
  // submit() and wait() return an error with VK_ERROR_DEVICE_LOST every time; the executor can then
  // only be destroyed, which does not wait and leaks nothing.
  [[nodiscard]] tl::expected<FrameReport, Errors> submit(Graph& graph, const FrameInfo& frame = {});
  // Waits until the device has finished the frame that was last submitted with this slot.
  [[nodiscard]] tl::expected<void, Errors> wait(std::uint32_t slot = 0);

  // Returns the GPU time of each pass of the frame that was last recorded with this slot, in order
  // of execution on each queue. Call it after the device has finished that frame; before that, it
  // may return the times of an earlier frame with this slot. The result is empty if no such frame
  // exists or timestamps are off. It is valid until the next call of timings().
  [[nodiscard]] std::span<const PassTiming> timings(std::uint32_t slot = 0);

  // Drops the cached views of an imported image. Call it before you destroy the image, unless
  // passes only ever used the view that was imported with it: a new image may get the same handle
  // as the old one.
  void forget(VkImage image);

  const VulkanFunctions& functions() const;
  // Returns the limits that plans are compiled with.
  const Limits& limits() const;

 private:
  struct Implementation;
  struct Attempt;
  explicit Executor(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace alcove::framegraph
