// Tests of culling: passes that nobody needs are removed, and every pass has a reason.
#include <gtest/gtest.h>

#include "small_frames.h"

namespace alcove::framegraph {
namespace {

class Cull : public testing::Test {
 protected:
  Texture write(const char* name, Texture texture, Contents contents = Contents::discard) {
    return graph_.add_pass(name).write(texture, access::storage_write_compute, {}, contents);
  }
  Texture write_from(const char* name, Texture input, Texture output) {
    PassBuilder pass = graph_.add_pass(name);
    pass.read(input, access::sampled_compute);
    return pass.write(output, access::storage_write_compute, {}, Contents::discard);
  }
  // Returns a history that an earlier frame has written.
  TextureHistory make_history() {
    (void)write("first", graph_.create_texture_history("h", kSmall).current, Contents::discard);
    graph_.leave_histories(plan().finals);
    graph_.reset();
    return graph_.create_texture_history("h", kSmall);
  }
  Texture make(const char* name) { return write(name, graph_.create_texture(name, kSmall)); }
  Plan plan() const { return compile_verified(graph_); }
  Graph graph_;
};

TEST_F(Cull, PassWhoseOutputNobodyReadsIsCulledTogetherWithItsTexture) {
  const Texture wanted = make("wanted");
  (void)make("unwanted");
  graph_.output(wanted);
  const Plan result = plan();
  ASSERT_EQ(result.passes.size(), 1u);
  EXPECT_EQ(result.cull_reasons[0].cull_reason, CullReason::output);
  EXPECT_EQ(result.cull_reasons[1].cull_reason, CullReason::unread);
  EXPECT_EQ(result.placements[1].heap, kNone);
}

TEST_F(Cull, PlanNamesThePassThatReadsTheOutputOfAKeptPass) {
  const Texture first = make("first");
  const Texture second = write_from("reader", first, graph_.create_texture("second", kSmall));
  graph_.output(second);
  const Plan result = plan();
  EXPECT_EQ(result.cull_reasons[0].cull_reason, CullReason::feeds_pass);
  EXPECT_EQ(result.cull_reasons[0].consumer, 1u);
  EXPECT_EQ(result.cull_reasons[0].resource, 0u);
}

TEST_F(Cull, PassDeclaredToHaveASideEffectIsKeptThoughItWritesNothing) {
  graph_.add_pass("kept").side_effect();
  (void)graph_.add_pass("gone");
  const Plan result = plan();
  EXPECT_EQ(result.cull_reasons[0].cull_reason, CullReason::side_effect);
  EXPECT_EQ(result.cull_reasons[1].cull_reason, CullReason::writes_nothing);
}

TEST_F(Cull, PassWhoseOutputTheNextPassDiscardsIsCulled) {
  Texture texture = make("first");
  texture = write("second", texture, Contents::discard);
  graph_.output(texture);
  const Plan result = plan();
  EXPECT_EQ(result.cull_reasons[0].cull_reason, CullReason::unread);
  EXPECT_EQ(result.cull_reasons[1].cull_reason, CullReason::output);
}

TEST_F(Cull, PassThatWritesAMipIsCulledUnlessThatMipIsRead) {
  TextureDesc desc = kSmall;
  desc.mips = 3;
  Texture texture = graph_.create_texture("t", desc);
  for (std::uint32_t mip = 0; mip < 3; ++mip) {
    texture = graph_.add_pass("mip").write(texture, access::storage_write_compute, Range::mip(mip),
                                           Contents::discard);
  }
  add_read(graph_, texture, access::sampled_compute, QueueClass::graphics, Range::mip(1));
  const Plan result = plan();
  EXPECT_EQ(result.cull_reasons[0].cull_reason, CullReason::unread);
  EXPECT_EQ(result.cull_reasons[1].cull_reason, CullReason::feeds_pass);
  EXPECT_EQ(result.cull_reasons[2].cull_reason, CullReason::unread);
}

TEST_F(Cull, PassThatWritesAHistoryIsKeptOnlyIfAKeptPassReadsThatHistory) {
  const TextureHistory history = make_history();
  const Texture result =
      write_from("accumulate", history.previous(), graph_.create_texture("result", kSmall));
  (void)write("remember", history.current);
  // Nobody needs the result. The pass that reads the history and the pass that writes it need only
  // each other, so that both are culled.
  EXPECT_EQ(plan().passes.size(), 0u);
  graph_.output(result);
  const Plan kept = plan();
  EXPECT_EQ(kept.passes.size(), 2u);
  EXPECT_EQ(kept.cull_reasons[1].cull_reason, CullReason::feeds_history);
  EXPECT_EQ(kept.cull_reasons[1].consumer, 0u);
}

// A depth pyramid that only the culling of the next frame reads is declared in this way. After a
// reset it starts anew, and a frame that does not read it need not write it.
TEST_F(Cull, HistoryThatIsReadOnlyIfItIsValidIsWrittenInTheFirstFrame) {
  for (const bool reads : {true, false}) {
    graph_.reset_histories();
    for (int frame = 0; frame < 3; ++frame) {
      graph_.reset();
      const TextureHistory history = graph_.create_texture_history("h", kSmall);
      const bool is_valid = history.validity == HistoryValidity::valid;
      EXPECT_EQ(is_valid, frame != 0);
      PassBuilder reader = graph_.add_pass("reader");
      if (is_valid && reads) reader.read(history.previous(), access::sampled_compute);
      reader.side_effect();
      (void)write("writer", history.current, Contents::discard);
      const Plan result = plan();
      EXPECT_EQ(result.cull_reasons[1].cull_reason,
                is_valid && !reads ? CullReason::unread : CullReason::feeds_history);
      EXPECT_EQ(result.cull_reasons[1].consumer, is_valid && reads ? 0u : kNone);
      graph_.leave_histories(result.finals);
    }
  }
}

TEST_F(Cull, PassThatUpdatesAHistoryInPlaceIsKeptOnlyIfAKeptPassReadsThatHistory) {
  const TextureHistory history = make_history();
  (void)write("remember", history.current);
  const Texture result =
      write_from("look", history.previous(), graph_.create_texture("result", kSmall));
  (void)graph_.add_pass("update").write(history.previous(), access::storage_read_write_compute);
  EXPECT_EQ(plan().passes.size(), 0u);
  graph_.output(result);
  const Plan kept = plan();
  EXPECT_EQ(kept.passes.size(), 3u);
  EXPECT_EQ(kept.cull_reasons[2].cull_reason, CullReason::feeds_history);
  EXPECT_EQ(kept.cull_reasons[2].consumer, 1u);
}

// A pass updates `acc` and writes a second texture. Only the second texture is an output:
//
//   clear -> acc -> update -> acc (unread)
//                     +----> second -> output
class CullReadModifyWrite : public Cull {
 protected:
  // Returns the plan of the frame above. The arguments are the accesses of the two passes to `acc`.
  Plan plan_of_update(const Access& clear, const Access& update) {
    TextureDesc desc = kSmall;
    if (update.usage & VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT)
      desc.format = VK_FORMAT_D32_SFLOAT;
    Texture acc = graph_.create_texture("acc", desc);
    Texture second = graph_.create_texture("second", kSmall);
    acc = graph_.add_pass("clear").write(acc, clear, {}, Contents::discard);
    PassBuilder both = graph_.add_pass("update");
    (void)both.write(acc, update);
    second = both.write(second, access::storage_write_compute, {}, Contents::discard);
    graph_.output(second);
    return plan();
  }
};

// Reading and writing in a shader, blending, and the depth test.
TEST_F(CullReadModifyWrite, PassThatWritesTheInputOfAReadModifyWriteIsNotCulled) {
  for (const auto& [clear, update] : {std::pair{access::clear, access::storage_read_write_compute},
                                      {access::clear, access::color_attachment},
                                      {access::depth_attachment, access::depth_attachment}}) {
    graph_.reset();
    const Plan plan = plan_of_update(clear, update);
    EXPECT_EQ(plan.passes.size(), 2u);
    EXPECT_EQ(plan.cull_reasons[0].cull_reason, CullReason::feeds_pass);
    EXPECT_EQ(plan.cull_reasons[0].consumer, 1u);
  }
}

TEST_F(CullReadModifyWrite, PassIsCulledIfItsTextureIsOnlyWrittenAgainWithoutBeingRead) {
  const Plan result = plan_of_update(access::clear, access::storage_write_compute);
  EXPECT_EQ(result.passes.size(), 1u);
  EXPECT_EQ(result.cull_reasons[0].cull_reason, CullReason::unread);
}

TEST_F(CullReadModifyWrite, VerifierRefusesAPlanThatLacksTheWriterOfAReadModifyWritesInput) {
  (void)plan_of_update(access::clear, access::storage_read_write_compute);
  // `wrong` is the plan of the same frame, except that its update does not read `acc`. The pass
  // that clears `acc` is therefore culled in that plan.
  const GraphDescription& description = graph_.description();
  GraphDescription not_reading = description;
  not_reading.accesses[1].access = access::storage_write_compute.access;
  const auto wrong = compile(not_reading);
  ASSERT_TRUE(wrong);
  ASSERT_EQ(wrong->passes.size(), 1u);
  EXPECT_TRUE(verify(not_reading, {}, *wrong));
  const auto verified = verify(description, {}, *wrong);
  ASSERT_FALSE(verified);
  EXPECT_NE(
      to_string(verified.error()).find("the update of 'acc' does not find what was written for it"),
      std::string::npos);
}

// A history keeps its contents for the next frame. They are needed if a pass that runs writes any
// part of them, even if no pass of this frame reads them.
TEST_F(Cull, AllWritersOfAHistoryAreKeptIfOneOfThemRuns) {
  const TextureHistory history = graph_.create_texture_history("history", kSmall);
  const Texture filled = write("fill", history.current, Contents::discard);
  PassBuilder update = graph_.add_pass("update");
  const Texture updated = update.write(filled, access::storage_write_compute);
  update.side_effect();
  (void)write("finish", updated, Contents::keep);
  EXPECT_EQ(plan().passes.size(), 3u);
}

}  // namespace
}  // namespace alcove::framegraph
