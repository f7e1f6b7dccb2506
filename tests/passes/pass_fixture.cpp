#include "pass_fixture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <iterator>
#include <limits>
#include <numeric>
#include <span>

#include "alcove/framegraph/verify.h"
#include "drawing.h"

namespace alcove::passes {

using framegraph::Graph;
using framegraph::Texture;

HostImage decode(std::span<const std::byte> bytes, VkFormat format, std::uint32_t width,
                 std::uint32_t height) {
  const sample::TexelLayout layout = sample::texel_layout(format);
  HostImage image{width, height, {}, layout.channels};
  for (std::size_t i = 0; i < std::size_t{width} * height * layout.channels; ++i)
    image.texels.push_back(sample::read_channel(&bytes[i * layout.bytes], layout));
  return image;
}

HostImage uniform(std::uint32_t width, std::uint32_t height, const std::vector<float>& texel) {
  HostImage image{width, height, {}, static_cast<std::uint32_t>(texel.size())};
  for (std::size_t i = 0; i < std::size_t{width} * height; ++i)
    image.texels.insert(image.texels.end(), texel.begin(), texel.end());
  return image;
}

HostImage with_16_bits(HostImage depth) {
  for (float& texel : depth.texels) texel = std::round(texel * 65535.0f) / 65535.0f;
  return depth;
}

VkFormat float_format(std::uint32_t channels) {
  return channels == 1   ? VK_FORMAT_R32_SFLOAT
         : channels == 2 ? VK_FORMAT_R32G32_SFLOAT
                         : VK_FORMAT_R32G32B32A32_SFLOAT;
}

double rms(const HostImage& a, const HostImage& b) {
  EXPECT_EQ(a.texels.size(), b.texels.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < a.texels.size(); ++i)
    sum += std::pow(double{a.texels[i]} - b.texels[i], 2.0);
  return std::sqrt(sum / static_cast<double>(a.texels.size()));
}

double mean(const HostImage& image) {
  return std::accumulate(image.texels.begin(), image.texels.end(), 0.0) /
         static_cast<double>(image.texels.size());
}

namespace {

// All tests of a program use one device, and the pipelines that earlier tests created.
class SharedGpu : public testing::Environment {
 public:
  void TearDown() override { gpu.reset(); }

