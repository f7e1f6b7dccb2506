#include <iostream>

#include "cli/commands.h"
#include "gpu/vulkan_device.h"

namespace alcove::sample {

tl::expected<void, std::string> run_doctor(const Options& /*options*/) {
  const auto devices = list_devices();
  if (!devices) {
    return tl::unexpected(devices.error());
  }
  bool usable = false;
  for (std::size_t i = 0; i < devices->size(); ++i) {
    const DeviceSummary& device = (*devices)[i];
    std::cout << "device " << i << ": " << device.name << ", " << device.driver << ", Vulkan "
              << VK_API_VERSION_MAJOR(device.api_version) << "."
              << VK_API_VERSION_MINOR(device.api_version) << "\n  "
              << (device.missing.empty() ? "has all that Alcove needs" : "lacks " + device.missing)
              << "\n";
    usable = usable || device.missing.empty();
  }
  if (!usable) {
    return tl::unexpected(
        std::string("No Vulkan device has what Alcove needs; install a driver (on Debian, "
                    "mesa-vulkan-drivers brings a software one)."));
  }
  return {};
}

}  // namespace alcove::sample
