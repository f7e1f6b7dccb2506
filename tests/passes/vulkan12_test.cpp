// Tests devices of Vulkan 1.2. The passes run if VK_KHR_synchronization2 is enabled; otherwise an
// error sentence names the extension.
#include <gmock/gmock.h>

#include "views.h"
#include "vulkan12_device.h"

namespace alcove::passes {
namespace {

using testing::Each;
using testing::HasSubstr;

// The physical device reports Vulkan 1.2 instead of 1.3.
VKAPI_ATTR void VKAPI_CALL get_properties(VkPhysicalDevice device,
                                          VkPhysicalDeviceProperties* properties) {
  vkGetPhysicalDeviceProperties(device, properties);
  properties->apiVersion = VK_API_VERSION_1_2;
}

TEST(CVulkan12, FramesRunOnAVulkan12DeviceWithTheSynchronization2Extension) {
  replaced_functions = {{"vkGetPhysicalDeviceProperties", untyped(&get_properties)}};
  const Vulkan12Device device;
  {
    TestEngine engine(device.handles());
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
    EXPECT_THAT(engine.read(view.images[ALCOVE_IMAGE_VISIBILITY], 1), Each(std::byte{255}))
        << "a plane is unoccluded";
  }
  EXPECT_EQ(device.messages(), "");
}

TEST(CVulkan12, MissingSynchronization2ExtensionIsReported) {
  const Vulkan12Device device(false);
  const AlcoveContextInfo info = TestEngine(device.handles()).context_info();
  AlcoveContext* made = nullptr;
  char message[ALCOVE_MAX_MESSAGE];
  EXPECT_EQ(alcoveCreateContext(&info, &made, message), ALCOVE_ERROR_UNSUPPORTED);
  EXPECT_THAT(message, HasSubstr("VK_KHR_synchronization2"));
  EXPECT_EQ(device.messages(), "");
}

}  // namespace
}  // namespace alcove::passes
