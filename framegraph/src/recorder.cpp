#include "recorder.h"

#include <algorithm>

#include "aspects.h"

namespace alcove::framegraph {
namespace {

// Returns a barrier with the execution dependency of a transition and no memory dependency.
VkMemoryBarrier2 execution(const Transition& t) {
  return {.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
          .srcStageMask = t.src_stages,
          .dstStageMask = t.dst_stages};
}

}  // namespace

void Recorder::begin(const RecordedFrame& frame) {
  frame_ = frame;
  graph_ = frame.graph;
  plan_ = frame.plan;
  errors_.clear();
  shares_with_buffers_ = false;
  if (!device_.is_validated) return;
  for (std::uint32_t r = 0; r < plan_->placements.size(); ++r)
    shares_with_buffers_ |= plan_->placements[r].heap != kNone &&
                            graph_->description().resources[r].kind == ResourceKind::buffer;
}

void Recorder::full_barrier(VkCommandBuffer commands) {
  const VkMemoryBarrier2 all{
      .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
      .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
      .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
      .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
      .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};
  const VkDependencyInfo info{
      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &all};
  device_.vk.vkCmdPipelineBarrier2(commands, &info);
}

void Recorder::submission(std::uint32_t index, VkCommandBuffer commands, Timestamps* timestamps) {
  const Submission& submission = plan_->submissions[index];
  const std::uint32_t first_time = timestamps ? timestamps->add(submission.pass_count) : 0;
  std::uint32_t position = submission.first_pass;
  for (std::uint32_t i = 0; i < submission.pass_count; ++i) {
    pass(plan_->passes[position], commands, timestamps, first_time + i);
    position = plan_->passes[position].next;
  }
  batch(submission.end_batch, commands);
  if (index == plan_->final_submission) batch(plan_->final_batch, commands);
}

void Recorder::begin_label(std::string_view name, VkCommandBuffer commands) const {
  const DebugName text(name);
  const VkDebugUtilsLabelEXT info{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT,
                                  .pLabelName = text.text};
  device_.vk.vkCmdBeginDebugUtilsLabelEXT(commands, &info);
}

void Recorder::pass(const PlannedPass& planned, VkCommandBuffer commands, Timestamps* timestamps,
                    std::uint32_t time) {
  batch(planned.batch, commands);
  const std::string_view name = graph_->description().pass_name(planned.pass);
  const bool label = device_.handles.debug_utils && device_.vk.vkCmdBeginDebugUtilsLabelEXT;
  if (label) begin_label(name, commands);
  if (timestamps) timestamps->begin_pass(commands, time, planned.pass, name);
  RecordContext context(commands, device_.vk, *this, planned.pass);
  context.handle_epoch = pool_.handle_epoch();
  context.frame_slot = frame_.slot;
  const Graph::Callback& callback = graph_->callbacks_[planned.pass];
  if (callback.call)
    callback.call(callback.object, context);
  else
    errors_.push_back(graph_->missing_callback(planned.pass));
  if (timestamps) timestamps->end_pass(commands, time);
  if (label) device_.vk.vkCmdEndDebugUtilsLabelEXT(commands);
}

void Recorder::batch(std::uint32_t index, VkCommandBuffer commands) {
  if (index == kNone) return;
  const VkDependencyInfo info = dependency(plan_->batches[index]);
  device_.vk.vkCmdPipelineBarrier2(commands, &info);
}

// Returns the barriers of a batch for vkCmdPipelineBarrier2. The result is valid until the next
// call.
VkDependencyInfo Recorder::dependency(const Batch& batch) {
  images_.clear();
  memories_.clear();
  for (std::uint32_t i = batch.first; i < batch.first + batch.count; ++i) {
    const Transition& t = plan_->transitions[i];
    const VkMemoryBarrier2 memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                  nullptr,
                                  t.src_stages,
                                  t.src_access,
                                  t.dst_stages,
                                  t.dst_access};
    if (t.resource != kNone) {
      images_.push_back(image_barrier(t));
      if (!device_.is_validated) continue;
      // An image barrier orders all commands of its stages, whichever resources they use. The
      // validation layers (1.3.239) assume that it orders only uses of its own image. They then
      // report a hazard between two other resources that this image barrier orders. A memory
      // barrier over the same stages avoids the false report. It makes nothing available or visible
      // that the image barrier does not.
      const bool takes_over = t.old_layout == VK_IMAGE_LAYOUT_UNDEFINED && shares_with_buffers_;
      add_memory(takes_over ? memory : execution(t));
    } else {
      add_memory(memory);
    }
  }
  return {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
          .memoryBarrierCount = static_cast<std::uint32_t>(memories_.size()),
          .pMemoryBarriers = memories_.data(),
          .imageMemoryBarrierCount = static_cast<std::uint32_t>(images_.size()),
          .pImageMemoryBarriers = images_.data()};
}

