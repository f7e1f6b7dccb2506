// Records the submissions of a plan into command buffers.
#pragma once

#include <vector>

#include "alcove/framegraph/graph.h"
#include "alcove/framegraph/plan.h"
#include "device_context.h"
#include "pool.h"
#include "timestamps.h"

namespace alcove::framegraph {

// A frame that is being recorded. `physical` is indexed by resource; its entry is null if no pass
// uses the resource.
struct RecordedFrame {
  const Graph* graph = nullptr;
  const Plan* plan = nullptr;
  const std::vector<Physical*>* physical = nullptr;
  bool check_uses = false;
  bool starts_anew = false;  // it follows a frame of another plan: it begins with full_barrier()
  std::uint32_t slot = 0;
};

class Recorder {
 public:
  Recorder(const DeviceContext& device, Pool& pool) : device_(device), pool_(pool) {}

  // Sets the frame that the next calls record.
  void begin(const RecordedFrame& frame);
  // Records a barrier that orders all later commands after all earlier commands of the queue.
  void full_barrier(VkCommandBuffer commands);
  // Records a submission of the plan. `timestamps` may be null.
  void submission(std::uint32_t index, VkCommandBuffer commands, Timestamps* timestamps);
  // Returns the errors that callbacks caused while recording: undeclared uses, and objects that
  // could not be created.
  Errors& errors() { return errors_; }

 private:
  friend class RecordContext;
  void pass(const PlannedPass& planned, VkCommandBuffer commands, Timestamps* timestamps,
            std::uint32_t time);
  void batches(std::uint32_t first, std::uint32_t count, VkCommandBuffer commands);
  // Record the queue ownership transfers of imports between the graph's queue families and families
  // outside the graph. Acquires come before the submission that uses the import first, releases
  // after the final submission.
  void acquire_imports(std::uint32_t index, VkCommandBuffer commands);
  void release_imports(VkCommandBuffer commands);
  void begin_label(std::string_view name, VkCommandBuffer commands) const;
  VkDependencyInfo dependency(const Batch& batch);
  void add_memory(const VkMemoryBarrier2& barrier);
  void transfer_import(std::uint32_t resource, std::uint32_t from, std::uint32_t to,
                       const State& state, bool acquires, VkCommandBuffer commands);
  VkImageMemoryBarrier2 image_barrier(const Transition& transition) const;
  VkBufferMemoryBarrier2 buffer_barrier(const Transition& transition) const;
  std::uint32_t family(const Transition& transition, QueueClass queue) const;

  // Returns the access with which the running pass declares this resource, or null if it declares
  // none. In that case adds an error if uses are checked.
  const AccessRecord* declared(std::uint32_t pass, std::uint32_t resource) const;
  // Returns the index of the access that declares the resource as an attachment of the pass. If
  // there is none, adds an error and returns kNone.
  std::uint32_t attachment_access(std::uint32_t pass, std::uint32_t resource) const;
  // Returns the index of the access that declares one aspect of the resource as an attachment of
  // the pass, or any aspect if `aspect` is 0. Returns kNone, without an error, if there is none.
  std::uint32_t find_attachment(std::uint32_t pass, std::uint32_t resource,
                                VkImageAspectFlags aspect) const;
  // Returns whether `range` lies within the texture `resource` and, if check_uses_ is set, whether
  // the pass declared accesses to all mips and layers of that range. If not, adds an error and
  // returns false.
  bool check_view(std::uint32_t pass, std::uint32_t resource, const Range& range) const;

  const DeviceContext& device_;
  Pool& pool_;
  RecordedFrame frame_;
  const Graph* graph_ = nullptr;
  const Plan* plan_ = nullptr;
  bool shares_with_buffers_ = false;   // the plan has transient buffers
  bool has_outside_families_ = false;  // an import is transferred from or to another queue family
  std::vector<VkImageMemoryBarrier2> images_;
  std::vector<VkBufferMemoryBarrier2> buffers_;
  std::vector<VkMemoryBarrier2> memories_;
  mutable Errors errors_;
};

}  // namespace alcove::framegraph
