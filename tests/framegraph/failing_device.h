// Wraps a device for tests: calls that create objects can be made to fail, the device can be lost,
// and objects that were not destroyed are counted.
#pragma once

#include <vulkan/vulkan.h>

namespace alcove::framegraph::failing {

// Makes one call that creates an object fail with VK_ERROR_OUT_OF_DEVICE_MEMORY: call number
// `call`, where number 1 is the first such call from now on. With 0, no call fails.
void fail_at(int call);
// Returns the number of calls that create objects since fail_at().
int calls();
// Makes the device lost, or not lost any more. While it is lost, submissions and waits return
// VK_ERROR_DEVICE_LOST.
void lose(bool lost);
// Makes the device lost after this number of further submissions.
void lose_after(int submissions);
// Returns the number of objects that were created and not destroyed.
int alive();
// Returns the number of calls of vkUpdateDescriptorSets.
int descriptor_updates();
// Return the number of calls of vkQueueSubmit2, and of the semaphores that they wait for.
int submits();
int semaphore_waits();
// Returns the number of recorded memory barriers over all commands.
int full_barriers();
// The function to give to the executor instead of vkGetInstanceProcAddr.
PFN_vkVoidFunction VKAPI_CALL get_instance_proc_addr(VkInstance instance, const char* name);

}  // namespace alcove::framegraph::failing
