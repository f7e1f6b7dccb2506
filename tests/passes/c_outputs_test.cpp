// Outputs that share an image with something else of the engine, and outputs of half size.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "c_interface_fixture.h"
#include "gtao_scenes.h"

namespace alcove::passes {
namespace {

using testing::HasSubstr;
using testing::Not;
using Bytes = std::vector<std::byte>;

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
  void SetUp() override {
    CInterface::SetUp();
    if (!HasFatalFailure()) context_ = create_context();
  }
  void TearDown() override {
    if (context_) engine().wait();
    context_.reset();
    CInterface::TearDown();
  }

  // Copies between an image that rests and the bytes of all of its texels.
  void write_bytes(const AlcoveImage& image, const Bytes& bytes) {
    const auto buffer = host_buffer(bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    std::memcpy(buffer->bytes().data(), bytes.data(), bytes.size());
    engine().submit(0, [&](VkCommandBuffer commands) {
      change_layout(commands, image, VK_IMAGE_LAYOUT_UNDEFINED,
                    VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
      const VkBufferImageCopy region = whole(image);
      vkCmdCopyBufferToImage(commands, buffer->buffer(), image.image,
                             VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
      change_layout(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, kResting.layout);
    });
    engine().wait();
  }
  Bytes read_bytes(const AlcoveImage& image, std::size_t texel_bytes) {
    Bytes bytes(std::size_t{image.width} * image.height * texel_bytes);
    const auto buffer = host_buffer(bytes.size(), VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    engine().submit(0, [&](VkCommandBuffer commands) {
      change_layout(commands, image, kResting.layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
      const VkBufferImageCopy region = whole(image);
      vkCmdCopyImageToBuffer(commands, image.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                             buffer->buffer(), 1, &region);
      change_layout(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, kResting.layout);
    });
    engine().wait();
    std::memcpy(bytes.data(), buffer->bytes().data(), bytes.size());
    return bytes;
  }

  bool can_store(VkFormat format) {
    VkFormatProperties properties{};
    vkGetPhysicalDeviceFormatProperties(gpu().device().physical_device(), format, &properties);
    return (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT) != 0;
  }

  // Records one frame of a new history and waits for it.
  void run_alone(AlcoveView view) {
    view.reset_history = VK_TRUE;
    run_frame(*context_, {&view, 1}, 3);
    engine().wait();
  }

  // Returns the error of recording the view, which must be one of the input.
  std::string error_of(const AlcoveView& view) {
    const AlcoveFrame frame{.struct_size = sizeof(AlcoveFrame), .view_count = 1, .views = &view};
    engine().submit(0, [&](VkCommandBuffer commands) {
      EXPECT_EQ(alcoveRecordFrame(context_.get(), commands, &frame), ALCOVE_ERROR_INVALID_INPUT);
    });
    return alcoveGetMessage(context_.get());
  }

  AlcoveContext& context() { return *context_; }

 private:
  std::unique_ptr<sample::HostBuffer> host_buffer(std::size_t bytes, VkBufferUsageFlags usage) {
    auto made = sample::HostBuffer::create(gpu().device(), bytes, usage);
    EXPECT_TRUE(made) << made.error();
    return std::move(*made);
  }
  static VkBufferImageCopy whole(const AlcoveImage& image) {
    return {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
            .imageExtent = {image.width, image.height, 1}};
  }
  static void change_layout(VkCommandBuffer commands, const AlcoveImage& image, VkImageLayout from,
                            VkImageLayout to) {
    const VkImageMemoryBarrier2 barrier{
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .srcAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
        .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
        .oldLayout = from,
        .newLayout = to,
        .image = image.image,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    const VkDependencyInfo dependency{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                      .imageMemoryBarrierCount = 1,
                                      .pImageMemoryBarriers = &barrier};
    vkCmdPipelineBarrier2(commands, &dependency);
  }

  Context context_;
};

Scene open_plane() { return {plane({0.0, 0.0, -4.0}, {0.1, 0.2, 1.0})}; }

// Random texels. Those of floats are numbers in [1, 2).
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
  for (std::size_t i = 0; i < single.size() / size; ++i) {
    std::memcpy(texels.data() + (i * 4 + format.places.at(channel)) * size,
                single.data() + i * size, size);
  }
  return texels;
}

TEST_F(COutputs, WritingVisibilityToOneChannelKeepsEveryBitOfTheOtherChannels) {
  const std::uint32_t seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  GivenView given = given_view(test_views()[2], 17, 11, ball_on_floor());
  for (const bool half_resolution : {false, true}) {
    given.settings.half_resolution = half_resolution;
    AlcoveSettings settings;
    AlcoveView view = view_of(given, settings);
    for (const SharedFormat& format : kSharedFormats) {
      if (!can_store(format.format) || !can_store(format.single))
        continue;  // Vulkan requires this of few formats only, among them R8G8B8A8_UNORM
      view.visibility = engine().make_image(format.single, 17, 11, kSharedUsage);
      view.visibility.initial_state.layout = VK_IMAGE_LAYOUT_UNDEFINED;
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
  const std::uint32_t seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  const SharedFormat& format = kSharedFormats[0];
  AlcoveSettings settings;
  AlcoveView view = view_of(given_view(test_views()[2], 16, 12, open_plane()), settings);
  view.visibility = engine().make_image(format.format, 20, 13, kSharedUsage);
  view.visibility_channel = ALCOVE_CHANNEL_A;
  AlcoveImage all = view.visibility;
  const Bytes before = random_texels(20UL * 13, format, random);
  write_bytes(all, before);
  view.visibility.width = 16;
  view.visibility.height = 12;
  run_alone(view);
  const Bytes after = read_bytes(all, 4);
  for (std::size_t i = 0; i < after.size(); ++i) {
    const bool written = i % 4 == 3 && i / 4 % 20 < 16 && i / 4 / 20 < 12;
    ASSERT_EQ(after[i], written ? std::byte{255} : before[i]) << i;
  }
}

TEST_F(COutputs, PassesThatReadVisibilityReadItFromTheChannelThatTheEngineChose) {
  for (const Specular model : {Specular::table, Specular::cone}) {
    GivenView given = given_view(test_views()[2], 16, 12, ball_on_floor());
    given.settings.specular = model;
    given.multi_bounce = true;
    AlcoveSettings settings;
    AlcoveView view = view_of(given, settings);
    view.visibility = engine().make_image(VK_FORMAT_R32G32B32A32_SFLOAT, 16, 12, kSharedUsage);
    view.visibility_channel = ALCOVE_CHANNEL_B;
    write_bytes(view.visibility, Bytes(16UL * 12 * 16));
    run_alone(view);
    given.reset = true;
    const Results expected = run_by_cpp(given, 3);
    EXPECT_EQ(read(view.specular).texels, expected.specular.texels);
    EXPECT_EQ(read(view.multi_bounce).texels, expected.multi_bounce.texels);
  }
}

TEST_F(COutputs, WritingVisibilityToOneChannelAddsNoPassAndNoMemory) {
  GivenView given = given_view(test_views()[2], 16, 12, ball_on_floor());
  AlcoveSettings settings;
  AlcoveView view = view_of(given, settings);
  run_alone(view);
  const std::string plain = plan_of(context());
  const AlcoveMemory memory = memory_of(context());
  view.visibility = engine().make_image(VK_FORMAT_R8G8B8A8_UNORM, 16, 12, kSharedUsage);
  view.visibility_channel = ALCOVE_CHANNEL_G;
  write_bytes(view.visibility, Bytes(16UL * 12 * 4));
  run_alone(view);
  const auto lines = [](const std::string& text) { return std::ranges::count(text, '\n'); };
  EXPECT_EQ(lines(plan_of(context())), lines(plain)) << plain << plan_of(context());
  EXPECT_EQ(memory_of(context()).allocated, memory.allocated);
}

TEST_F(COutputs, ImagesOfWhichASingleChannelCannotBeWrittenAreRefused) {
  AlcoveSettings settings;
  const AlcoveView good = view_of(given_view(test_views()[2], 16, 12, open_plane()), settings);
  const auto error = [&](VkFormat format, AlcoveChannel channel, VkImageUsageFlags usage,
                         VkImageLayout layout) {
    AlcoveView view = good;
    view.visibility = engine().make_image(format, 16, 12, kSharedUsage);
    view.visibility.usage = usage;
    view.visibility.initial_state.layout = layout;
    view.visibility_channel = channel;
    return error_of(view);
  };
  const VkImageLayout layout = kResting.layout;
  const char* const format = "of which visibility_channel cannot be written alone; give";
  EXPECT_THAT(error(VK_FORMAT_R8_UNORM, ALCOVE_CHANNEL_G, kSharedUsage, layout), HasSubstr(format));
  EXPECT_THAT(error(VK_FORMAT_R8G8B8A8_SNORM, ALCOVE_CHANNEL_A, kSharedUsage, layout),
              HasSubstr(format));
  EXPECT_THAT(error(VK_FORMAT_R8G8B8A8_UNORM, ALCOVE_CHANNEL_A,
                    VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, layout),
              HasSubstr("was made without VK_IMAGE_USAGE_SAMPLED_BIT"));
  EXPECT_THAT(
      error(VK_FORMAT_R8G8B8A8_UNORM, ALCOVE_CHANNEL_A, kSharedUsage, VK_IMAGE_LAYOUT_UNDEFINED),
      HasSubstr("without contents"));
  EXPECT_THAT(error(VK_FORMAT_R8G8B8A8_UNORM, static_cast<AlcoveChannel>(5), kSharedUsage, layout),
              HasSubstr("visibility_channel is 5"));
}

TEST_F(COutputs, VisibilityInOneChannelOfAnImageEqualsVisibilityInAnImageOfItsOwn) {
  const GivenView given = given_view(test_views()[2], 16, 12, ball_on_floor());
  const HostImage alone = run_by_cpp(given, 0).visibility;
  HostImage before{16, 12, {}, 4};
  for (std::size_t i = 0; i < 16UL * 12 * 4; ++i) before.texels.push_back(static_cast<float>(i));
  run([&](framegraph::Graph& graph) {
    const auto shared = upload(graph, before);
    const auto outputs = add_occlusion({graph, gpu().kernels(), given.view},
                                       {.depth_ndc = upload(graph, given.depth_ndc),
                                        .normals = upload(graph, given.normals),
                                        .normal_convention = {.in_view_space = true},
                                        .motion = upload(graph, given.motion),
                                        .into = {.visibility = shared},
                                        .visibility_channel = VisibilityChannel::alpha},
                                       given.settings, "shared");
    ASSERT_TRUE(outputs) << outputs.error().message;
    read_back(graph, outputs->visibility);
  });
  for (std::size_t i = 0; i < 16UL * 12 * 4; ++i)
    ASSERT_EQ(result().texels[i], i % 4 == 3 ? alone.texels[i / 4] : before.texels[i]) << i;
}

// Returns a view of a scene at half resolution, with outputs of half size.
GivenView half_view(std::uint32_t width, std::uint32_t height, const Scene& scene) {
  GivenView given = given_view(test_views()[2], width, height, scene);
  given.settings.half_resolution = true;
  given.half_size_outputs = true;
  return given;
}

TEST_F(COutputs, HalfSizeOutputsRunNoUpsamplingPass) {
  AlcoveSettings settings;
  AlcoveView view = view_of(half_view(17, 11, ball_on_floor()), settings);
  run_alone(view);
  EXPECT_THAT(plan_of(context()), HasSubstr("half-resolution output"));
  EXPECT_THAT(plan_of(context()), Not(HasSubstr("upsample")));
}

TEST_F(COutputs, HalfSizeOutputsOfTheCAndCppInterfacesAreEqualAtAnySize) {
  for (const VkExtent2D size : {VkExtent2D{1, 1}, {3, 1}, {1, 4}, {17, 11}, {18, 12}, {33, 8}}) {
    SCOPED_TRACE(testing::Message() << size.width << "x" << size.height);
    GivenView given = half_view(size.width, size.height, ball_on_floor());
    given.settings.bent_normal = true;
    given.settings.specular = Specular::slices;
    given.reset = true;
    expect_same_both_ways(context(), {&given, 1}, 0);
    given.reset = false;  // with history
    expect_same_both_ways(context(), {&given, 1}, 1);
  }
}

TEST_F(COutputs, HalfSizeOutputsOfAnUnoccludedPlaneAreUnoccluded) {
  GivenView given = half_view(17, 11, open_plane());
  given.settings.specular = Specular::slices;
  given.reset = true;
  const Results found = run_by_cpp(given, 0);
  ASSERT_EQ(found.visibility.width, 9u);
  ASSERT_EQ(found.visibility.height, 6u);
  EXPECT_THAT(found.visibility.texels, testing::Each(1.0f));
  EXPECT_THAT(found.specular.texels, testing::Each(testing::Ge(0.995f)));
}

// Away from depth edges a texel is about the mean of its four upsampled pixels.
TEST_F(COutputs, HalfSizeOutputsAgreeWithTheMeanOfUpsampledOutputs) {
  GivenView given = half_view(64, 48, groove(0.8));
  given.settings.bent_normal = true;
  given.settings.specular = Specular::slices;
  given.reset = true;
  const Results half = run_by_cpp(given, 0);
  given.half_size_outputs = false;
  const Results full = run_by_cpp(given, 0);
  const auto mean_difference = [](const HostImage& small, const HostImage& large) {
    double sum = 0.0;
    for (std::uint32_t y = 0; y < small.height; ++y) {
      for (std::uint32_t x = 0; x < small.width; ++x) {
        const float mean = (large.at(2 * x, 2 * y) + large.at(2 * x + 1, 2 * y) +
                            large.at(2 * x, 2 * y + 1) + large.at(2 * x + 1, 2 * y + 1)) /
                           4.0f;
        sum += std::abs(small.at(x, y) - mean);
      }
    }
    return sum / (small.width * small.height);
  };
  EXPECT_LT(mean_difference(half.visibility, full.visibility), 0.01);
  EXPECT_LT(mean_difference(half.specular, full.specular), 0.01);
  EXPECT_LT(mean_difference(half.bent_normal, full.bent_normal), 0.01);
}

// The radius of this test is so small that nothing occludes. Each bent normal is then the normal of
// its pixel, and shows which pixel a texel belongs to.
TEST_F(COutputs, HalfSizeTexelsShowTheNearestOrFarthestOfFourPixelsInACheckerboard) {
  GivenView given = half_view(33, 23, ball_on_floor());
  given.settings.bent_normal = true;
  given.settings.radius = 1e-4f;
  given.reset = true;
  const HostImage found = run_by_cpp(given, 0).bent_normal;
  const bool reversed = given.view.clip_from_view[10] >= 0.0f;
  std::size_t told_apart = 0;
  for (std::uint32_t y = 0; y < found.height; ++y) {
    for (std::uint32_t x = 0; x < found.width; ++x) {
      std::array<std::uint32_t, 2> chosen{};
      double best = 0.0;
      bool any = false;
      for (std::uint32_t i = 0; i < 4; ++i) {
        const std::uint32_t px = 2 * x + i / 2, py = 2 * y + i % 2;
        if (px >= 33 || py >= 23) continue;
        const double depth = given.depth_ndc.at(px, py);
        const bool sky = depth == (reversed ? 0.0 : 1.0);
        const double farness = reversed ? -depth : depth;
        const double rank = (x + y) % 2 == 0 ? -farness : sky ? -1e9 : farness;
        if (!any || rank > best) {
          any = true;
          best = rank;
          chosen = {px, py};
        }
      }
      const double depth = given.depth_ndc.at(chosen[0], chosen[1]);
      if (depth == (reversed ? 0.0 : 1.0)) continue;
      for (std::uint32_t c = 0; c < 3; ++c) {
        ASSERT_NEAR(found.at(x, y, c), given.normals.at(chosen[0], chosen[1], c), 2e-3)
            << "at " << x << ", " << y;
      }
      ++told_apart;
    }
  }
  EXPECT_GT(told_apart, 100u);
}

TEST_F(COutputs, HalfSizeOutputsOfWrongSizeOrWithUnsuitableSettingsAreRefused) {
  AlcoveSettings settings;
  const GivenView given = half_view(17, 11, open_plane());
  AlcoveView view = view_of(given, settings);
  const auto with_image = [&](std::uint32_t width, std::uint32_t height) {
    AlcoveView changed = view;
    changed.visibility = output(VK_FORMAT_R8_UNORM, width, height);
    return changed;
  };
  EXPECT_THAT(error_of(with_image(8, 5)), HasSubstr("is 8x5 pixels; with half_size_outputs it must "
                                                    "be 9x6, half of depth's 17x11 rounded up."));
  EXPECT_THAT(error_of(with_image(17, 11)), HasSubstr("it must be 9x6"));
  AlcoveView full = view;
  full.half_size_outputs = VK_FALSE;
  EXPECT_THAT(error_of(full), HasSubstr("is 9x6 pixels and that of depth 17x11"));
  settings.half_resolution = VK_FALSE;
  EXPECT_THAT(error_of(view), HasSubstr("needs half_resolution in its settings"));
  settings.half_resolution = VK_TRUE;
  view.multi_bounce = output(VK_FORMAT_R32G32B32A32_SFLOAT, 9, 6);
  EXPECT_THAT(error_of(view), HasSubstr("half_size_outputs and an image of multi-bounce"));
  view.multi_bounce = {};
  view.specular = output(VK_FORMAT_R8_UNORM, 9, 6);
  settings.specular = ALCOVE_SPECULAR_TABLE;
  EXPECT_THAT(error_of(view), HasSubstr("outputs of half size need slices"));
}

}  // namespace
}  // namespace alcove::passes
