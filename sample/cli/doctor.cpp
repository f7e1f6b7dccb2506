#include <iostream>

#include "cli/commands.h"
#include "gpu/vulkan_device.h"
#include "support/result.h"

namespace alcove::sample {

Result<void> run_doctor(const Options& /*options*/) {
  ALCOVE_TRY(const auto devices, list_devices());
  bool usable = false;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const DeviceSummary& device = devices[i];
    std::cout << "device " << i << ": " << device.name << ", " << device.driver << ", Vulkan "
              << VK_API_VERSION_MAJOR(device.api_version) << "."
              << VK_API_VERSION_MINOR(device.api_version) << "\n  "
              << (device.missing.empty() ? "has all that Alcove needs" : "lacks " + device.missing)
              << "\n";
    usable = usable || device.missing.empty();
  }
  if (!usable) {
    return Failure(
        "No Vulkan device has what Alcove needs; install a driver (on Debian, "
        "mesa-vulkan-drivers brings a software one).");
  }
  return {};
}

}  // namespace alcove::sample
