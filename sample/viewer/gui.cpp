#include "viewer/gui.h"

#include <imgui.h>
#include <imgui_impl_glfw.h>
#include <imgui_impl_vulkan.h>

#include "alcove/framegraph/access.h"

namespace alcove::sample {
namespace {

void choose_style(float scale) {
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 4.0f;
  style.FrameRounding = 3.0f;
  style.GrabRounding = 3.0f;
  style.Colors[ImGuiCol_WindowBg].w = 0.88f;
  style.ScaleAllSizes(scale);
  ImFontConfig font;
  constexpr float kFontPixels = 13.0f;
  font.SizePixels = kFontPixels * scale;
  ImGui::GetIO().Fonts->AddFontDefault(&font);
}

}  // namespace

Result<std::unique_ptr<Gui>> Gui::create(Gpu& gpu, Window& window, VkFormat format) {
  const VulkanDevice& device = gpu.device();
  std::unique_ptr<Gui> made(new Gui(device));
  made->framebuffers_.resize(gpu.frames_in_flight(), VK_NULL_HANDLE);
  VkResult result = made->create_render_pass(format);
  if (result == VK_SUCCESS) result = made->create_pool();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  choose_style(window.content_scale());
  if (result == VK_SUCCESS) {
    made->on_window_ = ImGui_ImplGlfw_InitForVulkan(window.handle(), true);
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = device.instance();
    info.PhysicalDevice = device.physical_device();
    info.Device = device.device();
    info.QueueFamily = device.queue_family();
    info.Queue = device.queue();
    info.DescriptorPool = made->pool_;
    info.MinImageCount = gpu.frames_in_flight();
    info.ImageCount = gpu.frames_in_flight();  // so many sets of vertices take turns
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    made->on_device_ = ImGui_ImplVulkan_Init(&info, made->render_pass_);
  }
  if (!made->on_window_ || !made->on_device_)
    return device_failure("create what the panel is drawn with", result);
#if IMGUI_VERSION_NUM < 19000  // later versions upload the font by themselves
  auto uploaded = gpu.run([](Graph& graph) -> Result<void> {
    auto pass = graph.add_pass("upload");
    pass.side_effect();  // on an image of ImGui's own, which synchronises it
    pass.record(
        [](RecordContext& context) { ImGui_ImplVulkan_CreateFontsTexture(context.commands); });
    return {};
  });
  ImGui_ImplVulkan_DestroyFontUploadObjects();
  ALCOVE_TRY_VOID(uploaded);
#endif
  return made;
}

Gui::~Gui() {
  if (on_device_) ImGui_ImplVulkan_Shutdown();
  if (on_window_) ImGui_ImplGlfw_Shutdown();
  if (ImGui::GetCurrentContext() != nullptr) ImGui::DestroyContext();
  for (const VkFramebuffer framebuffer : framebuffers_)
    vkDestroyFramebuffer(device_.device(), framebuffer, nullptr);
  vkDestroyRenderPass(device_.device(), render_pass_, nullptr);
  vkDestroyDescriptorPool(device_.device(), pool_, nullptr);
}

// Creates the render pass that ImGui's pipeline needs. It changes no layouts and has no barriers,
// because the render graph does both.
VkResult Gui::create_render_pass(VkFormat format) {
  const VkAttachmentDescription attachment{
      .format = format,
      .samples = VK_SAMPLE_COUNT_1_BIT,
      .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
      .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
      .initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
      .finalLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  const VkSubpassDescription subpass{.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                     .colorAttachmentCount = 1,
                                     .pColorAttachments = &reference};
  const VkRenderPassCreateInfo info{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                    .attachmentCount = 1,
                                    .pAttachments = &attachment,
                                    .subpassCount = 1,
                                    .pSubpasses = &subpass};
  return vkCreateRenderPass(device_.device(), &info, nullptr, &render_pass_);
}

VkResult Gui::create_pool() {
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};
  const VkDescriptorPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                        .flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT,
                                        .maxSets = 1,
                                        .poolSizeCount = 1,
                                        .pPoolSizes = &size};
  return vkCreateDescriptorPool(device_.device(), &info, nullptr, &pool_);
}

void Gui::begin() {
  ImGui_ImplVulkan_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
}

void Gui::end() { ImGui::Render(); }

Texture Gui::add(Graph& graph, Texture target) {
  auto pass = graph.add_pass("panel");
  const Texture drawn = pass.write(target, framegraph::access::color_attachment);
  pass.record([this, drawn](RecordContext& context) { record(context, drawn); });
  return drawn;
}

void Gui::record(RecordContext& context, Texture target) {
  const VkDevice device = device_.device();
  const VkExtent3D size = context.extent(target);
  const VkImageView view = context.view(target);
  // The framebuffer is created for each frame, because the window has several images, and gets new
  // ones when its size changes.
  VkFramebuffer& framebuffer = framebuffers_[context.frame_slot];
  vkDestroyFramebuffer(device, framebuffer, nullptr);
  framebuffer = VK_NULL_HANDLE;
  const VkFramebufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                     .renderPass = render_pass_,
                                     .attachmentCount = 1,
                                     .pAttachments = &view,
                                     .width = size.width,
                                     .height = size.height,
                                     .layers = 1};
  if (vkCreateFramebuffer(device, &info, nullptr, &framebuffer) != VK_SUCCESS)
    return;  // a frame without a panel
  const VkRenderPassBeginInfo begin{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                    .renderPass = render_pass_,
                                    .framebuffer = framebuffer,
                                    .renderArea = {{0, 0}, {size.width, size.height}}};
  vkCmdBeginRenderPass(context.commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
  ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), context.commands);
  vkCmdEndRenderPass(context.commands);
}

}  // namespace alcove::sample
