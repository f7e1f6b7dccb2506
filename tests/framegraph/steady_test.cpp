// A frame that did not change allocates nothing: counted by replacing operator new.
#include <gtest/gtest.h>

#include "alcove/framegraph/compile.h"
#include "allocation_counter.h"
#include "deferred_frame.h"

namespace alcove::framegraph {
namespace {

void declare(Graph& graph) {
  graph.reset();
  const TextureHistory history = graph.create_texture_history(
      "history of frames", {VK_FORMAT_R8_UNORM, Extent::absolute(8, 8)});
  declare_deferred_frame(graph, 1920, 1080);
  PassBuilder pass = graph.add_pass("remember");
  graph.output(pass.write(history.current, access::storage_write_compute));
}

TEST(Steady, DeclaringAFrameAgainAllocatesNothing) {
  Graph graph;
  declare(graph);
  declare(graph);
  const GraphDescription kept = graph.description();
  const std::size_t before = allocations();
  for (int frame = 0; frame < 10; ++frame) {
    declare(graph);
    ASSERT_TRUE(same_declaration(graph.description(), kept));
    ASSERT_EQ(hash(graph.description()), hash(kept));
  }
  EXPECT_EQ(allocations() - before, 0u);
}

TEST(Steady, CompilingAFrameAgainAllocatesNothing) {
  Graph graph;
  declare(graph);
  Compiler compiler;
  Plan plan;
  ASSERT_TRUE(compiler.compile(graph.description(), {}, plan));
  const std::size_t before = allocations();
  ASSERT_TRUE(compiler.compile(graph.description(), {}, plan));
  EXPECT_EQ(allocations() - before, 0u);
}

TEST(Steady, AnyDifferenceMakesAnotherKey) {
  Graph one;
  Graph other;
  declare_deferred_frame(one, 1920, 1080);
  declare_deferred_frame(other, 1920, 1080);
  EXPECT_TRUE(same_declaration(one.description(), other.description()));
  (void)other.create_buffer("more", {4});
  EXPECT_FALSE(same_declaration(one.description(), other.description()));
  EXPECT_NE(hash(one.description()), hash(other.description()));
}

}  // namespace
}  // namespace alcove::framegraph
