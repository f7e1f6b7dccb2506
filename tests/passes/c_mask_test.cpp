// Tests masks of surfaces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "c_interface_fixture.h"

namespace alcove::passes {
namespace {

constexpr std::uint32_t kWidth = 60;
constexpr std::uint32_t kHeight = 40;
constexpr std::uint32_t kNotReceiving = 1;
constexpr std::uint32_t kNotOccluding = 2;

// A groove seen over a weapon: a box that is near the walls, so that it occludes them, in the right
// lower corner of the image.
class CMask : public CInterface {
 protected:
  static HostView draw_scene(bool with_weapon) {
    Scene scene = groove(0.8);
    if (with_weapon)
      std::ranges::copy(box({0.6, -1.2, -3.6}, {1.4, -0.3, -3.1}), std::back_inserter(scene));
    HostView view = draw_view(kWidth, kHeight, scene);
    view.motion = {};
    view.settings.radius = 1.0f;
    view.settings.bent_normal = true;
    view.settings.specular = ALCOVE_SPECULAR_SLICES;
    return view;
  }

  // Returns the mean difference of visibility at pixels of the walls.
  double wall_error(const HostOutputs& a, const HostOutputs& b) const {
    double sum = 0.0, count = 0.0;
    for (std::size_t i = 0; i < shows_weapon_.size(); ++i) {
      if (!shows_weapon_[i]) {
        sum += std::abs(a.visibility.texels[i] - b.visibility.texels[i]);
        count += 1.0;
      }
    }
    return sum / count;
  }

  void SetUp() override {
    CInterface::SetUp();
    for (std::size_t i = 0; i < with_.depth_ndc.texels.size(); ++i)
      shows_weapon_.push_back(with_.depth_ndc.texels[i] != without_.depth_ndc.texels[i]);
    ASSERT_GT(std::ranges::count(shows_weapon_, true), 100);
  }

  // Returns a mask with `bits` where the weapon is.
  AlcoveImage create_mask(VkFormat format, std::uint32_t bits) {
    Bytes bytes;
    for (const bool shows : shows_weapon_)
      bytes.push_back(static_cast<std::byte>(shows ? bits : 64));
    return engine().make_filled(format, kWidth, kHeight, bytes);
  }

  // Runs frames with a moving and then a static camera, and returns the results of the last.
  HostOutputs run_frames(HostView from, const AlcoveImage& mask = {},
                         std::uint32_t not_receiving = 0, std::uint32_t not_occluding = 0) {
    from.id = next_id_++;
    HostOutputs results;
    for (std::uint32_t index = 0; index < 8; ++index) {
      from.previous_view = from.view;
      from.view.view_from_world[12] = index < 4 ? 0.001f * static_cast<float>(index) : 0.003f;
      from.static_frames = index < 5 ? 0 : index - 4;
      AlcoveView view = create_view(from);
      view.images[ALCOVE_IMAGE_MASK] = mask;
      view.info.not_receiving = not_receiving;
      view.info.not_occluding = not_occluding;
      results = run_view(view, index);
    }
    return results;
  }

  const HostView with_ = draw_scene(true);
  const HostView without_ = draw_scene(false);
  std::vector<bool> shows_weapon_;  // by pixel
  std::uint32_t next_id_ = 0;
};

TEST_F(CMask, WeaponThatIsMaskedOutIsUnoccludedAndLeavesTheWallsAsTheyAreWithoutIt) {
  const HostOutputs bare = run_frames(without_);
  const double plain_error = wall_error(run_frames(with_), bare);
  EXPECT_GT(plain_error, 0.005);
  for (const VkFormat format : {VK_FORMAT_R8_UNORM, VK_FORMAT_R8_UINT}) {
    SCOPED_TRACE(format);
    const AlcoveImage mask = create_mask(format, kNotReceiving | kNotOccluding);
    const HostOutputs masked = run_frames(with_, mask, kNotReceiving, kNotOccluding);
    EXPECT_LT(wall_error(masked, bare), 0.1 * plain_error);
    for (std::size_t i = 0; i < shows_weapon_.size(); ++i) {
      if (!shows_weapon_[i]) continue;
      ASSERT_EQ(masked.visibility.texels[i], 1.0f);
      ASSERT_EQ(masked.specular.texels[i], 1.0f);
      for (std::size_t c = 0; c < 3; ++c)
        ASSERT_NEAR(masked.bent_normal.texels[4 * i + c], with_.normals.texels[4 * i + c], 1e-3f);
    }
  }
}

TEST_F(CMask, EachBitHasItsOwnEffect) {
  const AlcoveImage mask = create_mask(VK_FORMAT_R8_UNORM, 4 | 8);
  const HostOutputs plain = run_frames(with_);
  // No surface has the bits that are asked for: nothing changes.
  expect_equal(run_frames(with_, mask, 1, 2), plain);
  const HostOutputs not_receiving = run_frames(with_, mask, 4, 0);
  const HostOutputs not_occluding = run_frames(with_, mask, 0, 8);
  EXPECT_LT(wall_error(not_receiving, plain), 0.004);  // the walls are still occluded
  EXPECT_GT(wall_error(not_occluding, plain), 0.005);
  double occluded = 0.0;
  for (std::size_t i = 0; i < shows_weapon_.size(); ++i) {
    if (!shows_weapon_[i]) continue;
    ASSERT_EQ(not_receiving.visibility.texels[i], 1.0f);
    occluded += 1.0 - not_occluding.visibility.texels[i];
  }
  EXPECT_GT(occluded, 1.0);  // the weapon receives the occlusion by the walls
}

}  // namespace
}  // namespace alcove::passes
