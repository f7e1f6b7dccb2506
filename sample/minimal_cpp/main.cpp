// A minimal program that uses the C++ interface, from creating the device to an image of the
// occlusion. Copy this file as a start.
//
//   alcove_minimal_cpp FILE.pgm
//
// Instead of an engine's rendering, the CPU writes the depth buffer of a ball on a floor. Each
// frame is a render graph that uploads the depth, computes the occlusion, and reads the visibility
// back.
#include <alcove/framegraph/executor.h>
#include <alcove/framegraph/graph.h>
#include <alcove/passes/graph.h>
#include <vulkan/vulkan.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

namespace {

using namespace alcove;

constexpr std::uint32_t kWidth = 480, kHeight = 270, kFrames = 32;
constexpr float kNear = 0.1f;     // The projection is reversed and infinite: depth = near / z.
constexpr float kFocal = 1.732f;  // 1 / tan(fov_y / 2), 60 degrees

void require(bool condition, const std::string& message) {
  if (!condition) {
    std::cerr << "alcove_minimal_cpp: " << message << "\n";
    std::exit(1);
  }
}

void check(VkResult result, const std::string& what) {
  require(result == VK_SUCCESS, what + " failed");
}

std::string to_string(const passes::Error& error) { return error.message; }

template <typename Result>
auto value_of(Result result) {
  require(result.has_value(), result ? "" : to_string(result.error()));
  if constexpr (!std::is_void_v<typename Result::value_type>) return std::move(*result);
}

// Creates the first device that has a queue family for graphics and compute. The graph needs Vulkan
// 1.3 with synchronization2, and timelineSemaphore if it submits frames itself. The passes need
// shaderStorageImageWriteWithoutFormat.
framegraph::DeviceHandles create_device() {
  framegraph::DeviceHandles handles;
  handles.get_instance_proc_addr = vkGetInstanceProcAddr;
  const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                      .apiVersion = VK_API_VERSION_1_3};
  const VkInstanceCreateInfo instance{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                      .pApplicationInfo = &application};
  check(vkCreateInstance(&instance, nullptr, &handles.instance), "vkCreateInstance");
  std::uint32_t count = 1;
  vkEnumeratePhysicalDevices(handles.instance, &count, &handles.physical_device);
  require(count != 0, "there is no Vulkan device");
  vkGetPhysicalDeviceQueueFamilyProperties(handles.physical_device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(handles.physical_device, &count, families.data());
  const auto family = std::ranges::find_if(families, [](const VkQueueFamilyProperties& f) {
    constexpr VkQueueFlags kWanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    return (f.queueFlags & kWanted) == kWanted;
  });
  require(family != families.end(), "no queue family draws and computes");
  framegraph::QueueHandle& queue = handles.queues[0];
  queue.family = static_cast<std::uint32_t>(family - families.begin());

  VkPhysicalDeviceVulkan13Features features13{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES, .synchronization2 = VK_TRUE};
  VkPhysicalDeviceVulkan12Features features12{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
      .pNext = &features13,
      .timelineSemaphore = VK_TRUE};
  const VkPhysicalDeviceFeatures2 features{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
      .pNext = &features12,
      .features = {.shaderStorageImageWriteWithoutFormat = VK_TRUE}};
  const float priority = 1.0f;
  const VkDeviceQueueCreateInfo queue_info{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                           .queueFamilyIndex = queue.family,
                                           .queueCount = 1,
                                           .pQueuePriorities = &priority};
  const VkDeviceCreateInfo device{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                  .pNext = &features,
                                  .queueCreateInfoCount = 1,
                                  .pQueueCreateInfos = &queue_info};
  check(vkCreateDevice(handles.physical_device, &device, nullptr, &handles.device),
        "vkCreateDevice");
  vkGetDeviceQueue(handles.device, queue.family, 0, &queue.queue);
  return handles;
}

// A buffer that the CPU sees, for the depth on its way in and the picture on its way out.
struct HostBuffer {
  framegraph::ImportedBuffer import;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  void* mapped = nullptr;
};

HostBuffer create_host_buffer(const framegraph::DeviceHandles& handles, VkDeviceSize size) {
  HostBuffer made;
  made.import.desc.size = size;
  made.import.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  made.import.final_state = framegraph::buffer_access::host_read;
  const VkBufferCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = size, .usage = made.import.usage};
  check(vkCreateBuffer(handles.device, &info, nullptr, &made.import.buffer), "vkCreateBuffer");
  VkMemoryRequirements requirements;
  vkGetBufferMemoryRequirements(handles.device, made.import.buffer, &requirements);
  VkPhysicalDeviceMemoryProperties properties;
  vkGetPhysicalDeviceMemoryProperties(handles.physical_device, &properties);
  constexpr VkMemoryPropertyFlags kWanted =
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  std::uint32_t type = 0;
  while (type < properties.memoryTypeCount &&
         ((requirements.memoryTypeBits >> type & 1) == 0 ||
          (properties.memoryTypes[type].propertyFlags & kWanted) != kWanted))
    ++type;
  const VkMemoryAllocateInfo allocation{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                        .allocationSize = requirements.size,
                                        .memoryTypeIndex = type};
  check(vkAllocateMemory(handles.device, &allocation, nullptr, &made.memory), "vkAllocateMemory");
  check(vkBindBufferMemory(handles.device, made.import.buffer, made.memory, 0),
        "vkBindBufferMemory");
  check(vkMapMemory(handles.device, made.memory, 0, VK_WHOLE_SIZE, 0, &made.mapped), "vkMapMemory");
  return made;
}

