// Tests dynamic resolution: only a part of each image is used, and the history continues while the
// size of that part changes.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "c_interface_fixture.h"

namespace alcove::passes {
namespace {

using CDynamicResolution = CInterface;

TEST_F(CDynamicResolution, RenderingToAPartOfAnImageGivesTheSameResultAsAnImageOfThatSize) {
  constexpr VkExtent2D kLarger{37, 25};
  HostView from = draw_view(21, 14);
  request_all_outputs(from);
  from.settings.radius = 2.0f;
  from.settings.depth_layers = 2;
  AlcoveView view = create_view(from);
  for (const InputMember& each : kInputs)
    view.images[each.role] = input(placed_in(kLarger, from.*each.texels));
  for (const OutputMember& each : kOutputs)
    view.images[each.role] = output(view.images[each.role].format, kLarger.width, kLarger.height);
  for (AlcoveImage& image : view.images) {
    if (image.width == 0) continue;
    image.width = 21;
    image.height = 14;
  }
  view.info.largest_width = kLarger.width;
  view.info.largest_height = kLarger.height;
  for (std::uint32_t i = 0; i < 3; ++i) {
    view.info.previous_camera = view.info.camera;
    view.info.camera.view_from_world[12] = from.view.view_from_world[12] =
        0.02f * static_cast<float>(i);
    const HostOutputs outputs = run_view(view, i);
    EXPECT_LT(std::ranges::min(outputs.visibility.texels), 0.9f);
    expect_equal(outputs, run_plainly(from, i));
    from.previous_view = from.view;
  }
}

// A view whose size changes in every frame accumulates history like a view of constant size, both
// if history is found by the camera alone and if it is found by motion vectors.
TEST_F(CDynamicResolution, HistoryKeepsAccumulatingWhileTheRenderedSizeChangesInEveryFrame) {
  constexpr std::array<VkExtent2D, 4> kSizes{{{48, 36}, {40, 30}, {56, 42}, {44, 33}}};
  constexpr std::uint32_t kFrames = 17;  // the last frame has the first of the sizes
  const Context context = create_context();
  const auto draw_size = [](VkExtent2D size, bool motion) {
    HostView view = draw_view(size.width, size.height);
    view.settings.radius = 1.5f;
    view.motion.texels.assign(motion ? view.motion.texels.size() : 0, 0.0f);
    return view;
  };
  HostView constant = draw_size(kSizes[0], false);
  HostOutputs expected;
  for (std::uint32_t i = 0; i < 3 * kFrames; ++i) expected = run_plainly(constant, i);
  constant.id = 1;
  const double fresh = rms(run_plainly(constant, kFrames - 1).visibility, expected.visibility);
  for (const bool motion : {false, true}) {
    HostOutputs outputs;
    VkDeviceSize history = 0;
    for (std::uint32_t i = 0; i < kFrames; ++i) {
      HostView from = draw_size(kSizes.at(i % kSizes.size()), motion);
      from.id = motion ? 3 : 2;
      from.largest_size = kSizes[2];
      from.previous_size = kSizes.at((i + kSizes.size() - 1) % kSizes.size());
      from.reset = i == 0;
      outputs = run_views(*context, {&from, 1}, i)[0];
      expect_equal(outputs, run_plainly(from, i));
      history = i == 0 ? get_memory(*context).history : history;
      EXPECT_EQ(get_memory(*context).history, history);
    }
    // The difference includes the rounding of both images to 8 bits, a root mean square of 0.0011.
    EXPECT_LT(rms(outputs.visibility, expected.visibility), 0.8 * fresh) << motion;
    EXPECT_EQ(alcoveDropView(context.get(), 2), ALCOVE_SUCCESS);
  }
}

}  // namespace
}  // namespace alcove::passes
