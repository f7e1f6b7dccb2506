#include "base.h"

#include <array>
#include <cstdio>
#include <cstdlib>

#include "scene.h"

namespace host {

void require(bool condition, const char* message) {
  if (!condition) {
    std::fprintf(stderr, "alcove_host: %s\n", message);
    std::exit(1);
  }
}

void Base::open(const VkPhysicalDeviceFeatures2& features, bool async) {
  const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                      .apiVersion = VK_API_VERSION_1_3};
  const VkInstanceCreateInfo instance_info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                           .pApplicationInfo = &application};
  require(vkCreateInstance(&instance_info, nullptr, &instance), "there is no Vulkan 1.3");
  std::uint32_t count = 1;
  vkEnumeratePhysicalDevices(instance, &count, &physical_device);
  require(count == 1, "there is no Vulkan device");
  vkGetPhysicalDeviceQueueFamilyProperties(physical_device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical_device, &count, families.data());
  graphics_family = compute_family = count;
  for (std::uint32_t i = 0; i < count; ++i) {
    const VkQueueFlags flags = families[i].queueFlags;
    if ((flags & VK_QUEUE_GRAPHICS_BIT) != 0 && graphics_family == count)
      graphics_family = i;
    else if ((flags & VK_QUEUE_COMPUTE_BIT) != 0 && (flags & VK_QUEUE_GRAPHICS_BIT) == 0)
      compute_family = i;
  }
  require(graphics_family < count, "the device has no graphics queue");
  if (!async || compute_family == count) compute_family = graphics_family;
  const bool second =
      async && compute_family == graphics_family && families[graphics_family].queueCount > 1;
  const std::array priorities{1.0f, 1.0f};
  std::vector<VkDeviceQueueCreateInfo> queues;
  for (const std::uint32_t family : {graphics_family, compute_family}) {
    if (queues.empty() || family != graphics_family) {
      queues.push_back({.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                        .queueFamilyIndex = family,
                        .queueCount = second ? 2u : 1u,
                        .pQueuePriorities = priorities.data()});
    }
  }
  const VkDeviceCreateInfo device_info{
      .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
      .pNext = &features,
      .queueCreateInfoCount = static_cast<std::uint32_t>(queues.size()),
      .pQueueCreateInfos = queues.data()};
  require(vkCreateDevice(physical_device, &device_info, nullptr, &device),
          "the device cannot be opened");
  vkGetDeviceQueue(device, graphics_family, 0, &graphics_queue);
  vkGetDeviceQueue(device, compute_family, second ? 1 : 0, &compute_queue);
  pools_.resize(count);
  for (const VkDeviceQueueCreateInfo& queue : queues) {
    const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                       .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                       .queueFamilyIndex = queue.queueFamilyIndex};
    pools_[queue.queueFamilyIndex] = create(vkCreateCommandPool, pool);
  }
}

void Base::close() {
  for (const VkCommandPool pool : pools_) vkDestroyCommandPool(device, pool, nullptr);
  vkDestroyDevice(device, nullptr);
  vkDestroyInstance(instance, nullptr);
}

VkDeviceMemory Base::allocate(const VkMemoryRequirements& requirements,
                              VkMemoryPropertyFlags properties) const {
  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(physical_device, &memory);
  std::uint32_t type = 0;
  while (type < memory.memoryTypeCount &&
         ((requirements.memoryTypeBits >> type & 1u) == 0 ||
          (memory.memoryTypes[type].propertyFlags & properties) != properties))
    ++type;
  require(type < memory.memoryTypeCount, "the device has no suitable memory");
  const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                  .allocationSize = requirements.size,
                                  .memoryTypeIndex = type};
  VkDeviceMemory allocated = VK_NULL_HANDLE;
  require(vkAllocateMemory(device, &info, nullptr, &allocated), "device memory ran out");
  return allocated;
}

Image Base::create_image(VkFormat format, VkExtent2D size, VkImageUsageFlags usage) const {
  const std::array families{graphics_family, compute_family};
  const bool shared = graphics_family != compute_family;
  const VkImageCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
      .imageType = VK_IMAGE_TYPE_2D,
      .format = format,
      .extent = {size.width, size.height, 1},
      .mipLevels = 1,
      .arrayLayers = 1,
      .samples = VK_SAMPLE_COUNT_1_BIT,
      .usage = usage,
      .sharingMode = shared ? VK_SHARING_MODE_CONCURRENT : VK_SHARING_MODE_EXCLUSIVE,
      .queueFamilyIndexCount = shared ? 2u : 0u,
      .pQueueFamilyIndices = families.data()};
  Image image{.image = create(vkCreateImage, info), .format = format, .usage = usage};
  VkMemoryRequirements requirements;
  vkGetImageMemoryRequirements(device, image.image, &requirements);
  image.memory = allocate(requirements, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
  require(vkBindImageMemory(device, image.image, image.memory, 0), "an image cannot be bound");
  const VkImageAspectFlags aspect =
      format == VK_FORMAT_D32_SFLOAT_S8_UINT
          ? VkImageAspectFlags{VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT}
          : VkImageAspectFlags{VK_IMAGE_ASPECT_COLOR_BIT};
  const VkImageViewCreateInfo view{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                   .image = image.image,
                                   .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                   .format = format,
                                   .subresourceRange = {aspect, 0, 1, 0, 1}};
  image.view = create(vkCreateImageView, view);
  return image;
}

