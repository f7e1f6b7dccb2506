#include "pass_fixture.h"

#include <cstring>

namespace alcove::passes {

using framegraph::Graph;
using framegraph::Texture;

void PassTest::SetUp() {
  auto made = sample::Gpu::create({.validation = true}, {.verify = true, .check_uses = true});
  ASSERT_TRUE(made) << made.error();
  gpu_ = std::move(*made);
}

void PassTest::TearDown() {
  if (gpu_) {
    for (const std::string& message : gpu_->device().validation_messages()) {
      ADD_FAILURE() << message;
    }
  }
  uploads_.clear();
  downloads_.clear();
}

Texture PassTest::upload(Graph& graph, const HostImage& image) {
  const std::size_t bytes = image.texels.size() * sizeof(float);
  auto buffer = sample::HostBuffer::create(gpu_->device(), bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  EXPECT_TRUE(buffer) << buffer.error();
  std::memcpy((*buffer)->bytes().data(), image.texels.data(), bytes);
  const Texture target = graph.create_texture(
      "uploaded", {image.channels == 1 ? VK_FORMAT_R32_SFLOAT : VK_FORMAT_R32G32B32A32_SFLOAT,
                   framegraph::Extent::absolute(image.width, image.height)});
  uploads_.push_back(std::move(*buffer));
  return sample::add_copy(graph, *uploads_.back(), target);
}

void PassTest::read_back(Graph& graph, Texture texture, std::uint32_t mip) {
  const VkExtent3D extent = graph.extent(texture);
  HostImage image;
  image.width = std::max(extent.width >> mip, 1u);
  image.height = std::max(extent.height >> mip, 1u);
  image.channels = graph.format(texture) == VK_FORMAT_R32_SFLOAT      ? 1
                   : graph.format(texture) == VK_FORMAT_R32G32_SFLOAT ? 2
                                                                      : 4;
  image.texels.resize(std::size_t{image.width} * image.height * image.channels);
  auto buffer = sample::HostBuffer::create(gpu_->device(), image.texels.size() * sizeof(float),
                                           VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  EXPECT_TRUE(buffer) << buffer.error();
  downloads_.push_back(std::move(*buffer));
  results_.push_back(std::move(image));
  sample::add_read_back(graph, texture, *downloads_.back(), mip);
}

void PassTest::run(const std::function<void(Graph&)>& declare) {
  uploads_.clear();
  downloads_.clear();
  results_.clear();
  const auto report = gpu_->run([&](Graph& graph) -> tl::expected<void, std::string> {
    declare(graph);
    return {};
  });
  ASSERT_TRUE(report) << report.error();
  for (std::size_t i = 0; i < results_.size(); ++i) {
    std::memcpy(results_[i].texels.data(), downloads_[i]->bytes().data(),
                results_[i].texels.size() * sizeof(float));
  }
}

}  // namespace alcove::passes
