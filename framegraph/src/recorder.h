// Records the submissions of a plan into command buffers.
#pragma once

#include <vector>

#include "alcove/framegraph/graph.h"
#include "alcove/framegraph/plan.h"
#include "device_context.h"
#include "pool.h"
#include "timestamps.h"

namespace alcove::framegraph {

// Returns whether one range of mips and layers lies within another.
constexpr bool contains(const Range& whole, const Range& part) {
  return part.base_mip >= whole.base_mip && part.base_layer >= whole.base_layer &&
         part.base_mip + part.mips <= whole.base_mip + whole.mips &&
         part.base_layer + part.layers <= whole.base_layer + whole.layers;
}

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
  void batch(std::uint32_t index, VkCommandBuffer commands);
  void begin_label(std::string_view name, VkCommandBuffer commands) const;
  VkDependencyInfo dependency(const Batch& batch);
  void add_memory(const VkMemoryBarrier2& barrier);
  VkImageMemoryBarrier2 image_barrier(const Transition& transition) const;

  // Adds an error with the sentence "pass 'NAME' WHAT".
  void fail(ErrorCode code, std::uint32_t pass, const std::string& what,
            std::uint32_t resource = kNone, std::uint32_t version = 0,
            VkResult result = VK_SUCCESS) const;
  // Returns the access with which the running pass declares this resource, or null if it declares
  // none. In that case adds an error if uses are checked.
  const AccessRecord* declared(std::uint32_t pass, std::uint32_t resource) const;
  // Returns the index of the first access that declares `range` of the resource as an attachment of
  // the pass. Range{} means any. If there is none, adds an error and returns kNone.
  std::uint32_t attachment_access(std::uint32_t pass, std::uint32_t resource,
                                  const Range& range = {}) const;
  // Returns whether `range` lies within the texture `resource` and, if check_uses_ is set, whether
  // the pass declared accesses to all mips and layers of that range. If not, adds an error and
  // returns false.
  bool check_view(std::uint32_t pass, std::uint32_t resource, const Range& range) const;

  const DeviceContext& device_;
  Pool& pool_;
  RecordedFrame frame_;
  const Graph* graph_ = nullptr;
  const Plan* plan_ = nullptr;
  bool shares_with_buffers_ = false;  // the plan has transient buffers
  std::vector<VkImageMemoryBarrier2> images_;
  std::vector<VkMemoryBarrier2> memories_;
  mutable Errors errors_;
};

}  // namespace alcove::framegraph
