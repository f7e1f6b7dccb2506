// Tests frames of typical renderers; many are known from the tests of other render graphs. Each
// test checks which passes run and how many barriers they need, and verifies the plan.
#include <gtest/gtest.h>

#include "alcove/framegraph/compile.h"
#include "alcove/framegraph/print.h"
#include "alcove/framegraph/verify.h"
#include "fake_handle.h"

namespace alcove::framegraph {
namespace {

const TextureDesc kColor{VK_FORMAT_R8G8B8A8_UNORM, Extent::absolute(64, 64)};
const TextureDesc kDepth{VK_FORMAT_D32_SFLOAT, Extent::absolute(64, 64)};

class Scenario : public testing::Test {
 protected:
  Plan plan() {
    auto compiled = compile(graph_.description());
    EXPECT_TRUE(compiled) << to_string(compiled.error());
    if (!compiled) return {};
    const auto verified = verify(graph_.description(), {}, *compiled);
    EXPECT_TRUE(verified) << to_string(verified.error());
    return std::move(*compiled);
  }
  // Returns the number of transitions before the pass with this declaration index.
  static std::uint32_t transitions_before(const Plan& plan, std::uint32_t pass) {
    std::uint32_t count = 0;
    for (const PlannedPass& planned : plan.passes) {
      if (planned.pass == pass && planned.batch != kNone) count = plan.batches[planned.batch].count;
    }
    return count;
  }
  // Adds a pass that writes a texture without reading it.
  Texture write(const char* name, Texture texture, const Access& access, const Range& range = {}) {
    return graph_.add_pass(name).write(texture, access, range, Contents::discard);
  }
  // Adds a pass that reads a resource and is not culled.
  template <typename Resource, typename... Use>
  void read(const char* name, Resource resource, const Use&... use) {
    PassBuilder pass = graph_.add_pass(name);
    pass.read(resource, use...);
    pass.side_effect();
  }

