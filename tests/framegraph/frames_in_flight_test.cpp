// Tests consecutive frames between which the CPU does not wait for the GPU.
#include <gtest/gtest.h>

#include "executor_fixture.h"

namespace alcove::framegraph {
namespace {

class FramesInFlight : public ExecutorTest {
 protected:
  void TearDown() override {
    wait();
    ExecutorTest::TearDown();
  }

  Executor make() const {
    return ExecutorTest::make(handles(), {.frames_in_flight = Gpu::kSlots, .timestamps = false});
  }
  // Records and submits a frame. The slot's previous frame must have finished; this frame may still
  // be running when the function returns.
  void run(Executor& executor, Graph& graph, std::uint32_t slot) {
    const auto report = gpu_.record(executor, graph, slot);
    ASSERT_TRUE(report) << to_string(report.error());
    gpu_.submit(slot);
  }

  void wait() { vkDeviceWaitIdle(gpu_.device().device()); }
};

// Returns an import of the buffer whose last use was a copy by the previous frame.
ImportedBuffer arriving(const HostBuffer& host) {
  ImportedBuffer import = Gpu::imported(host);
  import.initial_state = {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                          VK_IMAGE_LAYOUT_UNDEFINED};
  return import;
}

void declare(Graph& graph, std::uint32_t size) {
  graph.reset();
  const Texture texture =
      graph.create_texture("texture", {VK_FORMAT_R32_UINT, Extent::absolute(size, 4)});
  graph.output(add_clear(graph, texture, 0));
}

// Two plans alternate. One ends with a write of the texture and the other with a read, so that each
// frame finds the texture in another state than the one in which it leaves it. The validation
// layers check both submissions.
TEST_F(FramesInFlight, FramesOfAlternatingPlansAreOrderedOnTheDeviceWithoutAWaitOnTheHost) {
  Executor executor = make();
  const HostBuffer host = gpu_.make_host_buffer(4);
  Graph graph;
  for (std::uint32_t frame = 0; frame < Gpu::kSlots; ++frame) {
    const bool written_last = frame % 2 == 0;
    graph.reset();
    Buffer out = graph.import_buffer("out", arriving(host));
    Texture texture =
        graph.create_texture("texture", {VK_FORMAT_R32_UINT, Extent::absolute(16, 16)});
    texture = add_clear(graph, texture, 0);
    if (!written_last) texture = add_clear(graph, texture, 0, Contents::discard);
    out = add_copy(graph, texture, out);
    if (written_last) graph.output(add_clear(graph, texture, 0, Contents::discard));
    run(executor, graph, frame);
  }
  wait();
}

// An image is read by one stage of the frame, and later, in the same layout, by another stage in
// the caller's own commands. The next frame waits only for the caller's stage, so that the frame
// must order its own reads before the final state.
TEST_F(FramesInFlight, BarrierToTheFinalStateOfAnImportWaitsForTheReadsOfTheFrame) {
  Executor executor = make();
  const HostBuffer host = gpu_.make_host_buffer(4);
  const TextureDesc desc{VK_FORMAT_R32_UINT, Extent::absolute(16, 16)};
  constexpr VkImageUsageFlags kUsage =
      VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  const VkImage image = gpu_.make_image(desc, kUsage);
  Graph graph;
  for (std::uint32_t frame = 0; frame < Gpu::kSlots; ++frame) {
    graph.reset();
    Buffer out = graph.import_buffer("out", arriving(host));
    Texture texture = graph.import_texture(
        "image", {.image = image,
                  .desc = desc,
                  .usage = kUsage,
                  .initial_state = {VK_PIPELINE_STAGE_2_BLIT_BIT, 0, VK_IMAGE_LAYOUT_UNDEFINED},
                  .final_state = {VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
                                  VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL}});
    texture = add_clear(graph, texture, 0, Contents::discard);
    out = add_copy(graph, texture, out);
    run(executor, graph, frame);
  }
  wait();
}

// The executor must not conclude from a frame that never runs that earlier frames have finished.
TEST_F(FramesInFlight, RefusedOrDiscardedFrameFreesNoMemoryThatEarlierFramesMayStillUse) {
  Executor executor = make();
  Graph graph;
  declare(graph, 4);
  run(executor, graph, 0);
  declare(graph, 64);  // needs more memory: the old memory is freed when the device is done
  run(executor, graph, 1);
  wait();  // the executor does not know of this wait
  const int alive = failing::alive();
  for (const bool refused : {true, false, true}) {
    // The frame of slot 0 has finished. The frame of slot 1 may still be running.
    declare(graph, refused ? 0 : 64);
    EXPECT_EQ(gpu_.record(executor, graph, 0).has_value(), !refused);
    if (!refused) executor.discard(graph, {0});
    EXPECT_EQ(failing::alive(), alive);
  }
  declare(graph, 64);
  run(executor, graph, 1);
  EXPECT_LT(failing::alive(), alive);
  wait();
}

}  // namespace
}  // namespace alcove::framegraph
