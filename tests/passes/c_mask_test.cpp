// Tests masks of surfaces.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "c_interface_fixture.h"
#include "gtao_scenes.h"

namespace alcove::passes {
namespace {

using testing::HasSubstr;

constexpr std::uint32_t kWidth = 60;
constexpr std::uint32_t kHeight = 40;
constexpr std::uint32_t kNotReceiving = 1;
constexpr std::uint32_t kNotOccluding = 2;

// A groove seen over a weapon: a box that is near the walls, so that it occludes them, in the right
// lower corner of the image.
Scene walls() { return groove(0.8); }
Scene weapon() { return box({0.6, -1.2, -3.6}, {1.4, -0.3, -3.1}); }

class CMask : public CInterface {
 protected:
  GivenView given(bool with_weapon) const {
    Scene scene = walls();
    if (with_weapon) std::ranges::copy(weapon(), std::back_inserter(scene));
    GivenView view = given_view(test_views()[2], kWidth, kHeight, scene);
    view.motion = {};
    view.settings.radius = 1.0f;
    view.settings.bent_normal = true;
    view.settings.specular = Specular::slices;
    return view;
  }
  // Whether each pixel shows the weapon.
  static std::vector<bool> shows_weapon(const GivenView& with, const GivenView& without) {
    std::vector<bool> shows(with.depth_ndc.texels.size());
    for (std::size_t i = 0; i < shows.size(); ++i)
      shows[i] = with.depth_ndc.texels[i] != without.depth_ndc.texels[i];
    return shows;
  }

