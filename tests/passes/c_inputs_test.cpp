// Tests normals and motion vectors in the conventions of different engines, and the output settings
// `power` and `intensity`.
#include <gmock/gmock.h>

#include <algorithm>
#include <functional>

#include "c_interface_fixture.h"
#include "gtao_scenes.h"
#include "maths/octahedral.h"

namespace alcove::passes {
namespace {

constexpr std::uint32_t kWidth = 40;
constexpr std::uint32_t kHeight = 30;

// Returns an image of the same size with `channels` channels. `map` makes each texel from the texel
// of `image` at the same place.
HostImage mapped(const HostImage& image, std::uint32_t channels,
                 const std::function<void(const float* from, float* to)>& map) {
  HostImage result{image.width, image.height, {}, channels};
  const std::size_t texels = std::size_t{image.width} * image.height;
  result.texels.resize(texels * channels);
  for (std::size_t i = 0; i < texels; ++i)
    map(&image.texels[i * image.channels], &result.texels[i * channels]);
  return result;
}

HostImage packed(const HostImage& image) {
  return mapped(image, image.channels, [&](const float* from, float* to) {
    std::transform(from, from + image.channels, to, [](float x) { return 0.5f + 0.5f * x; });
  });
}

HostImage octahedral(const HostImage& image) {
  return mapped(image, 2, [](const float* from, float* to) {
    const glm::vec2 encoded = maths::octahedral_encode({from[0], from[1], from[2]});
    to[0] = encoded.x;
    to[1] = encoded.y;
  });
}

class CInputs : public CInterface {
 protected:
  static GivenView given() {
    GivenView view = given_view(test_views()[2], kWidth, kHeight, ball_on_floor());
    view.settings.bent_normal = true;
    view.settings.specular = Specular::table;
    view.motion = {};
    return view;
  }

