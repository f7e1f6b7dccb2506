// Frames by the C interface, and the same by the C++ functions.
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

// What a view of a frame is given. Empty images are not given.
struct GivenView {
  std::uint32_t id = 0;
  View view;
  View previous_view = view;
  bool reset = false;
  std::uint32_t static_frames = 0;
  VkExtent2D largest_size{};
  VkExtent2D previous_size{};
  HostImage depth_ndc;
  HostImage normals;
  bool normals_in_view_space = true;
  HostImage motion;
  HostImage roughness;
  HostImage back_depth_ndc;
  HostImage second_depth_ndc;
  HostImage albedo;
  OcclusionSettings settings;  // their flags tell the outputs that are wanted
  bool multi_bounce = false;
};

struct Results {
  HostImage visibility;
  HostImage bent_normal;
  HostImage specular;
  HostImage multi_bounce;
};

// A view with every input, of a scene; its settings and camera are the tests' to change.
GivenView given_view(const TestView& view, std::uint32_t width, std::uint32_t height,
                     const Scene& scene);

// An image of `larger` pixels that holds `contents` from the first pixel on, and numbers that must
// not be read around it.
HostImage in_corner_of(const HostImage& contents, VkExtent2D larger);

class CInterface : public PassTest {
 protected:
  void SetUp() override;
  void TearDown() override;

  Context create_context();

  // An image that holds `contents`.
  AlcoveImage input(const HostImage& contents);
  // Fills an image that rests, and leaves it in `final_state`.
  void fill_image(const AlcoveImage& image, const HostImage& contents, AlcoveState final_state);
  AlcoveImage output(VkFormat format, std::uint32_t width, std::uint32_t height);
  HostImage read(const AlcoveImage& image);

  // The images of a view, made for it; `settings` must live as long as the view is used.
  AlcoveView view_of(const GivenView& given, AlcoveSettings& settings);
  // Records, submits and waits for a frame, which has to succeed.
  void run_frame(AlcoveContext& context, std::span<const AlcoveView> views, std::uint32_t index);
  // The same, but of the frame nothing is submitted.
  void record_and_throw_away(AlcoveContext& context, const AlcoveView& view, std::uint32_t index);
  Results results_of(const AlcoveView& view);

  std::vector<Results> run_by_c(AlcoveContext& context, std::span<const GivenView> views,
                                std::uint32_t index);
  // Its history is the fixture's, by the view's id.
  Results run_by_cpp(const GivenView& given, std::uint32_t index);
  // Runs the frame both ways: each view's results have to be equal.
  void expect_same_both_ways(AlcoveContext& context, std::span<const GivenView> views,
                             std::uint32_t index);

  std::string plan_of(AlcoveContext& context);
  AlcoveMemory memory_of(AlcoveContext& context);

  Engine& engine() { return *engine_; }

 private:
  std::unique_ptr<Engine> engine_;
  std::deque<AlcoveAdvancedSettings> advanced_;  // of view_of()'s settings
};

void expect_equal(const Results& found, const Results& expected);

}  // namespace alcove::passes
