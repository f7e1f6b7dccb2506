// From which cache pipelines are made.
#include <gmock/gmock.h>

#include <cstring>
#include <set>

#include "c_interface_fixture.h"
#include "gtao_scenes.h"

namespace alcove::passes {
namespace {

// Those that pipelines were made from since a test began.
std::set<VkPipelineCache> caches;

VKAPI_ATTR VkResult VKAPI_CALL create_pipelines(VkDevice device, VkPipelineCache cache,
                                                std::uint32_t count,
                                                const VkComputePipelineCreateInfo* infos,
                                                const VkAllocationCallbacks* callbacks,
                                                VkPipeline* made) {
  caches.insert(cache);
  return vkCreateComputePipelines(device, cache, count, infos, callbacks, made);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_proc_addr(VkDevice device, const char* name) {
  return std::strcmp(name, "vkCreateComputePipelines") == 0
             ? reinterpret_cast<PFN_vkVoidFunction>(&create_pipelines)
             : vkGetDeviceProcAddr(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_instance_proc_addr(VkInstance instance,
                                                                const char* name) {
  return std::strcmp(name, "vkGetDeviceProcAddr") == 0
             ? reinterpret_cast<PFN_vkVoidFunction>(&get_device_proc_addr)
             : vkGetInstanceProcAddr(instance, name);
}

class CPipelines : public CInterface {
 protected:
  void SetUp() override {
    CInterface::SetUp();
    caches.clear();
  }

  Context create_watched(VkPipelineCache cache = VK_NULL_HANDLE) {
    AlcoveContextInfo info = engine().context_info();
    info.get_instance_proc_addr = get_instance_proc_addr;
    info.pipeline_cache = cache;
    AlcoveContext* made = nullptr;
    char message[ALCOVE_MAX_MESSAGE];
    EXPECT_EQ(alcoveCreateContext(&info, &made, message), ALCOVE_SUCCESS) << message;
    return Context(made);
  }
};

TEST_F(CPipelines, ComeFromTheEnginesCacheWhichOutlivesTheContext) {
  GivenView given = given_view(test_views()[2], 16, 12, groove(0.8));
  (void)run_by_c(*create_watched(), {&given, 1}, 0);
  EXPECT_THAT(caches, testing::ElementsAre(VkPipelineCache{VK_NULL_HANDLE})) << "by default";

  const VkDevice device = gpu().device().device();
  const VkPipelineCacheCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
  VkPipelineCache cache = VK_NULL_HANDLE;
  ASSERT_EQ(vkCreatePipelineCache(device, &info, nullptr, &cache), VK_SUCCESS);
  caches.clear();
  (void)run_by_c(*create_watched(cache), {&given, 1}, 0);
  EXPECT_THAT(caches, testing::ElementsAre(cache));
  std::size_t size = 0;
  EXPECT_EQ(vkGetPipelineCacheData(device, cache, &size, nullptr), VK_SUCCESS);
  vkDestroyPipelineCache(device, cache, nullptr);
}

}  // namespace
}  // namespace alcove::passes
