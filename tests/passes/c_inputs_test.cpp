// Tests the images that an engine gives: normals and motion vectors in the conventions of different
// engines, layers of an array, depth in a depth format, one image for several inputs, and images
// that the engine destroys; and the output settings `power` and `intensity`.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>

#include "c_interface_fixture.h"
#include "maths/octahedral.h"

namespace alcove::passes {
namespace {

constexpr std::uint32_t kWidth = 40;
constexpr std::uint32_t kHeight = 30;

// Returns an image of the same size with `channels` channels. `map` makes each texel from the texel
// of `image` at the same place.
HostImage map_texels(const HostImage& image, std::uint32_t channels,
                     const std::function<void(const float* from, float* to)>& map) {
  HostImage result{image.width, image.height, {}, channels};
  const std::size_t texels = std::size_t{image.width} * image.height;
  result.texels.resize(texels * channels);
  for (std::size_t i = 0; i < texels; ++i)
    map(&image.texels[i * image.channels], &result.texels[i * channels]);
  return result;
}

HostImage pack(const HostImage& image) {
  return map_texels(image, image.channels, [&](const float* from, float* to) {
    std::transform(from, from + image.channels, to, [](float x) { return 0.5f + 0.5f * x; });
  });
}

HostImage octahedral(const HostImage& image) {
  return map_texels(image, 2, [](const float* from, float* to) {
    const glm::vec2 encoded = maths::octahedral_encode({from[0], from[1], from[2]});
    to[0] = encoded.x;
    to[1] = encoded.y;
  });
}

HostImage mirror(const HostImage& image) {
  return map_texels(image, image.channels, [&](const float* from, float* to) {
    std::copy_n(from, image.channels, to);
    to[2] = -to[2];
  });
}

void expect_near(const HostOutputs& outputs, const HostOutputs& expected, double limit) {
  for (const OutputMember& each : kOutputs) {
    if ((expected.*each.texels).texels.empty()) continue;
    EXPECT_LT(rms(outputs.*each.texels, expected.*each.texels), limit);
  }
}

class CInputs : public CInterface {
 protected:
  static HostView draw_inputs() {
    HostView view = draw_view(kWidth, kHeight);
    view.settings.bent_normal = true;
    view.settings.specular = ALCOVE_SPECULAR_TABLE;
    view.motion = {};
    return view;
  }

  // Records frames of a new view and returns the results of the last. `change` sets the fields of
  // AlcoveView that describe the convention of the inputs.
  HostOutputs run_frames(
      const HostView& from, std::uint32_t frames,
      const std::function<void(AlcoveView&)>& change = [](AlcoveView&) {}) {
    AlcoveView view = create_view(from);
    view.info.id = next_id_++;
    change(view);
    for (std::uint32_t i = 0; i < frames; ++i) run_frame(context(), {&view, 1}, i);
    engine().wait();
    return read_results(view);
  }

