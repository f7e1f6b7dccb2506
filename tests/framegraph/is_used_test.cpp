// Tests that a pass learns which parts of its resources are in use.
#include <gtest/gtest.h>

#include "executor_fixture.h"

namespace alcove::framegraph {
namespace {

class PartOfATexture : public ExecutorTest {
 protected:
  // Runs a graph whose pass reads one part of a texture, and would write another that nobody reads.
  void expect_used(Graph& graph, PassBuilder& pass, Texture texture, Range read, Range culled) {
    int calls = 0;
    pass.side_effect();
    pass.record([&calls, texture, read, culled](RecordContext& c) {
      ++calls;
      EXPECT_TRUE(c.is_used(texture, read));
      EXPECT_FALSE(c.is_used(texture, culled));
      EXPECT_TRUE(c.is_used(texture));
    });
    Executor executor = make({.check_uses = true});
    const auto report = gpu_.run(executor, graph);
    ASSERT_TRUE(report) << to_string(report.error());
    EXPECT_EQ(calls, 1);
  }
};

TEST_F(PartOfATexture, CulledWriteOfAMipIsNotUsedThoughThePassReadsAnotherMip) {
  Graph graph;
  Texture texture = graph.create_texture("t", {VK_FORMAT_R32_UINT, Extent::absolute(4, 4), 2});
  PassBuilder clear = graph.add_pass("clear");
  texture = clear.write(texture, access::clear, Range::mip(0));
  clear.record([=](RecordContext& c) { clear_image(c, c.image(texture), 1); });
  PassBuilder reduce = graph.add_pass("reduce");
  reduce.read(texture, access::sampled_general_compute, Range::mip(0));
  texture = reduce.write_optional(texture, access::storage_write_compute, Range::mip(1));
  expect_used(graph, reduce, texture, Range::mip(0), Range::mip(1));
}

TEST_F(PartOfATexture, CulledWriteOfStencilIsNotUsedThoughThePassReadsDepth) {
  Graph graph;
  Texture texture =
      graph.create_texture("t", {VK_FORMAT_D32_SFLOAT_S8_UINT, Extent::absolute(4, 4)});
  PassBuilder draw = graph.add_pass("draw");
  texture = draw.write(texture, access::depth_attachment);
  draw.record([](RecordContext&) {});
  PassBuilder mask = graph.add_pass("mask");
  mask.read(texture, access::depth_read_fragment, Range::depth());
  texture = mask.write_optional(texture, access::stencil_attachment, Range::stencil());
  expect_used(graph, mask, texture, Range::depth(), Range::stencil());
}

}  // namespace
}  // namespace alcove::framegraph
