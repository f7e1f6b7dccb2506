// Runs graphs on a Vulkan device that the caller created. The device must have version 1.3, or
// version 1.2 with VK_KHR_synchronization2. The feature synchronization2 must be enabled. submit()
// also needs timelineSemaphore, even with a single queue. Passes that call
// RecordContext::begin_rendering() also need dynamicRendering.
//
//   frame:  wait for the fence of slot s;  graph.reset(); declare;  begin commands
//           executor.record(graph, commands, {s});  end commands, submit with the fence of slot s
//
// Plans and physical resources are cached. A frame whose declaration is cached compiles and
// allocates nothing. Only one thread at a time may call an executor.
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

// The caller's device. It must outlive the executor. `queues` is indexed by QueueClass. The
// graphics queue is required, but its family is enough for an executor that only records; the other
// queues may be null.
struct DeviceHandles {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  PFN_vkGetInstanceProcAddr get_instance_proc_addr = nullptr;
  QueueHandle queues[kQueueClasses];
  bool debug_utils = false;             // VK_EXT_debug_utils is enabled on the instance
  bool storage_multisample = false;     // the feature shaderStorageImageMultisample is enabled
  bool separate_depth_stencil = false;  // the feature separateDepthStencilLayouts is enabled
  HostServices host;                    // the caller's allocators and log
};

// Checks a plan against the declaration and the limits that it was made for.
using PlanCheck = tl::expected<void, Errors>(const GraphDescription&, const Limits&, const Plan&);

struct ExecutorOptions {
  std::uint32_t frames_in_flight = 2;  // frame slots, 1 to 8
  bool timestamps = true;              // GPU time of each pass, on queues that have timestamps
  Ordering ordering = Ordering::lower_peak;
  bool alias = true;
  // How long placement looks for a lower memory peak when a frame's declaration changes, in
  // comparisons of two resources: see Limits::placement_effort.
  std::int64_t placement_effort = Limits{}.placement_effort;
  // Plans that are kept, 1 to 4096, for each of record() and submit(). A frame whose declaration is
  // that of a kept plan is not compiled again. When all are taken, the plan that was unused for
  // longest is replaced. A plan takes some hundred bytes a pass and resource.
  std::uint32_t cached_plans = 64;
  // Number of threads that record passes, 1 to 64, including the caller's. Fewer are used if the
  // system cannot create so many. With more than one thread, callbacks of different passes run at
  // the same time, into secondary command buffers. The command buffer that record() is given must
  // then have no active query. If a callback throws, the exception reaches the caller of record(),
  // whichever thread the callback ran in.
  std::uint32_t recording_threads = 1;
  // If not null, this function checks each new plan when it is compiled. Pass framegraph::verify()
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
// queue, they go to its first or last submission.
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
  // Used by submit() only; with record() the caller synchronises. For a swapchain image, add the
  // semaphore of vkAcquireNextImageKHR to `waits`, for the queue that uses the image first, and the
  // semaphore that vkQueuePresentKHR waits for to `signals`, for the graphics queue, which leaves
  // imports in their final states.
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

  // Records the frame into `commands`, a primary command buffer of the graphics family that is in
  // the recording state and outside a render pass. All passes run on its queue. The caller must
  // submit the command buffers in the order in which they were recorded, once each, to one queue.
  // On an error nothing is recorded, unless the error is found while recording (an undeclared use,
  // or memory that runs out): `commands` must then be thrown away. After an error, histories are as
  // before the frame, except that histories which the frame declared differently or reset have no
  // contents.
  [[nodiscard]] tl::expected<FrameReport, Errors> record(Graph& graph, VkCommandBuffer commands,
                                                         const FrameInfo& frame = {});
  // Takes back a recorded frame whose commands are not submitted after all. Call it before any
  // other function of this graph or executor. The graph and the executor are then as if that frame
  // had not been recorded or declared. Without this call the frame's histories have wrong contents.
  // To record the frame again, declare it again if it changed the description of a history.
  void discard(Graph& graph, const FrameInfo& frame = {});

  // Records the frame and submits it to all queues of the device, with one vkQueueSubmit2 for all
  // work of a queue that comes before another queue waits for it. First waits for the frame that
  // was last submitted with this slot. Do not mix it with record() on one executor unless the
  // caller orders the two. After the device is lost, submit() and wait() return an error with
  // VK_ERROR_DEVICE_LOST every time; the executor can then only be destroyed, which does not wait
  // and leaks nothing.
  [[nodiscard]] tl::expected<FrameReport, Errors> submit(Graph& graph, const FrameInfo& frame = {});
  // Waits until the device has finished the frame that was last submitted with this slot.
  [[nodiscard]] tl::expected<void, Errors> wait(std::uint32_t slot = 0);

  // Returns the GPU time of each pass of the frame last recorded with this slot, in order of
  // execution on each queue. Call it after the device has finished that frame; until then it may
  // return the times of the frame before. The result is empty if no such frame exists or timestamps
  // are off. It is valid until the next call.
  [[nodiscard]] std::span<const PassTiming> timings(std::uint32_t slot = 0);

  // Returns a persistent texture or buffer, as the frames recorded so far leave it, for another
  // graph to import. The other graph's frame must come between two frames of this one and leaves
  // the resource in the same state, which is also the import's final state. Handles are null before
  // a frame has used the resource.
  [[nodiscard]] ImportedTexture exported(const Graph& graph, const TextureHistory& texture) const;
  [[nodiscard]] ImportedBuffer exported(const Graph& graph, const BufferHistory& buffer) const;

  // Call it before you destroy an image that was imported, if passes asked for views of it other
  // than the imported one: a new image may get the same handle.
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