// Depth of the view ray through a pixel: a ball of radius 0.5 on a floor, 3 units away.
float depth_at(std::uint32_t x, std::uint32_t y) {
  const auto px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
  const float slope_x = (2 * px / kWidth - 1) * kWidth / kHeight / kFocal;
  const float slope_y = (1 - 2 * py / kHeight) / kFocal;
  const float floor_z = slope_y < -1e-4f ? -0.8f / slope_y : 1e9f;
  // (z slope_x)^2 + (z slope_y + 0.3)^2 + (z - 3)^2 = 0.25
  const float a = slope_x * slope_x + slope_y * slope_y + 1;
  const float b = 0.3f * slope_y - 3;
  const float root = b * b - a * (0.09f + 9 - 0.25f);
  const float ball_z = root > 0 ? (-b - std::sqrt(root)) / a : 1e9f;
  const float z = std::min(ball_z, floor_z);
  return z < 50 ? kNear / z : 0;  // 0 is the sky
}

constexpr VkBufferImageCopy kWholeImage{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                        .imageExtent = {kWidth, kHeight, 1}};

// Declares a frame. Every image of it is a transient, which shares memory with the others.
void declare(framegraph::Graph& graph, passes::Pipelines& pipelines, const HostBuffer& upload,
             const HostBuffer& result, std::uint32_t index) {
  graph.reset();
  const auto from = graph.import_buffer("upload", upload.import);
  auto draw = graph.add_pass("depth");  // An engine draws its depth here.
  draw.read(from, framegraph::buffer_access::transfer_source);
  const auto size = framegraph::Extent::absolute(kWidth, kHeight);
  const auto depth =
      draw.write(graph.create_texture("depth", {VK_FORMAT_R32_SFLOAT, size}),
                 framegraph::access::transfer_destination, {}, framegraph::Contents::discard);
  draw.record([=](framegraph::RecordContext& context) {
    vkCmdCopyBufferToImage(context.commands, context.buffer(from), context.image(depth),
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &kWholeImage);
  });

  AlcoveSettings settings{.struct_size = sizeof settings};
  alcoveGetSettings(ALCOVE_QUALITY_MEDIUM, 0.5f, &settings);
  const AlcoveCamera camera{
      // The eye is the origin, and looks along -Z.
      {kFocal * kHeight / kWidth, 0, 0, 0, 0, -kFocal, 0, 0, 0, 0, 0, -1, 0, 0, kNear, 0},
      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
  const AlcoveViewInfo view{
      .static_frames = index, .settings = &settings, .camera = camera, .previous_camera = camera};
  passes::ViewTextures images{};
  images[ALCOVE_IMAGE_DEPTH] = depth;
  images[ALCOVE_IMAGE_VISIBILITY] = graph.create_texture("visibility", {VK_FORMAT_R8_UNORM, size});
  value_of(passes::add_view(graph, pipelines, view, index, images));

  const auto target = graph.import_buffer("result", result.import);
  auto copy = graph.add_pass("read back");
  copy.read(images[ALCOVE_IMAGE_VISIBILITY], framegraph::access::transfer_source);
  const auto filled = copy.write(target, framegraph::buffer_access::transfer_destination);
  copy.record(
      [visibility = images[ALCOVE_IMAGE_VISIBILITY], filled](framegraph::RecordContext& context) {
        vkCmdCopyImageToBuffer(context.commands, context.image(visibility),
                               VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, context.buffer(filled), 1,
                               &kWholeImage);
      });
}

}  // namespace

int main(int argc, char** argv) {
  require(argc == 2, "usage: alcove_minimal_cpp FILE.pgm");
  const framegraph::DeviceHandles handles = create_device();
  const HostBuffer upload = create_host_buffer(handles, kWidth * kHeight * sizeof(float));
  const HostBuffer result = create_host_buffer(handles, kWidth * kHeight);
  for (std::uint32_t i = 0; i < kWidth * kHeight; ++i)
    static_cast<float*>(upload.mapped)[i] = depth_at(i % kWidth, i / kWidth);
  {
    auto executor = value_of(framegraph::Executor::create(handles, {.frames_in_flight = 1}));
    auto pipelines = value_of(passes::Pipelines::create(handles, 1));
    framegraph::Graph graph;
    for (std::uint32_t i = 0; i < kFrames; ++i) {
      pipelines.begin_frame(0);
      declare(graph, pipelines, upload, result, i);
      (void)value_of(executor.submit(graph));
      value_of(executor.wait());
    }
  }
  std::ofstream file(argv[1], std::ios::binary);
  file << "P5\n" << kWidth << " " << kHeight << "\n255\n";
  file.write(static_cast<const char*>(result.mapped), kWidth * kHeight);
  require(file.flush().good(), std::string(argv[1]) + " cannot be written");

  for (const HostBuffer& buffer : {upload, result}) {
    vkDestroyBuffer(handles.device, buffer.import.buffer, nullptr);
    vkFreeMemory(handles.device, buffer.memory, nullptr);
  }
  vkDestroyDevice(handles.device, nullptr);
  vkDestroyInstance(handles.instance, nullptr);
}
