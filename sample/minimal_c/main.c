/* From device creation to an occlusion picture, in C99: copy this file to start.
 *
 *   alcove_minimal_c FILE.pgm
 *
 * A ball on a floor is written into a depth image on the CPU, in place of an engine's rendering.
 * Alcove then records 32 frames of a static camera, and the last visibility is written to the file.
 */
#include <alcove/alcove.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <vulkan/vulkan.h>

enum { kWidth = 480, kHeight = 270, kFrames = 32 };
static const float kNear = 0.1f;    /* The projection is reversed and infinite: depth = near / z. */
static const float kFocal = 1.732f; /* 1 / tan(fov_y / 2), 60 degrees */

static VkInstance instance;
static VkPhysicalDevice physical_device;
static VkDevice device;
static uint32_t queue_family;
static VkQueue queue;

static void check(int ok, const char* what) {
  if (!ok) {
    fprintf(stderr, "alcove_minimal_c: %s\n", what);
    exit(1);
  }
}

#define CHECK_VK(call) check((call) == VK_SUCCESS, #call " failed")

/* The first device with a compute queue. This program uses Vulkan 1.3 and two of its features. */
static void create_device(void) {
  const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                         .apiVersion = VK_API_VERSION_1_3};
  const VkInstanceCreateInfo instance_info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                              .pApplicationInfo = &application};
  CHECK_VK(vkCreateInstance(&instance_info, NULL, &instance));
  uint32_t count = 1;
  check(vkEnumeratePhysicalDevices(instance, &count, &physical_device) >= 0 && count == 1,
        "there is no Vulkan device");
  VkQueueFamilyProperties families[16];
  count = 16;
  vkGetPhysicalDeviceQueueFamilyProperties(physical_device, &count, families);
  while (queue_family < count && !(families[queue_family].queueFlags & VK_QUEUE_COMPUTE_BIT))
    ++queue_family;
  check(queue_family < count, "the device has no compute queue");

  VkPhysicalDeviceVulkan13Features features13 = {
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES, .synchronization2 = VK_TRUE};
  const VkPhysicalDeviceFeatures2 features = {
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
      .pNext = &features13,
      .features = {.shaderStorageImageWriteWithoutFormat = VK_TRUE}};
  const float priority = 1.0f;
  const VkDeviceQueueCreateInfo queue_info = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                              .queueFamilyIndex = queue_family,
                                              .queueCount = 1,
                                              .pQueuePriorities = &priority};
  const VkDeviceCreateInfo device_info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                          .pNext = &features,
                                          .queueCreateInfoCount = 1,
                                          .pQueueCreateInfos = &queue_info};
  CHECK_VK(vkCreateDevice(physical_device, &device_info, NULL, &device));
  vkGetDeviceQueue(device, queue_family, 0, &queue);
}

static VkDeviceMemory allocate(VkMemoryRequirements requirements, VkMemoryPropertyFlags wanted) {
  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(physical_device, &memory);
  uint32_t type = 0;
  while (type < memory.memoryTypeCount &&
         (!(requirements.memoryTypeBits >> type & 1) ||
          (memory.memoryTypes[type].propertyFlags & wanted) != wanted))
    ++type;
  check(type < memory.memoryTypeCount, "the device has no suitable memory");
  const VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                     .allocationSize = requirements.size,
                                     .memoryTypeIndex = type};
  VkDeviceMemory allocated;
  CHECK_VK(vkAllocateMemory(device, &info, NULL, &allocated));
  return allocated;
}

typedef struct Image {
  VkImage image;
  VkDeviceMemory memory;
} Image;

