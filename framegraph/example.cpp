// Clears a texture and copies it to the images of a window, with two frames in flight.
#include <vulkan/vulkan_raii.hpp>
// GLFW is included after Vulkan, so that it declares glfwCreateWindowSurface.
#include <GLFW/glfw3.h>

#include "alcove/framegraph/framegraph.h"
using namespace alcove::framegraph;

int main() {
  glfwInit();
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  GLFWwindow* window = glfwCreateWindow(640, 360, "Alcove", nullptr, nullptr);
  std::uint32_t count = 0;
  const char** names = glfwGetRequiredInstanceExtensions(&count);
  const vk::raii::Context loader;
  const vk::ApplicationInfo app("example", 1, "", 1, VK_API_VERSION_1_3);
  const vk::raii::Instance instance(loader, {{}, &app, 0, nullptr, count, names});
  VkSurfaceKHR handle = VK_NULL_HANDLE;
  glfwCreateWindowSurface(*instance, window, nullptr, &handle);
  const vk::raii::SurfaceKHR surface(instance, handle);
  // Uses the first device and its first queue family, which must support graphics and presenting.
  const vk::raii::PhysicalDevice physical(vk::raii::PhysicalDevices(instance).front());
  const float priority = 1.0f;
  const vk::DeviceQueueCreateInfo queues({}, 0, 1, &priority);
  vk::PhysicalDeviceVulkan12Features v12;
  vk::PhysicalDeviceVulkan13Features v13;
  v13.setSynchronization2(true).setDynamicRendering(true).setPNext(&v12.setTimelineSemaphore(true));
  const char* extension = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
  const vk::raii::Device device(physical, {{}, 1, &queues, 0, nullptr, 1, &extension, {}, &v13});
  const vk::raii::Queue queue(device, 0, 0);
  constexpr auto kUsage = vk::ImageUsageFlagBits::eTransferDst;
  constexpr auto kWaits = VK_PIPELINE_STAGE_2_COPY_BIT;  // the first use of an image waits here
  const vk::raii::SwapchainKHR swapchain(
      device, vk::SwapchainCreateInfoKHR({}, *surface, 3, vk::Format::eB8G8R8A8Unorm, {},
                                         {640, 360}, 1, kUsage));
  const std::vector<vk::Image> images = swapchain.getImages();
  std::vector<vk::raii::Semaphore> acquired, drawn;  // one per frame slot; one per image
  while (acquired.size() < 2) acquired.emplace_back(device, vk::SemaphoreCreateInfo());
  while (drawn.size() < images.size()) drawn.emplace_back(device, vk::SemaphoreCreateInfo());

  const DeviceHandles handles{*instance, *physical, *device, vkGetInstanceProcAddr, {{*queue, 0}}};
  auto executor = Executor::create(handles).value();
  Graph graph;
  for (std::uint32_t frame = 0; frame < 100 && !glfwWindowShouldClose(window); ++frame) {
    glfwPollEvents();
    const std::uint32_t slot = frame % 2;
    if (!executor.wait(slot)) return 1;
    const std::uint32_t index = swapchain.acquireNextImage(~0ull, *acquired[slot]).second;

    graph.reset();
    const TextureDesc desc{VK_FORMAT_B8G8R8A8_UNORM, Extent::absolute(640, 360)};
    Texture scene = graph.create_texture("scene", desc);
    Texture image = graph.import_texture("window", {.image = images[index],
                                                    .desc = desc,
                                                    .usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                                    .initial_state = access::acquired(kWaits),
                                                    .final_state = access::present});
    PassBuilder draw = graph.add_pass("draw");
    scene = draw.write(scene, access::color_attachment);
    draw.record([=](RecordContext& context) {
      const VkClearValue color{{{0.1f, 0.2f, 0.01f * static_cast<float>(frame), 1.0f}}};
      const Attachment target{scene, &color};
      if (context.begin_rendering({&target, 1})) context.end_rendering();
    });
    PassBuilder copy = graph.add_pass("copy");
    copy.read(scene, access::transfer_source);
    image = copy.write(image, access::transfer_destination, {}, Contents::discard);
    copy.record([=](RecordContext& context) {
      const VkImageSubresourceLayers color{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
      const VkImageCopy all{color, {}, color, {}, context.extent(scene)};
      vkCmdCopyImage(context.commands, context.image(scene), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                     context.image(image), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &all);
    });
    const QueueSemaphore wait{*acquired[slot], 0, kWaits}, signal{*drawn[index]};
    if (!executor.submit(graph, {slot, {&wait, 1}, {&signal, 1}})) return 1;
    (void)queue.presentKHR({1, &*drawn[index], 1, &*swapchain, &index});
  }
  device.waitIdle();
}
