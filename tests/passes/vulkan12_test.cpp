// Tests devices of Vulkan 1.2. The passes run if VK_KHR_synchronization2 is enabled; otherwise an
// error sentence names the extension.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>

#include "engine.h"
#include "views.h"
#include "vulkan12_device.h"

namespace alcove::passes {
namespace {

using testing::Each;
using testing::HasSubstr;

VKAPI_ATTR void VKAPI_CALL get_properties(VkPhysicalDevice device,
                                          VkPhysicalDeviceProperties* properties) {
  vkGetPhysicalDeviceProperties(device, properties);
  properties->apiVersion = VK_API_VERSION_1_2;
}

// Returns the loader's functions, except that the physical device reports Vulkan 1.2 instead of
// 1.3.
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_instance_proc_addr(VkInstance instance,
                                                                const char* name) {
  return std::strcmp(name, "vkGetPhysicalDeviceProperties") == 0
             ? reinterpret_cast<PFN_vkVoidFunction>(&get_properties)
             : vkGetInstanceProcAddr(instance, name);
}

TEST(CVulkan12, FramesRunOnAVulkan12DeviceWithTheSynchronization2Extension) {
  Vulkan12Device device;
  {
    AlcoveContextInfo info = device.context_info();
    info.get_instance_proc_addr = get_instance_proc_addr;
    info.timestamps = VK_TRUE;
    AlcoveContext* made = nullptr;
    char message[ALCOVE_MAX_MESSAGE];
    ASSERT_EQ(alcoveCreateContext(&info, &made, message), ALCOVE_SUCCESS) << message;
    const Context context(made);
    AlcoveSettings settings{.struct_size = sizeof settings};
    ASSERT_EQ(alcoveGetSettings(ALCOVE_QUALITY_MEDIUM, 0.5f, &settings), ALCOVE_SUCCESS);
    AlcoveView view{.struct_size = sizeof view, .info = {.settings = &settings}};
    std::ranges::copy(test_views()[2].view.clip_from_view, view.info.camera.clip_from_view);
    std::ranges::copy(test_views()[2].view.view_from_world, view.info.camera.view_from_world);
    view.info.previous_camera = view.info.camera;
    view.images[ALCOVE_IMAGE_DEPTH] = device.make_image(
        VK_FORMAT_R32_SFLOAT, 24, 16, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    view.images[ALCOVE_IMAGE_DEPTH].initial_state = {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                                     VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                                     VK_IMAGE_LAYOUT_GENERAL};
    view.images[ALCOVE_IMAGE_DEPTH].final_state = {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, 0,
                                                   VK_IMAGE_LAYOUT_GENERAL};
    view.images[ALCOVE_IMAGE_VISIBILITY] = device.make_image(
        VK_FORMAT_R8_UNORM, 24, 16, VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    view.images[ALCOVE_IMAGE_VISIBILITY].final_state = {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                                        VK_ACCESS_2_TRANSFER_READ_BIT,
                                                        VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
    view.images[ALCOVE_IMAGE_BENT_NORMAL] =
        device.make_image(VK_FORMAT_R8G8B8A8_SNORM, 24, 16, VK_IMAGE_USAGE_STORAGE_BIT);
    view.images[ALCOVE_IMAGE_BENT_NORMAL].final_state = {VK_PIPELINE_STAGE_2_NONE, 0,
                                                         VK_IMAGE_LAYOUT_GENERAL};
    view.images[ALCOVE_IMAGE_SPECULAR] =
        device.make_image(VK_FORMAT_R8_UNORM, 24, 16, VK_IMAGE_USAGE_STORAGE_BIT);
    view.images[ALCOVE_IMAGE_SPECULAR].final_state =
        view.images[ALCOVE_IMAGE_BENT_NORMAL].final_state;
    AlcoveFrame frame{.struct_size = sizeof frame, .view_count = 1, .views = &view};
    EXPECT_EQ(alcovePrepareFrame(context.get(), &frame), ALCOVE_SUCCESS)
        << alcoveGetMessage(context.get());
    for (; frame.index < 3; ++frame.index) {
      device.run([&](VkCommandBuffer commands) {
        const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        const VkImageMemoryBarrier barrier{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                                           .dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                           .newLayout = VK_IMAGE_LAYOUT_GENERAL,
                                           .image = view.images[ALCOVE_IMAGE_DEPTH].image,
                                           .subresourceRange = all};
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                             VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0, nullptr, 1,
                             &barrier);
        const VkClearColorValue plane{{0.5f}};
        vkCmdClearColorImage(commands, view.images[ALCOVE_IMAGE_DEPTH].image,
                             VK_IMAGE_LAYOUT_GENERAL, &plane, 1, &all);
        EXPECT_EQ(alcoveRecordFrame(context.get(), commands, &frame), ALCOVE_SUCCESS)
            << alcoveGetMessage(context.get());
      });
    }
    std::uint32_t count = 0;
    EXPECT_EQ(alcoveGetTimings(context.get(), 0, &count, nullptr), ALCOVE_SUCCESS);
    EXPECT_EQ(count, 2u);  // gtao and reconstruct
    EXPECT_THAT(device.read(view.images[ALCOVE_IMAGE_VISIBILITY], 1), Each(255))
        << "a plane is unoccluded";
  }
  EXPECT_EQ(device.messages(), "");
}

TEST(CVulkan12, MissingSynchronization2ExtensionIsReported) {
  const Vulkan12Device device(false);
  const AlcoveContextInfo info = device.context_info();
  AlcoveContext* made = nullptr;
  char message[ALCOVE_MAX_MESSAGE];
  EXPECT_EQ(alcoveCreateContext(&info, &made, message), ALCOVE_ERROR_UNSUPPORTED);
  EXPECT_THAT(message, HasSubstr("VK_KHR_synchronization2"));
  EXPECT_EQ(device.messages(), "");
}

}  // namespace
}  // namespace alcove::passes
