// Tests images that the engine gives to the C interface: layers of an array, formats, layouts, one
// image for several inputs, and images that the engine destroys.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <vector>

#include "c_interface_fixture.h"
#include "gtao_scenes.h"

namespace alcove::passes {
namespace {

using CImages = CInterface;

// Records a copy of both layers of an image, which is in the state kResting, to a buffer. The
// second layer follows the first.
void copy(VkCommandBuffer commands, const AlcoveImage& image, const sample::HostBuffer& buffer) {
  const VkImageMemoryBarrier2 barrier{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                      .srcStageMask = kResting.stages,
                                      .dstStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                      .dstAccessMask = VK_ACCESS_2_TRANSFER_READ_BIT,
                                      .oldLayout = kResting.layout,
                                      .newLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                      .image = image.image,
                                      .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 2}};
  const VkDependencyInfo dependency{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                    .imageMemoryBarrierCount = 1,
                                    .pImageMemoryBarriers = &barrier};
  vkCmdPipelineBarrier2(commands, &dependency);
  const VkBufferImageCopy region{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 2},
                                 .imageExtent = {image.width, image.height, 1}};
  vkCmdCopyImageToBuffer(commands, image.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                         buffer.buffer(), 1, &region);
}

// The two eyes of a stereo view are two layers of one array image. The library makes an image view
// for each.
TEST_F(CImages, LayersOfAnArrayImageCanBeOutputsOfDifferentViews) {
  const Context context = create_context();
  constexpr VkImageUsageFlags kStored =
      VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  AlcoveImage both = engine().make_image(VK_FORMAT_R32_SFLOAT, 16, 12, kStored, 2);
  std::vector<GivenView> given{given_view(test_views()[2], 16, 12, ball_on_floor()),
                               given_view(test_views()[0], 16, 12, groove(0.8))};
  std::array<AlcoveSettings, 2> settings{};
  std::vector<AlcoveView> views;
  for (std::uint32_t eye = 0; eye < 2; ++eye) {
    given[eye].id = eye;
    views.push_back(view_of(given[eye], settings[eye]));
    views[eye].visibility = both;
    views[eye].visibility.layer = eye;
  }
  run_frame(*context, views, 0);
  constexpr std::size_t kTexels = 16UL * 12;
  constexpr std::size_t kSize = kTexels * sizeof(float);  // of an eye, bytes
  const auto bytes =
      sample::HostBuffer::create(gpu().device(), 2 * kSize, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  ASSERT_TRUE(bytes) << bytes.error();
  engine().submit(1, [&](VkCommandBuffer commands) { copy(commands, both, **bytes); });
  engine().wait();
  for (std::uint32_t eye = 0; eye < 2; ++eye) {
    Results found;
    found.visibility.texels.resize(kTexels);
    std::memcpy(found.visibility.texels.data(), (*bytes)->bytes().data() + eye * kSize, kSize);
    expect_equal(found, run_by_cpp(given[eye], 0));
  }
}

TEST_F(CImages, DepthImageInDepthFormatAndAttachmentLayoutIsAccepted) {
  const Context context = create_context();
  GivenView given = given_view(test_views()[2], 16, 12, ball_on_floor());
  AlcoveSettings settings;
  AlcoveView view = view_of(given, settings);
  view.depth =
      engine().make_image(VK_FORMAT_D32_SFLOAT, 16, 12,
                          VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                              VK_IMAGE_USAGE_TRANSFER_DST_BIT);
  const AlcoveState attached{VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
                             VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                             VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
  fill_image(view.depth, given.depth_ndc, attached);
  view.depth.initial_state = attached;
  view.depth.final_state = {VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT,
                            VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT,
                            VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL};
  view.visibility.final_state.layout = VK_IMAGE_LAYOUT_GENERAL;
  run_frame(*context, {&view, 1}, 0);
  expect_equal(results_of(view), run_by_cpp(given, 0));
}

TEST_F(CImages, OneImageMayBeGivenAsBothAlbedoAndRoughness) {
  const Context context = create_context();
  GivenView given = given_view(test_views()[2], 16, 12, ball_on_floor());
  given.roughness = given.albedo;  // packed: roughness is its green
  given.settings.specular = Specular::slices;
  given.multi_bounce = true;
  AlcoveSettings settings;
  AlcoveView view = view_of(given, settings);
  view.roughness = view.albedo;
  run_frame(*context, {&view, 1}, 0);
  expect_equal(results_of(view), run_by_cpp(given, 0));
}

TEST_F(CImages, ImageMayBeDestroyedAfterTheEngineCalledForgetImage) {
  const Context context = create_context();
  const GivenView given = given_view(test_views()[2], 16, 12, ball_on_floor());
  AlcoveSettings settings;
  AlcoveView view = view_of(given, settings);
  view.reset_history = VK_TRUE;
  const Results expected = run_by_cpp(given, 0);
  for (std::uint32_t round = 0; round < 4; ++round) {
    run_frame(*context, {&view, 1}, 0);
    expect_equal(results_of(view), expected);
    engine().wait();
    EXPECT_EQ(alcoveForgetImage(context.get(), view.visibility.image), ALCOVE_SUCCESS);
    engine().destroy_image(view.visibility);
    view.visibility = output(view.visibility.format, 16, 12);
  }
}

}  // namespace
}  // namespace alcove::passes
