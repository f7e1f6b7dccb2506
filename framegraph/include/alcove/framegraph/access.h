// Named Access values for common uses: each says how a pass reads or writes a resource.
//
// Functions take the shader stages of the access as an argument. Constants have the usual stages. A
// pass declares each subresource only once. If it uses a subresource in two ways, combine the two
// accesses with `|`.
#pragma once

#include "alcove/framegraph/types.h"

namespace alcove::framegraph {

// Returns the combination of two accesses. If their layouts differ, the result has
// VK_IMAGE_LAYOUT_GENERAL, which allows every access except presentation
// (VK_IMAGE_LAYOUT_PRESENT_SRC_KHR). Exception: DEPTH_STENCIL_READ_ONLY_OPTIMAL with
// SHADER_READ_ONLY_OPTIMAL gives DEPTH_STENCIL_READ_ONLY_OPTIMAL, which also allows sampling.
constexpr Access operator|(const Access& a, const Access& b) {
  constexpr auto kDepth = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
  constexpr auto kSampled = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  VkImageLayout layout = a.layout == b.layout ? a.layout : VK_IMAGE_LAYOUT_GENERAL;
  if ((a.layout == kDepth && b.layout == kSampled) || (a.layout == kSampled && b.layout == kDepth))
    layout = kDepth;
  return {a.stages | b.stages, a.access | b.access, layout, a.usage | b.usage};
}

}  // namespace alcove::framegraph