static Image create_image(VkFormat format, VkImageUsageFlags usage) {
  const VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                  .imageType = VK_IMAGE_TYPE_2D,
                                  .format = format,
                                  .extent = {kWidth, kHeight, 1},
                                  .mipLevels = 1,
                                  .arrayLayers = 1,
                                  .samples = VK_SAMPLE_COUNT_1_BIT,
                                  .usage = usage};
  Image made;
  CHECK_VK(vkCreateImage(device, &info, NULL, &made.image));
  VkMemoryRequirements requirements;
  vkGetImageMemoryRequirements(device, made.image, &requirements);
  made.memory = allocate(requirements, 0);
  CHECK_VK(vkBindImageMemory(device, made.image, made.memory, 0));
  return made;
}

static void destroy_image(Image image) {
  vkDestroyImage(device, image.image, NULL);
  vkFreeMemory(device, image.memory, NULL);
}

/* Depth of the view ray through a pixel: a ball of radius 0.5 on a floor, 3 units away. */
static float depth_at(int x, int y) {
  const float slope_x = (2 * (x + 0.5f) / kWidth - 1) * kWidth / kHeight / kFocal;
  const float slope_y = (1 - 2 * (y + 0.5f) / kHeight) / kFocal;
  const float floor_z = slope_y < -1e-4f ? -0.8f / slope_y : 1e9f;
  /* (z slope_x)^2 + (z slope_y + 0.3)^2 + (z - 3)^2 = 0.25 */
  const float a = slope_x * slope_x + slope_y * slope_y + 1;
  const float b = 0.3f * slope_y - 3;
  const float root = b * b - a * (0.09f + 9 - 0.25f);
  const float ball_z = root > 0 ? (-b - sqrtf(root)) / a : 1e9f;
  const float z = ball_z < floor_z ? ball_z : floor_z;
  return z < 50 ? kNear / z : 0; /* 0 is the sky */
}