  // Records `frames` frames of a view and returns the results of the last. `change` sets the fields
  // of AlcoveView that describe the convention of the inputs.
  Results results(const GivenView& given, std::uint32_t frames,
                  const std::function<void(AlcoveView&)>& change) {
    const Context context = create_context();
    AlcoveSettings settings{};
    AlcoveView view = view_of(given, settings);
    change(view);
    for (std::uint32_t i = 0; i < frames; ++i) run_frame(*context, {&view, 1}, i);
    engine().wait();
    return results_of(view);
  }
};

TEST_F(CInputs, AllNormalEncodingsGiveTheSameImages) {
  const GivenView plain = given();
  const Results expected = results(plain, 2, [](AlcoveView&) {});
  struct Case {
    AlcoveNormalEncoding encoding;
    HostImage normals;
  };
  const HostImage two = octahedral(plain.normals);
  for (const Case& encoded : {Case{ALCOVE_NORMAL_ENCODING_UNSIGNED_XYZ, packed(plain.normals)},
                              Case{ALCOVE_NORMAL_ENCODING_OCTAHEDRAL, two},
                              Case{ALCOVE_NORMAL_ENCODING_UNSIGNED_OCTAHEDRAL, packed(two)}}) {
    SCOPED_TRACE(static_cast<int>(encoded.encoding));
    GivenView changed = plain;
    changed.normals = encoded.normals;
    const Results found =
        results(changed, 2, [&](AlcoveView& view) { view.normal_encoding = encoded.encoding; });
    EXPECT_LT(rms(found.visibility, expected.visibility), 2e-3);
    EXPECT_LT(rms(found.bent_normal, expected.bent_normal), 2e-3);
    EXPECT_LT(rms(found.specular, expected.specular), 2e-3);
  }
}

TEST_F(CInputs, NormalsOfACameraAlongPlusZAreMirroredOnInputAndBentNormalsOnOutput) {
  const GivenView plain = given();
  const Results expected = results(plain, 2, [](AlcoveView&) {});
  const auto mirrored = [](const HostImage& image) {
    return mapped(image, image.channels, [&](const float* from, float* to) {
      std::copy_n(from, image.channels, to);
      to[2] = -to[2];
    });
  };
  GivenView changed = plain;
  changed.normals = mirrored(plain.normals);
  const Results found =
      results(changed, 2, [](AlcoveView& view) { view.normals_forward_z = VK_TRUE; });
  EXPECT_LT(rms(found.visibility, expected.visibility), 1e-5);
  EXPECT_LT(rms(mirrored(found.bent_normal), expected.bent_normal), 1e-5);
  EXPECT_LT(rms(found.specular, expected.specular), 1e-5);
}

TEST_F(CInputs, MotionVectorsInAnyUnitAndSignConventionGiveTheSameImages) {
  // All planes face the eye, so that the history has the same depth everywhere. If motion vectors
  // were misread, history from the wrong place would therefore be used, and the images would
  // differ.
  GivenView moving = given_view(test_views()[2], kWidth, kHeight, step(0.31, 0.6));
  moving.settings.bent_normal = true;
  moving.settings.advanced.estimator = Estimator::horizons;
  moving.settings.radius = 1.5f;
  moving.motion = {kWidth, kHeight, {}, 2};
  for (std::uint32_t i = 0; i < kWidth * kHeight; ++i)
    moving.motion.texels.insert(moving.motion.texels.end(), {0.05f, -0.025f});
  const Results expected = results(moving, 3, [](AlcoveView&) {});
  const auto with = [&](float scale_x, float scale_y, float x, float y) {
    GivenView changed = moving;
    changed.motion = mapped(moving.motion, 2, [&](const float* from, float* to) {
      to[0] = (from[0] - x) / scale_x;
      to[1] = (from[1] - y) / scale_y;
    });
    return results(changed, 3, [&](AlcoveView& view) {
      view.motion_scale[0] = scale_x;
      view.motion_scale[1] = scale_y;
      view.motion_offset[0] = x;
      view.motion_offset[1] = y;
    });
  };
  // The four conventions are: motion in pixels; motion from this frame to the last one instead of
  // the reverse; motion without the jitter of the camera; and motion in normalised device
  // coordinates with y up.
  for (const Results& found :
       {with(1.0f / kWidth, 1.0f / kHeight, 0.0f, 0.0f), with(-1.0f, -1.0f, 0.0f, 0.0f),
        with(1.0f, 1.0f, 0.004f, -0.006f), with(0.5f, -0.5f, 0.0f, 0.0f)}) {
    EXPECT_LT(rms(found.visibility, expected.visibility), 1e-5);
    EXPECT_LT(rms(found.bent_normal, expected.bent_normal), 1e-5);
  }
  const Results wrong = results(
      moving, 3, [](AlcoveView& view) { view.motion_scale[0] = view.motion_scale[1] = -1.0f; });
  EXPECT_GT(rms(wrong.visibility, expected.visibility), 1e-3) << "the sign makes no difference";
}

TEST_F(CInputs, PowerAndIntensityChangeOnlyTheWrittenVisibility) {
  GivenView plain = given();
  plain.settings.specular = Specular::slices;
  const Results open = results(plain, 3, [](AlcoveView&) {});
  plain.settings.power = 2.0f;
  plain.settings.intensity = 0.75f;
  const Results shaped = results(plain, 3, [](AlcoveView&) {});
  for (std::size_t i = 0; i < open.visibility.texels.size(); ++i) {
    const double v = open.visibility.texels[i];
    ASSERT_NEAR(shaped.visibility.texels[i], 1.0 - 0.75 * (1.0 - v * v), 1e-5);
  }
  EXPECT_EQ(shaped.bent_normal.texels, open.bent_normal.texels);
  EXPECT_EQ(shaped.specular.texels, open.specular.texels);
}

TEST_F(CInputs, UnknownNormalEncodingAndZeroScaleOfMotionVectorsAreReported) {
  GivenView plain = given();
  plain.motion = {kWidth, kHeight, std::vector<float>(std::size_t{2} * kWidth * kHeight, 0.0f), 2};
  const Context context = create_context();
  AlcoveSettings settings{};
  const auto error_of = [&](const std::function<void(AlcoveView&)>& spoil) {
    AlcoveView view = view_of(plain, settings);
    spoil(view);
    const AlcoveFrame frame{.struct_size = sizeof frame, .view_count = 1, .views = &view};
    EXPECT_EQ(alcovePrepareFrame(context.get(), &frame), ALCOVE_ERROR_INVALID_INPUT);
    return std::string(alcoveGetMessage(context.get()));
  };
  EXPECT_THAT(error_of([](AlcoveView& view) {
                const std::uint32_t number = 4;
                std::memcpy(&view.normal_encoding, &number, sizeof number);
              }),
              testing::HasSubstr("normal_encoding is 4"));
  EXPECT_THAT(error_of([](AlcoveView& view) { view.motion_scale[0] = 1.0f; }),
              testing::HasSubstr("scale of motion vectors is 0"));
}

}  // namespace
}  // namespace alcove::passes
