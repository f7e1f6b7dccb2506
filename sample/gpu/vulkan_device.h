#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

namespace alcove::sample {

// Options for creating a device.
struct DeviceOptions {
  // Index of the physical device in the loader's order, as `alcove doctor` lists them. -1 chooses
  // the first discrete GPU, else the first integrated GPU, else any device, such as lavapipe.
  int index = -1;
  // Whether Khronos validation with synchronisation validation is enabled, also across queue
  // submits. Creating the device fails if the layer is not installed.
  bool validation = false;
  // Whether the device is that of an engine for Vulkan 1.2, with VK_KHR_synchronization2 and no
  // other feature that 1.2 or 1.3 made core. The passes run on it, and the sample does not.
  bool vulkan12 = false;
  // Instance extensions of the window system. If there are any, the swapchain extension is enabled
  // too.
  std::vector<const char*> surface_extensions;
};

// A physical device as `alcove doctor` lists it.
struct DeviceSummary {
  std::string name;
  std::string driver;         // name and version as the driver reports them
  std::uint32_t api_version;  // VK_MAKE_API_VERSION
  VkPhysicalDeviceType type;
  std::string missing;  // requirements of Alcove that the device lacks; empty if it has all
};

// Owns an instance, a device and one queue for graphics and compute. The sample and the tests use
// it; the libraries never create a device.
class VulkanDevice {
 public:
  // Errors say in one sentence what is missing and how to get it.
  [[nodiscard]] static tl::expected<std::unique_ptr<VulkanDevice>, std::string> create(
      const DeviceOptions& options = {});
  ~VulkanDevice();
  VulkanDevice(const VulkanDevice&) = delete;
  VulkanDevice& operator=(const VulkanDevice&) = delete;

  VkInstance instance() const { return instance_; }
  VkPhysicalDevice physical_device() const { return physical_device_; }
  VkDevice device() const { return device_; }
  VkQueue queue() const { return queue_; }
  std::uint32_t queue_family() const { return queue_family_; }
  const VkPhysicalDeviceProperties& properties() const { return properties_; }
  const std::string& driver() const { return driver_; }
  // Returns the largest anisotropy for samplers: 1 on software devices and on devices without
  // anisotropic filtering.
  float max_anisotropy() const { return max_anisotropy_; }

  // Returns the largest allocation in bytes, which also limits the size of buffers and images.
  VkDeviceSize max_allocation() const { return max_allocation_; }

  // The errors and warnings of the validation layers so far, in order.
  const std::vector<std::string>& validation_messages() const { return messages_; }

  // Returns the first memory type allowed by `type_bits` with all of `flags`, or UINT32_MAX if
  // there is none.
  std::uint32_t memory_type(std::uint32_t type_bits, VkMemoryPropertyFlags flags) const;

  // Allocates memory of the first type that `needs` allows and that has all of `flags`.
  [[nodiscard]] VkResult allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags flags,
                                  VkDeviceMemory& memory) const;

 private:
  VulkanDevice() = default;
  static VKAPI_ATTR VkBool32 VKAPI_CALL receive_message(
      VkDebugUtilsMessageSeverityFlagBitsEXT severity, VkDebugUtilsMessageTypeFlagsEXT types,
      const VkDebugUtilsMessengerCallbackDataEXT* data, void* self);
  tl::expected<void, std::string> create_instance(const DeviceOptions& options);
  tl::expected<void, std::string> choose_physical_device(int index);
  tl::expected<void, std::string> create_device(const DeviceOptions& options);

  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device_ = VK_NULL_HANDLE;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  std::uint32_t queue_family_ = 0;
  VkPhysicalDeviceProperties properties_{};
  VkPhysicalDeviceMemoryProperties memory_{};
  std::string driver_;
  float max_anisotropy_ = 1.0f;
  VkDeviceSize max_allocation_ = 0;
  std::vector<std::string> messages_;
};

// Returns every Vulkan device of the machine, including those that Alcove cannot use.
[[nodiscard]] tl::expected<std::vector<DeviceSummary>, std::string> list_devices();

// Returns the name of a result for error sentences, for example `VK_ERROR_DEVICE_LOST`.
[[nodiscard]] std::string_view result_name(VkResult result);
// Returns the error "The device could not WHAT (RESULT).", for example with RESULT
// VK_ERROR_DEVICE_LOST.
[[nodiscard]] tl::unexpected<std::string> device_failure(const std::string& what, VkResult result);
// Returns that error if `result` is not VK_SUCCESS.
[[nodiscard]] tl::expected<void, std::string> check(VkResult result, const std::string& what);
// Returns the error for an object of `bytes` bytes that exceeds VulkanDevice::max_allocation().
// Drivers may crash if they are asked for more.
[[nodiscard]] tl::unexpected<std::string> too_large(const std::string& what, VkDeviceSize bytes,
                                                    const VulkanDevice& device);

}  // namespace alcove::sample