void Base::destroy(Image& image) const {
  vkDestroyImageView(device, image.view, nullptr);
  vkDestroyImage(device, image.image, nullptr);
  vkFreeMemory(device, image.memory, nullptr);
  image = {};
}

Buffer Base::create_buffer(VkDeviceSize bytes, VkBufferUsageFlags usage) const {
  const VkBufferCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = bytes, .usage = usage};
  Buffer buffer{.buffer = create(vkCreateBuffer, info)};
  VkMemoryRequirements requirements;
  vkGetBufferMemoryRequirements(device, buffer.buffer, &requirements);
  buffer.memory = allocate(
      requirements, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  require(vkBindBufferMemory(device, buffer.buffer, buffer.memory, 0), "a buffer cannot be bound");
  void* mapped = nullptr;
  require(vkMapMemory(device, buffer.memory, 0, VK_WHOLE_SIZE, 0, &mapped), "cannot map a buffer");
  buffer.mapped = static_cast<std::byte*>(mapped);
  return buffer;
}

void Base::destroy(Buffer& buffer) const {
  vkDestroyBuffer(device, buffer.buffer, nullptr);
  vkFreeMemory(device, buffer.memory, nullptr);
  buffer = {};
}

VkCommandBuffer Base::allocate_commands(std::uint32_t family) const {
  const VkCommandBufferAllocateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                         .commandPool = pools_[family],
                                         .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                         .commandBufferCount = 1};
  VkCommandBuffer commands = VK_NULL_HANDLE;
  require(vkAllocateCommandBuffers(device, &info, &commands), "no command buffer is left");
  return commands;
}

VkPipeline Base::create_pipeline(const PipelineDescription& description) const {
  const VkSpecializationMapEntry entry{0, 0, sizeof description.packed};
  const VkSpecializationInfo constants{1, &entry, sizeof description.packed, &description.packed};
  const auto create_stage = [&](VkShaderStageFlagBits stage, std::span<const std::uint32_t> code) {
    const VkShaderModuleCreateInfo info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                        .codeSize = code.size_bytes(),
                                        .pCode = code.data()};
    return VkPipelineShaderStageCreateInfo{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
        .stage = stage,
        .module = create(vkCreateShaderModule, info),
        .pName = "main"};
  };
  std::array stages{create_stage(VK_SHADER_STAGE_VERTEX_BIT, description.vertex),
                    create_stage(VK_SHADER_STAGE_FRAGMENT_BIT, description.fragment)};
  stages[1].pSpecializationInfo = &constants;
  const VkVertexInputBindingDescription binding{0, sizeof(Vertex), VK_VERTEX_INPUT_RATE_VERTEX};
  const std::array<VkVertexInputAttributeDescription, 2> attributes{
      {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position)},
       {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, normal)}}};
  VkPipelineVertexInputStateCreateInfo vertices{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  if (description.has_vertices) {
    vertices.vertexBindingDescriptionCount = 1;
    vertices.pVertexBindingDescriptions = &binding;
    vertices.vertexAttributeDescriptionCount = 2;
    vertices.pVertexAttributeDescriptions = attributes.data();
  }
  const VkPipelineInputAssemblyStateCreateInfo assembly{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
      .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
  const VkPipelineViewportStateCreateInfo viewport{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
      .viewportCount = 1,
      .scissorCount = 1};
  const VkPipelineRasterizationStateCreateInfo rasterisation{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
      .cullMode = description.has_vertices ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE,
      .frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE,
      .lineWidth = 1.0f};
  const VkPipelineMultisampleStateCreateInfo samples{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
      .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
  const VkBool32 tests = description.has_vertices ? VK_TRUE : VK_FALSE;
  const VkPipelineDepthStencilStateCreateInfo depth{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
      .depthTestEnable = tests,
      .depthWriteEnable = tests,
      .depthCompareOp = VK_COMPARE_OP_LESS};
  const VkPipelineColorBlendAttachmentState written{.colorWriteMask = 0xf};
  const VkPipelineColorBlendStateCreateInfo blend{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
      .attachmentCount = 1,
      .pAttachments = &written};
  const std::array dynamic{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  const VkPipelineDynamicStateCreateInfo dynamics{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
      .dynamicStateCount = 2,
      .pDynamicStates = dynamic.data()};
  const VkGraphicsPipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                          .stageCount = 2,
                                          .pStages = stages.data(),
                                          .pVertexInputState = &vertices,
                                          .pInputAssemblyState = &assembly,
                                          .pViewportState = &viewport,
                                          .pRasterizationState = &rasterisation,
                                          .pMultisampleState = &samples,
                                          .pDepthStencilState = &depth,
                                          .pColorBlendState = &blend,
                                          .pDynamicState = &dynamics,
                                          .layout = description.layout,
                                          .renderPass = description.render_pass};
  VkPipeline pipeline = VK_NULL_HANDLE;
  require(vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
          "a pipeline cannot be created");
  for (const VkPipelineShaderStageCreateInfo& stage : stages)
    vkDestroyShaderModule(device, stage.module, nullptr);
  return pipeline;
}

}  // namespace host