static void image_barrier(VkCommandBuffer commands, VkImage image, VkAccessFlags2 after,
                          VkImageLayout from, VkImageLayout to) {
  const VkImageMemoryBarrier2 barrier = {
      .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
      .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
      .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
      .dstAccessMask = after,
      .oldLayout = from,
      .newLayout = to,
      .image = image,
      .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
  const VkDependencyInfo info = {.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                 .imageMemoryBarrierCount = 1,
                                 .pImageMemoryBarriers = &barrier};
  vkCmdPipelineBarrier2(commands, &info);
}

int main(int argc, char** argv) {
  check(argc == 2, "usage: alcove_minimal_c FILE.pgm");
  create_device();

  /* A buffer that the CPU sees, for the depth on its way in and the picture on its way out. */
  const VkBufferCreateInfo buffer_info = {
      .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
      .size = kWidth * kHeight * sizeof(float),
      .usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT};
  VkBuffer buffer;
  CHECK_VK(vkCreateBuffer(device, &buffer_info, NULL, &buffer));
  VkMemoryRequirements requirements;
  vkGetBufferMemoryRequirements(device, buffer, &requirements);
  const VkDeviceMemory buffer_memory = allocate(
      requirements, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  CHECK_VK(vkBindBufferMemory(device, buffer, buffer_memory, 0));
  void* mapped;
  CHECK_VK(vkMapMemory(device, buffer_memory, 0, VK_WHOLE_SIZE, 0, &mapped));
  for (int i = 0; i < kWidth * kHeight; ++i) ((float*)mapped)[i] = depth_at(i % kWidth, i / kWidth);

  const Image depth = create_image(VK_FORMAT_R32_SFLOAT,
                                   VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
  const Image visibility = create_image(
      VK_FORMAT_R8_UNORM, VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
  const VkCommandPoolCreateInfo pool_info = {
      .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
      .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
      .queueFamilyIndex = queue_family};
  VkCommandPool pool;
  CHECK_VK(vkCreateCommandPool(device, &pool_info, NULL, &pool));
  const VkCommandBufferAllocateInfo commands_info = {
      .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
      .commandPool = pool,
      .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
      .commandBufferCount = 1};
  VkCommandBuffer commands;
  CHECK_VK(vkAllocateCommandBuffers(device, &commands_info, &commands));

  /* Alcove: a context once, settings, and a view that says what its images are. */
  const AlcoveContextInfo context_info = {.struct_size = sizeof context_info,
                                          .queue_family = queue_family,
                                          .instance = instance,
                                          .physical_device = physical_device,
                                          .device = device,
                                          .get_instance_proc_addr = vkGetInstanceProcAddr,
                                          .frames_in_flight = 1};
  AlcoveContext* context;
  char message[ALCOVE_MAX_MESSAGE];
  check(alcoveCreateContext(&context_info, &context, message) == ALCOVE_SUCCESS, message);
  AlcoveSettings settings = {.struct_size = sizeof settings};
  alcoveGetSettings(ALCOVE_QUALITY_MEDIUM, 0.5f, &settings);

  AlcoveView view = {.struct_size = sizeof view, .info.settings = &settings};
  float* clip = view.info.camera.clip_from_view; /* column-major */
  clip[0] = kFocal * kHeight / kWidth;
  clip[5] = -kFocal; /* Vulkan's clip space has y down */
  clip[11] = -1;
  clip[14] = kNear;
  for (int i = 0; i < 4; ++i) view.info.camera.view_from_world[5 * i] = 1; /* eye: origin */
  view.info.previous_camera = view.info.camera;
  view.images[ALCOVE_IMAGE_DEPTH] = (AlcoveImage){
      .image = depth.image,
      .format = VK_FORMAT_R32_SFLOAT,
      .width = kWidth,
      .height = kHeight,
      .usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
      .initial_state = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL},
      .final_state = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                      VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL}};
  view.images[ALCOVE_IMAGE_VISIBILITY] = (AlcoveImage){
      .image = visibility.image,
      .format = VK_FORMAT_R8_UNORM,
      .width = kWidth,
      .height = kHeight,
      .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
      .initial_state = {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_NONE, VK_IMAGE_LAYOUT_UNDEFINED},
      .final_state = {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                      VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL}};

  const VkBufferImageCopy region = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                    .imageExtent = {kWidth, kHeight, 1}};
  for (uint32_t i = 0; i < kFrames; ++i) {
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    CHECK_VK(vkBeginCommandBuffer(commands, &begin));
    AlcoveImage* drawn = &view.images[ALCOVE_IMAGE_DEPTH];
    if (i == 0) { /* An engine draws its depth here, in every frame. */
      image_barrier(commands, depth.image, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                    VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
      vkCmdCopyBufferToImage(commands, buffer, depth.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                             &region);
      drawn->initial_state =
          (AlcoveState){VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                        VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
    } else {
      drawn->initial_state = drawn->final_state;
    }
    view.info.static_frames = i;
    const AlcoveFrame frame = {sizeof frame, .index = i, .view_count = 1, .views = &view};
    const AlcoveResult result = alcoveRecordFrame(context, commands, &frame);
    check(result == ALCOVE_SUCCESS, alcoveGetMessage(context));
    if (i + 1 == kFrames) {
      vkCmdCopyImageToBuffer(commands, visibility.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                             buffer, 1, &region);
    }
    CHECK_VK(vkEndCommandBuffer(commands));
    const VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                 .commandBufferCount = 1,
                                 .pCommandBuffers = &commands};
    CHECK_VK(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE));
    CHECK_VK(vkQueueWaitIdle(queue));
  }

  FILE* file = fopen(argv[1], "wb");
  check(file != NULL, "the file cannot be written");
  fprintf(file, "P5\n%d %d\n255\n", kWidth, kHeight);
  const size_t written = fwrite(mapped, 1, kWidth * kHeight, file);
  check(fclose(file) == 0 && written == kWidth * kHeight, "the file cannot be written");

  alcoveDestroyContext(context);
  vkDestroyCommandPool(device, pool, NULL);
  destroy_image(depth);
  destroy_image(visibility);
  vkDestroyBuffer(device, buffer, NULL);
  vkFreeMemory(device, buffer_memory, NULL);
  vkDestroyDevice(device, NULL);
  vkDestroyInstance(instance, NULL);
  return 0;
}
