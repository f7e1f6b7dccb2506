#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cctype>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gpu/gpu.h"
#include "gpu/occlusion.h"

namespace alcove::passes {

using sample::OcclusionSettings;

// A float image in host memory, row by row from the top.
struct HostImage {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<float> texels;  // `channels` values per pixel
  std::uint32_t channels = 1;

  float at(std::uint32_t x, std::uint32_t y, std::uint32_t channel = 0) const {
    return texels[(std::size_t{y} * width + x) * channels + channel];
  }
};

inline constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Returns an image of which each pixel is `texel`.
HostImage uniform(std::uint32_t width, std::uint32_t height, const std::vector<float>& texel);
// Returns the depths that a buffer of 16 bits would hold.
HostImage with_16_bits(HostImage depth);
// Returns the format of 32-bit floats with 1, 2 or 4 channels.
VkFormat float_format(std::uint32_t channels);
// Returns texels of a format that the passes write, or of floats, as floats.
HostImage decode(std::span<const std::byte> bytes, VkFormat format, std::uint32_t width,
                 std::uint32_t height);
// Returns the root mean square of the differences between two images of one size.
double rms(const HostImage& a, const HostImage& b);
// Returns the mean of all values of an image.
double mean(const HostImage& image);

// Fails the test at the first pixel whose value differs from expected(x, y) by more than
// `tolerance`.
template <typename Expected>
void expect_pixels(const HostImage& image, double tolerance, const Expected& expected) {
  for (std::uint32_t y = 0; y < image.height; ++y)
    for (std::uint32_t x = 0; x < image.width; ++x)
      ASSERT_NEAR(image.at(x, y), expected(x, y), tolerance) << "at " << x << ", " << y;
}

// Tests that a pass has refused its input with a sentence that contains `message`.
template <typename Result>
void expect_error(const Result& result, const std::string& message) {
  ASSERT_FALSE(result) << message;
  const std::string& text = result.error().message;
  EXPECT_PRED_FORMAT2(testing::IsSubstring, message, text);
  EXPECT_TRUE(text.ends_with('.') && std::isupper(static_cast<unsigned char>(text[0]))) << text;
}

// A view in host memory. An input without texels is not given.
struct HostView {
  std::uint32_t id = 0;
  AlcoveCamera view{};
  AlcoveCamera previous_view = view;
  bool reset = false;  // resets the history first
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
};

// The outputs of a view. One that is not requested has no texels.
struct HostOutputs {
  HostImage visibility;
  HostImage bent_normal;
  HostImage specular;
  HostImage multi_bounce;
};

// An image in host memory, and its role.
struct InputMember {
  HostImage HostView::*texels;
  AlcoveImageRole role;
};
struct OutputMember {
  HostImage HostOutputs::*texels;
  AlcoveImageRole role;
};
inline constexpr std::array kInputs{
    InputMember{&HostView::depth_ndc, ALCOVE_IMAGE_DEPTH},
    InputMember{&HostView::normals, ALCOVE_IMAGE_NORMALS},
    InputMember{&HostView::motion, ALCOVE_IMAGE_MOTION},
    InputMember{&HostView::roughness, ALCOVE_IMAGE_ROUGHNESS},
    InputMember{&HostView::back_depth_ndc, ALCOVE_IMAGE_BACK_DEPTH},
    InputMember{&HostView::second_depth_ndc, ALCOVE_IMAGE_SECOND_DEPTH},
    InputMember{&HostView::albedo, ALCOVE_IMAGE_ALBEDO}};
inline constexpr std::array kOutputs{
    OutputMember{&HostOutputs::visibility, ALCOVE_IMAGE_VISIBILITY},
    OutputMember{&HostOutputs::bent_normal, ALCOVE_IMAGE_BENT_NORMAL},
    OutputMember{&HostOutputs::specular, ALCOVE_IMAGE_SPECULAR},
    OutputMember{&HostOutputs::multi_bounce, ALCOVE_IMAGE_MULTI_BOUNCE}};

void expect_equal(const HostOutputs& outputs, const HostOutputs& expected);

// Returns what the C interface takes for a view, without settings.
AlcoveViewInfo view_info(const HostView& view);

struct Drawing;
// Returns the view of a drawing with its normals, and with its depth as second depth. Frame 0
// resets the history first.
HostView make_view(const Drawing& drawing, const OcclusionSettings& settings,
                   std::uint32_t index = 0);

// Returns settings of a preset that request visibility, bent normals and specular occlusion as
// 32-bit floats. The preset `height_field` has fewer samples, which compile and run faster.
OcclusionSettings all_outputs(AlcoveQuality quality, float radius = 0.5f,
                              AlcoveSpecular specular = ALCOVE_SPECULAR_SLICES);

// Runs passes on the machine's Vulkan device under the validation layers. Any message of the layers
// fails the test. The tests of a program share the device and its pipelines, but no resources.
class PassTest : public testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  // Adds a texture of 32-bit floats with 1, 2 or 4 channels that contains `image`. If a `format`
  // with 32-bit channels is given, the texture has that format, and the bits of the floats are
  // copied unchanged.
  framegraph::Texture upload(framegraph::Graph& graph, const HostImage& image,
                             VkFormat format = VK_FORMAT_UNDEFINED);
  // Adds a pass that fills `target`, a texture with 32-bit channels, with `image`.
  framegraph::Texture fill(framegraph::Graph& graph, framegraph::Texture target,
                           const HostImage& image);
  // Adds a copy of `texture` to host memory. The texture may have any format that the passes write.
  // After the frame, result() returns its contents as floats.
  void read_back(framegraph::Graph& graph, framegraph::Texture texture);
  // Returns an image that the last frame read back. They are numbered in the order of read_back()
  // calls.
  const HostImage& result(std::size_t index = 0) const { return results_[index]; }

  // Runs the frame that `declare` declares. Fails the test if it cannot be run.
  void run(const std::function<void(framegraph::Graph&)>& declare);

  // Adds the occlusion of a view to a graph. Fails the test if it is refused.
  void add_view_of(framegraph::Graph& graph, const AlcoveViewInfo& view, std::uint32_t index,
                   const OcclusionSettings& settings, ViewTextures& textures) {
    const auto added =
        sample::add_occlusion(graph, gpu().pipelines(), view, index, settings, textures);
    ASSERT_TRUE(added) << added.error().message;
  }
  // Runs add_view() for frame `index` and returns its outputs. `albedo` is not an input.
  HostOutputs run_occlusion(const HostView& view, std::uint32_t index = 0);
  // Runs frame `index` of make_view().
  HostOutputs render(const Drawing& drawing, const OcclusionSettings& settings,
                     std::uint32_t index = 0);

  // Fills the device memory that transients of about this size will use with NaN, so that the test
  // notices texels that a pass does not write.
  void poison_memory(std::uint32_t width, std::uint32_t height);

  static sample::Gpu& gpu();
  // Replaces the device that tests share by another, for tests that count pipelines and tables.
  static void open_gpu();

 private:
  struct Download {
    std::unique_ptr<sample::HostBuffer> buffer;
    VkFormat format = VK_FORMAT_UNDEFINED;
    VkExtent3D extent{};
  };
  std::vector<std::unique_ptr<sample::HostBuffer>> uploads_;
  std::vector<Download> downloads_;
  std::vector<HostImage> results_;
};

}  // namespace alcove::passes
