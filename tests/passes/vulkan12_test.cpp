// Tests that the passes run on a device of Vulkan 1.2 with VK_KHR_synchronization2.
// c_failure_test.cpp has the error without the extension.
#include <gmock/gmock.h>

#include "engine.h"
#include "views.h"

namespace alcove::passes {
namespace {

using testing::Each;

// The physical device reports Vulkan 1.2 instead of 1.3.
VKAPI_ATTR void VKAPI_CALL get_properties(VkPhysicalDevice device,
                                          VkPhysicalDeviceProperties* properties) {
  vkGetPhysicalDeviceProperties(device, properties);
  properties->apiVersion = VK_API_VERSION_1_2;
}

TEST(CVulkan12, FramesRunOnAVulkan12DeviceWithTheSynchronization2Extension) {
  replaced_functions = {{"vkGetPhysicalDeviceProperties", untyped(&get_properties)}};
  const auto device = sample::VulkanDevice::create({.validation = true, .vulkan12 = true});
  ASSERT_TRUE(device) << device.error();
  {
    TestEngine engine(**device);
    AlcoveContextInfo info = engine.context_info();
    info.get_instance_proc_addr = get_replaced_function;
    const Context context = create_context(info);
    ASSERT_NE(context, nullptr);
    const AlcoveSettings settings = get_settings(ALCOVE_QUALITY_MEDIUM, 0.5f);
    AlcoveView view = engine.make_view(settings, 24, 16,
                                       {ALCOVE_IMAGE_DEPTH, ALCOVE_IMAGE_VISIBILITY,
                                        ALCOVE_IMAGE_BENT_NORMAL, ALCOVE_IMAGE_SPECULAR});
    view.info.camera = view.info.previous_camera = test_views()[2].view;
    const std::vector<float> plane(24UL * 16, 0.5f);
    engine.write(view.images[ALCOVE_IMAGE_DEPTH], std::as_bytes(std::span(plane)));
    for (const AlcoveImageRole role : {ALCOVE_IMAGE_BENT_NORMAL, ALCOVE_IMAGE_SPECULAR})
      view.images[role].final_state = {VK_PIPELINE_STAGE_2_NONE, 0, VK_IMAGE_LAYOUT_GENERAL};
    AlcoveFrame frame{.struct_size = sizeof frame, .view_count = 1, .views = &view};
    EXPECT_EQ(alcovePrepareFrame(context.get(), &frame), ALCOVE_SUCCESS)
        << alcoveGetMessage(context.get());
    for (; frame.index < 3; ++frame.index) {
      engine.submit(0, [&](VkCommandBuffer commands) {
        EXPECT_EQ(alcoveRecordFrame(context.get(), commands, &frame), ALCOVE_SUCCESS)
            << alcoveGetMessage(context.get());
      });
      for (AlcoveImage& image : view.images) image.initial_state = image.final_state;
    }
    engine.wait();
    std::uint32_t count = 0;
    EXPECT_EQ(alcoveGetTimings(context.get(), 0, &count, nullptr), ALCOVE_SUCCESS);
    EXPECT_EQ(count, 2u);  // gtao and reconstruct
    EXPECT_THAT(engine.read(view.images[ALCOVE_IMAGE_VISIBILITY]), Each(std::byte{255}))
        << "a plane is unoccluded";
  }
  EXPECT_THAT((*device)->validation_messages(), testing::IsEmpty());
}

}  // namespace
}  // namespace alcove::passes
