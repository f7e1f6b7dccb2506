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
    bool normals;
    Quality quality;
    bool half_resolution = false;
    bool history = true;
  };
  for (const Case& wanted :
       {Case{"visibility", ALCOVE_OUTPUT_VISIBILITY, Specular::none, true, Quality::medium},
        Case{"from depth", ALCOVE_OUTPUT_VISIBILITY, Specular::none, false, Quality::low},
        Case{"bent", ALCOVE_OUTPUT_VISIBILITY | ALCOVE_OUTPUT_BENT_NORMAL, Specular::none, true,
             Quality::medium},
        Case{"all", 7, Specular::slices, true, Quality::low},
        Case{"by cone", ALCOVE_OUTPUT_SPECULAR, Specular::cone, true, Quality::low},
        Case{"half resolution", 7, Specular::slices, true, Quality::medium, true},
        Case{"console", ALCOVE_OUTPUT_VISIBILITY, Specular::none, true, Quality::console, true},
        Case{"half resolution without history", 7, Specular::slices, true, Quality::medium, true,
             false},
        Case{"without history", ALCOVE_OUTPUT_VISIBILITY, Specular::none, true,
             Quality::reference}}) {
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
    if (!wanted.normals) given.normals = {};
    const Context context = create_context();
    (void)run_by_c(*context, {&given, 1}, 0);
    const AlcoveMemory found = memory_of(*context);
    AlcoveAdvancedSettings advanced;
    const AlcoveSettings settings = from_settings(given.settings, advanced);
    AlcoveMemory estimate{.struct_size = sizeof estimate};
    ASSERT_EQ(alcoveEstimateMemory(&settings, kWidth, kHeight, wanted.outputs,
                                   wanted.normals ? VK_TRUE : VK_FALSE, &estimate),
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
  const auto result = [&](std::uint32_t width, std::uint32_t height, std::uint32_t outputs) {
    return alcoveEstimateMemory(&settings, width, height, outputs, VK_TRUE, &memory);
  };
  EXPECT_EQ(result(16, 16, 1), ALCOVE_SUCCESS);
  EXPECT_EQ(result(0, 16, 1), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(result(16, 70000, 1), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(result(16, 16, 0), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(result(16, 16, 16), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcoveEstimateMemory(nullptr, 16, 16, 1, VK_TRUE, &memory), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcoveEstimateMemory(&settings, 16, 16, 1, VK_TRUE, nullptr),
            ALCOVE_ERROR_INVALID_INPUT);
}

}  // namespace
}  // namespace alcove::passes
