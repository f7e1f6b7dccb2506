// The lines that an engine adds for Alcove, except for the images of normals and visibility, which
// renderer.cpp creates. The lines between "Alcove: begin" and "Alcove: end" are counted by
// count_lines.cmake.
#include "renderer.h"
#include "scene.h"

namespace host {

// Alcove: begin
void Renderer::request_features(VkPhysicalDeviceFeatures2& features,
                                VkPhysicalDeviceVulkan13Features& features13) {
  features13.synchronization2 = VK_TRUE;
  features.features.shaderStorageImageWriteWithoutFormat = VK_TRUE;
}

void Renderer::create_occlusion() {
  AlcoveContextInfo info{.struct_size = sizeof info};
  info.queue_family = base_.compute_family;
  info.instance = base_.instance;
  info.physical_device = base_.physical_device;
  info.device = base_.device;
  info.get_instance_proc_addr = vkGetInstanceProcAddr;
  info.frames_in_flight = kSlots;
  char message[ALCOVE_MAX_MESSAGE];
  require(alcoveCreateContext(&info, &alcove_, message) == ALCOVE_SUCCESS, message);
}

void Renderer::destroy_occlusion() const { alcoveDestroyContext(alcove_); }

// The library made views of these images, which are about to be destroyed.
void Renderer::forget_images() const {
  for (const Image* image : {&depth_, &normals_, &visibility_})
    alcoveForgetImage(alcove_, image->image);
}

static AlcoveImage describe(const Image& of, VkExtent2D size, AlcoveState from, AlcoveState to) {
  // Without a view: the library makes one. Layer 0, one sample a pixel.
  return {of.image, VK_NULL_HANDLE, of.format, size.width, size.height, 0, of.usage, 1, from, to};
}

void Renderer::record_occlusion(VkCommandBuffer commands, const CameraMatrices& camera) const {
  // If Alcove runs on the asynchronous queue, semaphores order it with the graphics queue, and the
  // state only names the stage that waits for a semaphore. Otherwise the state is the destination
  // of the subpass dependency at the end of the g-buffer's render pass.
  const bool async = options_.async;
  const AlcoveState read{
      async ? VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT : VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
      async ? VK_ACCESS_2_NONE : VK_ACCESS_2_SHADER_READ_BIT,
      VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  AlcoveState depth = read, written = read;
  depth.layout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
  written.layout = VK_IMAGE_LAYOUT_UNDEFINED;
  AlcoveSettings settings{.struct_size = sizeof settings};
  alcoveGetSettings(ALCOVE_QUALITY_MEDIUM, kRadius, &settings);
  AlcoveView view{.struct_size = sizeof view, .info = {.settings = &settings}};
  view.info.normal_encoding = options_.float_normals ? ALCOVE_NORMAL_ENCODING_SIGNED_XYZ
                                                     : ALCOVE_NORMAL_ENCODING_UNSIGNED_XYZ;
  view.info.static_frames = still_frames_;
  alcoveConvertCamera(&camera.projection[0][0], &camera.view[0][0], 0, &view.info.camera);
  alcoveConvertCamera(&previous_.projection[0][0], &previous_.view[0][0], 0,
                      &view.info.previous_camera);
  view.images[ALCOVE_IMAGE_DEPTH] = describe(depth_, size_, depth, depth);
  view.images[ALCOVE_IMAGE_NORMALS] = describe(normals_, size_, read, read);
  view.images[ALCOVE_IMAGE_VISIBILITY] = describe(visibility_, size_, written, read);
  AlcoveFrame frame{sizeof frame, frame_, frame_ % kSlots, 1, &view, VK_TRUE};
  const bool recorded = alcoveRecordFrame(alcove_, commands, &frame) == ALCOVE_SUCCESS;
  require(recorded, alcoveGetMessage(alcove_));
}

// For the time of integration: ends the program if Alcove saw a mistake in the frames.
void Renderer::require_no_mistakes() const {
  char mistakes[2048];
  require(alcoveDiagnose(alcove_, mistakes, sizeof mistakes) == 0, mistakes);
}
// Alcove: end

}  // namespace host
