// Outputs that share an image with something else of the engine, and outputs of half size.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>

#include "c_interface_fixture.h"

namespace alcove::passes {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr VkImageUsageFlags kSharedUsage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                           VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                           VK_IMAGE_USAGE_TRANSFER_DST_BIT;

// A format with several channels, and one of a single channel with the same bits per channel.
struct SharedFormat {
  VkFormat format;
  VkFormat single;
  std::size_t channel_bytes;
  std::array<std::size_t, 4> places;  // of the channels r, g, b and a within the texel
};
constexpr SharedFormat kSharedFormats[] = {
    {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8_UNORM, 1, {0, 1, 2, 3}},
    {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8_UNORM, 1, {2, 1, 0, 3}},
    {VK_FORMAT_R16G16B16A16_UNORM, VK_FORMAT_R16_UNORM, 2, {0, 1, 2, 3}},
    {VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R32_SFLOAT, 4, {0, 1, 2, 3}},
};

class COutputs : public CInterface {
 protected:
  bool can_store(VkFormat format) {
    VkFormatProperties properties{};
    vkGetPhysicalDeviceFormatProperties(gpu().device().physical_device(), format, &properties);
    return (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT) != 0;
  }

  // Records one frame of a new history and waits for it.
  void run_alone(AlcoveView view) {
    view.reset_history = VK_TRUE;
    run_frame(context(), {&view, 1}, 3);
    engine().wait();
  }
};

Scene open_plane() { return {plane({0.0, 0.0, -4.0}, {0.1, 0.2, 1.0})}; }

// Returns random texels. Those of floats are numbers in [1, 2).
Bytes random_texels(std::size_t texels, const SharedFormat& format, std::mt19937& random) {
  Bytes bytes(texels * 4 * format.channel_bytes);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
  if (format.channel_bytes == 4) {
    std::uniform_real_distribution<float> number(1.0f, 2.0f);
    for (std::size_t i = 0; i < bytes.size(); i += 4) {
      const float value = number(random);
      std::memcpy(bytes.data() + i, &value, 4);
    }
  }
  return bytes;
}

// Returns `texels` with one channel replaced by the texels of an image of that channel alone.
Bytes with_channel(Bytes texels, const SharedFormat& format, std::size_t channel,
                   const Bytes& single) {
  const std::size_t size = format.channel_bytes;
  for (std::size_t i = 0; i < single.size() / size; ++i)
    std::memcpy(&texels[(i * 4 + format.places.at(channel)) * size], &single[i * size], size);
  return texels;
}

TEST_F(COutputs, WritingVisibilityToOneChannelKeepsEveryBitOfTheOtherChannels) {
  const std::uint32_t seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  HostView from = draw_view(17, 11);
  for (const bool half_resolution : {false, true}) {
    from.settings.half_resolution = half_resolution;
    AlcoveView view = create_view(from);
    for (const SharedFormat& format : kSharedFormats) {
      if (!can_store(format.format) || !can_store(format.single))
        continue;  // Vulkan requires this of few formats only, among them R8G8B8A8_UNORM
      view.visibility = output(format.single, 17, 11);
      view.visibility_channel = ALCOVE_CHANNEL_ALL;
      run_alone(view);
      const Bytes alone = read_bytes(view.visibility, format.channel_bytes);
      for (const std::size_t channel : {0u, 1u, 2u, 3u}) {
        SCOPED_TRACE(testing::Message() << "format " << format.format << ", channel " << channel
                                        << ", half resolution " << half_resolution);
        view.visibility = engine().make_image(format.format, 17, 11, kSharedUsage);
        view.visibility_channel = static_cast<AlcoveChannel>(ALCOVE_CHANNEL_R + channel);
        const Bytes before = random_texels(17UL * 11, format, random);
        write_bytes(view.visibility, before);
        run_alone(view);
        EXPECT_EQ(read_bytes(view.visibility, 4 * format.channel_bytes),
                  with_channel(before, format, channel, alone));
      }
    }
  }
}

// With dynamic resolution the image may be larger than the part that Alcove writes.
TEST_F(COutputs, WritingVisibilityToOneChannelKeepsPixelsOutsideTheRenderedPart) {
  std::mt19937 random(1);
  AlcoveView view = create_view(draw_view(16, 12, open_plane()));
  const AlcoveImage whole = engine().make_image(VK_FORMAT_R8G8B8A8_UNORM, 20, 13, kSharedUsage);
  const Bytes before = random_texels(20UL * 13, kSharedFormats[0], random);
  write_bytes(whole, before);
  view.visibility = whole;
  view.visibility.width = 16;
  view.visibility.height = 12;
  view.visibility_channel = ALCOVE_CHANNEL_A;
  run_alone(view);
  const Bytes after = read_bytes(whole, 4);
  for (std::size_t i = 0; i < after.size(); ++i) {
    const bool written = i % 4 == 3 && i / 4 % 20 < 16 && i / 4 / 20 < 12;
    ASSERT_EQ(after[i], written ? std::byte{255} : before[i]) << i;
  }
}

TEST_F(COutputs, PassesThatReadVisibilityReadItFromTheChannelThatTheEngineChose) {
  for (const Specular model : {Specular::table, Specular::cone}) {
    HostView from = draw_view(16, 12);
    from.settings.specular = model;
    from.multi_bounce = true;
    AlcoveView view = create_view(from);
    view.visibility = engine().make_image(VK_FORMAT_R32G32B32A32_SFLOAT, 16, 12, kSharedUsage);
    view.visibility_channel = ALCOVE_CHANNEL_B;
    write_bytes(view.visibility, Bytes(16UL * 12 * 16));
    run_alone(view);
    from.reset = true;
    const Results found = read_results(view), expected = run_by_cpp(from, 3);
    EXPECT_EQ(found.specular.texels, expected.specular.texels);
    EXPECT_EQ(found.multi_bounce.texels, expected.multi_bounce.texels);
  }
}

TEST_F(COutputs, WritingVisibilityToOneChannelAddsNoPassAndNoMemory) {
  AlcoveView view = create_view(draw_view(16, 12));
  run_alone(view);
  const std::string plain = print_plan(context());
  const AlcoveMemory memory = get_memory(context());
  view.visibility = engine().make_image(VK_FORMAT_R8G8B8A8_UNORM, 16, 12, kSharedUsage);
  view.visibility_channel = ALCOVE_CHANNEL_G;
  write_bytes(view.visibility, Bytes(16UL * 12 * 4));
  run_alone(view);
  const auto lines = [](const std::string& text) { return std::ranges::count(text, '\n'); };
  EXPECT_EQ(lines(print_plan(context())), lines(plain)) << plain << print_plan(context());
  EXPECT_EQ(get_memory(context()).transients_unshared, memory.transients_unshared);
  EXPECT_EQ(get_memory(context()).history, memory.history);
}

TEST_F(COutputs, CppInterfaceWritesVisibilityToOneChannelOfAnImage) {
  const HostView from = draw_view(16, 12);
  const HostImage alone = run_by_cpp(from, 0).visibility;
  HostImage before{16, 12, {}, 4};
  for (std::size_t i = 0; i < 16UL * 12 * 4; ++i) before.texels.push_back(static_cast<float>(i));
  run([&](framegraph::Graph& graph) {
    const auto outputs = add_occlusion({graph, gpu().kernels(), from.view},
                                       {.depth_ndc = upload(graph, from.depth_ndc),
                                        .normals = upload(graph, from.normals),
                                        .normal_convention = {.in_view_space = true},
                                        .motion = upload(graph, from.motion),
                                        .into = {.visibility = upload(graph, before)},
                                        .visibility_channel = VisibilityChannel::alpha},
                                       from.settings, "shared");
    ASSERT_TRUE(outputs) << outputs.error().message;
    read_back(graph, outputs->visibility);
  });
  for (std::size_t i = 0; i < 16UL * 12 * 4; ++i)
    ASSERT_EQ(result().texels[i], i % 4 == 3 ? alone.texels[i / 4] : before.texels[i]) << i;
}

// Returns a view of a scene at half resolution, with all outputs of half size.
HostView draw_half_view(std::uint32_t width, std::uint32_t height, const Scene& scene) {
  HostView view = draw_view(width, height, scene);
  view.settings.half_resolution = true;
  view.half_size_outputs = true;
  request_all_outputs(view);
  view.reset = true;
  return view;
}

TEST_F(COutputs, HalfSizeOutputsOfTheCAndCppInterfacesAreEqualAtAnySizeWithoutUpsampling) {
  for (const VkExtent2D size : {VkExtent2D{1, 1}, {3, 1}, {1, 4}, {17, 11}, {18, 12}, {33, 8}}) {
    SCOPED_TRACE(testing::Message() << size.width << "x" << size.height);
    HostView view = draw_half_view(size.width, size.height, ball_on_floor());
    expect_same_both_ways(context(), {&view, 1}, 0);
    view.reset = false;  // with history
    expect_same_both_ways(context(), {&view, 1}, 1);
    EXPECT_THAT(print_plan(context()), HasSubstr("half-resolution output"));
    EXPECT_THAT(print_plan(context()), Not(HasSubstr("upsample")));
  }
}

TEST_F(COutputs, HalfSizeOutputsOfAnUnoccludedPlaneAreUnoccluded) {
  const Results found = run_by_cpp(draw_half_view(17, 11, open_plane()), 0);
  ASSERT_EQ(found.visibility.width, 9u);
  ASSERT_EQ(found.visibility.height, 6u);
  EXPECT_THAT(found.visibility.texels, testing::Each(1.0f));
  EXPECT_THAT(found.specular.texels, testing::Each(testing::Ge(0.995f)));
}

// Away from depth edges a texel is about the mean of its four upsampled pixels.
TEST_F(COutputs, HalfSizeOutputsAgreeWithTheMeanOfUpsampledOutputs) {
  HostView view = draw_half_view(64, 48, groove(0.8));
  const Results half = run_by_cpp(view, 0);
  view.half_size_outputs = false;
  const Results full = run_by_cpp(view, 0);
  for (const auto& image : {&Results::visibility, &Results::specular, &Results::bent_normal}) {
    const HostImage &small = half.*image, &large = full.*image;
    double sum = 0.0;
    for (std::uint32_t y = 0; y < small.height; ++y) {
      for (std::uint32_t x = 0; x < small.width; ++x) {
        const float mean = (large.at(2 * x, 2 * y) + large.at(2 * x + 1, 2 * y) +
                            large.at(2 * x, 2 * y + 1) + large.at(2 * x + 1, 2 * y + 1)) /
                           4.0f;
        sum += std::abs(small.at(x, y) - mean);
      }
    }
    EXPECT_LT(sum / (small.width * small.height), 0.01);
  }
}

// The radius of this test is so small that nothing occludes. Each bent normal is then the normal of
// its pixel, and shows which pixel a texel belongs to.
TEST_F(COutputs, HalfSizeTexelsShowTheNearestOrFarthestOfFourPixelsInACheckerboard) {
  HostView view = draw_half_view(33, 23, ball_on_floor());
  view.settings.radius = 1e-4f;
  const HostImage found = run_by_cpp(view, 0).bent_normal;
  std::size_t told_apart = 0;
  for (std::uint32_t y = 0; y < found.height; ++y) {
    for (std::uint32_t x = 0; x < found.width; ++x) {
      std::array<std::uint32_t, 2> chosen{};
      double best = -kInfinity;
      for (std::uint32_t i = 0; i < 4; ++i) {
        const std::uint32_t px = 2 * x + i / 2, py = 2 * y + i % 2;
        if (px >= 33 || py >= 23) continue;
        const double nearness = view.depth_ndc.at(px, py);  // reversed: the sky is 0
        const double rank = (x + y) % 2 == 0 ? nearness : nearness == 0.0 ? -1e9 : -nearness;
        if (rank > best) {
          best = rank;
          chosen = {px, py};
        }
      }
      if (view.depth_ndc.at(chosen[0], chosen[1]) == 0.0f) continue;
      for (std::uint32_t c = 0; c < 3; ++c)
        ASSERT_NEAR(found.at(x, y, c), view.normals.at(chosen[0], chosen[1], c), 2e-3)
            << "at " << x << ", " << y;
      ++told_apart;
    }
  }
  EXPECT_GT(told_apart, 100u);
}

}  // namespace
}  // namespace alcove::passes
