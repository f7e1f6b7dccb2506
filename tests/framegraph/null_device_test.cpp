// Tests the executor on a device that does nothing and has two queues: what it submits and records,
// and what happens if a call fails.
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <optional>
#include <set>
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
std::vector<VkImageView> destroyed_views;

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

void VKAPI_CALL destroy_view(VkDevice /*device*/, VkImageView view,
                             const VkAllocationCallbacks* /*callbacks*/) {
  destroyed_views.push_back(view);
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
  if (std::strcmp(name, "vkDestroyImageView") == 0) return as(destroy_view);
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

// The device says how much memory an image needs only after it has created one.
TEST_F(NullDeviceTest, FrameIsRefusedAndNoPlanKeptIfTheMemoryOfAnImageCannotBeAskedFor) {
  for (const bool fails : {true, false}) {
    graph_.reset();
    add_write(make_texture());
    image_fails = fails;
    const auto report = executor_->submit(graph_);
    ASSERT_EQ(report.has_value(), !fails);
    if (fails)
      EXPECT_EQ(report.error()[0].result, VK_ERROR_OUT_OF_HOST_MEMORY);
    else
      EXPECT_TRUE(report->compiled);
  }
}

// Textures of changing sizes and a history are used in turn, until some are evicted. No view that a
// pass has got is destroyed while the number stays.
TEST_F(NullDeviceTest, HandleEpochChangesBeforeAViewIsDestroyed) {
  std::map<VkImageView, std::uint64_t> epochs;  // in which a pass got the view last
  std::set<std::uint64_t> seen;
  destroyed_views.clear();
  for (std::uint32_t frame = 0; frame < 600; ++frame) {
    graph_.reset();
    const std::uint32_t width = frame < 200 ? 16 << frame / 20 % 3 : 16;
    const TextureHistory history = graph_.create_texture_history(
        "h", {VK_FORMAT_R32_UINT, Extent::absolute(frame < 100 ? 8 : 16, 8)});
    PassBuilder pass = graph_.add_pass("pass");
    const Texture textures[] = {
        pass.write(make_texture(width), access::storage_write_compute, {}, Contents::discard),
        pass.write(history.current, access::storage_write_compute, {}, Contents::discard)};
    pass.read(history.previous(), access::sampled_compute);
    pass.side_effect();
    pass.record([&, textures, history](RecordContext& c) {
      (void)c.validity(history.previous());
      for (const VkImageView view : destroyed_views) EXPECT_LT(epochs[view], c.handle_epoch);
      for (const Texture& texture : {textures[0], textures[1], history.previous()})
        epochs[c.view(texture)] = c.handle_epoch;
      seen.insert(c.handle_epoch);
    });
    const auto report = executor_->submit(graph_, {frame % 2});
    ASSERT_TRUE(report) << to_string(report.error());
  }
  EXPECT_GE(destroyed_views.size(), 4u);
  EXPECT_LE(seen.size(), 12u);
}

}  // namespace
}  // namespace alcove::framegraph
