// A device with validation, whose functions a test can let fail, and on which it creates executors.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>

#include "failing_device.h"
#include "gpu.h"

namespace alcove::framegraph {

class ExecutorTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(gpu_.problem(), "");
    failing::fail_at(0);
    failing::lose(false);
  }
  void TearDown() override {
    if (gpu_.problem().empty()) {
      EXPECT_EQ(gpu_.messages(), "");
    }
  }

  DeviceHandles handles() const {
    DeviceHandles handles = gpu_.handles();
    handles.get_instance_proc_addr = failing::get_instance_proc_addr;
    return handles;
  }
  static Executor make(const DeviceHandles& handles,
                       const ExecutorOptions& options = {.verify = verify, .check_uses = true}) {
    auto made = Executor::create(handles, options);
    EXPECT_TRUE(made) << to_string(made.error());
    return std::move(*made);
  }
  Executor make() const { return make(handles()); }

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
