#include "device_context.h"

#include <algorithm>
#include <bit>
#include <vector>

namespace alcove::framegraph {
namespace {

// Sets the queue families that use an image or buffer.
template <typename Info>
void share(Info& info, const DeviceContext& device, bool concurrent) {
  info.sharingMode = concurrent ? VK_SHARING_MODE_CONCURRENT : VK_SHARING_MODE_EXCLUSIVE;
  if (!concurrent) return;
  info.queueFamilyIndexCount = static_cast<std::uint32_t>(device.families.size());
  info.pQueueFamilyIndices = device.families.data();
}

VkImageCreateInfo image_info(const DeviceContext& device, const ResourceRecord& record,
                             VkFlags usage, bool concurrent) {
  VkImageCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                         .flags = record.create_flags,
                         .imageType = record.depth > 1 ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D,
                         .format = record.format,
                         .extent = {record.width, record.height, record.depth},
                         .mipLevels = record.mips,
                         .arrayLayers = record.layers,
                         .samples = static_cast<VkSampleCountFlagBits>(record.samples),
                         .tiling = VK_IMAGE_TILING_OPTIMAL,
                         .usage = usage,
                         .initialLayout = VK_IMAGE_LAYOUT_UNDEFINED};
  share(info, device, concurrent);
  return info;
}

VkBufferCreateInfo buffer_info(const DeviceContext& device, const ResourceRecord& record,
                               VkFlags usage, bool concurrent) {
  VkBufferCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = record.size, .usage = usage};
  share(info, device, concurrent);
  return info;
}

MemoryRequirements device_requirements(const void* context, const ResourceRecord& record,
                                       VkFlags usage, bool concurrent) {
  const auto& device = *static_cast<const DeviceContext*>(context);
  VkMemoryRequirements2 requirements{VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2, nullptr, {}};
  if (!device.vk.vkGetDeviceImageMemoryRequirements) {
    // Without VK_KHR_maintenance4 a device reports the requirements of existing resources only.
    VkImage image = VK_NULL_HANDLE;
    VkBuffer buffer = VK_NULL_HANDLE;
    if (const VkResult result = create_unbound(device, record, usage, concurrent, image, buffer,
                                               requirements.memoryRequirements))
      return {0, 0, 0, result};
    device.vk.vkDestroyImage(device.handles.device, image, device.callbacks());
    device.vk.vkDestroyBuffer(device.handles.device, buffer, device.callbacks());
  } else if (record.kind == ResourceKind::texture) {
    const VkImageCreateInfo info = image_info(device, record, usage, concurrent);
    const VkDeviceImageMemoryRequirements query{VK_STRUCTURE_TYPE_DEVICE_IMAGE_MEMORY_REQUIREMENTS,
                                                nullptr, &info, VK_IMAGE_ASPECT_COLOR_BIT};
    device.vk.vkGetDeviceImageMemoryRequirements(device.handles.device, &query, &requirements);
  } else {
    const VkBufferCreateInfo info = buffer_info(device, record, usage, concurrent);
    const VkDeviceBufferMemoryRequirements query{
        VK_STRUCTURE_TYPE_DEVICE_BUFFER_MEMORY_REQUIREMENTS, nullptr, &info};
    device.vk.vkGetDeviceBufferMemoryRequirements(device.handles.device, &query, &requirements);
  }
  const VkMemoryRequirements& r = requirements.memoryRequirements;
  return {r.size, r.alignment, r.memoryTypeBits};
}

ImageLimits image_limits(const void* context, const ResourceRecord& record, VkFlags usage) {
  const auto& device = *static_cast<const DeviceContext*>(context);
  const VkImageCreateInfo image = image_info(device, record, usage, false);
  const VkPhysicalDeviceImageFormatInfo2 info{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_IMAGE_FORMAT_INFO_2,
                                              nullptr,
                                              image.format,
                                              image.imageType,
                                              image.tiling,
                                              image.usage,
                                              image.flags};
  VkImageFormatProperties2 properties{.sType = VK_STRUCTURE_TYPE_IMAGE_FORMAT_PROPERTIES_2};
  const VkResult result = device.vk.vkGetPhysicalDeviceImageFormatProperties2(
      device.handles.physical_device, &info, &properties);
  if (result != VK_SUCCESS) return {};
  // Storage of several samples needs a feature that the library does not ask for.
  if (usage & VK_IMAGE_USAGE_STORAGE_BIT)
    properties.imageFormatProperties.sampleCounts &= VK_SAMPLE_COUNT_1_BIT;
  const VkImageFormatProperties& p = properties.imageFormatProperties;
  return {p.maxExtent, p.maxMipLevels, p.maxArrayLayers, p.sampleCounts};
}

