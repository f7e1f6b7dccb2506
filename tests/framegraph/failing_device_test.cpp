// Tests the executor on a device that runs out of memory or is lost.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "executor_fixture.h"

namespace alcove::framegraph {
namespace {

class FailingDeviceTest : public ExecutorTest {
 protected:
  void SetUp() override {
    ExecutorTest::SetUp();
    host_ = gpu_.make_host_buffer(4 * sizeof(std::uint32_t));
  }

  // Declares a frame with transients, an import and a history. The pass that writes the history
  // runs on `queue`.
  void declare(Graph& graph, QueueClass queue = QueueClass::graphics) {
    declare_chain(graph, host_, 4);
    const TextureHistory history =
        graph.create_texture_history("history", {VK_FORMAT_R32_UINT, Extent::absolute(4, 4)});
    PassBuilder pass = graph.add_pass("remember", queue);
    const Texture texture = pass.write(history.current, access::clear, {}, Contents::discard);
    pass.record([=](RecordContext& c) {
      (void)c.view(texture);
      clear_image(c, c.image(texture), 1);
    });
    graph.output(texture);
  }

  HostBuffer host_;
};

// Makes each call that creates an object fail in turn. The frame must then return an error, the
// next frame must run, and nothing may leak.
TEST_F(FailingDeviceTest, OutOfDeviceMemoryInAnyVulkanCallIsAnErrorAndLeaksNothing) {
  int failed = 0;
  int last = 0;
  for (const bool submits : {false, true}) {
    for (int call = 1; call == 1 || last >= call - 1; ++call) {
      Executor executor = make();
      Graph graph;
      failing::fail_at(call);
      declare(graph);
      const auto report = submits ? executor.submit(graph) : gpu_.run(executor, graph);
      last = failing::calls();
      failing::fail_at(0);
      if (last < call) {
        EXPECT_TRUE(report);
      } else {
        ++failed;
        ASSERT_FALSE(report) << "call " << call;
        EXPECT_EQ(report.error()[0].result, VK_ERROR_OUT_OF_DEVICE_MEMORY);
      }
      ASSERT_TRUE(executor.wait());
      declare(graph);
      const auto again = submits ? executor.submit(graph) : gpu_.run(executor, graph);
      EXPECT_TRUE(again) << to_string(again.error());
      ASSERT_TRUE(executor.wait());
    }
    EXPECT_EQ(failing::alive(), 0);
  }
  EXPECT_GE(failed, 20);
}

// Loses the device at each submission in turn. Every later call must return an error, and nothing
// may leak.
TEST_F(FailingDeviceTest, LosingTheDeviceAtAnySubmissionIsAnErrorAndLeaksNothing) {
  DeviceHandles two = handles();
  two.queues[1] = two.queues[0];
  int lost = 0;
  for (int submission = 0; submission < 4; ++submission) {
    {
      Executor executor = make(two);
      Graph graph;
      failing::lose_after(submission);
      for (std::uint32_t frame = 0; frame < 4; ++frame) {
        declare(graph, QueueClass::compute);
        const auto report = executor.submit(graph, {frame % 2});
        if (report) {
          EXPECT_EQ(lost, 0);
          continue;
        }
        ++lost;
        EXPECT_EQ(report.error()[0].result, VK_ERROR_DEVICE_LOST);
        EXPECT_THAT(report.error()[0].message, testing::HasSubstr("VK_ERROR_DEVICE_LOST"));
      }
      EXPECT_GE(lost, 1) << submission;
      lost = 0;
    }
    EXPECT_EQ(failing::alive(), 0);
    failing::lose(false);
  }
}

TEST_F(FailingDeviceTest, LosingTheDeviceWhileWaitingForAFrameIsAnErrorAndLeaksNothing) {
  {
    Executor executor = make();
    Graph graph;
    declare(graph);
    ASSERT_TRUE(executor.submit(graph));
    failing::lose(true);
    const auto waited = executor.wait();
    ASSERT_FALSE(waited);
    EXPECT_EQ(waited.error()[0].result, VK_ERROR_DEVICE_LOST);
    declare(graph);
    const auto report = executor.submit(graph);
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error()[0].result, VK_ERROR_DEVICE_LOST);
  }
  EXPECT_EQ(failing::alive(), 0);
  failing::lose(false);
}

}  // namespace
}  // namespace alcove::framegraph
