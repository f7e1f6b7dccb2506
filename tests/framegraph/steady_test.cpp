// Tests that declaring and compiling an unchanged frame allocates nothing. Allocations are counted
// by replacing operator new.
#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "alcove/framegraph/compile.h"
#include "allocation_counter.h"
#include "deferred_frame.h"
#include "random_graph.h"

namespace alcove::framegraph {
namespace {

void declare(Graph& graph) {
  graph.reset();
  const TextureHistory history = graph.create_texture_history(
      "history of frames", {VK_FORMAT_R8_UNORM, Extent::absolute(8, 8)});
  declare_deferred_frame(graph, 1920, 1080);
  PassBuilder pass = graph.add_pass("remember");
  graph.output(pass.write(history.current, access::storage_write_compute, {}, Contents::discard));
}

TEST(SteadyFrame, DeclaringAnUnchangedFrameAgainAllocatesNoHostMemory) {
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
  (void)graph.create_buffer("more", {4});
  EXPECT_FALSE(same_declaration(graph.description(), kept));
  EXPECT_NE(hash(graph.description()), hash(kept));
}

TEST(SteadyFrame, CompilingAnUnchangedFrameAgainAllocatesNoHostMemory) {
  Graph graph;
  declare(graph);
  Compiler compiler;
  Plan plan;
  ASSERT_TRUE(compiler.compile(graph.description(), {}, plan));
  const std::size_t before = allocations();
  ASSERT_TRUE(compiler.compile(graph.description(), {}, plan));
  EXPECT_EQ(allocations() - before, 0u);
}

template <typename Record>
bool same_bytes(const Records<Record>& a, const Records<Record>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Record)) == 0);
}

// Declares one of a few frames, chosen at random. Some are empty and some are invalid.
void declare_one_of_few(Graph& graph, Dice& order) {
  graph.reset();
  graph.reset_histories();
  Dice dice(order.roll(5));
  RandomOptions options;
  options.most_passes = 6;
  options.mistakes = order.roll(4) == 0;
  if (order.roll(4) != 0) declare_random(graph, dice, options);
}

TEST(SteadyFrame, GraphReusedAfterResetRecordsTheSameDeclarationAsANewGraph) {
  Graph used;
  Dice order(11);
  for (int frame = 0; frame < 2000; ++frame) {
    Graph fresh;
    Dice same = order;
    declare_one_of_few(used, order);
    declare_one_of_few(fresh, same);
    const GraphDescription& a = used.description();
    const GraphDescription& b = fresh.description();
    ASSERT_TRUE(same_bytes(a.passes, b.passes)) << frame;
    ASSERT_TRUE(same_bytes(a.accesses, b.accesses)) << frame;
    ASSERT_TRUE(same_bytes(a.resources, b.resources)) << frame;
    ASSERT_TRUE(same_bytes(a.outputs, b.outputs)) << frame;
    for (std::uint32_t i = 0; i < a.passes.size(); ++i) ASSERT_EQ(a.pass_name(i), b.pass_name(i));
    for (std::uint32_t i = 0; i < a.resources.size(); ++i)
      ASSERT_EQ(a.resource_name(i), b.resource_name(i));
  }
}

// The caller makes a handle by incrementing the index of another handle. It must be invalid until
// its resource is declared, even if the previous frame declared such a resource.
TEST(SteadyFrame, ResourceHandleMadeUpByTheCallerIsRefused) {
  Graph graph;
  for (int frame = 0; frame < 3; ++frame) {
    graph.reset();
    const TextureDesc desc{VK_FORMAT_R8_UNORM, Extent::absolute(8, 8)};
    Texture made_up = graph.create_texture("first", desc);
    ++made_up.index;
    if (frame == 0) made_up = graph.create_texture("second", desc);
    graph.add_pass("pass").read(made_up, access::sampled_compute);
    EXPECT_EQ((graph.description().accesses[0].flags & kForeign) != 0, frame != 0) << frame;
  }
}

TEST(SteadyFrame, PassAndResourceNamesOfAnyLengthAreStored) {
  Graph graph;
  for (std::size_t size = 0; size < 80; ++size) {
    graph.reset();
    const std::string name = std::string(size, 'a') + "bcdefgh";
    for (std::size_t i = 0; i < name.size(); ++i) {
      const std::string_view part = std::string_view(name).substr(i);
      (void)graph.create_texture(part, {VK_FORMAT_R8_UNORM, Extent::absolute(8, 8)});
      graph.add_pass(part);
    }
    for (std::uint32_t i = 0; i < name.size(); ++i) {
      EXPECT_EQ(graph.description().resource_name(i), name.substr(i));
      EXPECT_EQ(graph.description().pass_name(i), name.substr(i));
    }
  }
}

}  // namespace
}  // namespace alcove::framegraph
