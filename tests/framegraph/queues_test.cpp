// Tests that queues wait for each other only if they must.
#include <gtest/gtest.h>

#include "fake_handle.h"
#include "small_frames.h"

namespace alcove::framegraph {
namespace {

class Queues : public testing::Test {
 protected:
  Queues() {
    limits_.queue_families[1] = 1;
    limits_.queue_families[2] = 2;
  }
  Texture make(const char* name) { return graph_.create_texture(name, kSmall); }
  // Imports a texture whose final state is a read by compute shaders.
  Texture import(const char* name) {
    const State state{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT,
                      VK_IMAGE_LAYOUT_GENERAL};
    return graph_.import_texture(
        name, {.image = fake_handle<VkImage>(imports_++),
               .desc = kSmall,
               .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
               .initial_state = state,
               .final_state = state});
  }
  Plan compiled() const { return compile_verified(graph_, limits_); }
  Graph graph_;
  Limits limits_;
  std::size_t imports_ = 0;
};

// Pass c waits for pass b, which waits for pass a. Pass c therefore needs no wait of its own for
// pass a:
//
//   a (graphics) -- x --> b (compute) -- z --> c (transfer)
//         +--------------- y -------------------^
TEST_F(Queues, SemaphoreWaitsImpliedByOtherWaitsAreLeftOut) {
  PassBuilder a = graph_.add_pass("a");
  const Texture x = a.write(make("x"), access::storage_write_compute, {}, Contents::discard);
  const Texture y = a.write(make("y"), access::storage_write_compute, {}, Contents::discard);
  PassBuilder b = graph_.add_pass("b", QueueClass::compute);
  b.read(x, access::storage_read_compute);
  const Texture z = b.write(make("z"), access::storage_write_compute, {}, Contents::discard);
  PassBuilder c = graph_.add_pass("c", QueueClass::transfer);
  c.read(y, access::transfer_source);
  c.read(z, access::transfer_source);
  c.side_effect();
  const Plan plan = compiled();
  ASSERT_EQ(plan.submissions.size(), 3u);
  ASSERT_EQ(plan.submissions[2].wait_count, 1u);
  EXPECT_EQ(plan.waits[plan.submissions[2].first_wait].submission, 1u)
      << "the wait for b implies the wait for a";
}

TEST_F(Queues, AtTheEndOfAFrameTheGraphicsQueueWaitsOnlyForTheLastOfAChainOfQueues) {
  Texture x = import("x");
  Texture y = import("y");
  PassBuilder first = graph_.add_pass("first", QueueClass::compute);
  x = first.write(x, access::storage_write_compute, {}, Contents::discard);
  const Texture between =
      first.write(make("between"), access::storage_write_compute, {}, Contents::discard);
  PassBuilder second = graph_.add_pass("second", QueueClass::transfer);
  second.read(between, access::transfer_source);
  y = second.write(y, access::transfer_destination, {}, Contents::discard);
  const Plan plan = compiled();
  const Submission& last = plan.submissions.back();
  EXPECT_EQ(last.pass_count, 0u);
  ASSERT_EQ(last.wait_count, 1u);
  EXPECT_EQ(plan.submissions[plan.waits[last.first_wait].submission].queue, QueueClass::transfer);
}

TEST_F(Queues, ComputePassesThatReadImportsOfTheGraphicsQueueShareOneSubmission) {
  const Texture x = import("x");
  const Texture y = import("y");
  for (const Texture texture : {x, y})
    add_read(graph_, texture, access::storage_read_compute, QueueClass::compute);
  const Plan plan = compiled();
  EXPECT_EQ(plan.passes[0].submission, plan.passes[1].submission);
}

// In the second frame a pass of the compute queue updates one of the history's two mips. No pass
// uses the other mip, which the compute queue owns too. The verifier must accept the plan.
TEST_F(Queues, UpdatingAPartOfAHistoryOnTheQueueThatOwnsItGivesAVerifiedPlan) {
  const auto declare = [&] {
    graph_.reset();
    return graph_.create_texture_history("h", {VK_FORMAT_R8_UNORM, Extent::absolute(8, 8), 2});
  };
  TextureHistory history = declare();
  graph_.output(add_write(graph_, history.current, QueueClass::compute));
  graph_.leave_histories(compiled().finals);
  history = declare();
  ASSERT_EQ(history.validity, HistoryValidity::valid);
  PassBuilder update = graph_.add_pass("update", QueueClass::compute);
  graph_.output(update.write(history.previous(), access::clear, Range{1, 1, 0, 1}));
  (void)compiled();
}

// Two queues read one of the history's two mips, so that the frame leaves the mips in different
// layouts. The final barriers bring both into one layout, and no barrier changes a layout twice.
TEST_F(Queues, HistoryWhoseMipsSeveralQueuesReadIsLeftInOneLayout) {
  for (int frame = 0; frame < 3; ++frame) {
    graph_.reset();
    const TextureHistory history =
        graph_.create_texture_history("h", {VK_FORMAT_R8_UNORM, Extent::absolute(8, 8), 2});
    const Texture written = add_write(graph_, history.current);
    for (const QueueClass queue : {QueueClass::graphics, QueueClass::compute})
      add_read(graph_, written, access::sampled_compute, queue, Range::mip(1));
    const Plan plan = compiled();
    for (const FinalState& left : plan.finals) EXPECT_NE(left.written, WriteCoverage::part);
    graph_.leave_histories(plan.finals);
  }
}

// The frame leaves the mips of a history with different stages: compute updates mip 0, and graphics
// waits for it in the fragment stage only. A barrier of the next frame comes after both mips.
TEST_F(Queues, HistoryWhoseMipsEndTheFrameInDifferentStagesGivesAVerifiedPlan) {
  for (int frame = 0; frame < 3; ++frame) {
    graph_.reset();
    const TextureHistory history =
        graph_.create_texture_history("h", {VK_FORMAT_R32_UINT, Extent::absolute(64, 64), 2});
    const bool is_first = history.validity != HistoryValidity::valid;
    Texture texture = is_first ? history.current : history.previous();
    PassBuilder first =
        graph_.add_pass("mip 0", is_first ? QueueClass::graphics : QueueClass::compute);
    texture = first.write(texture,
                          is_first ? access::color_attachment : access::storage_read_write_compute,
                          Range::mip(0), is_first ? Contents::discard : Contents::keep);
    PassBuilder second = graph_.add_pass("second");
    if (is_first)
      texture = second.write(texture, access::clear, Range::mip(1), Contents::discard);
    else
      second.read(texture, access::storage_read_fragment);
    first.side_effect();
    second.side_effect();
    Plan plan = compiled();
    graph_.leave_histories(plan.finals);
    // The next frame would not wait for a use that the final state does not name.
    for (FinalState& final : plan.finals) final.state.stages = 0;
    EXPECT_FALSE(verify(graph_.description(), limits_, plan));
  }
}

// The image of a window is imported without a state. The semaphore of its acquisition waits in any
// stage of the queue that uses the image first, or of the graphics queue. The first change of the
// layout comes after it.
TEST_F(Queues, ImportWithTheDefaultStateIsFirstUsedAfterASemaphoreThatTheFrameWaitsFor) {
  for (const QueueClass queue : {QueueClass::graphics, QueueClass::compute}) {
    graph_.reset();
    ImportedTexture import{.image = fake_handle<VkImage>(), .desc = kSmall};
    import.usage = ~VkImageUsageFlags{0};
    import.final_state = access::present;
    add_write(graph_, graph_.import_texture("window", import), queue);
    const Plan plan = compiled();
    ASSERT_FALSE(plan.transitions.empty());
    EXPECT_NE(plan.transitions[0].src_stages &
                  (VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT),
              0u);
    // The compute queue waits for a submission of the graphics queue.
    EXPECT_EQ(plan.submissions[0].queue, QueueClass::graphics);
    EXPECT_EQ(plan.submissions.size(), queue == QueueClass::graphics ? 1u : 3u);
  }
}

// Particles are simulated on the compute queue while the scene is drawn on the graphics queue. The
// two share no memory, so that neither queue waits for the previous frame of the other.
TEST_F(Queues, QueuesThatShareNoMemoryDoNotWaitForEachOthersPreviousFrame) {
  const TextureHistory particles = graph_.create_texture_history("particles", kSmall);
  PassBuilder simulate = graph_.add_pass("simulate", QueueClass::compute);
  (void)simulate.write(particles.current, access::storage_write_compute, {}, Contents::discard);
  simulate.side_effect();
  const Texture scene = add_write(graph_, make("scene"), access::color_attachment);
  add_read(graph_, scene, access::sampled_fragment);
  const Plan plan = compiled();
  ASSERT_GE(plan.submissions.size(), 2u);
  for (const Submission& submission : plan.submissions) EXPECT_EQ(submission.frame_before, 0u);
}

//   scene (graphics) --> blur (compute) --> effect outside the graph
// The pass `blur` reads the texture that the graphics queue writes. In the next frame the graphics
// queue writes to the same memory, so that it must wait for the previous frame's `blur`.
TEST_F(Queues, GraphicsQueueWaitsBeforeReusingMemoryThatComputeReadInThePreviousFrame) {
  const Texture scene = add_write(graph_, make("scene"), access::color_attachment);
  add_read(graph_, scene, access::sampled_compute, QueueClass::compute);
  Plan plan = compiled();
  const auto compute = static_cast<std::uint8_t>(1u << static_cast<unsigned>(QueueClass::compute));
  ASSERT_EQ(plan.submissions[0].queue, QueueClass::graphics);
  EXPECT_EQ(plan.submissions[0].frame_before, compute);
  EXPECT_EQ(plan.submissions[1].frame_before, 0u);
  plan.submissions[0].frame_before = 0;
  EXPECT_FALSE(verify(graph_.description(), limits_, plan));
}

// A history that the graphics queue wrote was used in an earlier frame. The compute queue waits for
// that frame, and the graphics queue needs no submission before its passes to be waited for.
TEST_F(Queues, QueueThatReadsAHistoryOfAnotherQueueWaitsForThePreviousFrame) {
  Plan plan;
  for (int frame = 0; frame < 2; ++frame) {
    graph_.reset();
    const TextureHistory history = graph_.create_texture_history("history", kSmall);
    if (frame == 1)
      add_read(graph_, history.previous(), access::sampled_compute, QueueClass::compute);
    PassBuilder draw = graph_.add_pass("draw");
    (void)draw.write(history.current, access::color_attachment, {}, Contents::discard);
    draw.side_effect();
    plan = compiled();
    graph_.leave_histories(plan.finals);
  }
  for (const Submission& submission : plan.submissions)
    EXPECT_TRUE(submission.pass_count != 0 || submission.wait_count != 0);
  ASSERT_EQ(plan.submissions[0].queue, QueueClass::compute);
  const auto graphics =
      static_cast<std::uint8_t>(1u << static_cast<unsigned>(QueueClass::graphics));
  EXPECT_EQ(plan.submissions[0].frame_before, graphics);
  plan.submissions[0].frame_before = 0;
  EXPECT_FALSE(verify(graph_.description(), limits_, plan));
}

// Occlusion is computed on the compute queue and read by the lighting on the graphics queue. The
// history that it is written to must be valid in the next frame.
TEST_F(Queues, HistoryWrittenOnOneQueueAndReadOnAnotherIsValidInTheNextFrame) {
  for (const std::uint32_t family : {0u, 1u}) {
    limits_.queue_families[1] = family;
    HistoryValidity validity = HistoryValidity::first_frame;
    for (int frame = 0; frame < 2; ++frame) {
      graph_.reset();
      graph_.reset_history(frame == 0 ? "history" : "");
      const TextureHistory history = graph_.create_texture_history("history", kSmall);
      validity = history.validity;
      const Texture occlusion = add_write(graph_, history.current, QueueClass::compute);
      add_read(graph_, occlusion, access::sampled_fragment);
      Plan plan = compiled();
      graph_.leave_histories(plan.finals);
      ASSERT_FALSE(plan.finals.empty());
      plan.finals[0].written = WriteCoverage::nothing;
      EXPECT_FALSE(verify(graph_.description(), limits_, plan));
      plan.finals.clear();
      EXPECT_FALSE(verify(graph_.description(), limits_, plan));
    }
    EXPECT_EQ(validity, HistoryValidity::valid) << "in family " << family;
  }
}

// A texture that never changes is read on both queues:
//
//   static --> occlusion (compute) --> lighting (graphics)
//      +------------- depth (graphics) ----^
TEST_F(Queues, ReadingAnImportThatNoQueueWritesNeedsNoSubmissionsWithoutPasses) {
  const State state{0, 0, VK_IMAGE_LAYOUT_GENERAL};
  const State final_state{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT,
                          VK_IMAGE_LAYOUT_GENERAL};
  for (const bool has_final_state : {false, true}) {
    graph_.reset();
    limits_.queue_families[1] = 0;
    const Texture fixed =
        graph_.import_texture("static", {.image = fake_handle<VkImage>(),
                                         .desc = kSmall,
                                         .usage = VK_IMAGE_USAGE_STORAGE_BIT,
                                         .initial_state = state,
                                         .final_state = has_final_state ? final_state : State{}});
    PassBuilder depth = graph_.add_pass("depth");
    depth.read(fixed, access::storage_read_fragment);
    const Texture drawn = depth.write(make("depth"), access::color_attachment);
    PassBuilder occlusion = graph_.add_pass("occlusion", QueueClass::compute);
    occlusion.read(fixed, access::storage_read_compute);
    const Texture occluded =
        occlusion.write(make("occlusion"), access::storage_write_compute, {}, Contents::discard);
    PassBuilder lighting = graph_.add_pass("lighting");
    lighting.read(drawn, access::sampled_fragment);
    lighting.read(occluded, access::sampled_fragment);
    lighting.side_effect();
    const Plan plan = compiled();
    EXPECT_EQ(plan.submissions.size(), 3u);
    EXPECT_EQ(plan.waits.size(), 1u) << "only the lighting has to wait";
  }
}

// Two queues read one texture, each after the pass that writes it and not after each other.
TEST_F(Queues, QueuesThatOnlyReadATextureDoNotWaitForEachOther) {
  limits_.queue_families[1] = 0;
  const Texture shared = add_write(graph_, make("shared"));
  for (const QueueClass queue :
       {QueueClass::graphics, QueueClass::compute, QueueClass::graphics, QueueClass::compute})
    add_read(graph_, shared, access::storage_read_compute, queue);
  const Plan plan = compiled();
  EXPECT_EQ(plan.submissions.size(), 3u);
  EXPECT_EQ(plan.waits.size(), 1u);
}

// `light` reads the result of the compute queue in fragment shaders, and `mirror` reads it in
// vertex shaders of a later submission. The vertex shaders of `light` must not wait.
TEST_F(Queues, SubmissionWaitsInTheStagesThatUseWhatItWaitsFor) {
  for (const bool has_mirror : {false, true}) {
    graph_.reset();
    const Texture occlusion = add_write(graph_, make("ao"), QueueClass::compute);
    PassBuilder light = graph_.add_pass("light");
    light.read(occlusion, access::storage_read_fragment);
    (void)light.write(make("color"), access::color_attachment, {}, Contents::discard);
    light.side_effect();
    const Texture blurred = add_write(graph_, make("blurred"), QueueClass::compute);
    PassBuilder mirror = graph_.add_pass("mirror");
    mirror.read(blurred, access::sampled_fragment);
    if (has_mirror)
      mirror.read(occlusion, access::storage_read(VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT));
    mirror.side_effect();
    Plan plan = compiled();
    ASSERT_EQ(plan.waits.size(), 2u);
    EXPECT_EQ(plan.waits[0].stages, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT);
    EXPECT_EQ((plan.waits[1].stages & VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT) != 0, has_mirror);
    plan.waits[1].stages &= VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT;
    EXPECT_FALSE(verify(graph_.description(), limits_, plan));
  }
}

// Two passes on two queues read a depth attachment, in one other layout:
//
//   gbuffer (graphics) -- depth --> ao (compute) ------> light (graphics)
//                           +-----> decals (graphics) ----^
//
// The graphics queue changes the layout after `gbuffer`, so that `decals` waits for no other queue.
TEST_F(Queues, ReadersOfAnAttachmentOnTwoQueuesDoNotWaitForEachOther) {
  for (const std::uint32_t family : {0u, 1u}) {
    limits_.queue_families[1] = family;
    for (const bool decals_first : {false, true}) {
      graph_.reset();
      PassBuilder gbuffer = graph_.add_pass("gbuffer");
      const Texture depth =
          gbuffer.write(graph_.create_texture("depth", {VK_FORMAT_D32_SFLOAT, kSmall.extent, 2}),
                        access::depth_attachment, {}, Contents::discard);
      Texture occlusion;
      Texture color;
      const auto draw_decals = [&] {
        PassBuilder decals = graph_.add_pass("decals");
        decals.read(depth, access::depth_read_fragment, Range::mip(0));
        color = decals.write(make("color"), access::color_attachment, {}, Contents::discard);
      };
      if (decals_first) draw_decals();
      PassBuilder ao = graph_.add_pass("ao", QueueClass::compute);
      ao.read(depth, access::depth_read_compute);
      occlusion = ao.write(make("ao"), access::storage_write_compute, {}, Contents::discard);
      if (!decals_first) draw_decals();
      PassBuilder light = graph_.add_pass("light");
      light.read(occlusion, access::sampled_fragment);
      light.read(color, access::sampled_fragment);
      light.side_effect();
      Plan plan = compiled();
      // Two of the submissions [gbuffer] [ao] [decals] [light] wait: ao and light.
      ASSERT_EQ(plan.submissions.size(), 4u);
      for (const PlannedPass& planned : plan.passes) {
        const std::string_view name = graph_.description().pass_name(planned.pass);
        EXPECT_EQ(plan.submissions[planned.submission].wait_count,
                  name == "ao" || name == "light" ? 1u : 0u)
            << name;
      }
      EXPECT_EQ(plan.placements[depth.index].concurrent, family != 0);
      ASSERT_NE(plan.submissions[0].end_batch, kNone);
      EXPECT_EQ(plan.batches[plan.submissions[0].end_batch].count, 1u) << "one for both mips";
      plan.submissions[0].end_batch = kNone;
      EXPECT_FALSE(verify(graph_.description(), limits_, plan));
    }
  }
}

}  // namespace
}  // namespace alcove::framegraph