VkImageUsageFlags format_usage(const void* context, VkFormat format) {
  const auto& device = *static_cast<const DeviceContext*>(context);
  VkFormatProperties properties{};
  device.vk.vkGetPhysicalDeviceFormatProperties(device.handles.physical_device, format,
                                                &properties);
  struct Pair {
    VkFormatFeatureFlags feature;
    VkImageUsageFlags usage;
  };
  constexpr Pair kPairs[] = {
      {VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT, VK_IMAGE_USAGE_SAMPLED_BIT},
      {VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT, VK_IMAGE_USAGE_STORAGE_BIT},
      {VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT},
      {VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT},
      {VK_FORMAT_FEATURE_TRANSFER_SRC_BIT, VK_IMAGE_USAGE_TRANSFER_SRC_BIT},
      {VK_FORMAT_FEATURE_TRANSFER_DST_BIT, VK_IMAGE_USAGE_TRANSFER_DST_BIT},
  };
  VkImageUsageFlags usage = 0;
  for (const Pair& pair : kPairs)
    if (properties.optimalTilingFeatures & pair.feature) usage |= pair.usage;
  return usage;
}

// Returns the largest size of a buffer in bytes. Without VK_KHR_maintenance4, that is the largest
// size of one allocation.
VkDeviceSize max_buffer_size(const DeviceContext& context) {
  VkPhysicalDeviceMaintenance4Properties buffers{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_PROPERTIES};
  VkPhysicalDeviceMaintenance3Properties allocations{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES,
      .pNext = context.vk.vkGetDeviceBufferMemoryRequirements ? &buffers : nullptr};
  VkPhysicalDeviceProperties2 all{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                  .pNext = &allocations};
  context.vk.vkGetPhysicalDeviceProperties2(context.handles.physical_device, &all);
  if (buffers.maxBufferSize != 0) return buffers.maxBufferSize;
  if (allocations.maxMemoryAllocationSize != 0) return allocations.maxMemoryAllocationSize;
  return Limits{}.max_buffer_size;  // The driver reports neither limit.
}

void read_limits(DeviceContext& context) {
  Limits& limits = context.limits;
  const VkPhysicalDeviceLimits& device = context.properties.limits;
  limits.max_extent_2d = device.maxImageDimension2D;
  limits.max_extent_3d = device.maxImageDimension3D;
  limits.max_layers = device.maxImageArrayLayers;
  // The largest sample count of any format. image_limits() returns the counts of a single texture.
  const VkSampleCountFlags samples =
      device.framebufferColorSampleCounts | device.framebufferDepthSampleCounts |
      device.sampledImageColorSampleCounts | device.sampledImageIntegerSampleCounts |
      device.sampledImageDepthSampleCounts;
  limits.max_samples = std::bit_floor(std::max(samples, VkSampleCountFlags{1}));
  limits.max_buffer_size = max_buffer_size(context);
  limits.buffer_image_granularity = device.bufferImageGranularity;
  limits.memory = {device_requirements, &context};
  limits.formats = {format_usage, &context};
  limits.images = {image_limits, &context};
  for (std::size_t i = 0; i < kQueueClasses; ++i) {
    const QueueHandle& queue = context.handles.queues[i];
    limits.queue_families[i] = queue.queue == VK_NULL_HANDLE && i != 0 ? kNone : queue.family;
    auto& families = context.families;
    if (limits.queue_families[i] != kNone &&
        std::find(families.begin(), families.end(), queue.family) == families.end())
      families.push_back(queue.family);
  }
}

void read_timestamp_bits(DeviceContext& context) {
  const VkPhysicalDevice device = context.handles.physical_device;
  std::uint32_t count = 0;
  context.vk.vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  context.vk.vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  for (std::size_t i = 0; i < kQueueClasses; ++i) {
    const std::uint32_t family = context.limits.queue_families[i];
    if (family < count) context.timestamp_bits[i] = families[family].timestampValidBits;
  }
}