  std::unique_ptr<sample::Gpu> gpu;
  std::size_t messages = 0;  // of the validation layers that earlier tests reported
};

SharedGpu& shared = static_cast<SharedGpu&>(*testing::AddGlobalTestEnvironment(new SharedGpu));

}  // namespace

void PassTest::SetUp() {
  if (!shared.gpu) {
    open_gpu();
    return;
  }
  const auto restarted = shared.gpu->restart();
  ASSERT_TRUE(restarted) << restarted.error();
}

void PassTest::open_gpu() {
  shared.gpu.reset();
  shared.messages = 0;
  auto gpu =
      sample::Gpu::create({.validation = true}, {.verify = framegraph::verify, .check_uses = true});
  ASSERT_TRUE(gpu) << gpu.error();
  shared.gpu = std::move(*gpu);
}

void PassTest::TearDown() {
  if (shared.gpu) {
    const std::vector<std::string>& messages = shared.gpu->device().validation_messages();
    for (; shared.messages < messages.size(); ++shared.messages)
      ADD_FAILURE() << messages[shared.messages];
  }
  uploads_.clear();
  downloads_.clear();
}

sample::Gpu& PassTest::gpu() { return *shared.gpu; }

Texture PassTest::upload(Graph& graph, const HostImage& image, VkFormat format) {
  return fill(
      graph,
      graph.create_texture("uploaded",
                           {format == VK_FORMAT_UNDEFINED ? float_format(image.channels) : format,
                            framegraph::Extent::absolute(image.width, image.height)}),
      image);
}

Texture PassTest::fill(Graph& graph, Texture target, const HostImage& image) {
  const std::size_t bytes = image.texels.size() * sizeof(float);
  auto buffer = sample::HostBuffer::create(gpu().device(), bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  EXPECT_TRUE(buffer) << buffer.error();
  std::memcpy((*buffer)->bytes().data(), image.texels.data(), bytes);
  uploads_.push_back(std::move(*buffer));
  return sample::add_copy(graph, *uploads_.back(), target);
}

void PassTest::read_back(Graph& graph, Texture texture) {
  const VkExtent3D extent = graph.extent(texture);
  const VkFormat format = graph.format(texture);
  const sample::TexelLayout layout = sample::texel_layout(format);
  auto buffer = sample::HostBuffer::create(
      gpu().device(), std::size_t{extent.width} * extent.height * layout.channels * layout.bytes,
      VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  ASSERT_TRUE(buffer) << buffer.error();
  downloads_.push_back({std::move(*buffer), format, extent});
  sample::add_read_back(graph, texture, *downloads_.back().buffer);
}

void PassTest::run(const std::function<void(Graph&)>& declare) {
  uploads_.clear();
  downloads_.clear();
  results_.clear();
  const auto report = gpu().run([&](Graph& graph) -> tl::expected<void, std::string> {
    declare(graph);
    return {};
  });
  for (const Download& each : downloads_)
    results_.push_back(
        decode(each.buffer->bytes(), each.format, each.extent.width, each.extent.height));
  ASSERT_TRUE(report) << report.error();
}

void expect_equal(const HostOutputs& outputs, const HostOutputs& expected) {
  for (const OutputMember& each : kOutputs)
    EXPECT_EQ((outputs.*each.texels).texels, (expected.*each.texels).texels);
}

AlcoveViewInfo view_info(const HostView& view) {
  return {.id = view.id,
          .reset_history = view.reset ? 1u : 0u,
          .static_frames = view.static_frames,
          .camera = view.view,
          .previous_camera = view.previous_view,
          .largest_width = view.largest_size.width,
          .largest_height = view.largest_size.height,
          .previous_width = view.previous_size.width,
          .previous_height = view.previous_size.height,
          .depth_format = static_cast<std::uint32_t>(view.depth_format),
          .normals_in_view_space = view.normals_in_view_space ? 1u : 0u};
}

HostView make_view(const Drawing& drawing, const OcclusionSettings& settings, std::uint32_t index) {
  return {.view = drawing.view,
          .reset = index == 0,
          .depth_ndc = drawing.depth_ndc,
          .normals = drawing.normal_vs,
          .second_depth_ndc = drawing.depth_ndc,
          .settings = settings};
}

OcclusionSettings all_outputs(AlcoveQuality quality, float radius, AlcoveSpecular specular) {
  OcclusionSettings settings(quality, radius);
  settings.bent_normal = true;
  settings.specular = specular;
  settings.precision = ALCOVE_PRECISION_FLOAT32;
  settings.slices = std::min(settings.slices, 4u);
  settings.steps = std::min(settings.steps, 16u);
  return settings;
}

HostOutputs PassTest::render(const Drawing& drawing, const OcclusionSettings& settings,
                             std::uint32_t index) {
  return run_occlusion(make_view(drawing, settings, index), index);
}

HostOutputs PassTest::run_occlusion(const HostView& view, std::uint32_t index) {
  ViewTextures textures{};
  run([&](Graph& graph) {
    for (const InputMember& each : kInputs)
      if (const HostImage& image = view.*each.texels;
          each.role != ALCOVE_IMAGE_ALBEDO && !image.texels.empty())
        textures[each.role] = upload(graph, image);
    add_view_of(graph, view_info(view), index, view.settings, textures);
    for (const OutputMember& each : kOutputs)
      if (textures[each.role]) read_back(graph, textures[each.role]);
  });
  HostOutputs outputs;
  std::size_t next = 0;
  for (const OutputMember& each : kOutputs)
    if (textures[each.role] && next < results_.size()) outputs.*each.texels = results_[next++];
  return outputs;
}

void PassTest::poison_memory(std::uint32_t width, std::uint32_t height) {
  constexpr int kTextures = 6;
  const HostImage poison = uniform(width, height, {kNaN, kNaN, kNaN, kNaN});
  run([&](Graph& graph) {
    std::vector<Texture> textures;
    textures.reserve(kTextures);
    for (int i = 0; i < kTextures; ++i) textures.push_back(upload(graph, poison));
    for (const Texture texture : textures) read_back(graph, texture);
  });
}

}  // namespace alcove::passes
