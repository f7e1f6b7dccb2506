// Tests that a call returns an error value and a message of one sentence if the device lacks a
// feature or a function, or if memory runs out at any allocation. Nothing may be thrown or leaked.
#include <gmock/gmock.h>

#include <array>
#include <climits>
#include <string>
#include <utility>

#include "c_interface_fixture.h"
#include "framegraph/allocation_counter.h"
#include "framegraph/failing_device.h"
#include "gtao_scenes.h"

namespace alcove::passes {
namespace {

using testing::AllOf;
using testing::HasSubstr;

bool has_synchronization2 = true;
bool has_write_without_format = true;
std::uint32_t api_version = VK_API_VERSION_1_3;
std::uint32_t storage_images = 10;  // that a shader can bind
const char* missing_function = "";

VKAPI_ATTR void VKAPI_CALL get_features(VkPhysicalDevice device, VkPhysicalDeviceFeatures2* all) {
  vkGetPhysicalDeviceFeatures2(device, all);
  auto* features = static_cast<VkPhysicalDeviceSynchronization2Features*>(all->pNext);
  features->synchronization2 = has_synchronization2 ? VK_TRUE : VK_FALSE;
  all->features.shaderStorageImageWriteWithoutFormat =
      has_write_without_format ? VK_TRUE : VK_FALSE;
}

VKAPI_ATTR void VKAPI_CALL get_properties(VkPhysicalDevice device,
                                          VkPhysicalDeviceProperties* properties) {
  vkGetPhysicalDeviceProperties(device, properties);
  properties->apiVersion = api_version;
  properties->limits.maxPerStageDescriptorStorageImages = storage_images;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_proc_addr(VkDevice device, const char* name) {
  return std::string(name) == missing_function ? nullptr : vkGetDeviceProcAddr(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_instance_proc_addr(VkInstance instance,
                                                                const char* name) {
  const std::string wanted(name);
  if (wanted == "vkGetPhysicalDeviceFeatures2")
    return reinterpret_cast<PFN_vkVoidFunction>(&get_features);
  if (wanted == "vkGetPhysicalDeviceProperties")
    return reinterpret_cast<PFN_vkVoidFunction>(&get_properties);
  if (wanted == "vkGetDeviceProcAddr")
    return reinterpret_cast<PFN_vkVoidFunction>(&get_device_proc_addr);
  return wanted == missing_function ? nullptr : vkGetInstanceProcAddr(instance, name);
}

class CFailure : public CInterface {
 protected:
  void SetUp() override {
    CInterface::SetUp();
    has_synchronization2 = has_write_without_format = true;
    api_version = VK_API_VERSION_1_3;
    storage_images = 10;
    missing_function = "";
    framegraph::failing::fail_at(0);
    framegraph::failing::lose(false);
  }

  std::string error_of_context(const AlcoveContextInfo& info, AlcoveResult expected) {
    char message[ALCOVE_MAX_MESSAGE];
    AlcoveContext* made = nullptr;
    EXPECT_EQ(alcoveCreateContext(&info, &made, message), expected) << message;
    const Context context(made);
    return message;
  }
};

TEST_F(CFailure, VulkanFeaturesAndFunctionsThatTheDeviceLacksAreReported) {
  AlcoveContextInfo info = engine().context_info();
  info.get_instance_proc_addr = get_instance_proc_addr;
  EXPECT_EQ(error_of_context(info, ALCOVE_SUCCESS), "");
  has_synchronization2 = false;
  EXPECT_THAT(
      error_of_context(info, ALCOVE_ERROR_UNSUPPORTED),
      AllOf(HasSubstr("has no feature synchronization2"), HasSubstr("VK_KHR_synchronization2")));
  has_synchronization2 = true;
  has_write_without_format = false;
  EXPECT_THAT(error_of_context(info, ALCOVE_ERROR_UNSUPPORTED),
              HasSubstr("has no feature shaderStorageImageWriteWithoutFormat"));
  has_write_without_format = true;
  api_version = VK_API_VERSION_1_1;
  EXPECT_THAT(error_of_context(info, ALCOVE_ERROR_UNSUPPORTED),
              HasSubstr("has Vulkan 1.1, and at least 1.2 is needed"));
  api_version = VK_API_VERSION_1_3;
  storage_images = 7;
  EXPECT_THAT(error_of_context(info, ALCOVE_ERROR_UNSUPPORTED),
              HasSubstr("7 storage images to a shader; the occlusion passes need 8."));
  storage_images = 10;
  missing_function = "vkCmdPipelineBarrier2";
  EXPECT_THAT(error_of_context(info, ALCOVE_ERROR_UNSUPPORTED), HasSubstr("vkCmdPipelineBarrier2"));
  missing_function = "vkGetPhysicalDeviceQueueFamilyProperties2";
  EXPECT_THAT(error_of_context(info, ALCOVE_ERROR_UNSUPPORTED), HasSubstr("instance"));
}

TEST_F(CFailure, VulkanFeatureThatTheEngineDidNotEnableIsReported) {
  AlcoveContextInfo info = engine().context_info();
  VkPhysicalDeviceVulkan13Features vulkan13{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  VkPhysicalDeviceFeatures2 enabled{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                    .pNext = &vulkan13};
  enabled.features.shaderStorageImageWriteWithoutFormat = VK_TRUE;
  info.enabled_features = &enabled;
  EXPECT_THAT(error_of_context(info, ALCOVE_ERROR_UNSUPPORTED), HasSubstr("synchronization2"));
  vulkan13.synchronization2 = VK_TRUE;
  EXPECT_EQ(error_of_context(info, ALCOVE_SUCCESS), "");
  enabled.features.shaderStorageImageWriteWithoutFormat = VK_FALSE;
  EXPECT_THAT(error_of_context(info, ALCOVE_ERROR_UNSUPPORTED),
              HasSubstr("shaderStorageImageWriteWithoutFormat"));
}

// The result and the message of the first call that failed while a context was created, a frame
// prepared and two frames recorded.
struct Outcome {
  AlcoveResult result = ALCOVE_SUCCESS;
  std::string message;
};
Outcome run_frames(const AlcoveContextInfo& info, const AlcoveView& view, Engine& engine) {
  Outcome outcome;
  char message[ALCOVE_MAX_MESSAGE];
  AlcoveContext* made = nullptr;
  outcome.result = alcoveCreateContext(&info, &made, message);
  const Context context(made);
  std::string said = message;
  const AlcoveFrame frame{.struct_size = sizeof frame, .view_count = 1, .views = &view};
  if (outcome.result == ALCOVE_SUCCESS) {
    outcome.result = alcovePrepareFrame(context.get(), &frame);
    said = alcoveGetMessage(context.get());
  }
  for (int i = 0; i < 2 && outcome.result == ALCOVE_SUCCESS; ++i) {
    engine.submit(0, [&](VkCommandBuffer commands) {
      outcome.result = alcoveRecordFrame(context.get(), commands, &frame);
      if (outcome.result != ALCOVE_SUCCESS) throw_away(commands);
    });
    said = alcoveGetMessage(context.get());
  }
  engine.wait();
  outcome.message = said;
  return outcome;
}

TEST_F(CFailure, OutOfDeviceMemoryAtAnyAllocationIsAnErrorAndLeaksNothing) {
  GivenView given = given_view(test_views()[2], 8, 6, groove(0.8));
  given.settings.advanced.estimator = Estimator::horizons;
  AlcoveSettings settings;
  const AlcoveView view = view_of(given, settings);
  AlcoveContextInfo info = engine().context_info();
  info.get_instance_proc_addr = framegraph::failing::get_instance_proc_addr;
  bool failed = true;
  for (int call = 1; failed; ++call) {
    SCOPED_TRACE(call);
    framegraph::failing::fail_at(call);
    const Outcome outcome = run_frames(info, view, engine());
    EXPECT_EQ(framegraph::failing::alive(), 0);
    failed = framegraph::failing::calls() >= call;
    EXPECT_EQ(outcome.result, failed ? ALCOVE_ERROR_OUT_OF_DEVICE_MEMORY : ALCOVE_SUCCESS)
        << outcome.message;
    EXPECT_EQ(outcome.message.empty(), !failed);
    ASSERT_LT(call, 500);
  }
}

TEST(CResult, ResultNamesMatchTheEnumerators) {
#define ALCOVE_NAMED(value) \
  std::pair { value, #value }
  for (const auto& [value, name] :
       {ALCOVE_NAMED(ALCOVE_SUCCESS), ALCOVE_NAMED(ALCOVE_ERROR_INVALID_INPUT),
        ALCOVE_NAMED(ALCOVE_ERROR_UNSUPPORTED), ALCOVE_NAMED(ALCOVE_ERROR_OUT_OF_HOST_MEMORY),
        ALCOVE_NAMED(ALCOVE_ERROR_OUT_OF_DEVICE_MEMORY), ALCOVE_NAMED(ALCOVE_ERROR_DEVICE_LOST),
        ALCOVE_NAMED(ALCOVE_ERROR_VULKAN), ALCOVE_NAMED(ALCOVE_ERROR_INTERNAL)})
    EXPECT_STREQ(alcoveGetResultName(value), name);
#undef ALCOVE_NAMED
  for (const int none : {1, -8, INT_MAX, INT_MIN})
    EXPECT_STREQ(alcoveGetResultName(static_cast<AlcoveResult>(none)), "unknown AlcoveResult");
}

// Calls a function of the library while the allocation number `which`, counted from the beginning
// of the call, fails. Returns whether the call made that many allocations.
template <typename Call>
bool call_without_memory(std::size_t which, const Call& call) {
  framegraph::fail_allocation(which);
  call();
  const bool failed = framegraph::allocation_failed();
  framegraph::fail_allocation(0);
  return failed;
}

TEST_F(CFailure, OutOfHostMemoryWhileCreatingAContextIsAnErrorAndLeaksNothing) {
  AlcoveContextInfo info = engine().context_info();
  info.get_instance_proc_addr = framegraph::failing::get_instance_proc_addr;
  bool failed = true;
  std::size_t which = 1;
  for (; failed; ++which) {
    SCOPED_TRACE(which);
    char message[ALCOVE_MAX_MESSAGE];
    AlcoveContext* made = nullptr;
    AlcoveResult result = ALCOVE_SUCCESS;
    failed =
        call_without_memory(which, [&] { result = alcoveCreateContext(&info, &made, message); });
    EXPECT_EQ(result, failed ? ALCOVE_ERROR_OUT_OF_HOST_MEMORY : ALCOVE_SUCCESS) << message;
    EXPECT_EQ(made == nullptr, failed);
    alcoveDestroyContext(made);
    EXPECT_EQ(framegraph::failing::alive(), 0);
    ASSERT_LT(which, 2000u);
  }
  EXPECT_GT(which, 20u) << "hardly any of them failed";
}

TEST_F(CFailure, PrepareFrameSucceedsAfterItFailedForLackOfHostMemory) {
  GivenView given = given_view(test_views()[2], 16, 12, groove(0.8));
  AlcoveSettings settings;
  const AlcoveView view = view_of(given, settings);
  const Context context = create_context();
  const AlcoveFrame frame{.struct_size = sizeof frame, .view_count = 1, .views = &view};
  bool failed = true;
  std::size_t which = 1;
  for (; failed; ++which) {
    SCOPED_TRACE(which);
    AlcoveResult result = ALCOVE_SUCCESS;
    failed =
        call_without_memory(which, [&] { result = alcovePrepareFrame(context.get(), &frame); });
    EXPECT_EQ(result, failed ? ALCOVE_ERROR_OUT_OF_HOST_MEMORY : ALCOVE_SUCCESS)
        << alcoveGetMessage(context.get());
    EXPECT_EQ(alcovePrepareFrame(context.get(), &frame), ALCOVE_SUCCESS);
    ASSERT_LT(which, 2000u);
  }
  EXPECT_GT(which, 20u) << "hardly any of them failed";
}

// Each frame has another size than the one before, so that its plan is compiled and its memory is
// allocated again.
TEST_F(CFailure, RecordFrameSucceedsAfterItFailedForLackOfHostMemory) {
  GivenView given = given_view(test_views()[2], 64, 48, groove(0.8));
  given.settings.bent_normal = true;
  AlcoveSettings settings;
  AlcoveView view = view_of(given, settings);
  AlcoveContextInfo info = engine().context_info();
  info.get_instance_proc_addr = framegraph::failing::get_instance_proc_addr;
  AlcoveContext* made = nullptr;
  ASSERT_EQ(alcoveCreateContext(&info, &made, nullptr), ALCOVE_SUCCESS);
  Context context(made);
  const AlcoveFrame frame{.struct_size = sizeof frame, .view_count = 1, .views = &view};
  bool failed = true;
  std::size_t which = 1;
  for (; failed; ++which) {
    SCOPED_TRACE(which);
    for (AlcoveImage* image :
         {&view.depth, &view.normals, &view.motion, &view.roughness, &view.back_depth,
          &view.second_depth, &view.albedo, &view.visibility, &view.bent_normal}) {
      image->width = 8 + static_cast<std::uint32_t>(which % 56);
      image->height = 8 + static_cast<std::uint32_t>(which / 56);
    }
    for (const std::size_t fails : {which, std::size_t{0}}) {
      engine().submit(0, [&](VkCommandBuffer commands) {
        AlcoveResult result = ALCOVE_SUCCESS;
        const bool now = call_without_memory(
            fails, [&] { result = alcoveRecordFrame(context.get(), commands, &frame); });
        EXPECT_EQ(result, now ? ALCOVE_ERROR_OUT_OF_HOST_MEMORY : ALCOVE_SUCCESS)
            << alcoveGetMessage(context.get());
        if (fails != 0) failed = now;
        if (now) throw_away(commands);
      });
    }
    ASSERT_LT(which, 2000u);
  }
  EXPECT_GT(which, 20u) << "hardly any of them failed";
  engine().wait();
  context.reset();
  EXPECT_EQ(framegraph::failing::alive(), 0);
}

}  // namespace
}  // namespace alcove::passes
