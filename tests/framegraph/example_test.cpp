// The example of framegraph/README.md, as it stands there, run on the device.
#include <gtest/gtest.h>

#include "gpu.h"

namespace alcove::framegraph {
namespace {

// Stand-ins for an engine's kernels: what they are given is looked at, nothing is drawn.
void dispatch_occlusion(RecordContext&, VkImageView depth, VkImageView ao, VkExtent3D size) {
  EXPECT_NE(depth, VkImageView{VK_NULL_HANDLE});
  EXPECT_NE(ao, VkImageView{VK_NULL_HANDLE});
  EXPECT_EQ(size.width, 16u);  // half of 31, rounded up
}
void dispatch_blur(RecordContext&, VkImageView ao, VkImageView soft, VkExtent3D size) {
  EXPECT_NE(ao, soft);
  EXPECT_EQ(size.height, 9u);
}
void dispatch_edges(RecordContext&, VkImageView) { ADD_FAILURE() << "nobody reads the edges"; }
void copy_to_buffer(RecordContext& context, VkImage image, VkBuffer buffer, VkExtent3D size) {
  VkBufferImageCopy copy{};
  copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  copy.imageExtent = size;
  context.vk.vkCmdCopyImageToBuffer(context.commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                    buffer, 1, &copy);
}

// A depth buffer of the engine's, half-resolution occlusion from it, blurred, read back by the
// host.
void declare_frame(Graph& graph, const ImportedTexture& engine_depth, const ImportedBuffer& host) {
  graph.reset();
  const Texture depth = graph.import_texture("depth", engine_depth);
  Buffer result = graph.import_buffer("result", host);

  Texture ao = graph.create_texture("ao", {VK_FORMAT_R32_UINT, Extent::relative(depth, 2)});
  PassBuilder occlusion = graph.add_pass("occlusion", QueueClass::compute);
  occlusion.read(depth, access::sampled_compute);
  ao = occlusion.write(ao, access::storage_write_compute);
  occlusion.record([=](RecordContext& context) {
    // Bind context.view(depth) and context.view(ao), then dispatch.
    dispatch_occlusion(context, context.view(depth), context.view(ao), context.extent(ao));
  });

  // An output that costs nothing unless somebody reads it: here nobody does.
  Texture edges = graph.create_texture("edges", {VK_FORMAT_R32_UINT, Extent::relative(ao)});
  Texture soft = graph.create_texture("soft", {VK_FORMAT_R32_UINT, Extent::relative(ao)});
  PassBuilder blur = graph.add_pass("blur", QueueClass::compute);
  blur.read(ao, access::sampled_compute);
  soft = blur.write(soft, access::storage_write_compute);
  edges = blur.write_optional(edges, access::storage_write_compute);
  blur.record([=](RecordContext& context) {
    dispatch_blur(context, context.view(ao), context.view(soft), context.extent(soft));
    if (context.is_used(edges)) dispatch_edges(context, context.view(edges));
  });

  PassBuilder copy = graph.add_pass("copy");
  copy.read(soft, access::transfer_source);
  result = copy.write(result, buffer_access::transfer_destination, Contents::discard);
  copy.record([=](RecordContext& context) {
    copy_to_buffer(context, context.image(soft), context.buffer(result), context.extent(soft));
  });
}

TEST(Example, OfTheReadmeRuns) {
  Gpu gpu;
  ASSERT_EQ(gpu.problem(), "");
  ImportedTexture depth;
  depth.desc = {VK_FORMAT_R32_UINT, Extent::absolute(31, 17)};
  depth.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  depth.image = gpu.make_image(depth.desc, depth.usage);
  // The engine left it so; here nothing did, and its contents do not matter.
  depth.initial_state = {VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT, 0,
                         VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  gpu.change_layout(depth.image, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  const HostBuffer host = gpu.make_host_buffer(VkDeviceSize{4} * 16 * 9);
  {
    auto executor = Executor::create(gpu.handles());
    ASSERT_TRUE(executor) << to_string(executor.error());
    Graph graph;
    for (int frame = 0; frame < 2; ++frame) {
      declare_frame(graph, depth, Gpu::imported(host));
      const auto report = gpu.run(*executor, graph);
      ASSERT_TRUE(report) << to_string(report.error());
      EXPECT_EQ(report->plan->passes.size(), 3u);
      EXPECT_EQ(report->compiled, frame == 0);
    }
  }
  EXPECT_EQ(gpu.messages(), "");
}

}  // namespace
}  // namespace alcove::framegraph