// Adds a memory barrier unless the dependency already contains the same one.
void Recorder::add_memory(const VkMemoryBarrier2& barrier) {
  for (const VkMemoryBarrier2& other : memories_)
    if (other.srcStageMask == barrier.srcStageMask && other.dstStageMask == barrier.dstStageMask &&
        (barrier.srcAccessMask & ~other.srcAccessMask) == 0 &&
        (barrier.dstAccessMask & ~other.dstAccessMask) == 0)
      return;
  memories_.push_back(barrier);
}

VkImageMemoryBarrier2 Recorder::image_barrier(const Transition& t) const {
  const Physical& physical = *(*frame_.physical)[t.resource];
  VkImageMemoryBarrier2 barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
  barrier.srcStageMask = t.src_stages;
  barrier.srcAccessMask = t.src_access;
  // The validation layers (1.3.239) forget the last use of memory by other resources, and uses
  // before full_barrier(), unless the barrier names an access. There is nothing left to make
  // available, so that naming it changes nothing.
  const bool takes_over = t.old_layout == VK_IMAGE_LAYOUT_UNDEFINED;
  if (device_.is_validated && (takes_over || frame_.starts_anew) && t.src_stages != 0)
    barrier.srcAccessMask |= VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  barrier.dstStageMask = t.dst_stages;
  barrier.dstAccessMask = t.dst_access;
  barrier.oldLayout = t.old_layout;
  barrier.newLayout = t.new_layout;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = physical.image;
  barrier.subresourceRange = {aspects(physical.record.format), t.range.base_mip, t.range.mips,
                              physical.layer + t.range.base_layer, t.range.layers};
  return barrier;
}

void Recorder::fail(ErrorCode code, std::uint32_t pass, const std::string& what,
                    std::uint32_t resource, std::uint32_t version, VkResult result) const {
  const std::string name(graph_->description().pass_name(pass));
  errors_.push_back({code, "pass '" + name + "' " + what, result, pass, resource, version});
}

const AccessRecord* Recorder::declared(std::uint32_t pass, std::uint32_t resource) const {
  const GraphDescription& graph = graph_->description();
  for (const AccessRecord& access : graph.pass_accesses(pass))
    if (access.resource == resource) return &access;
  if (frame_.check_uses)
    fail(ErrorCode::undeclared_use, pass,
         resource >= graph.resources.size()
             ? "uses a null handle while it records"
             : "uses '" + std::string(graph.resource_name(resource)) +
                   "' while it records, which it did not declare: add a read or a write",
         resource);
  return nullptr;
}

std::uint32_t Recorder::attachment_access(std::uint32_t pass, std::uint32_t resource,
                                          const Range& range) const {
  if (!declared(pass, resource) && frame_.check_uses) return kNone;
  constexpr VkFlags kDrawn =
      VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
  const GraphDescription& graph = graph_->description();
  std::uint32_t index = graph.passes[pass].first_access;
  for (const AccessRecord& access : graph.pass_accesses(pass)) {
    if (access.resource == resource && (access.usage & kDrawn) != 0 &&
        (range == Range{} || contains(access.range, range)))
      return index;
    ++index;
  }
  fail(ErrorCode::undeclared_use, pass,
       "draws to a texture, or a part of one, that it did not declare as an attachment: write it "
       "with access::color_attachment or access::depth_attachment",
       resource);
  return kNone;
}

bool Recorder::check_view(std::uint32_t pass, std::uint32_t resource, const Range& range) const {
  const GraphDescription& graph = graph_->description();
  const ResourceRecord& record = graph.resources[resource];
  const auto refuse = [&](ErrorCode code, const std::string& reason) {
    fail(code, pass,
         "asks for a view of '" + std::string(graph.resource_name(resource)) + "' from mip " +
             std::to_string(range.base_mip) + " and layer " + std::to_string(range.base_layer) +
             " on, " + reason,
         resource);
    return false;
  };
  if (range.mips == 0 || range.layers == 0 || range.base_mip + range.mips > record.mips ||
      range.base_layer + range.layers > record.layers)
    return refuse(ErrorCode::bad_range, "but the texture has " + std::to_string(record.mips) +
                                            " mips and " + std::to_string(record.layers) +
                                            " layers");
  if (!frame_.check_uses) return true;
  const auto is_declared = [&](std::uint32_t mip, std::uint32_t layer) {
    const auto accesses = graph.pass_accesses(pass);
    return std::any_of(accesses.begin(), accesses.end(), [&](const AccessRecord& access) {
      const Range one{static_cast<std::uint16_t>(mip), 1, static_cast<std::uint16_t>(layer), 1};
      return access.resource == resource && contains(access.range, one);
    });
  };
  for (std::uint32_t layer = range.base_layer; layer < range.base_layer + range.layers; ++layer)
    for (std::uint32_t mip = range.base_mip; mip < range.base_mip + range.mips; ++mip)
      if (!is_declared(mip, layer))
        return refuse(ErrorCode::undeclared_use,
                      "part of which it did not declare: add a read or a write of that range");
  return true;
}

}  // namespace alcove::framegraph
