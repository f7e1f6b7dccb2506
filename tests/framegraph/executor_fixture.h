// A device with validation, on which each test creates its executors.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>

#include "gpu.h"

namespace alcove::framegraph {

class ExecutorTest : public testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(gpu_.problem(), ""); }
  void TearDown() override { EXPECT_EQ(gpu_.messages(), ""); }

  Executor make(const ExecutorOptions& options = {}) {
    auto made = Executor::create(gpu_.handles(), options);
    EXPECT_TRUE(made.has_value());
    return std::move(*made);
  }
  Gpu gpu_;
};

// Declares a chain of passes that clear textures which share memory. Each texture is copied out
// before the next is cleared.
inline void declare_chain(Graph& graph, const HostBuffer& host, std::uint32_t length) {
  graph.reset();
  Buffer out = graph.import_buffer("out", Gpu::imported(host));
  for (std::uint32_t i = 0; i < length; ++i) {
    Texture texture =
        graph.create_texture("texture", {VK_FORMAT_R32_UINT, Extent::absolute(16 + i, 16)});
    texture = add_clear(graph, texture, 100 + i);
    out = add_copy(graph, texture, out, i * sizeof(std::uint32_t));
  }
}

}  // namespace alcove::framegraph
