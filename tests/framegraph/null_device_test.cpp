// Tests the executor on a device that does nothing and has two queues: what it submits and records,
// and what happens if a call fails.
#include <gtest/gtest.h>

#include <cstring>
#include <optional>
#include <vector>

#include "alcove/framegraph/framegraph.h"
#include "alcove/framegraph/verify.h"
#include "fake_handle.h"
#include "null_device.h"

namespace alcove::framegraph {
namespace {

int submits_until_failure = -1;  // negative: none fails
bool image_fails = false;
std::vector<std::uint32_t> waits;  // the number of semaphores that each submission waits for
std::vector<VkImageMemoryBarrier2> barriers;

VkResult VKAPI_CALL submit(VkQueue /*queue*/, std::uint32_t count, const VkSubmitInfo2* infos,
                           VkFence /*fence*/) {
  if (submits_until_failure >= 0 && submits_until_failure-- == 0)
    return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  for (std::uint32_t i = 0; i < count; ++i) waits.push_back(infos[i].waitSemaphoreInfoCount);
  return VK_SUCCESS;
}

void VKAPI_CALL barrier(VkCommandBuffer /*commands*/, const VkDependencyInfo* info) {
  barriers.insert(barriers.end(), info->pImageMemoryBarriers,
                  info->pImageMemoryBarriers + info->imageMemoryBarrierCount);
}

VkResult VKAPI_CALL create_image(VkDevice /*device*/, const VkImageCreateInfo* /*info*/,
                                 const VkAllocationCallbacks* /*callbacks*/, VkImage* image) {
  if (image_fails) return VK_ERROR_OUT_OF_HOST_MEMORY;
  static std::size_t count = 0;
  *image = fake_handle<VkImage>(++count);
  return VK_SUCCESS;
}

PFN_vkVoidFunction VKAPI_CALL get_device_proc(VkDevice device, const char* name) {
  const auto as = [](auto* function) { return reinterpret_cast<PFN_vkVoidFunction>(function); };
  if (std::strcmp(name, "vkQueueSubmit2") == 0) return as(submit);
  if (std::strcmp(name, "vkCmdPipelineBarrier2") == 0) return as(barrier);
  if (std::strcmp(name, "vkCreateImage") == 0) return as(create_image);
  return reinterpret_cast<PFN_vkGetDeviceProcAddr>(
      null_device().get_instance_proc_addr(VK_NULL_HANDLE, "vkGetDeviceProcAddr"))(device, name);
}

PFN_vkVoidFunction VKAPI_CALL get_instance_proc(VkInstance instance, const char* name) {
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0)
    return reinterpret_cast<PFN_vkVoidFunction>(get_device_proc);
  return null_device().get_instance_proc_addr(instance, name);
}

class NullDeviceTest : public testing::Test {
 protected:
  NullDeviceTest() {
    submits_until_failure = -1;
    image_fails = false;
    DeviceHandles handles = null_device();
    handles.get_instance_proc_addr = get_instance_proc;
    for (std::uint32_t queue : {0u, 1u})
      handles.queues[queue] = {fake_handle<VkQueue>(queue), queue};
    executor_.emplace(Executor::create(handles, {.timestamps = false, .verify = verify}).value());
  }

  // Adds a pass that writes a texture and is not culled.
  Texture add_write(Texture texture, QueueClass queue = QueueClass::graphics) {
    PassBuilder pass = graph_.add_pass("write", queue);
    texture = pass.write(texture, access::storage_write_compute, {}, Contents::discard);
    pass.side_effect();
    pass.record([](RecordContext&) {});
    return texture;
  }
  Texture make_texture(std::uint32_t width = 16) {
    return graph_.create_texture("t", {VK_FORMAT_R32_UINT, Extent::absolute(width, 16)});
  }

  std::optional<Executor> executor_;
  Graph graph_;
};

// The first frame uses the compute queue. The second one does not, and its only submission fails.
// When it is submitted again, it still has to wait for the first frame on both queues.
TEST_F(NullDeviceTest, FrameAfterAFailedSubmissionWaitsForEveryQueueOfTheFrameBefore) {
  add_write(make_texture(), QueueClass::compute);
  ASSERT_TRUE(executor_->submit(graph_));
  for (const bool fails : {true, false}) {
    graph_.reset();
    add_write(make_texture());
    submits_until_failure = fails ? 0 : -1;
    waits.clear();
    ASSERT_EQ(executor_->submit(graph_).has_value(), !fails);
  }
  // The graphics queue has run nothing before.
  EXPECT_EQ(waits, std::vector<std::uint32_t>{1});
}

// The graphics queue runs the pass that writes the history, and the submission to the compute queue
// fails. The next frame must not change the layout of the slot before that pass is done.
TEST_F(NullDeviceTest, HistoryOfAFrameThatWasSubmittedInPartIsWaitedForInEveryStage) {
  for (const bool fails : {true, false}) {
    graph_.reset();
    const TextureHistory history =
        graph_.create_texture_history("h", {VK_FORMAT_R32_UINT, Extent::absolute(16, 16)});
    EXPECT_EQ(history.validity, HistoryValidity::first_frame);
    const Texture written = add_write(history.current);
    PassBuilder reader = graph_.add_pass("read", QueueClass::compute);
    reader.read(written, access::storage_read_compute);
    reader.side_effect();
    reader.record([](RecordContext&) {});
    submits_until_failure = fails ? 1 : -1;
    waits.clear();
    barriers.clear();
    ASSERT_EQ(executor_->submit(graph_).has_value(), !fails);
    EXPECT_EQ(waits.size(), fails ? 1u : 2u);
  }
  ASSERT_EQ(barriers.size(), 1u);
  EXPECT_EQ(barriers[0].oldLayout, VK_IMAGE_LAYOUT_UNDEFINED);
  EXPECT_EQ(barriers[0].srcStageMask, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
  EXPECT_EQ(barriers[0].srcAccessMask, VK_ACCESS_2_MEMORY_WRITE_BIT);
}

}  // namespace
}  // namespace alcove::framegraph
