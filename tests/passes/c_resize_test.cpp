// Records frames whose sizes, settings, images and number of views change at random. The soak test
// sets ALCOVE_RESIZE_FRAMES, the number of frames.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <vector>

#include "c_interface_fixture.h"
#include "framegraph/failing_device.h"
#include "gtao_scenes.h"
#include "maths/random_input.h"

namespace alcove::passes {
namespace {

constexpr std::uint32_t kMostViews = 3;
constexpr std::uint32_t kMostSide = 40;
constexpr std::uint32_t kRound = 40;        // frames between two calls of CResize::rest()
constexpr std::uint32_t kProgress = 4'000;  // frames between two lines of progress

std::uint32_t wanted_frames() {
  const char* text = std::getenv("ALCOVE_RESIZE_FRAMES");
  return text != nullptr ? static_cast<std::uint32_t>(std::strtoul(text, nullptr, 10)) : kRound;
}

// Settings and optional images of a view. A round has only two kinds and two cameras, because each
// needs pipelines of its own, and a software device takes longer to create pipelines than to run
// frames.
struct Kind {
  OcclusionSettings settings;
  // The images that are not given: bit i stands for element i of kInputs or kOutputs.
  std::uint32_t without_inputs = 0;
  std::uint32_t without_outputs = 0;
};
constexpr std::uint32_t kOptionalInputs = 0b0001110;  // normals, motion, roughness

// A view that frames may show, with its images.
struct ViewState {
  std::uint32_t id = 0;
  bool is_shown = false;
  TestView camera;
  Scene scene;
  AlcoveView view{};  // with every image
  AlcoveSettings settings{};
  VkExtent2D largest{};  // of the images
  Kind kind;
};

// Returns the AlcoveView to record: `state.view` without the images that its kind leaves out.
AlcoveView recorded_view(const ViewState& state) {
  AlcoveView view = state.view;
  view.info.settings = &state.settings;
  for (std::size_t i = 0; i < kInputs.size(); ++i)
    if ((state.kind.without_inputs >> i & 1) != 0) view.images[kInputs.at(i).role] = {};
  for (std::size_t i = 0; i < kOutputs.size(); ++i)
    if ((state.kind.without_outputs >> i & 1) != 0) view.images[kOutputs.at(i).role] = {};
  return view;
}

class CResize : public CInterface {
 protected:
  void SetUp() override;
  void TearDown() override;

  void run_frames(std::uint32_t count);

 private:
  std::uint32_t below(std::uint32_t count) { return random_.bits() % count; }
  bool chance(std::uint32_t one_in) { return below(one_in) == 0; }

  Kind any_kind();
  void make_images(ViewState& state, VkExtent2D size);
  void destroy_images(ViewState& state);
  void use_part(ViewState& state, VkExtent2D size);
  void change_kind(ViewState& state);
  void change_numbers(ViewState& state);
  void show(ViewState& state);
  void drop(ViewState& state);
  void change(ViewState& state);
  void draw_frame(std::span<ViewState> all, bool discards);
  void choose_kinds();
  void run_round();
  AlcoveMemory rest();
  void expect_right(ViewState& state);

