// The Vulkan functions that the libraries call. A recording callback calls other functions through
// its own program, not through these tables. The functions are fetched through the caller's
// vkGetInstanceProcAddr, because the libraries define no Vulkan symbol and link no loader.
#pragma once

#include <vulkan/vulkan_core.h>

namespace alcove::framegraph {

// Calls X(name) for each function of the instance. Functions that a version above 1.0 made core are
// also found under their names with the suffix KHR or EXT.
#define ALCOVE_FRAMEGRAPH_INSTANCE_FUNCTIONS(X) \
  X(vkGetDeviceProcAddr)                        \
  X(vkGetPhysicalDeviceProperties)              \
  X(vkGetPhysicalDeviceMemoryProperties)        \
  X(vkGetPhysicalDeviceQueueFamilyProperties)   \
  X(vkGetPhysicalDeviceFormatProperties)        \
  X(vkGetPhysicalDeviceImageFormatProperties2)  \
  X(vkGetPhysicalDeviceProperties2)

// Calls X(name) for each function of the device that every device of Vulkan 1.2 has.
#define ALCOVE_FRAMEGRAPH_DEVICE_FUNCTIONS(X) \
  X(vkAllocateCommandBuffers)                 \
  X(vkAllocateDescriptorSets)                 \
  X(vkAllocateMemory)                         \
  X(vkBeginCommandBuffer)                     \
  X(vkBindBufferMemory)                       \
  X(vkBindImageMemory)                        \
  X(vkCmdBindDescriptorSets)                  \
  X(vkCmdBindPipeline)                        \
  X(vkCmdCopyImageToBuffer)                   \
  X(vkCmdDispatch)                            \
  X(vkCmdPipelineBarrier2)                    \
  X(vkCmdResetQueryPool)                      \
  X(vkCmdUpdateBuffer)                        \
  X(vkCmdWriteTimestamp2)                     \
  X(vkCreateBuffer)                           \
  X(vkCreateCommandPool)                      \
  X(vkCreateComputePipelines)                 \
  X(vkCreateDescriptorPool)                   \
  X(vkCreateDescriptorSetLayout)              \
  X(vkCreateImage)                            \
  X(vkCreateImageView)                        \
  X(vkCreatePipelineLayout)                   \
  X(vkCreateQueryPool)                        \
  X(vkCreateSampler)                          \
  X(vkCreateSemaphore)                        \
  X(vkCreateShaderModule)                     \
  X(vkDestroyBuffer)                          \
  X(vkDestroyCommandPool)                     \
  X(vkDestroyDescriptorPool)                  \
  X(vkDestroyDescriptorSetLayout)             \
  X(vkDestroyImage)                           \
  X(vkDestroyImageView)                       \
  X(vkDestroyPipeline)                        \
  X(vkDestroyPipelineLayout)                  \
  X(vkDestroyQueryPool)                       \
  X(vkDestroySampler)                         \
  X(vkDestroySemaphore)                       \
  X(vkDestroyShaderModule)                    \
  X(vkEndCommandBuffer)                       \
  X(vkFreeDescriptorSets)                     \
  X(vkFreeMemory)                             \
  X(vkGetBufferMemoryRequirements)            \
  X(vkGetImageMemoryRequirements)             \
  X(vkGetQueryPoolResults)                    \
  X(vkMapMemory)                              \
  X(vkQueueSubmit2)                           \
  X(vkQueueWaitIdle)                          \
  X(vkResetCommandPool)                       \
  X(vkUpdateDescriptorSets)                   \
  X(vkWaitSemaphores)

// Calls X(name) for each function of Vulkan 1.3 or of an extension that the executor does not
// require. Such a function is null if the device does not have it, and is checked before it is
// called.
#define ALCOVE_FRAMEGRAPH_OPTIONAL_FUNCTIONS(X) \
  X(vkCmdBeginRendering)                        \
  X(vkCmdEndRendering)                          \
  X(vkGetDeviceBufferMemoryRequirements)        \
  X(vkGetDeviceImageMemoryRequirements)         \
  X(vkCmdBeginDebugUtilsLabelEXT)               \
  X(vkCmdEndDebugUtilsLabelEXT)                 \
  X(vkSetDebugUtilsObjectNameEXT)

struct VulkanFunctions {
#define ALCOVE_DECLARE(name) PFN_##name name = nullptr;
  ALCOVE_FRAMEGRAPH_INSTANCE_FUNCTIONS(ALCOVE_DECLARE)
  ALCOVE_FRAMEGRAPH_DEVICE_FUNCTIONS(ALCOVE_DECLARE)
  ALCOVE_FRAMEGRAPH_OPTIONAL_FUNCTIONS(ALCOVE_DECLARE)
#undef ALCOVE_DECLARE
};

// Fetches all functions. Returns the name of the first required function that is missing, or null
// if all are there.
const char* load(VulkanFunctions& functions, PFN_vkGetInstanceProcAddr get_instance_proc_addr,
                 VkInstance instance, VkDevice device);

}  // namespace alcove::framegraph
