// Tests frames of several views, discarded frames, and a program in C.
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
    const std::vector<HostOutputs> outputs = run_views(context(), views, i);
    for (std::size_t view = 0; view < views.size(); ++view)
      expect_equal(outputs[view], run_plainly(views[view], i));
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
    std::vector<HostOutputs> outputs = run_views(context(), views, i);
    mirror(outputs[1].bent_normal);
    expect_equal(outputs[1], outputs[0]);
  }
}

TEST_F(CInterface, EightViewsWithAllInputsAndOutputsCanBeRecordedInOneFrame) {
  shares_inputs_ = false;
  std::vector<HostView> views;
  for (std::uint32_t id = 0; id < ALCOVE_MAX_VIEWS; ++id) {
    HostView& view = views.emplace_back(draw_view(8, 6, groove(0.8)));
    view.id = id;
    request_all_outputs(view);
    view.settings.thickness_limit = ALCOVE_THICKNESS_LIMIT_BACK_FACES;
    view.settings.depth_layers = 2;
    if (id % 2 == 1) {
      view.normals = {};  // a pass more, an image less
      view.settings.specular = ALCOVE_SPECULAR_TABLE;
    }
  }
  const std::vector<HostOutputs> outputs = run_views(context(), views, 0);
  for (std::size_t id = 0; id < views.size(); ++id)
    expect_equal(outputs[id], run_plainly(views[id], 0));
}

// In the middle of a sequence, frames with other settings, outputs or sizes are discarded, because
// an engine does not submit them, or refused as invalid. The next frame must equal that of a
// context that was never given the frames in between.
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
      {"a lobe", [](HostView& view) { view.settings.specular = ALCOVE_SPECULAR_SLICES; }},
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
    expect_equal(run_views(*context, {&view, 1}, index)[0], run_plainly(view, index));
    ++index;
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
    EXPECT_EQ(alcoveGetTimings(context.get(), index % TestEngine::kSlots, &count, nullptr),
              ALCOVE_SUCCESS);
    EXPECT_EQ(count, 0u);
    run_good_frame(id);
    // A frame whose first view is valid and whose second view is not is refused as a whole.
    views[1] = views[0];
    views[1].info.id = 99;
    views[1].images[ALCOVE_IMAGE_DEPTH] = {};
    EXPECT_EQ(record(*context, make_frame(views, index)), ALCOVE_ERROR_INVALID_INPUT);
    EXPECT_EQ(alcoveDiscardFrame(context.get()), ALCOVE_SUCCESS) << "of the frame that was refused";
    run_good_frame(id);
  }
}

TEST_F(CInterface, ProgramCompiledAsCRecordsTheSameFrame) {
  const AlcoveContextInfo info = engine().context_info();
  HostView from = moving_view(0, 16, 12);
  from.settings = OcclusionSettings(ALCOVE_QUALITY_HIGH, 0.5f);
  from.settings.estimator = ALCOVE_ESTIMATOR_HORIZONS;
  from.normals = {};
  from.roughness = {};
  const AlcoveView view = create_view(from);
  AlcoveContext* handle = nullptr;
  char text[ALCOVE_MAX_MESSAGE] = "";
  engine().submit(0, [&](VkCommandBuffer commands) {
    EXPECT_EQ(
        run_c_program(&info, &view.info.camera, &view.images[ALCOVE_IMAGE_DEPTH],
                      &view.images[ALCOVE_IMAGE_VISIBILITY], commands, &handle, text, sizeof text),
        ALCOVE_SUCCESS)
        << text;
  });
  const Context context(handle);
  EXPECT_NE(std::strstr(text, "bytes of transients"), nullptr) << text;
  engine().wait();
  expect_equal(read_results(view), run_plainly(from, 0));
}

}  // namespace
}  // namespace alcove::passes
