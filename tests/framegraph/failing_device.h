// A device whose creating calls fail when they are told to, that can be lost, and that counts what
// is not destroyed.
#pragma once

#include <vulkan/vulkan.h>

namespace alcove::framegraph::failing {

// The call, counted from 1, that fails with out of device memory; 0 for none.
void fail_at(int call);
// Calls since fail_at.
int calls();
// From now on (or no more) the device is lost: nothing is submitted, and waits say so.
void lose(bool lost);
// Loses it at the submission after so many more.
void lose_after(int submissions);
// Objects that were created and not destroyed.
int alive();
// Calls of vkUpdateDescriptorSets so far.
int descriptor_updates();
// Calls of vkQueueSubmit2 so far, and the semaphores that they wait for.
int submits();
int semaphore_waits();
// Image barriers recorded so far whose queue family on one side is VK_QUEUE_FAMILY_EXTERNAL.
int outside_transfers();
// The function that the executor gets in place of vkGetInstanceProcAddr.
PFN_vkVoidFunction VKAPI_CALL get_instance_proc_addr(VkInstance instance, const char* name);

}  // namespace alcove::framegraph::failing