 private:
  std::uint32_t next_id_ = 0;
};

TEST_F(CInputs, AllNormalEncodingsGiveTheSameImages) {
  HostView view = draw_inputs();
  const HostOutputs expected = run_frames(view, 2);
  const HostImage plain = view.normals, two = octahedral(plain);
  for (const auto& [encoding, normals] :
       {std::pair{ALCOVE_NORMAL_ENCODING_UNSIGNED_XYZ, pack(plain)},
        {ALCOVE_NORMAL_ENCODING_OCTAHEDRAL, two},
        {ALCOVE_NORMAL_ENCODING_UNSIGNED_OCTAHEDRAL, pack(two)}}) {
    SCOPED_TRACE(static_cast<int>(encoding));
    view.normals = normals;
    const AlcoveNormalEncoding value = encoding;
    expect_near(run_frames(view, 2, [&](AlcoveView& v) { v.info.normal_encoding = value; }),
                expected, 2e-3);
  }
}

TEST_F(CInputs, NormalsOfACameraAlongPlusZAreMirroredOnInputAndBentNormalsOnOutput) {
  HostView view = draw_inputs();
  const HostOutputs expected = run_frames(view, 2);
  view.normals = mirror(view.normals);
  HostOutputs outputs =
      run_frames(view, 2, [](AlcoveView& v) { v.info.normals_forward_z = VK_TRUE; });
  outputs.bent_normal = mirror(outputs.bent_normal);
  expect_near(outputs, expected, 1e-5);
}

// All planes face the eye, so that the history has the same depth everywhere. If motion vectors
// were misread, history from the wrong place would therefore be used, and the images would differ.
TEST_F(CInputs, MotionVectorsInAnyUnitAndSignConventionGiveTheSameImages) {
  HostView moving = draw_view(kWidth, kHeight, step(0.31, 0.6));
  moving.settings.bent_normal = true;
  moving.settings.estimator = ALCOVE_ESTIMATOR_HORIZONS;
  moving.settings.radius = 1.5f;
  for (std::size_t i = 0; i < moving.motion.texels.size(); ++i)
    moving.motion.texels[i] = i % 2 == 0 ? 0.05f : -0.025f;
  const HostOutputs expected = run_frames(moving, 3);
  // The conventions are: motion in pixels; motion from this frame to the last one instead of the
  // reverse; motion without the jitter of the camera; and motion in normalised device coordinates
  // with y up.
  struct Convention {
    float scale[2];
    float offset[2];
  };
  for (const Convention& c : {Convention{{1.0f / kWidth, 1.0f / kHeight}, {0.0f, 0.0f}},
                              {{-1.0f, -1.0f}, {0.0f, 0.0f}},
                              {{1.0f, 1.0f}, {0.004f, -0.006f}},
                              {{0.5f, -0.5f}, {0.0f, 0.0f}}}) {
    HostView changed = moving;
    changed.motion = map_texels(moving.motion, 2, [&](const float* from, float* to) {
      for (int i = 0; i < 2; ++i) to[i] = (from[i] - c.offset[i]) / c.scale[i];
    });
    expect_near(run_frames(changed, 3,
                           [&](AlcoveView& v) {
                             std::ranges::copy(c.scale, v.info.motion_scale);
                             std::ranges::copy(c.offset, v.info.motion_offset);
                           }),
                expected, 1e-5);
  }
  const HostOutputs wrong = run_frames(
      moving, 3, [](AlcoveView& v) { v.info.motion_scale[0] = v.info.motion_scale[1] = -1.0f; });
  EXPECT_GT(rms(wrong.visibility, expected.visibility), 1e-3) << "the sign makes no difference";
}

TEST_F(CInputs, PowerAndIntensityChangeOnlyTheWrittenVisibility) {
  HostView view = draw_inputs();
  view.settings.specular = ALCOVE_SPECULAR_SLICES;
  const HostOutputs open = run_frames(view, 3);
  view.settings.power = 2.0f;
  view.settings.intensity = 0.75f;
  const HostOutputs shaped = run_frames(view, 3);
  for (std::size_t i = 0; i < open.visibility.texels.size(); ++i) {
    const double v = open.visibility.texels[i];
    ASSERT_NEAR(shaped.visibility.texels[i], 1.0 - 0.75 * (1.0 - v * v), 1e-5);
  }
  EXPECT_EQ(shaped.bent_normal.texels, open.bent_normal.texels);
  EXPECT_EQ(shaped.specular.texels, open.specular.texels);
}

// The two eyes of a stereo view are two layers of one array image. The library makes an image view
// for each.
TEST_F(CInputs, LayersOfAnArrayImageCanBeOutputsOfDifferentViews) {
  const AlcoveImage both = engine().make_image(
      VK_FORMAT_R32_SFLOAT, 16, 12,
      VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT, 2);
  std::array<HostView, 2> from{draw_view(16, 12), draw_view(16, 12, groove(0.8), test_views()[0])};
  std::array<AlcoveView, 2> views;
  for (std::uint32_t eye = 0; eye < 2; ++eye) {
    from.at(eye).id = eye;
    views.at(eye) = create_view(from.at(eye));
    views.at(eye).images[ALCOVE_IMAGE_VISIBILITY] = both;
    views.at(eye).images[ALCOVE_IMAGE_VISIBILITY].layer = eye;
  }
  const std::vector<HostOutputs> results = run_views(context(), views, 0);
  for (std::uint32_t eye = 0; eye < 2; ++eye)
    expect_equal(results[eye], run_plainly(from.at(eye), 0));
}

TEST_F(CInputs, DepthImageInDepthFormatAndAttachmentLayoutIsAccepted) {
  const HostView from = draw_view(16, 12);
  AlcoveView view = create_view(from);
  view.images[ALCOVE_IMAGE_DEPTH] =
      engine().make_image(VK_FORMAT_D32_SFLOAT, 16, 12,
                          VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                              VK_IMAGE_USAGE_TRANSFER_DST_BIT);
  const AlcoveState attached{VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
                             VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                             VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
  engine().write(view.images[ALCOVE_IMAGE_DEPTH], std::as_bytes(std::span(from.depth_ndc.texels)),
                 attached);
  view.images[ALCOVE_IMAGE_DEPTH].initial_state = attached;
  view.images[ALCOVE_IMAGE_DEPTH].final_state = {VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT,
                                                 VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT,
                                                 VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL};
  view.images[ALCOVE_IMAGE_VISIBILITY].final_state.layout = VK_IMAGE_LAYOUT_GENERAL;
  expect_equal(run_view(view, 0), run_plainly(from, 0));
}

TEST_F(CInputs, OneImageMayBeGivenAsBothAlbedoAndRoughness) {
  HostView from = draw_view(16, 12);
  from.roughness = from.albedo;  // packed: roughness is its green
  from.settings.specular = ALCOVE_SPECULAR_SLICES;
  from.multi_bounce = true;
  const AlcoveView view = create_view(from);
  ASSERT_EQ(view.images[ALCOVE_IMAGE_ROUGHNESS].image, view.images[ALCOVE_IMAGE_ALBEDO].image);
  expect_equal(run_view(view, 0), run_plainly(from, 0));
}

TEST_F(CInputs, ImageMayBeDestroyedAfterTheEngineCalledForgetImage) {
  HostView from = draw_view(16, 12);
  from.reset = true;
  AlcoveView view = create_view(from);
  const HostOutputs expected = run_plainly(from, 0);
  for (std::uint32_t round = 0; round < 4; ++round) {
    expect_equal(run_view(view, 0), expected);
    EXPECT_EQ(alcoveForgetImage(&context(), view.images[ALCOVE_IMAGE_VISIBILITY].image),
              ALCOVE_SUCCESS);
    engine().destroy_image(view.images[ALCOVE_IMAGE_VISIBILITY]);
    view.images[ALCOVE_IMAGE_VISIBILITY] =
        output(view.images[ALCOVE_IMAGE_VISIBILITY].format, 16, 12);
  }
}

}  // namespace
}  // namespace alcove::passes
