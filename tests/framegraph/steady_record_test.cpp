// Tests that no memory is allocated when a frame that was recorded before is declared, recorded and
// submitted again.
#include <gtest/gtest.h>

#include "allocation_counter.h"
#include "gpu.h"

namespace alcove::framegraph {
namespace {

// Declares a frame with transients, a history, an import, views, and passes on other queues.
void declare(Graph& graph, const HostBuffer& host) {
  graph.reset();
  const TextureDesc desc{VK_FORMAT_R32_UINT, Extent::absolute(16, 16)};
  const TextureHistory history = graph.create_texture_history("history", desc);
  Buffer out = graph.import_buffer("out", Gpu::imported(host));
  PassBuilder remember = graph.add_pass("remember");
  const Texture current = remember.write(history.current, access::clear, {}, Contents::discard);
  remember.record([=](RecordContext& c) { clear_image(c, c.image(current), 0); });
  for (int i = 0; i < 10; ++i) {
    Texture texture = graph.create_texture("texture", desc);
    PassBuilder make = graph.add_pass("a pass with a name of some length");
    make.read(i % 2 ? history.previous() : current, access::sampled_compute);
    texture = make.write(texture, access::clear, {}, Contents::discard);
    make.record([=](RecordContext& c) {
      if (c.view(texture) != VK_NULL_HANDLE) clear_image(c, c.image(texture), 0);
    });
    PassBuilder copy = graph.add_pass("copy", QueueClass::transfer);
    copy.read(texture, access::transfer_source);
    out = copy.write(out, buffer_access::transfer_destination,
                     out.version == 0 ? Contents::discard : Contents::keep);
    copy.record([=](RecordContext& c) {
      copy_image(c, c.image(texture), c.buffer(out), 0, c.extent(texture));
    });
  }
}

enum class Path { record, submit, submit_to_three };

// Returns the number of allocations of this thread in 20 frames, after some frames of warm-up.
std::size_t allocations_of_steady_frames(Path path) {
  Gpu gpu(false);
  EXPECT_EQ(gpu.problem(), "");
  DeviceHandles handles = gpu.handles();
  if (path == Path::submit_to_three) handles.queues[1] = handles.queues[2] = handles.queues[0];
  ExecutorOptions options;
  options.check_uses = false;
  auto executor = Executor::create(handles, options);
  EXPECT_TRUE(executor);
  const HostBuffer host = gpu.make_host_buffer(VkDeviceSize{4} * 16 * 16);
  Graph graph;
  std::size_t before = 0;
  constexpr int kFrames = 30;
  for (int frame = 0; frame < kFrames; ++frame) {
    if (frame == 10) before = allocations();
    declare(graph, host);
    if (path == Path::record)
      EXPECT_TRUE(gpu.run(*executor, graph));
    else
      EXPECT_TRUE(executor->submit(graph, {static_cast<std::uint32_t>(frame % 2)}));
    EXPECT_TRUE(executor->wait(static_cast<std::uint32_t>(frame % 2)));
    EXPECT_EQ(executor->timings().empty(), false);
  }
  return allocations() - before;
}

TEST(SteadyFrameRecording, RecordingAnUnchangedFrameAgainAllocatesNoHostMemory) {
  EXPECT_EQ(allocations_of_steady_frames(Path::record), 0u);
}
TEST(SteadyFrameRecording, SubmittingAnUnchangedFrameAgainAllocatesNoHostMemory) {
  EXPECT_EQ(allocations_of_steady_frames(Path::submit), 0u);
}
TEST(SteadyFrameRecording, SubmittingAnUnchangedFrameToThreeQueuesAgainAllocatesNoHostMemory) {
  EXPECT_EQ(allocations_of_steady_frames(Path::submit_to_three), 0u);
}

}  // namespace
}  // namespace alcove::framegraph
