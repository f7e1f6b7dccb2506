// Outputs that share an image with something else of the engine.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>

#include "c_interface_fixture.h"

namespace alcove::passes {
namespace {

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

}  // namespace
}  // namespace alcove::passes
