// Compares the memory that alcoveEstimateMemory returns for settings and a size with the memory
// that recorded frames take.
#include <gtest/gtest.h>

#include <vector>

#include "c/settings.h"
#include "c_interface_fixture.h"
#include "gtao_scenes.h"

namespace alcove::passes {
namespace {

class CMemory : public CInterface {};

TEST_F(CMemory, EstimatedMemoryIsWithinFivePercentOfThatOfRecordedFrames) {
  constexpr std::uint32_t kWidth = 256, kHeight = 128;
  struct Case {
    const char* name;
    std::uint32_t outputs;
    Specular specular;
    std::uint32_t inputs;
    Quality quality;
    bool half_resolution = false;
    bool history = true;
  };
  constexpr std::uint32_t kAll =
      ALCOVE_OUTPUT_VISIBILITY | ALCOVE_OUTPUT_BENT_NORMAL | ALCOVE_OUTPUT_SPECULAR;
  constexpr std::uint32_t kNormals = ALCOVE_INPUT_NORMALS;
  for (const Case& wanted :
       {Case{"visibility", ALCOVE_OUTPUT_VISIBILITY, Specular::none, kNormals, Quality::medium},
        Case{"from depth", ALCOVE_OUTPUT_VISIBILITY, Specular::none, 0, Quality::low},
        Case{"bent", ALCOVE_OUTPUT_VISIBILITY | ALCOVE_OUTPUT_BENT_NORMAL, Specular::none, kNormals,
             Quality::medium},
        Case{"all", kAll, Specular::slices, kNormals, Quality::low},
        Case{"by cone", ALCOVE_OUTPUT_SPECULAR, Specular::cone, kNormals, Quality::low},
        Case{"half resolution", kAll, Specular::slices, kNormals, Quality::medium, true},
        Case{"console", ALCOVE_OUTPUT_VISIBILITY, Specular::none, kNormals, Quality::console, true},
        Case{"half resolution without history", kAll, Specular::slices, kNormals, Quality::medium,
             true, false},
        Case{"without history", ALCOVE_OUTPUT_VISIBILITY, Specular::none, kNormals,
             Quality::reference},
        Case{"mask", ALCOVE_OUTPUT_VISIBILITY, Specular::none, kNormals | ALCOVE_INPUT_MASK,
             Quality::low},
        Case{"samples", ALCOVE_OUTPUT_VISIBILITY, Specular::none, ALCOVE_INPUT_SAMPLES,
             Quality::low},
        Case{"mask, samples and cone", ALCOVE_OUTPUT_SPECULAR, Specular::cone,
             ALCOVE_INPUT_MASK | ALCOVE_INPUT_SAMPLES, Quality::low}}) {
    SCOPED_TRACE(wanted.name);
    GivenView given = given_view(test_views()[2], kWidth, kHeight, {tilted_plane(20.0, 4.0)});
    given.settings = quality_settings(wanted.quality, 0.5f);
    given.settings.half_resolution = wanted.half_resolution;
    given.settings.history_frames = wanted.history ? given.settings.history_frames : 0;
    given.settings.slices = 1;
    given.settings.steps = 4;
    given.settings.visibility = (wanted.outputs & ALCOVE_OUTPUT_VISIBILITY) != 0;
    given.settings.bent_normal = (wanted.outputs & ALCOVE_OUTPUT_BENT_NORMAL) != 0;
    given.settings.specular = wanted.specular;
    given.motion = given.back_depth_ndc = given.second_depth_ndc = {};
    if ((wanted.inputs & ALCOVE_INPUT_NORMALS) == 0) given.normals = {};
    AlcoveSettings settings;
    AlcoveView view = view_of(given, settings);
    if ((wanted.inputs & ALCOVE_INPUT_MASK) != 0) {
      view.mask =
          engine().make_image(VK_FORMAT_R8_UINT, kWidth, kHeight, VK_IMAGE_USAGE_SAMPLED_BIT);
      view.not_occluding = 1;
    }
    if ((wanted.inputs & ALCOVE_INPUT_SAMPLES) != 0) {
      view.depth = engine().make_image(
          VK_FORMAT_D32_SFLOAT, kWidth, kHeight,
          VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, 1,
          VK_SAMPLE_COUNT_4_BIT);
      view.depth.samples = 4;
    }
    const Context context = create_context();
    run_frame(*context, {&view, 1}, 0);
    engine().wait();
    const AlcoveMemory found = memory_of(*context);
    AlcoveMemory estimate{.struct_size = sizeof estimate};
    ASSERT_EQ(
        alcoveEstimateMemory(&settings, kWidth, kHeight, wanted.outputs, wanted.inputs, &estimate),
        ALCOVE_SUCCESS);
    const auto about = [](std::uint64_t bytes) { return static_cast<double>(bytes); };
    EXPECT_NEAR(about(found.history), about(estimate.history), 0.05 * about(estimate.history));
    EXPECT_NEAR(about(found.transients_unshared), about(estimate.transients_unshared),
                0.05 * about(estimate.transients_unshared));
    EXPECT_LE(found.transients, estimate.transients + estimate.transients / 20);
  }
}

TEST_F(CMemory, InvalidArgumentsOfTheMemoryEstimateAreErrors) {
  AlcoveSettings settings{.struct_size = sizeof settings};
  ASSERT_EQ(alcoveGetSettings(ALCOVE_QUALITY_MEDIUM, 1.0f, &settings), ALCOVE_SUCCESS);
  AlcoveMemory memory{.struct_size = sizeof memory};
  const auto result = [&](std::uint32_t width, std::uint32_t height, std::uint32_t outputs,
                          std::uint32_t inputs = ALCOVE_INPUT_NORMALS) {
    return alcoveEstimateMemory(&settings, width, height, outputs, inputs, &memory);
  };
  EXPECT_EQ(result(16, 16, 1), ALCOVE_SUCCESS);
  EXPECT_EQ(result(0, 16, 1), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(result(16, 70000, 1), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(result(16, 16, 0), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(result(16, 16, 16), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(result(16, 16, 1, 8), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcoveEstimateMemory(nullptr, 16, 16, 1, VK_TRUE, &memory), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcoveEstimateMemory(&settings, 16, 16, 1, VK_TRUE, nullptr),
            ALCOVE_ERROR_INVALID_INPUT);
}

}  // namespace
}  // namespace alcove::passes
