// Tests frames whose passes several threads record at the same time.
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "alcove/framegraph/verify.h"
#include "drawing.h"
#include "gtao_scenes.h"
#include "pass_fixture.h"

namespace alcove::passes {
namespace {

using framegraph::Graph;
using framegraph::Texture;

constexpr std::uint32_t kWidth = 16;
constexpr std::uint32_t kHeight = 12;
constexpr std::size_t kPixels = std::size_t{kWidth} * kHeight;
constexpr std::uint32_t kViews = 8;

std::unique_ptr<sample::HostBuffer> host_buffer(const sample::Gpu& gpu, std::size_t floats,
                                                VkBufferUsageFlags usage) {
  auto made = sample::HostBuffer::create(gpu.device(), floats * sizeof(float), usage);
  EXPECT_TRUE(made) << made.error();
  return std::move(*made);
}

std::unique_ptr<sample::HostBuffer> uploaded(const sample::Gpu& gpu, const HostImage& image) {
  auto buffer = host_buffer(gpu, image.texels.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  std::memcpy(buffer->bytes().data(), image.texels.data(), buffer->bytes().size());
  return buffer;
}

// Several views of one scene, so that many passes are recorded at the same time.
class Views {
 public:
  explicit Views(sample::Gpu& gpu) : gpu_(gpu) {
    const Drawing drawing = draw(test_views()[2], kWidth, kHeight, ball_on_floor());
    depth_ = uploaded(gpu, drawing.depth_ndc);
    normals_ = uploaded(gpu, drawing.normal_vs);
    for (std::uint32_t view = 0; view < kViews; ++view) {
      results_.push_back(host_buffer(gpu, kPixels, VK_BUFFER_USAGE_TRANSFER_DST_BIT));
    }
  }

  void run(std::uint32_t frame) {
    const auto report = gpu_.run([&](Graph& graph) { return declare(graph, frame); });
    EXPECT_TRUE(report) << report.error();
  }
  std::vector<float> visibility(std::uint32_t view) const {
    std::vector<float> texels(kPixels);
    std::memcpy(texels.data(), results_[view]->bytes().data(), texels.size() * sizeof(float));
    return texels;
  }

 private:
  tl::expected<void, std::string> declare(Graph& graph, std::uint32_t index) {
    const auto upload = [&](const char* name, VkFormat format, const sample::HostBuffer& from) {
      return add_copy(
          graph, from,
          graph.create_texture(name, {format, framegraph::Extent::absolute(kWidth, kHeight)}));
    };
    const Texture depth = upload("depth", VK_FORMAT_R32_SFLOAT, *depth_);
    const Texture normals = upload("normals", VK_FORMAT_R32G32B32A32_SFLOAT, *normals_);
    const Frame frame{
        .graph = graph, .kernels = gpu_.kernels(), .view = test_views()[2].view, .index = index};
    for (std::uint32_t view = 0; view < kViews; ++view) {
      OcclusionSettings settings =
          quality_settings(Quality::medium, 0.2f * static_cast<float>(1 + view));
      settings.precision = Precision::float32;
      const auto outputs = add_occlusion(
          frame, {.depth_ndc = depth, .normals = normals, .normals_in_view_space = true}, settings,
          "view " + std::to_string(view));
      if (!outputs) {
        return tl::unexpected(outputs.error().message);
      }
      add_read_back(graph, outputs->visibility, *results_[view]);
    }
    return {};
  }

  sample::Gpu& gpu_;
  std::unique_ptr<sample::HostBuffer> depth_;
  std::unique_ptr<sample::HostBuffer> normals_;
  std::vector<std::unique_ptr<sample::HostBuffer>> results_;
};

// Returns the messages of the validation layers, except one that is known to be false. If a layout
// change and the operations that its barrier waits for are in different command buffers, the layers
// do not see that they are ordered. With one thread they do.
std::string messages(const sample::Gpu& gpu) {
  std::string text;
  for (const std::string& message : gpu.device().validation_messages()) {
    if (message.find("vkCmdExecuteCommands: Hazard") == std::string::npos) {
      text += message + '\n';
    }
  }
  return text;
}

// Returns the visibility of each view of each frame, recorded by `threads` threads.
std::vector<std::vector<float>> run_frames(std::uint32_t threads, std::uint32_t frames) {
  const auto gpu = sample::Gpu::create(
      {.validation = true},
      {.recording_threads = threads, .verify = framegraph::verify, .check_uses = true});
  EXPECT_TRUE(gpu) << gpu.error();
  Views views(**gpu);
  std::vector<std::vector<float>> found;
  for (std::uint32_t frame = 0; frame < frames; ++frame) {
    views.run(frame);
    for (std::uint32_t view = 0; view < kViews; ++view) {
      found.push_back(views.visibility(view));
    }
  }
  EXPECT_EQ(messages(**gpu), "");
  return found;
}

TEST(PassesOnSeveralThreads, OcclusionRecordedByFourThreadsEqualsThatRecordedByOneThread) {
  constexpr std::uint32_t kFrames = 100;
  const auto by_one = run_frames(1, kFrames);
  const auto by_four = run_frames(4, kFrames);
  ASSERT_EQ(by_four.size(), by_one.size());
  for (std::size_t i = 0; i < by_one.size(); ++i) {
    ASSERT_EQ(by_four[i], by_one[i]) << "frame " << i / kViews << ", view " << i % kViews;
  }
}

}  // namespace
}  // namespace alcove::passes
