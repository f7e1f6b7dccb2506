// The Vulkan functions that the executor and recording callbacks call. They are fetched through the
// caller's vkGetInstanceProcAddr, because the library defines no Vulkan symbol and links no loader.
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
  X(vkCmdBeginQuery)                          \
  X(vkCmdBindDescriptorSets)                  \
  X(vkCmdBindIndexBuffer)                     \
  X(vkCmdBindPipeline)                        \
  X(vkCmdBindVertexBuffers)                   \
  X(vkCmdClearColorImage)                     \
  X(vkCmdClearDepthStencilImage)              \
  X(vkCmdCopyBuffer)                          \
  X(vkCmdCopyBufferToImage)                   \
  X(vkCmdCopyImage)                           \
  X(vkCmdCopyImageToBuffer)                   \
  X(vkCmdDispatch)                            \
  X(vkCmdDispatchIndirect)                    \
  X(vkCmdDraw)                                \
  X(vkCmdDrawIndexed)                         \
  X(vkCmdDrawIndexedIndirect)                 \
  X(vkCmdDrawIndirect)                        \
  X(vkCmdEndQuery)                            \
  X(vkCmdExecuteCommands)                     \
  X(vkCmdFillBuffer)                          \
  X(vkCmdPipelineBarrier2)                    \
  X(vkCmdPushConstants)                       \
  X(vkCmdResetQueryPool)                      \
  X(vkCmdSetScissor)                          \
  X(vkCmdSetViewport)                         \
  X(vkCmdUpdateBuffer)                        \
  X(vkCmdWriteTimestamp2)                     \
  X(vkCreateBuffer)                           \
  X(vkCreateCommandPool)                      \
  X(vkCreateComputePipelines)                 \
  X(vkCreateDescriptorPool)                   \
  X(vkCreateDescriptorSetLayout)              \
  X(vkCreateFence)                            \
  X(vkCreateImage)                            \
  X(vkCreateImageView)                        \
  X(vkCreatePipelineCache)                    \
  X(vkCreatePipelineLayout)                   \
  X(vkCreateQueryPool)                        \
  X(vkCreateSampler)                          \
  X(vkCreateSemaphore)                        \
  X(vkCreateShaderModule)                     \
  X(vkDestroyBuffer)                          \
  X(vkDestroyCommandPool)                     \
  X(vkDestroyDescriptorPool)                  \
  X(vkDestroyDescriptorSetLayout)             \
  X(vkDestroyFence)                           \
  X(vkDestroyImage)                           \
  X(vkDestroyImageView)                       \
  X(vkDestroyPipeline)                        \
  X(vkDestroyPipelineCache)                   \
  X(vkDestroyPipelineLayout)                  \
  X(vkDestroyQueryPool)                       \
  X(vkDestroySampler)                         \
  X(vkDestroySemaphore)                       \
  X(vkDestroyShaderModule)                    \
  X(vkDeviceWaitIdle)                         \
  X(vkEndCommandBuffer)                       \
  X(vkFlushMappedMemoryRanges)                \
  X(vkFreeCommandBuffers)                     \
  X(vkFreeDescriptorSets)                     \
  X(vkFreeMemory)                             \
  X(vkGetBufferMemoryRequirements)            \
  X(vkGetDeviceQueue)                         \
  X(vkGetFenceStatus)                         \
  X(vkGetImageMemoryRequirements)             \
  X(vkGetQueryPoolResults)                    \
  X(vkGetSemaphoreCounterValue)               \
  X(vkInvalidateMappedMemoryRanges)           \
  X(vkMapMemory)                              \
  X(vkQueueSubmit2)                           \
  X(vkQueueWaitIdle)                          \
  X(vkResetCommandBuffer)                     \
  X(vkResetCommandPool)                       \
  X(vkResetDescriptorPool)                    \
  X(vkResetFences)                            \
  X(vkUnmapMemory)                            \
  X(vkUpdateDescriptorSets)                   \
  X(vkWaitForFences)                          \
  X(vkWaitSemaphores)

// Calls X(name) for each function of Vulkan 1.3 or of an extension that the executor does not
// require. Such a function is null if the device does not have it. A callback must check it before
// it calls it.
#define ALCOVE_FRAMEGRAPH_OPTIONAL_FUNCTIONS(X) \
  X(vkCmdBeginRendering)                        \
  X(vkCmdEndRendering)                          \
  X(vkCmdBlitImage2)                            \
  X(vkCmdSetCullMode)                           \
  X(vkCmdSetFrontFace)                          \
  X(vkCreateGraphicsPipelines)                  \
  X(vkGetDeviceBufferMemoryRequirements)        \
  X(vkGetDeviceImageMemoryRequirements)         \
  X(vkCmdBeginDebugUtilsLabelEXT)               \
  X(vkCmdEndDebugUtilsLabelEXT)                 \
  X(vkSetDebugUtilsObjectNameEXT)               \
  X(vkCmdPushDescriptorSetKHR)

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
