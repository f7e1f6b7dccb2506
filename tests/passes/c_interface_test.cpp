// Frames by the C interface have the same results as those by the C++ functions, bit for bit.
#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "c_interface_fixture.h"
#include "c_program.h"
#include "gtao_scenes.h"

namespace alcove::passes {
namespace {

TestView moved(TestView view, std::uint32_t frame) {
  view.view.view_from_world[12] = 0.03f * static_cast<float>(frame);
  return view;
}

// Returns the inputs of frame number `frame` of a moving camera. The history is reset in frame
// `cut`.
GivenView frame_of(std::uint32_t frame, std::uint32_t width, std::uint32_t height,
                   std::uint32_t cut = ~0u) {
  GivenView given = given_view(moved(test_views()[2], frame), width, height, ball_on_floor());
  given.previous_view = moved(test_views()[2], frame == 0 ? 0 : frame - 1).view;
  given.reset = frame == cut;
  given.motion = {};
  return given;
}

TEST_F(CInterface, FramesWithHistoryEqualThoseRecordedByTheCppInterface) {
  const Context context = create_context();
  for (std::uint32_t i = 0; i < 5; ++i) {
    GivenView given = frame_of(i, 33, 17, 3);
    given.settings.bent_normal = true;
    given.settings.specular = Specular::slices;
    given.multi_bounce = true;
    expect_same_both_ways(*context, {&given, 1}, i);
  }
}

TEST_F(CInterface, FramesOfAStaticViewEqualThoseRecordedByTheCppInterface) {
  const Context context = create_context();
  for (std::uint32_t i = 0; i < 20; ++i) {
    GivenView given = frame_of(0, 33, 17);
    given.settings = quality_settings(Quality::low, 0.4f);
    given.static_frames = i;
    given.reset = i == 18;
    expect_same_both_ways(*context, {&given, 1}, i);
  }
}

TEST_F(CInterface, EverySettingHasTheSameEffectAsInTheCppInterface) {
  struct Case {
    const char* name;
    void (*change)(GivenView&);
    std::uint32_t frames = 1;
  };
  const Case cases[] = {
      {"quality low", [](GivenView& g) { g.settings = quality_settings(Quality::low, 0.4f); }},
      {"quality high", [](GivenView& g) { g.settings = quality_settings(Quality::high, 0.4f); }},
      {"bytes", [](GivenView& g) { g.settings.precision = Precision::unorm8; }},
      {"horizons with falloff",
       [](GivenView& g) {
         g.settings.advanced.estimator = Estimator::horizons;
         g.settings.advanced.falloff = 0.5f;
       }},
      {"bitmask",
       [](GivenView& g) {
         g.settings.advanced.estimator = Estimator::bitmask;
         g.settings.thickness = 0.05f;
         g.settings.hidden_occlusion = 0.9f;
       }},
      {"thickness by distance",
       [](GivenView& g) { g.settings.advanced.thickness_unit = ThicknessUnit::distance; }},
      {"thickness by back faces",
       [](GivenView& g) { g.settings.advanced.thickness_unit = ThicknessUnit::back_faces; }},
      {"depth copied from 16 bits", [](GivenView& g) { g.depth_format = VK_FORMAT_D16_UNORM; }},
      {"two layers", [](GivenView& g) { g.settings.depth_layers = 2; }},
      {"slices and steps",
       [](GivenView& g) {
         g.settings.slices = 3;
         g.settings.steps = 5;
       }},
      {"filter",
       [](GivenView& g) {
         g.settings.advanced.filter_radius = 1;
         g.settings.advanced.filter_tolerance_px = 0.5f;
         g.settings.history_frames = 0;
       }},
      {"static noise",
       [](GivenView& g) {
         g.settings.history_frames = 0;
         g.settings.static_noise = true;
       },
       2},
      {"history",
       [](GivenView& g) {
         g.settings.history_frames = 2;
         g.settings.advanced.clamp_width = 1.0f;
       },
       2},
      {"motion", [](GivenView& g) { g.motion = given_view(test_views()[2], 16, 12, {}).motion; },
       2},
      {"normals from depth", [](GivenView& g) { g.normals = {}; }},
      {"normals in world space", [](GivenView& g) { g.normals_in_view_space = false; }},
      {"table",
       [](GivenView& g) {
         g.settings.specular = Specular::table;
         g.settings.bent_normal = true;
       }},
      {"cone, one roughness",
       [](GivenView& g) {
         g.settings.specular = Specular::cone;
         g.settings.roughness = 0.2f;
         g.roughness = {};
       }},
      {"parts of the search",
       [](GivenView& g) {
         g.settings.advanced.snap_to_texels = false;
         g.settings.advanced.extrapolation = false;
         g.settings.advanced.unobserved = false;
       }},
      {"power and intensity",
       [](GivenView& g) {
         g.settings.power = 2.0f;
         g.settings.intensity = 0.5f;
       }},
      {"roughness of another channel",
       [](GivenView& g) {
         g.settings.specular = Specular::slices;
         g.settings.roughness_channel = 0;
       }},
  };
  const Context context = create_context();
  std::uint32_t index = 0;
  for (const Case& each : cases) {
    SCOPED_TRACE(each.name);
    for (std::uint32_t frame = 0; frame < each.frames; ++frame, ++index) {
      GivenView given = frame_of(frame, 16, 12, 0);
      each.change(given);
      expect_same_both_ways(*context, {&given, 1}, index);
    }
  }
}

TEST_F(CInterface, EachOutputRequestedAloneEqualsThatRecordedByTheCppInterface) {
  const std::array<void (*)(GivenView&), 4> only{
      [](GivenView& g) { g.settings.visibility = true; },
      [](GivenView& g) { g.settings.bent_normal = true; },
      [](GivenView& g) { g.settings.specular = Specular::slices; },
      [](GivenView& g) { g.multi_bounce = true; }};
  const Context context = create_context();
  for (std::uint32_t i = 0; i < only.size(); ++i) {
    SCOPED_TRACE(i);
    for (std::uint32_t frame = 0; frame < 2; ++frame) {
      GivenView given = frame_of(frame, 16, 12);
      given.id = i;
      given.settings.visibility = false;
      only.at(i)(given);
      expect_same_both_ways(*context, {&given, 1}, frame);
    }
  }
}

TEST_F(CInterface, ImagesOfAnySizeEqualThoseRecordedByTheCppInterface) {
  const Context context = create_context();
  const std::pair<std::uint32_t, std::uint32_t> sizes[] = {{1, 1}, {1, 7}, {5, 1}, {3, 2}, {31, 9}};
  std::uint32_t index = 0;
  for (const auto& [width, height] : sizes) {
    for (std::uint32_t frame = 0; frame < 2; ++frame, ++index) {
      GivenView given = frame_of(frame, width, height);
      given.settings.bent_normal = true;
      expect_same_both_ways(*context, {&given, 1}, index);
    }
  }
}

TEST_F(CInterface, ViewsRecordedInOneFrameEqualViewsRecordedInSeparateFrames) {
  const Context context = create_context();
  for (std::uint32_t i = 0; i < 4; ++i) {
    std::vector<GivenView> views(3, frame_of(i, 16, 12));
    views[0].id = 4000000000u;
    views[1] = given_view(test_views()[0], 9, 20, groove(0.8));
    views[1].id = 7;
    views[1].settings.bent_normal = true;
    views[2].id = 0;
    views[2].settings.history_frames = 0;
    views[2].reset = i == 2;
    if (i == 2) views.erase(views.begin());  // a view that is not recorded keeps its history
    expect_same_both_ways(*context, views, i);
  }
}

// The world of a left-handed engine is the mirror image of a right-handed one. If positions,
// normals and the view matrix are all mirrored, the image must be the same.
TEST_F(CInterface, MirroringTheWorldAndItsCameraGivesTheSameImage) {
  const Context context = create_context();
  const auto mirror = [](HostImage& image) {
    for (std::size_t i = 2; i < image.texels.size(); i += image.channels)
      image.texels[i] = -image.texels[i];
  };
  for (std::uint32_t i = 0; i < 3; ++i) {
    std::vector<GivenView> views(2, frame_of(i, 16, 12));
    for (GivenView& view : views) {
      view.normals_in_view_space = false;
      view.settings.bent_normal = true;
    }
    views[1].id = 1;
    views[1].view.view_from_world[10] = -1.0f;
    views[1].previous_view.view_from_world[10] = -1.0f;
    mirror(views[1].normals);
    std::vector<Results> found = run_by_c(*context, views, i);
    mirror(found[1].bent_normal);
    expect_equal(found[1], found[0]);
  }
}

TEST_F(CInterface, EightViewsWithAllOutputsCanBeRecordedInOneFrame) {
  const Context context = create_context();
  std::vector<GivenView> views;
  for (std::uint32_t id = 0; id < ALCOVE_MAX_VIEWS; ++id) {
    views.push_back(frame_of(id, 8, 6));
    views.back().id = id;
    views.back().motion = given_view(test_views()[2], 8, 6, {}).motion;
    if (id % 2 == 1) views.back().normals = {};  // a pass more, an image less
    views.back().settings.advanced.thickness_unit = ThicknessUnit::back_faces;
    views.back().settings.depth_layers = 2;
    views.back().settings.bent_normal = true;
    views.back().settings.specular = Specular::table;
    views.back().multi_bounce = true;
  }
  expect_same_both_ways(*context, views, 0);
}

TEST_F(CInterface, EightViewsWithAllInputsAndOutputsCanBeRecordedInOneFrame) {
  const Context context = create_context();
  std::vector<GivenView> views;
  for (std::uint32_t id = 0; id < ALCOVE_MAX_VIEWS; ++id) {
    views.push_back(given_view(test_views()[2], 8, 6, groove(0.8)));
    views.back().id = id;
    views.back().settings.bent_normal = true;
    views.back().settings.specular = Specular::slices;
    views.back().multi_bounce = true;
  }
  expect_same_both_ways(*context, views, 0);
}

// Visibility is an output that the library itself reads to make other outputs, and that the engine
// reads after the frame. The next frame writes the same image while the previous one is still in
// flight; synchronisation validation reports an error if it does not wait.
TEST_F(CInterface, FramesInFlightMayWriteTheSameImagesWithoutAHazard) {
  const Context context = create_context();
  GivenView given = frame_of(0, 33, 17);
  given.settings.bent_normal = true;
  given.settings.specular = Specular::table;
  given.multi_bounce = true;
  AlcoveSettings settings;
  const AlcoveView view = view_of(given, settings);
  for (std::uint32_t i = 0; i < 6; ++i) run_frame(*context, {&view, 1}, i);
  engine().wait();
}

// An engine discards a frame that it recorded and does not submit, for example because the window
// was closed.
TEST_F(CInterface, FrameDiscardedBeforeSubmissionDoesNotAffectLaterFrames) {
  const Context context = create_context();
  EXPECT_EQ(alcoveDiscardFrame(context.get()), ALCOVE_SUCCESS) << "before there is one";
  std::uint32_t index = 0;
  for (const bool discarded : {true, false, false, true, true, false}) {
    GivenView given = frame_of(index, 33, 17);
    given.settings.bent_normal = discarded;  // another plan
    if (discarded) {
      AlcoveSettings settings;
      const AlcoveView view = view_of(given, settings);
      record_and_throw_away(*context, view, index);
      EXPECT_EQ(alcoveDiscardFrame(context.get()), ALCOVE_SUCCESS);
      std::uint32_t count = 99;
      EXPECT_EQ(alcoveGetTimings(context.get(), 0, &count, nullptr), ALCOVE_SUCCESS);
      EXPECT_EQ(count, 0u);
      continue;
    }
    expect_same_both_ways(*context, {&given, 1}, index);
    EXPECT_EQ(alcoveRecordFrame(context.get(), VK_NULL_HANDLE, nullptr),
              ALCOVE_ERROR_INVALID_INPUT);
    EXPECT_EQ(alcoveDiscardFrame(context.get()), ALCOVE_SUCCESS) << "of the frame that was refused";
    ++index;
  }
}

// In the middle of a sequence, one frame is recorded with other settings, outputs or sizes, and
// then discarded, or refused as invalid. The next frame must equal that of the C++ functions, which
// were never given the frame in between.
TEST_F(CInterface, DiscardedOrRefusedFrameWithOtherSettingsDoesNotChangeTheHistory) {
  struct Case {
    const char* name;
    void (*change)(GivenView&);
  };
  const Case cases[] = {
      {"size", [](GivenView& g) { g = frame_of(0, 21, 40); }},
      {"largest size",
       [](GivenView& g) {
         g.largest_size = {64, 64};
       }},
      {"no bent normals", [](GivenView& g) { g.settings.bent_normal = false; }},
      {"a lobe", [](GivenView& g) { g.settings.specular = Specular::slices; }},
      {"no history", [](GivenView& g) { g.settings.history_frames = 0; }},
      {"a cut", [](GivenView& g) { g.reset = true; }},
  };
  const Context context = create_context();
  std::uint32_t index = 0;
  const auto good_frame = [&](std::uint32_t id) {
    GivenView given = frame_of(index, 33, 17);
    given.id = id;
    given.settings.bent_normal = true;
    expect_same_both_ways(*context, {&given, 1}, index++);
  };
  for (std::uint32_t id = 0; id < std::size(cases); ++id) {
    SCOPED_TRACE(cases[id].name);
    good_frame(id);
    good_frame(id);
    GivenView given = frame_of(index, 33, 17);
    given.settings.bent_normal = true;
    cases[id].change(given);
    given.id = id;
    AlcoveSettings settings;
    const AlcoveView view = view_of(given, settings);
    record_and_throw_away(*context, view, index);
    EXPECT_EQ(alcoveDiscardFrame(context.get()), ALCOVE_SUCCESS);
    good_frame(id);
    // A frame whose first view is valid and whose second view is not is refused as a whole.
    std::array<AlcoveView, 2> views{view, view};
    views[1].id = 99;
    views[1].depth = {};
    const AlcoveFrame frame{
        .struct_size = sizeof frame, .index = index, .view_count = 2, .views = views.data()};
    engine().submit(0, [&](VkCommandBuffer commands) {
      EXPECT_EQ(alcoveRecordFrame(context.get(), commands, &frame), ALCOVE_ERROR_INVALID_INPUT);
    });
    good_frame(id);
  }
}

TEST_F(CInterface, ImageOfReferenceQualityEqualsThatRecordedByTheCppInterface) {
  const Context context = create_context();
  GivenView given = frame_of(0, 6, 4);
  given.settings = quality_settings(Quality::reference, 0.5f);
  expect_same_both_ways(*context, {&given, 1}, 0);
}

TEST_F(CInterface, ProgramCompiledAsCRecordsTheSameFrameAsTheCppInterface) {
  const AlcoveContextInfo info = engine().context_info();
  GivenView given = frame_of(0, 16, 12);
  given.settings = quality_settings(Quality::high, 0.5f);
  given.settings.advanced.estimator = Estimator::horizons;
  given.normals = {};
  given.roughness = {};
  AlcoveSettings unused;
  AlcoveView view = view_of(given, unused);
  AlcoveContext* made = nullptr;
  char text[ALCOVE_MAX_MESSAGE] = "";
  engine().submit(0, [&](VkCommandBuffer commands) {
    EXPECT_EQ(run_c_program(&info, &view.camera, &view.depth, &view.visibility, commands, &made,
                            text, sizeof text),
              ALCOVE_SUCCESS)
        << text;
  });
  const Context context(made);
  EXPECT_NE(std::strstr(text, "bytes of transients"), nullptr) << text;
  expect_equal(results_of(view), run_by_cpp(given, 0));
  engine().wait();
}

}  // namespace
}  // namespace alcove::passes