  AlcoveImage mask_of(VkFormat format, const std::vector<bool>& shows, std::uint32_t bits) {
    AlcoveImage image = engine().make_image(
        format, kWidth, kHeight, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    auto buffer =
        sample::HostBuffer::create(gpu().device(), shows.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    EXPECT_TRUE(buffer);
    for (std::size_t i = 0; i < shows.size(); ++i)
      (*buffer)->bytes()[i] = static_cast<std::byte>(shows[i] ? bits : 64);
    run([&](framegraph::Graph& graph) {
      framegraph::ImportedTexture import{
          .image = image.image,
          .desc = {format, framegraph::Extent::absolute(kWidth, kHeight)},
          .usage = image.usage,
          .initial_state = {kResting.stages, kResting.access, kResting.layout},
          .final_state = {kResting.stages, kResting.access, kResting.layout}};
      sample::add_copy(graph, **buffer, graph.import_texture("mask", import));
    });
    return image;
  }

  // Records frames with a moving and then a static camera, and returns the last.
  Results run_frames(AlcoveContext& context, GivenView given, const AlcoveImage& mask,
                     std::uint32_t not_receiving, std::uint32_t not_occluding, std::uint32_t id) {
    AlcoveSettings settings;
    AlcoveView view{};
    for (std::uint32_t index = 0; index < 8; ++index) {
      given.id = id;
      given.previous_view = given.view;
      given.view.view_from_world[12] = index < 4 ? 0.001f * static_cast<float>(index) : 0.003f;
      given.static_frames = index < 5 ? 0 : index - 4;
      view = view_of(given, settings);
      view.mask = mask;
      view.not_receiving = not_receiving;
      view.not_occluding = not_occluding;
      run_frame(context, {&view, 1}, index);
      engine().wait();
    }
    return results_of(view);
  }
};

// The mean difference of visibility at pixels of the walls.
double wall_error(const Results& a, const Results& b, const std::vector<bool>& weapon) {
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < weapon.size(); ++i) {
    if (!weapon[i]) {
      sum += std::abs(a.visibility.texels[i] - b.visibility.texels[i]);
      count += 1.0;
    }
  }
  return sum / count;
}

TEST_F(CMask, WeaponThatIsMaskedOutIsUnoccludedAndLeavesTheWallsAsTheyAreWithoutIt) {
  const Context context = create_context();
  const GivenView with = given(true);
  const GivenView without = given(false);
  const std::vector<bool> shows = shows_weapon(with, without);
  ASSERT_GT(std::ranges::count(shows, true), 100);
  const Results bare = run_frames(*context, without, {}, 0, 0, 1);
  const Results plain = run_frames(*context, with, {}, 0, 0, 2);
  const double plain_error = wall_error(plain, bare, shows);
  for (const VkFormat format : {VK_FORMAT_R8_UNORM, VK_FORMAT_R8_UINT}) {
    SCOPED_TRACE(format == VK_FORMAT_R8_UINT ? "R8_UINT" : "R8_UNORM");
    const AlcoveImage mask = mask_of(format, shows, kNotReceiving | kNotOccluding);
    const Results masked = run_frames(*context, with, mask, kNotReceiving, kNotOccluding,
                                      format == VK_FORMAT_R8_UINT ? 3 : 4);
    const double error = wall_error(masked, bare, shows);
    EXPECT_GT(plain_error, 0.005);
    EXPECT_LT(error, 0.1 * plain_error);
    for (std::size_t i = 0; i < shows.size(); ++i) {
      if (shows[i]) {
        ASSERT_EQ(masked.visibility.texels[i], 1.0f);
        ASSERT_EQ(masked.specular.texels[i], 1.0f);
        for (std::size_t c = 0; c < 3; ++c)
          ASSERT_NEAR(masked.bent_normal.texels[4 * i + c], with.normals.texels[4 * i + c], 1e-3f);
      }
    }
  }
}

TEST_F(CMask, EachBitHasItsOwnEffect) {
  const Context context = create_context();
  const GivenView with = given(true);
  const std::vector<bool> shows = shows_weapon(with, given(false));
  const AlcoveImage mask = mask_of(VK_FORMAT_R8_UNORM, shows, 4 | 8);
  const Results plain = run_frames(*context, with, {}, 0, 0, 1);
  // No surface has the bits that are asked for: nothing changes.
  const Results none = run_frames(*context, with, mask, 1, 2, 2);
  EXPECT_EQ(none.visibility.texels, plain.visibility.texels);
  EXPECT_EQ(none.bent_normal.texels, plain.bent_normal.texels);
  EXPECT_EQ(none.specular.texels, plain.specular.texels);
  const Results not_receiving = run_frames(*context, with, mask, 4, 0, 3);
  const Results not_occluding = run_frames(*context, with, mask, 0, 8, 4);
  EXPECT_LT(wall_error(not_receiving, plain, shows), 0.004);  // the walls are still occluded
  EXPECT_GT(wall_error(not_occluding, plain, shows), 0.005);
  double occluded = 0.0;
  for (std::size_t i = 0; i < shows.size(); ++i) {
    if (shows[i]) {
      ASSERT_EQ(not_receiving.visibility.texels[i], 1.0f);
      occluded += 1.0 - not_occluding.visibility.texels[i];
    }
  }
  EXPECT_GT(occluded, 1.0);  // the weapon receives the occlusion by the walls
}

TEST_F(CMask, MasksThatCannotBeUsedAreNamed) {
  const Context context = create_context();
  AlcoveSettings settings;
  AlcoveView good = view_of(given(true), settings);
  good.mask = engine().make_image(VK_FORMAT_R8_UINT, kWidth, kHeight, VK_IMAGE_USAGE_SAMPLED_BIT);
  good.not_receiving = 1;
  const auto expect_refused = [&](const AlcoveView& view, const char* message) {
    const AlcoveFrame frame{.struct_size = sizeof frame, .view_count = 1, .views = &view};
    engine().submit(0, [&](VkCommandBuffer commands) {
      EXPECT_EQ(alcoveRecordFrame(context.get(), commands, &frame), ALCOVE_ERROR_INVALID_INPUT);
    });
    EXPECT_THAT(alcoveGetMessage(context.get()), HasSubstr(message));
  };
  AlcoveView view = good;
  view.mask.format = VK_FORMAT_R16_UINT;
  expect_refused(view, "must be VK_FORMAT_R8_UNORM or VK_FORMAT_R8_UINT");
  view = good;
  view.mask.width -= 1;
  expect_refused(view, "the image of mask is 59x40 pixels and that of depth 60x40");
  view = good;
  view.not_receiving = 0;
  expect_refused(view, "give at least one bit");
  view.not_occluding = 256;
  expect_refused(view, "values up to 255");
  view = good;
  view.mask.samples = 4;
  expect_refused(view, "has 4 samples a pixel; resolve it first");
}

}  // namespace
}  // namespace alcove::passes
