// A fixture that runs frames by the C interface.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "alcove/alcove_work.h"
#include "engine.h"
#include "gtao_scenes.h"
#include "pass_fixture.h"

namespace alcove::passes {

// Draws a view of a scene with every input. Tests change its settings and its camera.
HostView draw_view(std::uint32_t width, std::uint32_t height, const Scene& scene = ball_on_floor(),
                   const TestView& view = test_views()[2]);
// The parameter of a test: the settings of a preset, which `change` changes.
struct PresetCase {
  const char* name;
  AlcoveQuality quality;
  void (*change)(HostView& view) = [](HostView&) {};
  bool area_and_mask = false;  // the test gives a part of the images and a mask

  friend std::ostream& operator<<(std::ostream& out, const PresetCase& preset) {
    return out << preset.name;
  }
};
// Draws a view with these settings.
HostView draw_view(std::uint32_t width, std::uint32_t height, const Scene& scene, float radius,
                   const PresetCase& preset);
// Requests every output: specular occlusion by slices.
void request_all_outputs(HostView& view);

// Copies `contents` into `image`, from the pixel (x, y) on.
void place(HostImage& image, const HostImage& contents, std::uint32_t x, std::uint32_t y);
// Returns an image of `larger` pixels with `contents` from the pixel (x, y) on. The other pixels
// are NaN or 0.3, so that a pass which reads them is noticed.
HostImage placed_in(VkExtent2D larger, const HostImage& contents, std::uint32_t x = 0,
                    std::uint32_t y = 0);

// Returns what alcoveDescribeWork needs for a view.
AlcoveWorkInfo work_info(const AlcoveView& view, std::uint32_t index = 0,
                         const AlcoveWork* previous = nullptr);
// Moves a view on to frame `index` of a series of kSeriesFrames: a first frame, two in motion, and
// two without motion, of which the last has converged.
inline constexpr std::uint32_t kSeriesFrames = 5;
void advance(HostView& view, std::uint32_t index);

// Returns frame `index` of these views.
AlcoveFrame make_frame(std::span<const AlcoveView> views, std::uint32_t index);

// Returns the text of a function such as alcovePrintPlan, which writes like snprintf.
std::string print(const std::function<std::size_t(char*, std::size_t)>& write);
std::string print_plan(AlcoveContext& context);
AlcoveMemory get_memory(AlcoveContext& context);

class CInterface : public PassTest {
 protected:
  void SetUp() override;
  void TearDown() override;
  static void TearDownTestSuite() { shared_context.reset(); }

  // The context that the tests of a suite share, so that pipelines are created once. After each
  // test its views are dropped and its images forgotten.
  AlcoveContext& context();
  Context create_context();
  static Context create_context(const AlcoveContextInfo& info) {
    return passes::create_context(info);
  }

  // Creates an image that holds `contents`, or returns one with the same contents.
  AlcoveImage input(const HostImage& contents);
  AlcoveImage output(VkFormat format, std::uint32_t width, std::uint32_t height);
  // Returns the texels of an image as floats.
  HostImage read(const AlcoveImage& image);
  HostOutputs read_results(const AlcoveView& view);

  // Creates the images of a view and returns it. Its settings belong to the fixture.
  AlcoveView create_view(const HostView& view);

  // Records and submits a frame. A frame that fails or `discards` is not submitted.
  AlcoveResult record(AlcoveContext& context, const AlcoveFrame& frame, bool discards = false);
  // Records a frame of these views, which must succeed. Does not wait for it.
  void run_frame(AlcoveContext& context, std::span<const AlcoveView> views, std::uint32_t index);
  void discard_frame(AlcoveContext& context, std::span<const AlcoveView> views,
                     std::uint32_t index);
  // Run a frame and return its results; of one view with the shared context.
  std::vector<HostOutputs> run_views(AlcoveContext& context, std::span<const AlcoveView> views,
                                     std::uint32_t index);
  HostOutputs run_view(const AlcoveView& view, std::uint32_t index);

  std::vector<HostOutputs> run_views(AlcoveContext& context, std::span<const HostView> views,
                                     std::uint32_t index);
  // Runs a plain frame of one view with a context of its own, to compare with.
  HostOutputs run_plainly(const HostView& view, std::uint32_t index);

  TestEngine& engine() { return *engine_; }

  bool shares_inputs_ = true;  // images with the same contents are one image

 private:
  static Context shared_context;
  std::unique_ptr<TestEngine> engine_;
  Context plain_context_;                // of run_plainly()
  std::deque<AlcoveSettings> settings_;  // of the views
  std::vector<std::pair<HostImage, AlcoveImage>> inputs_;
  std::set<std::uint32_t> ids_;  // of the recorded views
};

}  // namespace alcove::passes
