// Tests that a call returns an error value and a message of one sentence if the device lacks a
// feature or a function, or if memory runs out at any allocation. Nothing may be thrown or leaked.
#include <gmock/gmock.h>

#include <array>
#include <climits>
#include <functional>
#include <string>
#include <utility>

#include "c_interface_fixture.h"
#include "framegraph/allocation_counter.h"
#include "framegraph/failing_device.h"

namespace alcove::passes {
namespace {

using testing::AllOf;
using testing::HasSubstr;

bool has_synchronization2 = true;
bool has_write_without_format = true;
std::uint32_t api_version = VK_API_VERSION_1_3;
std::uint32_t storage_images = 10;  // that a shader can bind

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

class CFailure : public CInterface {
 protected:
  void SetUp() override {
    CInterface::SetUp();
    has_synchronization2 = has_write_without_format = true;
    api_version = VK_API_VERSION_1_3;
    storage_images = 10;
    replaced_functions = {{"vkGetPhysicalDeviceFeatures2", untyped(&get_features)},
                          {"vkGetPhysicalDeviceProperties", untyped(&get_properties)}};
    framegraph::failing::fail_at(0);
    framegraph::failing::lose(false);
  }

  std::string error_of_context(const AlcoveContextInfo& info, AlcoveResult expected) {
    char message[ALCOVE_MAX_MESSAGE];
    AlcoveContext* handle = nullptr;
    EXPECT_EQ(alcoveCreateContext(&info, &handle, message), expected) << message;
    alcoveDestroyContext(handle);
    return message;
  }
};

TEST_F(CFailure, VulkanFeaturesAndFunctionsThatTheDeviceLacksAreReported) {
  AlcoveContextInfo info = engine().context_info();
  info.get_instance_proc_addr = get_replaced_function;
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
  storage_images = 5;
  EXPECT_THAT(error_of_context(info, ALCOVE_ERROR_UNSUPPORTED),
              HasSubstr("5 storage images to a shader; the occlusion passes need 6."));
  storage_images = 10;
  replaced_functions["vkCmdPipelineBarrier2"] = nullptr;
  EXPECT_THAT(error_of_context(info, ALCOVE_ERROR_UNSUPPORTED),
              AllOf(HasSubstr("vkCmdPipelineBarrier2"), HasSubstr("VK_KHR_synchronization2")));
  replaced_functions = {{"vkGetPhysicalDeviceQueueFamilyProperties2", nullptr}};
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

TEST_F(CFailure, EnabledFeaturesAreFoundInAnyOrderOfTheirStructs) {
  AlcoveContextInfo info = engine().context_info();
  for (const bool alone : {false, true}) {
    for (const bool complete : {true, false}) {
      VkPhysicalDeviceFeatures2 core{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
      core.features.shaderStorageImageWriteWithoutFormat = complete ? VK_TRUE : VK_FALSE;
      VkPhysicalDeviceVulkan11Features vulkan11{
          .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES};
      VkPhysicalDeviceVulkan13Features vulkan13{
          .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
      VkPhysicalDeviceSynchronization2Features synchronization2{
          .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES};
      vulkan13.synchronization2 = synchronization2.synchronization2 = VK_TRUE;
      const auto base = [](auto& feature) {
        return reinterpret_cast<VkBaseOutStructure*>(&feature);
      };
      std::array chain{base(core), base(vulkan11), alone ? base(synchronization2) : base(vulkan13)};
      std::ranges::sort(chain);
      do {
        for (std::size_t i = 0; i < 3; ++i) chain.at(i)->pNext = i < 2 ? chain.at(i + 1) : nullptr;
        info.enabled_features = reinterpret_cast<const VkPhysicalDeviceFeatures2*>(chain[0]);
        const std::string sentence =
            error_of_context(info, complete ? ALCOVE_SUCCESS : ALCOVE_ERROR_UNSUPPORTED);
        EXPECT_THAT(sentence, HasSubstr(complete ? "" : "shaderStorageImageWriteWithoutFormat"));
      } while (std::ranges::next_permutation(chain).found);
      // Without VkPhysicalDeviceFeatures2, and with a chain that does not end.
      vulkan11.pNext = nullptr;
      info.enabled_features = reinterpret_cast<const VkPhysicalDeviceFeatures2*>(&vulkan11);
      EXPECT_THAT(error_of_context(info, ALCOVE_ERROR_INVALID_INPUT),
                  HasSubstr("has no VkPhysicalDeviceFeatures2"));
      for (const auto& [last, again] : {std::pair{2, 0}, std::pair{2, 1}, std::pair{0, 0}}) {
        for (std::size_t i = 0; i < 2; ++i) chain.at(i)->pNext = chain.at(i + 1);
        chain.at(last)->pNext = chain.at(again);
        info.enabled_features = reinterpret_cast<const VkPhysicalDeviceFeatures2*>(chain[0]);
        EXPECT_THAT(error_of_context(info, ALCOVE_ERROR_INVALID_INPUT), HasSubstr("does not end"));
      }
    }
  }
}

// A context whose device is wrapped by failing_device.h.
AlcoveContextInfo failing_info(const TestEngine& engine) {
  AlcoveContextInfo info = engine.context_info();
  info.get_instance_proc_addr = framegraph::failing::get_instance_proc_addr;
  return info;
}

// Creates a context, prepares a frame and records two while a call that creates an object fails.
TEST_F(CFailure, OutOfDeviceMemoryAtAnyAllocationIsAnErrorAndLeaksNothing) {
  HostView from = draw_view(8, 6, groove(0.8));
  from.settings.estimator = ALCOVE_ESTIMATOR_HORIZONS;
  const AlcoveView view = create_view(from);
  const AlcoveFrame frame = make_frame({&view, 1}, 0);
  const AlcoveContextInfo info = failing_info(engine());
  bool failed = true;
  for (int call = 1; failed; ++call) {
    SCOPED_TRACE(call);
    framegraph::failing::fail_at(call);
    char message[ALCOVE_MAX_MESSAGE];
    AlcoveContext* handle = nullptr;
    AlcoveResult result = alcoveCreateContext(&info, &handle, message);
    Context context(handle);
    if (result == ALCOVE_SUCCESS) result = alcovePrepareFrame(handle, &frame);
    for (int i = 0; i < 2 && result == ALCOVE_SUCCESS; ++i) result = record(*handle, frame);
    engine().wait();
    failed = framegraph::failing::calls() >= call;
    EXPECT_EQ(result, failed ? ALCOVE_ERROR_OUT_OF_DEVICE_MEMORY : ALCOVE_SUCCESS);
    EXPECT_EQ(std::string(context ? alcoveGetMessage(handle) : message).empty(), !failed);
    context.reset();
    EXPECT_EQ(framegraph::failing::alive(), 0);
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

// The sentence about a radius below 0 needs memory.
TEST(COutOfMemory, FunctionsWithoutAContextReturnAValue) {
  AlcoveSettings settings{.struct_size = sizeof settings};
  ASSERT_EQ(alcoveGetSettings(ALCOVE_QUALITY_MEDIUM, 1.0f, &settings), ALCOVE_SUCCESS);
  AlcoveSettings bad = settings;
  bad.radius = -1.0f;
  const auto with_failure = [](const auto& call) {
    framegraph::fail_allocation(1);
    const auto result = call();
    EXPECT_TRUE(framegraph::allocation_failed());
    framegraph::fail_allocation(0);
    return result;
  };
  EXPECT_EQ(
      with_failure([&] { return alcoveGetSettings(ALCOVE_QUALITY_MEDIUM, -1.0f, &settings); }),
      ALCOVE_ERROR_OUT_OF_HOST_MEMORY);
  EXPECT_EQ(with_failure([&] { return alcovePrintSettings(&settings, nullptr, 0); }), 0u);
  EXPECT_EQ(with_failure([&] { return alcoveGetConvergedFrames(&bad); }), 0u);
}

// Makes a call while its first allocation fails, again while its second one fails, and so on until
// it makes no more of them. `check` is given the result and whether an allocation has failed.
void fail_each_allocation(const std::function<AlcoveResult(std::size_t number)>& call,
                          const std::function<void(AlcoveResult, bool failed)>& check) {
  bool failed = true;
  std::size_t number = 1;
  for (; failed; ++number) {
    SCOPED_TRACE(number);
    framegraph::fail_allocation(number);
    const AlcoveResult result = call(number);
    failed = framegraph::allocation_failed();
    framegraph::fail_allocation(0);
    EXPECT_EQ(result, failed ? ALCOVE_ERROR_OUT_OF_HOST_MEMORY : ALCOVE_SUCCESS);
    check(result, failed);
    ASSERT_LT(number, 2000u);
  }
  EXPECT_GT(number, 20u) << "hardly any of them failed";
}

TEST_F(CFailure, OutOfHostMemoryWhileCreatingAContextIsAnErrorAndLeaksNothing) {
  const AlcoveContextInfo info = failing_info(engine());
  AlcoveContext* handle = nullptr;
  fail_each_allocation([&](std::size_t) { return alcoveCreateContext(&info, &handle, nullptr); },
                       [&](AlcoveResult, bool failed) {
                         EXPECT_EQ(handle == nullptr, failed);
                         alcoveDestroyContext(handle);
                         EXPECT_EQ(framegraph::failing::alive(), 0);
                       });
}

TEST_F(CFailure, PrepareFrameSucceedsAfterItFailedForLackOfHostMemory) {
  const AlcoveView view = create_view(draw_view(16, 12, groove(0.8)));
  const AlcoveFrame frame = make_frame({&view, 1}, 0);
  const Context context = create_context();
  const auto prepare = [&] { return alcovePrepareFrame(context.get(), &frame); };
  fail_each_allocation([&](std::size_t) { return prepare(); },
                       [&](AlcoveResult, bool) { EXPECT_EQ(prepare(), ALCOVE_SUCCESS); });
}

// Each frame has another size than the one before, so that its plan is compiled and its memory is
// allocated again.
TEST_F(CFailure, RecordFrameSucceedsAfterItFailedForLackOfHostMemory) {
  HostView from = draw_view(64, 48, groove(0.8));
  from.settings.bent_normal = true;
  AlcoveView view = create_view(from);
  Context context = create_context(failing_info(engine()));
  VkCommandBuffer commands = VK_NULL_HANDLE;
  const AlcoveFrame frame = make_frame({&view, 1}, 0);
  const auto record_frame = [&] { return alcoveRecordFrame(context.get(), commands, &frame); };
  engine().submit(0, [&](VkCommandBuffer recording) {
    commands = recording;
    fail_each_allocation(
        [&](std::size_t number) {
          for (AlcoveImage& image : view.images) {
            image.width = 8 + static_cast<std::uint32_t>(number % 56);
            image.height = 8 + static_cast<std::uint32_t>(number / 56);
          }
          return record_frame();
        },
        [&](AlcoveResult, bool) {
          throw_away(commands);
          EXPECT_EQ(record_frame(), ALCOVE_SUCCESS);
          throw_away(commands);
        });
  });
  engine().wait();
  context.reset();
  EXPECT_EQ(framegraph::failing::alive(), 0);
}

}  // namespace
}  // namespace alcove::passes