  Graph graph_;
};

// prepass -> depth -> opaque -> colour -> output
TEST_F(Scenario, DepthPrepassIsKeptForTheOpaquePassThatTestsAgainstItsDepth) {
  Texture depth = graph_.create_texture("depth", kDepth);
  Texture color = graph_.create_texture("color", kColor);
  depth = write("prepass", depth, access::depth_attachment);
  PassBuilder opaque = graph_.add_pass("opaque");
  (void)opaque.write(depth, access::depth_attachment);
  color = opaque.write(color, access::color_attachment, {}, Contents::discard);
  graph_.output(color);
  EXPECT_EQ(plan().passes.size(), 2u);
}

// clear -> counter -> count -> draw arguments -> draw
TEST_F(Scenario, IndirectDrawWaitsForTheComputePassThatCountsItsArguments) {
  Buffer counter = graph_.create_buffer("counter", {16});
  Texture color = graph_.create_texture("color", kColor);
  counter = graph_.add_pass("clear").write(counter, buffer_access::fill, Contents::discard);
  counter = graph_.add_pass("count").write(counter, buffer_access::storage_read_write_compute);
  PassBuilder draw = graph_.add_pass("draw");
  draw.read(counter, buffer_access::indirect);
  color = draw.write(color, access::color_attachment, {}, Contents::discard);
  graph_.output(color);
  const Plan result = plan();
  EXPECT_EQ(result.passes.size(), 3u);
  const Transition& before_draw = result.transitions[result.batches[result.passes[2].batch].first];
  EXPECT_EQ(before_draw.dst_stages & VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,
            VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT);
}

// a -> b -> a -> b -> output: passes alternate between two textures.
TEST_F(Scenario, PassesThatAlternateBetweenTwoTexturesNeedOnlyTheirMemoryAndAreAllKept) {
  Texture a = graph_.create_texture("a", kColor);
  Texture b = graph_.create_texture("b", kColor);
  a = write("first", a, access::storage_write_compute);
  for (int i = 0; i < 4; ++i) {
    PassBuilder blur = graph_.add_pass("blur");
    blur.read(a, access::sampled_compute);
    b = blur.write(b, access::storage_write_compute, {}, Contents::discard);
    std::swap(a, b);
  }
  graph_.output(a);
  const Plan result = plan();
  EXPECT_EQ(result.passes.size(), 5u);
  ASSERT_EQ(result.heaps.size(), 1u);
  EXPECT_EQ(result.heaps[0].size, 2u * 64 * 64 * 4);
}

TEST_F(Scenario, ReaderOfAMipChainWrittenByOnePassPerMipNeedsAtMostTwoBarriers) {
  TextureDesc desc = kColor;
  desc.mips = 5;
  Texture chain = graph_.create_texture("chain", desc);
  chain = write("mip 0", chain, access::storage_write_compute, Range::mip(0));
  for (std::uint32_t mip = 1; mip < desc.mips; ++mip) {
    PassBuilder down = graph_.add_pass("down");
    down.read(chain, access::sampled_compute, Range::mip(mip - 1));
    chain = down.write(chain, access::storage_write_compute, Range::mip(mip), Contents::discard);
  }
  read("reader", chain, access::sampled_fragment);
  const Plan result = plan();
  EXPECT_EQ(result.passes.size(), 6u);
  // Only the last mip still needs a layout change before the reader. A memory barrier makes the
  // other mips visible.
  EXPECT_LE(transitions_before(result, 5), 2u);
}

TEST_F(Scenario, MipChainWrittenByOnePassNeedsOneBarrierBeforeAndOneAfterThatPass) {
  TextureDesc desc = kColor;
  desc.mips = 5;
  Texture chain = graph_.create_texture("chain", desc);
  chain = write("down", chain, access::storage_read_write_compute);
  read("reader", chain, access::sampled_fragment);
  const Plan result = plan();
  EXPECT_EQ(result.transitions.size(), 2u);
}

// The final state of the texture in the first graph is its initial state in the second.
TEST_F(Scenario, TextureLeftByOneGraphInTheStateThatAnotherGraphNeedsGetsNoFurtherBarrier) {
  const State between{access::sampled_fragment.stages, access::sampled_fragment.access,
                      access::sampled_fragment.layout};
  ImportedTexture import{.image = fake_handle<VkImage>(),
                         .desc = kColor,
                         .usage = ~VkImageUsageFlags{0},
                         .final_state = between};
  (void)graph_.add_pass("draw").write(graph_.import_texture("shared", import),
                                      access::color_attachment, {}, Contents::discard);
  EXPECT_EQ(plan().transitions.size(), 2u);

  graph_.reset();
  import.initial_state = between;
  import.final_state = {};
  read("reader", graph_.import_texture("shared", import), access::sampled_fragment);
  EXPECT_EQ(plan().transitions.size(), 0u);
}

// The pass `accumulate` blends into `sum`, which nobody reads afterwards, and draws `picture`,
// which is an output:
//
//   clear -> sum -> accumulate -> sum (unread)
//                      +------> picture -> output
TEST_F(Scenario, ClearOfABlendTargetIsNotCulledIfOnlyAnotherOutputOfTheBlendingPassIsRead) {
  Texture sum = graph_.create_texture("sum", kColor);
  Texture picture = graph_.create_texture("picture", kColor);
  sum = write("clear", sum, access::clear);
  PassBuilder accumulate = graph_.add_pass("accumulate");
  (void)accumulate.write(sum, access::color_attachment);
  picture = accumulate.write(picture, access::color_attachment, {}, Contents::discard);
  graph_.output(picture);
  EXPECT_EQ(plan().passes.size(), 2u);
}

TEST_F(Scenario, DepthTestAndSamplingOfOneTextureCanBeDeclaredAsOneAccess) {
  Texture depth = graph_.create_texture("depth", kDepth);
  Texture color = graph_.create_texture("color", kColor);
  depth = write("prepass", depth, access::depth_attachment);
  PassBuilder particles = graph_.add_pass("soft particles");
  particles.read(depth, access::depth_test | access::sampled_fragment);
  color = particles.write(color, access::color_attachment, {}, Contents::discard);
  graph_.output(color);
  constexpr Access kBoth = access::depth_test | access::sampled_fragment;
  static_assert(kBoth.layout == VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
  const Plan result = plan();
  EXPECT_EQ(result.passes.size(), 2u);
  EXPECT_EQ(result.placements[depth.index].usage,
            VkFlags{VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT});
}

// The frame has 1,000 passes, each of which reads some of the most recent textures. A debug build
// verifies every new plan; framegraph_benchmark prints how long this takes for a plan of this size.
TEST_F(Scenario, VerifierAcceptsAPlanOfAThousandPassesAndRefusesItIfOnePassLacksItsBarriers) {
  std::vector<Texture> textures;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    Texture texture = graph_.create_texture("texture", kColor);
    PassBuilder pass = graph_.add_pass("pass");
    if (i > 0) pass.read(textures[i - 1], access::sampled_compute);
    if (i > 20) pass.read(textures[i - 1 - i % 20 - 1], access::sampled_compute);
    textures.push_back(pass.write(texture, access::storage_write_compute, {}, Contents::discard));
    pass.side_effect();
  }
  Plan result = plan();
  result.batches[result.passes[900].batch].count = 0;
  EXPECT_FALSE(verify(graph_.description(), {}, result));
}

}  // namespace
}  // namespace alcove::framegraph