  maths_test::RandomInput random_;
  Context context_;
  std::array<Kind, 2> kinds_;
  std::array<TestView, 2> cameras_;
  std::array<ViewState, kMostViews> views_;
  std::array<ViewState, 1> resting_;
  std::uint32_t frame_ = 0;
  std::uint64_t most_transients_ = 0;
};

void CResize::SetUp() {
  CInterface::SetUp();
  framegraph::failing::fail_at(0);
  framegraph::failing::lose(false);
  shares_inputs_ = false;
  AlcoveContextInfo info = engine().context_info();
  info.get_instance_proc_addr = framegraph::failing::get_instance_proc_addr;
  info.debug_utils = VK_TRUE;
  context_ = create_context(info);
  choose_kinds();
  for (std::uint32_t i = 0; i < kMostViews; ++i) views_.at(i).id = i;
  resting_[0].id = kMostViews;
  make_images(resting_[0], {16, 12});
}

void CResize::TearDown() {
  if (context_) {
    engine().wait();
    context_.reset();
    EXPECT_EQ(framegraph::failing::alive(), 0);
  }
  CInterface::TearDown();
}

Kind CResize::any_kind() {
  OcclusionSettings settings(static_cast<AlcoveQuality>(below(3)));
  settings.estimator = static_cast<AlcoveEstimator>(below(2));
  settings.thickness_limit = static_cast<AlcoveThicknessLimit>(below(2));
  settings.depth_layers = 1 + below(2);
  settings.specular = static_cast<AlcoveSpecular>(1 + below(2));
  settings.roughness_channel = below(2);
  return {settings, below(128) & kOptionalInputs, below(15)};  // never without all outputs
}

// Makes new images of `size` pixels that are used completely, with another random camera and scene.
void CResize::make_images(ViewState& state, VkExtent2D size) {
  state.camera = cameras_.at(below(cameras_.size()));
  state.scene = chance(2) ? ball_on_floor() : groove(0.8);
  HostView from = draw_view(size.width, size.height, state.scene, state.camera);
  from.id = state.id;
  request_all_outputs(from);
  from.settings.precision = chance(3) ? ALCOVE_PRECISION_UNORM8 : ALCOVE_PRECISION_FLOAT32;
  state.view = create_view(from);
  state.largest = size;
  // Half of the views use dynamic resolution. In the others, a change of the used part of the
  // images begins a new history.
  if (chance(2)) {
    state.view.info.largest_width = size.width;
    state.view.info.largest_height = size.height;
  }
}

void CResize::destroy_images(ViewState& state) {
  engine().wait();
  for (const AlcoveImage& image : state.view.images) {
    if (image.image == VK_NULL_HANDLE) continue;
    EXPECT_EQ(alcoveForgetImage(context_.get(), image.image), ALCOVE_SUCCESS);
    engine().destroy_image(image);
  }
}

void CResize::use_part(ViewState& state, VkExtent2D size) {
  const HostView part = draw_view(size.width, size.height, state.scene, state.camera);
  for (const InputMember& each : kInputs) {
    AlcoveImage whole = state.view.images[each.role];
    whole.width = state.largest.width;
    whole.height = state.largest.height;
    const HostImage contents = placed_in(state.largest, part.*each.texels);
    engine().write(whole, std::as_bytes(std::span(contents.texels)));
  }
  for (AlcoveImage& image : state.view.images) {
    image.width = size.width;
    image.height = size.height;
  }
  state.view.info.read_area = {0, 0, size.width, size.height};
}

void CResize::change_kind(ViewState& state) {
  state.kind = kinds_.at(below(kinds_.size()));
  change_numbers(state);
}

void CResize::change_numbers(ViewState& state) {
  OcclusionSettings settings = state.kind.settings;
  settings.radius = random_.log_uniform(0.05f, 5.0f);
  settings.thickness = random_.uniform(0.0f, 1.0f);
  settings.hidden_occlusion = random_.uniform(0.0f, 1.0f);
  settings.history_frames = chance(4) ? 0 : 1 + below(127);
  settings.roughness = random_.uniform(0.0f, 1.0f);
  settings.precision = static_cast<AlcovePrecision>(below(3));
  state.settings = settings;
}

void CResize::show(ViewState& state) {
  destroy_images(state);
  make_images(state, {1 + below(kMostSide), 1 + below(kMostSide)});
  change_kind(state);
  state.is_shown = true;
}

void CResize::drop(ViewState& state) {
  state.is_shown = false;
  EXPECT_EQ(alcoveDropView(context_.get(), state.id), ALCOVE_SUCCESS);
  state.view.info.previous_width = state.view.info.previous_height = state.view.info.static_frames =
      0;
}

// Changes a view at random in five of twelve cases. A view that changes has static_frames 0.
void CResize::change(ViewState& state) {
  const std::uint32_t what = below(12);
  if (what > 4) return;
  state.view.info.static_frames = 0;
  if (what == 0 && state.is_shown && chance(2))
    drop(state);
  else if (what == 0)
    show(state);
  else if (what == 1 && state.is_shown)
    use_part(state, {1 + below(state.largest.width), 1 + below(state.largest.height)});
  else if (what == 2)
    change_kind(state);
  else if (what == 3)
    change_numbers(state);
  else
    state.view.info.camera.view_from_world[12] += random_.uniform(-0.05f, 0.05f);
}

// Stores the camera and the size of this frame as the previous ones of the next frame.
void remember(ViewState& state) {
  state.view.info.previous_camera = state.view.info.camera;
  if (state.view.info.largest_width != 0) {
    state.view.info.previous_width = state.view.images[ALCOVE_IMAGE_DEPTH].width;
    state.view.info.previous_height = state.view.images[ALCOVE_IMAGE_DEPTH].height;
  }
  ++state.view.info.static_frames;
}

void CResize::draw_frame(std::span<ViewState> all, bool discards) {
  std::vector<AlcoveView> views;
  for (ViewState& state : all)
    if (state.is_shown) views.push_back(recorded_view(state));
  if (views.empty()) return;
  const AlcoveResult result = record(*context_, make_frame(views, frame_), discards);
  ASSERT_EQ(result, ALCOVE_SUCCESS) << alcoveGetMessage(context_.get());
  most_transients_ = std::max(most_transients_, get_memory(*context_).transients);
  if (discards) {
    EXPECT_EQ(alcoveDiscardFrame(context_.get()), ALCOVE_SUCCESS);
    return;
  }
  ++frame_;
  for (ViewState& state : all)
    if (state.is_shown) remember(state);
}

// Expects every value of the image to be finite and within [low, 1].
void expect_within(const HostImage& image, float low, const char* what) {
  const auto wrong = std::ranges::find_if_not(
      image.texels, [low](float value) { return value >= low && value <= 1.0f; });
  if (wrong != image.texels.end()) {
    ADD_FAILURE() << what << " is " << *wrong << " in texel "
                  << (wrong - image.texels.begin()) / image.channels << " of " << image.width << "x"
                  << image.height;
  }
}

void CResize::expect_right(ViewState& state) {
  if (!state.is_shown) return;
  const HostOutputs outputs = read_results(recorded_view(state));
  expect_within(outputs.visibility, 0.0f, "visibility");
  expect_within(outputs.bent_normal, -1.0f, "a bent normal");
  expect_within(outputs.specular, 0.0f, "specular occlusion");
  expect_within(outputs.multi_bounce, 0.0f, "multi-bounce");
}

void CResize::choose_kinds() {
  std::ranges::generate(kinds_, [&] { return any_kind(); });
  const std::vector<TestView> views = test_views();
  std::ranges::generate(cameras_,
                        [&] { return views[below(static_cast<std::uint32_t>(views.size()))]; });
}

void CResize::run_round() {
  choose_kinds();
  for (std::uint32_t i = 0; i < kRound && !HasFailure(); ++i) {
    SCOPED_TRACE("frame " + std::to_string(frame_));
    std::ranges::for_each(views_, [&](ViewState& state) { change(state); });
    const bool discards = chance(20);
    draw_frame(views_, discards);
    // Reading results waits for the device. It is done in a quarter of the frames only, so that the
    // others are in flight together.
    if (!discards && chance(4))
      std::ranges::for_each(views_, [&](ViewState& state) { expect_right(state); });
    EXPECT_EQ(gpu().device().validation_messages(), std::vector<std::string>{});
  }
}

// Drops all views, records some frames of one small view that is always the same, and returns the
// memory of the context. If anything leaks, that memory grows from call to call.
AlcoveMemory CResize::rest() {
  for (ViewState& state : views_) drop(state);
  resting_[0].is_shown = true;
  AlcoveMemory memory{};
  // Frames with two specular models are recorded, so that the tables of their shaders are loaded
  // from the first call of this function on.
  for (const AlcoveSpecular specular : {ALCOVE_SPECULAR_TABLE, ALCOVE_SPECULAR_SLICES}) {
    OcclusionSettings settings;
    settings.specular = specular;
    resting_[0].settings = settings;
    for (std::uint32_t i = 0; i < 2 * TestEngine::kSlots; ++i) draw_frame(resting_, false);
    memory = get_memory(*context_);
  }
  drop(resting_[0]);
  return memory;
}

void CResize::run_frames(std::uint32_t count) {
  const AlcoveMemory first = rest();
  for (std::uint32_t done = kRound; done <= count && !HasFailure(); done += kRound) {
    run_round();
    const AlcoveMemory now = rest();
    EXPECT_EQ(now.history, first.history);
    // The heap of transients may still have the size of the largest frame, recorded or discarded,
    // because it shrinks only after many smaller ones.
    EXPECT_LE(now.allocated, first.allocated + most_transients_);
    if (done % kProgress == 0)
      std::cout << done << " frames, " << now.allocated << " bytes" << std::endl;
  }
}

TEST_F(CResize, ResultsStayInRangeAndMemoryBoundedWhileSizesSettingsAndViewsChangeAtRandom) {
  run_frames(wanted_frames());
}

}  // namespace
}  // namespace alcove::passes
