// The common accesses by name: what a pass says when it reads or writes.
#pragma once

#include "alcove/framegraph/types.h"

namespace alcove::framegraph::access {

// Textures.
inline constexpr Access sampled_compute{
    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
    VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_USAGE_SAMPLED_BIT};
inline constexpr Access sampled_fragment{
    VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
    VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_USAGE_SAMPLED_BIT};
// Sampled in the general layout: for a pass that also stores to other mips of the same texture.
inline constexpr Access sampled_general_compute{
    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
    VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_USAGE_SAMPLED_BIT};
inline constexpr Access storage_read_compute{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                             VK_ACCESS_2_SHADER_STORAGE_READ_BIT,
                                             VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_USAGE_STORAGE_BIT};
inline constexpr Access storage_write_compute{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                              VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                                              VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_USAGE_STORAGE_BIT};
inline constexpr Access storage_read_write_compute{
    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
    VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
    VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_USAGE_STORAGE_BIT};
// Color and depth attachments: the read bits are for blending, testing and load operations.
inline constexpr Access color_attachment{
    VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
    VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
    VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT};
inline constexpr Access depth_attachment{
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
    VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT};
// Depth test without writes.
inline constexpr Access depth_test{
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL,
    VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT};
inline constexpr Access depth_read_fragment{
    VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
    VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, VK_IMAGE_USAGE_SAMPLED_BIT};
inline constexpr Access depth_read_compute{
    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
    VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, VK_IMAGE_USAGE_SAMPLED_BIT};
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
// For a final_state: a swapchain image that is to be presented.
inline constexpr State present{VK_PIPELINE_STAGE_2_BOTTOM_OF_PIPE_BIT, 0,
                               VK_IMAGE_LAYOUT_PRESENT_SRC_KHR};

}  // namespace alcove::framegraph::access

namespace alcove::framegraph::buffer_access {

inline constexpr Access uniform_compute{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                        VK_ACCESS_2_UNIFORM_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                                        VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT};
inline constexpr Access uniform_graphics{
    VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
    VK_ACCESS_2_UNIFORM_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT};
inline constexpr Access storage_read_compute{
    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT,
    VK_IMAGE_LAYOUT_UNDEFINED, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT};
inline constexpr Access storage_write_compute{
    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
    VK_IMAGE_LAYOUT_UNDEFINED, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT};
inline constexpr Access storage_read_write_compute{
    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
    VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
    VK_IMAGE_LAYOUT_UNDEFINED, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT};
inline constexpr Access vertex_buffer{VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT,
                                      VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT,
                                      VK_IMAGE_LAYOUT_UNDEFINED, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT};
inline constexpr Access index_buffer{VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT,
                                     VK_ACCESS_2_INDEX_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                                     VK_BUFFER_USAGE_INDEX_BUFFER_BIT};
inline constexpr Access indirect{VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,
                                 VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                                 VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT};
inline constexpr Access transfer_source{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                                        VK_IMAGE_LAYOUT_UNDEFINED,
                                        VK_BUFFER_USAGE_TRANSFER_SRC_BIT};
inline constexpr Access transfer_destination{
    VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
    VK_BUFFER_USAGE_TRANSFER_DST_BIT};
// vkCmdFillBuffer and vkCmdUpdateBuffer, which implementations count among the clears or the
// copies.
inline constexpr Access fill{VK_PIPELINE_STAGE_2_CLEAR_BIT | VK_PIPELINE_STAGE_2_COPY_BIT,
                             VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_IMAGE_LAYOUT_UNDEFINED,
                             VK_BUFFER_USAGE_TRANSFER_DST_BIT};
// For a final_state: a buffer that the host reads once the frame's fence has signalled.
inline constexpr State host_read{VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT,
                                 VK_IMAGE_LAYOUT_UNDEFINED};

}  // namespace alcove::framegraph::buffer_access