// Returns whether one of the instance's layers validates. The name of the extension may be called
// with every version of the instance, and the layers of Vulkan 1.3.239 answer to no other.
bool has_validation_layers(const DeviceHandles& handles) {
  const auto query = reinterpret_cast<PFN_vkGetPhysicalDeviceToolProperties>(
      handles.get_instance_proc_addr(handles.instance, "vkGetPhysicalDeviceToolPropertiesEXT"));
  std::uint32_t count = 0;
  if (query == nullptr || query(handles.physical_device, &count, nullptr) != VK_SUCCESS)
    return false;
  std::vector<VkPhysicalDeviceToolProperties> tools(
      count, {VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TOOL_PROPERTIES});
  return query(handles.physical_device, &count, tools.data()) == VK_SUCCESS &&
         std::any_of(tools.begin(), tools.end(), [](const auto& tool) {
           return (tool.purposes & VK_TOOL_PURPOSE_VALIDATION_BIT) != 0;
         });
}

Errors missing(std::string what) {
  return {{ErrorCode::vulkan, std::move(what), VK_ERROR_FEATURE_NOT_PRESENT}};
}

}  // namespace

tl::expected<void, Errors> open(DeviceContext& context, const DeviceHandles& handles) {
  context.handles = handles;
  if (handles.instance == VK_NULL_HANDLE || handles.physical_device == VK_NULL_HANDLE ||
      handles.device == VK_NULL_HANDLE || handles.get_instance_proc_addr == nullptr ||
      handles.queues[0].family == kNone)
    return tl::unexpected(
        missing("DeviceHandles lacks the instance, physical device, device, get_instance_proc_addr "
                "or the graphics queue's family: set them all"));
  if (const char* name =
          load(context.vk, handles.get_instance_proc_addr, handles.instance, handles.device))
    return tl::unexpected(missing(std::string("the device has no ") + name +
                                  ": create instance and device for Vulkan 1.3, or for Vulkan 1.2 "
                                  "with VK_KHR_synchronization2"));
  context.vk.vkGetPhysicalDeviceProperties(handles.physical_device, &context.properties);
  if (context.properties.apiVersion < VK_API_VERSION_1_2)
    return tl::unexpected(missing(std::string("the device '") + context.properties.deviceName +
                                  "' is below Vulkan 1.2: choose another or update its driver"));
  read_limits(context);
  read_timestamp_bits(context);
  context.is_validated = has_validation_layers(handles);
  return {};
}

VkResult create_unbound(const DeviceContext& device, const ResourceRecord& record, VkFlags usage,
                        bool concurrent, VkImage& image, VkBuffer& buffer,
                        VkMemoryRequirements& requirements) {
  const VkDevice handle = device.handles.device;
  VkResult result = VK_SUCCESS;
  if (record.kind == ResourceKind::texture) {
    const VkImageCreateInfo info = image_info(device, record, usage, concurrent);
    result = device.vk.vkCreateImage(handle, &info, device.callbacks(), &image);
    if (result == VK_SUCCESS) device.vk.vkGetImageMemoryRequirements(handle, image, &requirements);
  } else {
    const VkBufferCreateInfo info = buffer_info(device, record, usage, concurrent);
    result = device.vk.vkCreateBuffer(handle, &info, device.callbacks(), &buffer);
    if (result == VK_SUCCESS)
      device.vk.vkGetBufferMemoryRequirements(handle, buffer, &requirements);
  }
  return result;
}

Errors vulkan_error(VkResult result, std::string what) {
  return {{ErrorCode::vulkan, std::move(what) + ": " + result_name(result), result}};
}

const char* result_name(VkResult result) {
  switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
      return "the host is out of memory";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
      return "the device is out of memory";
    case VK_ERROR_DEVICE_LOST:
      return "VK_ERROR_DEVICE_LOST";
    case VK_ERROR_TOO_MANY_OBJECTS:
      return "VK_ERROR_TOO_MANY_OBJECTS";
    case VK_ERROR_FEATURE_NOT_PRESENT:
      return "VK_ERROR_FEATURE_NOT_PRESENT";
    case VK_TIMEOUT:
      return "VK_TIMEOUT";
    default:
      return "VK_ERROR_UNKNOWN";
  }
}

}  // namespace alcove::framegraph
