// A fixture that runs the same frame by the C interface and by the C++ functions.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "drawing.h"
#include "engine.h"
#include "pass_fixture.h"

namespace alcove::passes {

// The inputs of a view for both interfaces. An image without texels stands for one that is not
// given.
struct GivenView {
  std::uint32_t id = 0;
  View view;
  View previous_view = view;
  bool reset = false;
  std::uint32_t static_frames = 0;
  VkExtent2D largest_size{};
  VkExtent2D previous_size{};
  HostImage depth_ndc;
  VkFormat depth_format = VK_FORMAT_UNDEFINED;
  HostImage normals;
  bool normals_in_view_space = true;
  HostImage motion;
  HostImage roughness;
  HostImage back_depth_ndc;
  HostImage second_depth_ndc;
  HostImage albedo;
  OcclusionSettings settings;  // their flags say which outputs are requested
  bool multi_bounce = false;
  bool half_size_outputs = false;
};

struct Results {
  HostImage visibility;
  HostImage bent_normal;
  HostImage specular;
  HostImage multi_bounce;
};

// Returns a view of a scene with every input. Tests change its settings and its camera.
GivenView given_view(const TestView& view, std::uint32_t width, std::uint32_t height,
                     const Scene& scene);

// Returns an image of `larger` pixels with `contents` from the pixel (x, y) on. The other pixels
// are NaN or 0.3, so that a pass which reads them is noticed.
HostImage placed_in(VkExtent2D larger, const HostImage& contents, std::uint32_t x = 0,
                    std::uint32_t y = 0);
// Copies `contents` into `image`, from the pixel (x, y) on.
void place(HostImage& image, const HostImage& contents, std::uint32_t x, std::uint32_t y);

class CInterface : public PassTest {
 protected:
  void SetUp() override;
  void TearDown() override;

  Context create_context();

  // Creates an image that holds `contents`.
  AlcoveImage input(const HostImage& contents);
  // Fills an image, which is in the state kResting, and leaves it in `final_state`.
  void fill_image(const AlcoveImage& image, const HostImage& contents, AlcoveState final_state);
  AlcoveImage output(VkFormat format, std::uint32_t width, std::uint32_t height);
  HostImage read(const AlcoveImage& image);

  // Creates the images of a view and returns it. The view points to `settings`, which receives
  // those of `given` and must live as long as the view is used.
  AlcoveView view_of(const GivenView& given, AlcoveSettings& settings);
  // Records a frame of these views, which must succeed, and submits it. Does not wait.
  void run_frame(AlcoveContext& context, std::span<const AlcoveView> views, std::uint32_t index);
  // Records a frame of one view, which must succeed, and does not submit it.
  void record_and_throw_away(AlcoveContext& context, const AlcoveView& view, std::uint32_t index);
  Results results_of(const AlcoveView& view);

  std::vector<Results> run_by_c(AlcoveContext& context, std::span<const GivenView> views,
                                std::uint32_t index);
  // Runs the frame by the C++ functions and waits for it. The history belongs to the fixture and to
  // the id of the view.
  Results run_by_cpp(const GivenView& given, std::uint32_t index);
  // Runs the frame by both interfaces and expects equal results for each view.
  void expect_same_both_ways(AlcoveContext& context, std::span<const GivenView> views,
                             std::uint32_t index);

  std::string plan_of(AlcoveContext& context);
  AlcoveMemory memory_of(AlcoveContext& context);

  Engine& engine() { return *engine_; }

 private:
  std::unique_ptr<Engine> engine_;
  std::deque<AlcoveAdvancedSettings> advanced_;  // that the settings of view_of() point to
};

void expect_equal(const Results& found, const Results& expected);

}  // namespace alcove::passes