namespace alcove::framegraph::access {

// Accesses to textures.

// Returns the access of a texture that shaders of these stages sample.
constexpr Access sampled(VkPipelineStageFlags2 stages) {
  return {stages, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
          VK_IMAGE_USAGE_SAMPLED_BIT};
}
// Returns the access of a texture that is sampled in VK_IMAGE_LAYOUT_GENERAL, for a pass that also
// stores to other mips of the same texture.
constexpr Access sampled_general(VkPipelineStageFlags2 stages) {
  return {stages, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_GENERAL,
          VK_IMAGE_USAGE_SAMPLED_BIT};
}
// Returns the access of a depth texture that is sampled, in a layout that allows the depth test
// against it at the same time.
constexpr Access depth_read(VkPipelineStageFlags2 stages) {
  return {stages, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
          VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, VK_IMAGE_USAGE_SAMPLED_BIT};
}
constexpr Access storage_read(VkPipelineStageFlags2 stages) {
  return {stages, VK_ACCESS_2_SHADER_STORAGE_READ_BIT, VK_IMAGE_LAYOUT_GENERAL,
          VK_IMAGE_USAGE_STORAGE_BIT};
}
constexpr Access storage_write(VkPipelineStageFlags2 stages) {
  return {stages, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_IMAGE_LAYOUT_GENERAL,
          VK_IMAGE_USAGE_STORAGE_BIT};
}
constexpr Access storage_read_write(VkPipelineStageFlags2 stages) {
  return storage_read(stages) | storage_write(stages);
}

inline constexpr Access sampled_compute = sampled(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
inline constexpr Access sampled_fragment = sampled(VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT);
inline constexpr Access depth_read_fragment = depth_read(VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT);
inline constexpr Access depth_read_compute = depth_read(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
inline constexpr Access storage_read_compute = storage_read(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
inline constexpr Access storage_read_fragment =
    storage_read(VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT);
inline constexpr Access storage_write_compute =
    storage_write(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
inline constexpr Access storage_read_write_compute =
    storage_read_write(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
// Colour and depth attachments: the read bits are for blending, testing and load operations.
inline constexpr Access color_attachment{
    VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
    VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
    VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT};
// The access of a resolve target: the texture with one sample per texel into which a multisampled
// colour attachment is resolved.
inline constexpr Access resolve_target{
    VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
    VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT};
inline constexpr Access depth_attachment{
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
    VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT};
// Accesses of a rendering that resolves depth: of the texture with one sample per texel, and of the
// multisampled one, which a pass declares as depth_attachment | depth_resolve_source. Vulkan
// resolves depth in the stage of colour attachments.
inline constexpr Access depth_resolve_target{
    VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
    VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT};
inline constexpr Access depth_resolve_source{
    VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT,
    VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT};
// Depth test without writes.
inline constexpr Access depth_test{
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL,
    VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT};
// Copies, blits and clears (VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT is their union).
inline constexpr Access transfer_source{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                                        VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                        VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
inline constexpr Access transfer_destination{
    VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
    VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_USAGE_TRANSFER_DST_BIT};
inline constexpr Access blit_source{VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                                    VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                    VK_IMAGE_USAGE_TRANSFER_SRC_BIT};
inline constexpr Access blit_destination{
    VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
    VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_USAGE_TRANSFER_DST_BIT};
inline constexpr Access clear{VK_PIPELINE_STAGE_2_CLEAR_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                              VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                              VK_IMAGE_USAGE_TRANSFER_DST_BIT};
// Returns the initial state of a swapchain image without contents. `stages` are those in which
// FrameInfo::waits has the semaphore of vkAcquireNextImageKHR wait: the change of the layout comes
// after that wait. They are usually the stages of the image's first use.
constexpr State acquired(VkPipelineStageFlags2 stages) { return {stages}; }
// The final state of a swapchain image that is presented after the frame.
inline constexpr State present{VK_PIPELINE_STAGE_2_BOTTOM_OF_PIPE_BIT, 0,
                               VK_IMAGE_LAYOUT_PRESENT_SRC_KHR};

}  // namespace alcove::framegraph::access

namespace alcove::framegraph::buffer_access {

constexpr Access uniform(VkPipelineStageFlags2 stages) {
  return {stages, VK_ACCESS_2_UNIFORM_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
          VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT};
}
constexpr Access storage_read(VkPipelineStageFlags2 stages) {
  return {stages, VK_ACCESS_2_SHADER_STORAGE_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT};
}
constexpr Access storage_write(VkPipelineStageFlags2 stages) {
  return {stages, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT};
}
constexpr Access storage_read_write(VkPipelineStageFlags2 stages) {
  return storage_read(stages) | storage_write(stages);
}

inline constexpr Access storage_read_compute = storage_read(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
inline constexpr Access storage_read_fragment =
    storage_read(VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT);
inline constexpr Access storage_write_compute =
    storage_write(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
inline constexpr Access storage_read_write_compute =
    storage_read_write(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
inline constexpr Access vertex_buffer{VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT,
                                      VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT,
                                      VK_IMAGE_LAYOUT_UNDEFINED, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT};
inline constexpr Access index_buffer{VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT,
                                     VK_ACCESS_2_INDEX_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                                     VK_BUFFER_USAGE_INDEX_BUFFER_BIT};
// The arguments of indirect draws and dispatches.
inline constexpr Access indirect{VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,
                                 VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                                 VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT};
inline constexpr Access transfer_source{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                                        VK_IMAGE_LAYOUT_UNDEFINED,
                                        VK_BUFFER_USAGE_TRANSFER_SRC_BIT};
inline constexpr Access transfer_destination{
    VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
    VK_BUFFER_USAGE_TRANSFER_DST_BIT};
// The destination of vkCmdFillBuffer and vkCmdUpdateBuffer. The access names both the clear stage
// and the copy stage, because implementations differ in which of the two these commands belong to.
inline constexpr Access fill{VK_PIPELINE_STAGE_2_CLEAR_BIT | VK_PIPELINE_STAGE_2_COPY_BIT,
                             VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                             VK_BUFFER_USAGE_TRANSFER_DST_BIT};

// The final state of a buffer that the host reads after the frame's fence has signalled.
inline constexpr State host_read{VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT,
                                 VK_IMAGE_LAYOUT_UNDEFINED};

}  // namespace alcove::framegraph::buffer_access
