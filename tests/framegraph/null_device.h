// A Vulkan device without a driver: every function succeeds and does nothing. The benchmark times
// the executor on it.
#pragma once

#include "alcove/framegraph/executor.h"

namespace alcove::framegraph {

DeviceHandles null_device();

}  // namespace alcove::framegraph
