// Tests dynamic resolution: only a part of each image is used, and the history continues while the
// size of that part changes.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>

#include "c_interface_fixture.h"
#include "gtao_scenes.h"

namespace alcove::passes {
namespace {

using testing::HasSubstr;

class CDynamicResolution : public CInterface {
 protected:
  // Makes an image of `larger` pixels. The part that is used holds `contents`.
  AlcoveImage part(const HostImage& contents, VkExtent2D larger) {
    AlcoveImage image = input(placed_in(larger, contents));
    image.width = contents.width;
    image.height = contents.height;
    return image;
  }
};

TEST_F(CDynamicResolution, RenderingToAPartOfAnImageGivesTheSameResultAsAnImageOfThatSize) {
  const Context context = create_context();
  GivenView given = given_view(test_views()[2], 21, 14, ball_on_floor());
  given.settings.radius = 2.0f;
  given.settings.bent_normal = true;
  given.settings.specular = Specular::slices;
  given.settings.depth_layers = 2;
  given.multi_bounce = true;
  AlcoveSettings settings;
  AlcoveView view = view_of(given, settings);
  constexpr VkExtent2D kLarger{37, 25};
  view.depth = part(given.depth_ndc, kLarger);
  view.normals = part(given.normals, kLarger);
  view.motion = part(given.motion, kLarger);
  view.roughness = part(given.roughness, kLarger);
  view.second_depth = part(given.second_depth_ndc, kLarger);
  view.albedo = part(given.albedo, kLarger);
  view.visibility = output(view.visibility.format, kLarger.width, kLarger.height);
  view.visibility.width = given.depth_ndc.width;
  view.visibility.height = given.depth_ndc.height;
  view.largest_width = kLarger.width;
  view.largest_height = kLarger.height;
  for (std::uint32_t i = 0; i < 3; ++i) {
    run_frame(*context, {&view, 1}, i);
    const Results found = results_of(view);
    EXPECT_LT(std::ranges::min(found.visibility.texels), 0.9f);
    expect_equal(found, run_by_cpp(given, i));
  }
}

TEST_F(CDynamicResolution, DeclaringALargestImageSizeDoesNotChangeTheResult) {
  const Context context = create_context();
  for (std::uint32_t i = 0; i < 4; ++i) {
    GivenView given = given_view(test_views()[2], 21, 14, ball_on_floor());
    given.settings.bent_normal = true;
    given.view.view_from_world[12] = 0.02f * static_cast<float>(i);
    given.previous_view.view_from_world[12] = given.view.view_from_world[12] - 0.02f;
    given.reset = i == 0;
    const Results expected = run_by_cpp(given, i);
    given.largest_size = {40, 30};
    expect_equal(run_by_c(*context, {&given, 1}, i)[0], expected);
  }
}

// A view whose size changes in every frame accumulates history like a view of constant size, both
// if history is found by the camera alone and if it is found by motion vectors.
TEST_F(CDynamicResolution, HistoryKeepsAccumulatingWhileTheRenderedSizeChangesInEveryFrame) {
  constexpr std::array<VkExtent2D, 4> kSizes{{{48, 36}, {40, 30}, {56, 42}, {44, 33}}};
  constexpr VkExtent2D kLargest{56, 42};
  constexpr std::uint32_t kFrames = 17;  // the last frame has the first of the sizes
  const Context context = create_context();
  const auto given_of = [](VkExtent2D size) {
    GivenView given = given_view(test_views()[2], size.width, size.height, ball_on_floor());
    given.settings.radius = 1.5f;
    given.motion = {};
    return given;
  };
  GivenView constant = given_of(kSizes[0]);
  Results expected;
  for (std::uint32_t i = 0; i < 3 * kFrames; ++i) expected = run_by_cpp(constant, i);
  constant.id = 1;
  const double fresh = rms(run_by_cpp(constant, kFrames - 1).visibility, expected.visibility);
  for (const bool motion : {false, true}) {
    Results found;
    VkDeviceSize history = 0;
    for (std::uint32_t i = 0; i < kFrames; ++i) {
      GivenView given = given_of(kSizes.at(i % kSizes.size()));
      given.id = motion ? 3 : 2;
      given.largest_size = kLargest;
      given.previous_size = kSizes.at((i + kSizes.size() - 1) % kSizes.size());
      given.reset = i == 0;
      if (motion) {
        given.motion = given_view(test_views()[2], given.depth_ndc.width, given.depth_ndc.height,
                                  ball_on_floor())
                           .motion;
        given.motion.texels.assign(given.motion.texels.size(), 0.0f);
      }
      found = run_by_c(*context, {&given, 1}, i)[0];
      expect_equal(found, run_by_cpp(given, i));
      history = i == 0 ? memory_of(*context).history : history;
      EXPECT_EQ(memory_of(*context).history, history);
    }
    // The difference includes the rounding of both images to 8 bits, a root mean square of 0.0011.
    EXPECT_LT(rms(found.visibility, expected.visibility), 0.8 * fresh) << motion;
    EXPECT_EQ(alcoveDropView(context.get(), 2), ALCOVE_SUCCESS);
  }
}

TEST_F(CDynamicResolution, RenderedSizesAboveTheDeclaredLargestSizeAreRefused) {
  const Context context = create_context();
  GivenView given = given_view(test_views()[2], 21, 14, ball_on_floor());
  AlcoveSettings settings;
  AlcoveView view = view_of(given, settings);
  const auto expect_refused = [&](const char* part) {
    const AlcoveFrame frame{.struct_size = sizeof frame, .view_count = 1, .views = &view};
    engine().submit(0, [&](VkCommandBuffer commands) {
      EXPECT_EQ(alcoveRecordFrame(context.get(), commands, &frame), ALCOVE_ERROR_INVALID_INPUT);
    });
    EXPECT_THAT(alcoveGetMessage(context.get()), HasSubstr(part));
  };
  view.largest_width = 20;
  view.largest_height = 14;
  expect_refused("within 20x14");
  view.largest_width = 0;
  expect_refused("within 0x14");
  view.largest_width = 30;
  view.previous_width = 30;
  view.previous_height = 15;
  expect_refused("had 30x15 in the frame before");
  view.previous_height = 0;
  expect_refused("had 30x0");
  view.largest_width = view.largest_height = 0;
  view.previous_height = 14;
  expect_refused("within 21x14");
  view.reset_history = VK_TRUE;  // the previous size is then not read
  run_frame(*context, {&view, 1}, 1);
  engine().wait();
}

}  // namespace
}  // namespace alcove::passes
