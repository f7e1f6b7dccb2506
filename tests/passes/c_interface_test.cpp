// Frames by the C interface have the same results as those by the C++ functions, bit for bit.
#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "c_interface_fixture.h"
#include "c_program.h"

namespace alcove::passes {
namespace {

// Returns the view of frame `frame` of a moving camera. The history is reset in frame `cut`.
HostView moving_view(std::uint32_t frame, std::uint32_t width, std::uint32_t height,
                     std::uint32_t cut = ~0u) {
  HostView view = draw_view(width, height);
  view.view.view_from_world[12] = 0.03f * static_cast<float>(frame);
  view.previous_view.view_from_world[12] = 0.03f * static_cast<float>(frame == 0 ? 0 : frame - 1);
  view.reset = frame == cut;
  view.motion = {};
  return view;
}

TEST_F(CInterface, EverySettingHasTheSameEffectAsInTheCppInterface) {
  struct Case {
    const char* name;
    void (*change)(HostView& view, OcclusionSettings& settings);
    std::uint32_t frames = 1;
  };
  using V = HostView;
  using S = OcclusionSettings;
  const Case cases[] = {
      {"all outputs", [](V& v, S&) { request_all_outputs(v); }, 3},
      {"one pixel", [](V& v, S&) { v = moving_view(0, 1, 1, 0); }},
      {"quality low", [](V&, S& s) { s = quality_settings(Quality::low, 0.4f); }},
      {"quality high", [](V&, S& s) { s = quality_settings(Quality::high, 0.4f); }},
      {"quality reference",
       [](V& v, S&) {
         v = moving_view(0, 6, 4, 0);
         v.settings = quality_settings(Quality::reference, 0.5f);
       }},
      {"static",
       [](V& v, S& s) {
         v.view = v.previous_view = draw_view(1, 1).view;
         s = quality_settings(Quality::low, 0.4f);
       },
       20},
      {"bent normals alone",
       [](V&, S& s) {
         s.visibility = false;
         s.bent_normal = true;
       },
       2},
      {"specular occlusion alone",
       [](V&, S& s) {
         s.visibility = false;
         s.specular = Specular::slices;
       },
       2},
      {"multi-bounce alone",
       [](V& v, S& s) {
         s.visibility = false;
         v.multi_bounce = true;
       },
       2},
      {"bytes", [](V&, S& s) { s.precision = Precision::unorm8; }},
      {"horizons", [](V&, S& s) { s.estimator = Estimator::horizons; }},
      {"thickness by back faces", [](V&, S& s) { s.thickness_unit = ThicknessUnit::back_faces; }},
      {"depth copied from 16 bits", [](V& v, S&) { v.depth_format = VK_FORMAT_D16_UNORM; }},
      {"two layers", [](V&, S& s) { s.depth_layers = 2; }},
      {"slices and steps",
       [](V&, S& s) {
         s.slices = 3;
         s.steps = 5;
       }},
      {"no history", [](V&, S& s) { s.history_frames = 0; }},
      {"static noise",
       [](V&, S& s) {
         s.history_frames = 0;
         s.static_noise = true;
       },
       2},
      {"history", [](V&, S& s) { s.history_frames = 2; }, 2},
      {"motion", [](V& v, S&) { v.motion = draw_view(16, 12).motion; }, 2},
      {"normals from depth", [](V& v, S&) { v.normals = {}; }},
      {"normals in world space", [](V& v, S&) { v.normals_in_view_space = false; }},
      {"table",
       [](V&, S& s) {
         s.specular = Specular::table;
         s.bent_normal = true;
       }},
      {"table, one roughness",
       [](V& v, S& s) {
         s.specular = Specular::table;
         s.roughness = 0.2f;
         v.roughness = {};
       }},
      {"power and intensity",
       [](V&, S& s) {
         s.power = 2.0f;
         s.intensity = 0.5f;
       }},
      {"roughness of another channel",
       [](V&, S& s) {
         s.specular = Specular::slices;
         s.roughness_channel = 0;
       }},
  };
  std::uint32_t index = 0;
  for (const Case& each : cases) {
    SCOPED_TRACE(each.name);
    for (std::uint32_t frame = 0; frame < each.frames; ++frame, ++index) {
      HostView view = moving_view(frame, 16, 12, 0);
      view.static_frames = each.frames > 3 ? frame : 0;
      view.reset = view.reset || frame == 18;
      each.change(view, view.settings);
      expect_same_both_ways(context(), {&view, 1}, index);
    }
  }
}

TEST_F(CInterface, ViewsRecordedInOneFrameEqualViewsRecordedInSeparateFrames) {
  for (std::uint32_t i = 0; i < 4; ++i) {
    std::vector<HostView> views(3, moving_view(i, 16, 12));
    views[0].id = 4000000000u;
    views[1] = draw_view(9, 20, groove(0.8), test_views()[0]);
    views[1].id = 7;
    views[1].settings.bent_normal = true;
    views[2].id = 0;
    views[2].settings.history_frames = 0;
    views[2].reset = i == 2;
    if (i == 2) views.erase(views.begin());  // a view that is not recorded keeps its history
    expect_same_both_ways(context(), views, i);
  }
}

// The world of a left-handed engine is the mirror image of a right-handed one. If positions,
// normals and the view matrix are all mirrored, the image must be the same.
TEST_F(CInterface, MirroringTheWorldAndItsCameraGivesTheSameImage) {
  const auto mirror = [](HostImage& image) {
    for (std::size_t i = 2; i < image.texels.size(); i += image.channels)
      image.texels[i] = -image.texels[i];
  };
  for (std::uint32_t i = 0; i < 3; ++i) {
    std::vector<HostView> views(2, moving_view(i, 16, 12));
    for (HostView& view : views) {
      view.normals_in_view_space = false;
      view.settings.bent_normal = true;
    }
    views[1].id = 1;
    views[1].view.view_from_world[10] = -1.0f;
    views[1].previous_view.view_from_world[10] = -1.0f;
    mirror(views[1].normals);
    std::vector<Results> found = run_by_c(context(), views, i);
    mirror(found[1].bent_normal);
    expect_equal(found[1], found[0]);
  }
}

TEST_F(CInterface, EightViewsWithAllInputsAndOutputsCanBeRecordedInOneFrame) {
  shares_inputs_ = false;
  std::vector<HostView> views;
  for (std::uint32_t id = 0; id < ALCOVE_MAX_VIEWS; ++id) {
    HostView& view = views.emplace_back(draw_view(8, 6, groove(0.8)));
    view.id = id;
    request_all_outputs(view);
    view.settings.thickness_unit = ThicknessUnit::back_faces;
    view.settings.depth_layers = 2;
    if (id % 2 == 1) {
      view.normals = {};  // a pass more, an image less
      view.settings.specular = Specular::table;
    }
  }
  expect_same_both_ways(context(), views, 0);
}

// In the middle of a sequence, frames with other settings, outputs or sizes are discarded, because
// an engine does not submit them, or refused as invalid. The next frame must equal that of the C++
// functions, which were never given the frames in between.
TEST_F(CInterface, DiscardedOrRefusedFrameWithOtherSettingsDoesNotChangeTheHistory) {
  struct Case {
    const char* name;
    void (*change)(HostView&);
  };
  const Case cases[] = {
      {"size", [](HostView& view) { view = moving_view(0, 21, 40); }},
      {"largest size",
       [](HostView& view) {
         view.largest_size = {64, 64};
       }},
      {"no bent normals", [](HostView& view) { view.settings.bent_normal = false; }},
      {"a lobe", [](HostView& view) { view.settings.specular = Specular::slices; }},
      {"no history", [](HostView& view) { view.settings.history_frames = 0; }},
      {"a cut", [](HostView& view) { view.reset = true; }},
  };
  const Context context = create_context();
  EXPECT_EQ(alcoveDiscardFrame(context.get()), ALCOVE_SUCCESS) << "before there is one";
  std::uint32_t index = 0;
  const auto next_view = [&](std::uint32_t id) {
    HostView view = moving_view(index, 33, 17);
    view.id = id;
    view.settings.bent_normal = true;
    return view;
  };
  const auto run_good_frame = [&](std::uint32_t id) {
    const HostView view = next_view(id);
    expect_same_both_ways(*context, {&view, 1}, index++);
  };
  for (std::uint32_t id = 0; id < std::size(cases); ++id) {
    SCOPED_TRACE(cases[id].name);
    run_good_frame(id);
    run_good_frame(id);
    HostView changed = next_view(id);
    cases[id].change(changed);
    changed.id = id;
    std::array<AlcoveView, 2> views{create_view(changed)};
    for (int i = 0; i < 2; ++i) discard_frame(*context, std::span(views).first(1), index);
    std::uint32_t count = 99;
    EXPECT_EQ(alcoveGetTimings(context.get(), index % Engine::kSlots, &count, nullptr),
              ALCOVE_SUCCESS);
    EXPECT_EQ(count, 0u);
    run_good_frame(id);
    // A frame whose first view is valid and whose second view is not is refused as a whole.
    views[1] = views[0];
    views[1].id = 99;
    views[1].depth = {};
    EXPECT_EQ(record(*context, make_frame(views, index)), ALCOVE_ERROR_INVALID_INPUT);
    EXPECT_EQ(alcoveDiscardFrame(context.get()), ALCOVE_SUCCESS) << "of the frame that was refused";
    run_good_frame(id);
  }
}

TEST_F(CInterface, ProgramCompiledAsCRecordsTheSameFrameAsTheCppInterface) {
  const AlcoveContextInfo info = engine().context_info();
  HostView from = moving_view(0, 16, 12);
  from.settings = quality_settings(Quality::high, 0.5f);
  from.settings.estimator = Estimator::horizons;
  from.normals = {};
  from.roughness = {};
  const AlcoveView view = create_view(from);
  AlcoveContext* handle = nullptr;
  char text[ALCOVE_MAX_MESSAGE] = "";
  engine().submit(0, [&](VkCommandBuffer commands) {
    EXPECT_EQ(run_c_program(&info, &view.camera, &view.depth, &view.visibility, commands, &handle,
                            text, sizeof text),
              ALCOVE_SUCCESS)
        << text;
  });
  const Context context(handle);
  EXPECT_NE(std::strstr(text, "bytes of transients"), nullptr) << text;
  engine().wait();
  expect_equal(read_results(view), run_by_cpp(from, 0));
}

}  // namespace
}  // namespace alcove::passes
