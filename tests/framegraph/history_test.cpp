// Tests histories on the device: in every frame, each slot has the contents that history.h
// promises.
#include <gmock/gmock.h>

#include <array>

#include "executor_fixture.h"

namespace alcove::framegraph {
namespace {

using testing::ElementsAre;

// One frame of a test. It can write its number into the history, and can copy the older slots to
// host memory.
struct Frame {
  std::uint32_t value = 0;
  bool writes = true;
  bool wanted = true;  // if false, the pass that writes the history is culled
  std::uint32_t size = 8;
  bool discarded = false;  // it is recorded and never submitted
  bool in_place = false;   // it updates the newest of the older slots instead
  bool reset = false;      // it resets the history first
};

class GraphHistory : public ExecutorTest {
 protected:
  static constexpr std::uint32_t kSlots = 3;

  void SetUp() override {
    ExecutorTest::SetUp();
    executor_ = std::make_unique<Executor>(make());
    host_ = gpu_.make_host_buffer(VkDeviceSize{4} * kSlots);
  }
  void TearDown() override {
    executor_.reset();
    ExecutorTest::TearDown();
  }

  void run(const Frame& frame) {
    graph_->reset();
    if (frame.reset) graph_->reset_history("history");
    const TextureHistory history = graph_->create_texture_history(
        "history", {VK_FORMAT_R32_UINT, Extent::absolute(frame.size, frame.size)}, kSlots);
    validity_ = history.validity;
    Buffer out = graph_->import_buffer("host", Gpu::imported(host_));
    PassBuilder mark = graph_->add_pass("mark");
    out = mark.write(out, buffer_access::fill, Contents::discard);
    mark.record([out](RecordContext& c) {
      vkCmdFillBuffer(c.commands, c.buffer(out), 0, VK_WHOLE_SIZE, 0xffff);
    });
    Texture newest = frame.in_place ? history.previous() : history.current;
    if (frame.writes)
      newest = add_clear(*graph_, newest, frame.value,
                         frame.in_place ? Contents::keep : Contents::discard);
    if (frame.writes && frame.wanted) graph_->output(newest);
    for (std::uint32_t age = 1; age < kSlots && frame.wanted; ++age) {
      if (!frame.writes && validity_ != HistoryValidity::valid) continue;
      const Texture older = frame.in_place && age == 1 ? newest : history.previous(age);
      out = copy_out(older, out, age);
    }
    const auto report =
        frame.discarded ? gpu_.record(*executor_, *graph_) : gpu_.run(*executor_, *graph_);
    ASSERT_TRUE(report) << to_string(report.error());
    history_bytes_ = report->memory.history;
    if (frame.discarded) executor_->discard(*graph_);
  }

  Buffer copy_out(Texture texture, Buffer out, std::uint32_t age) {
    PassBuilder pass = graph_->add_pass("copy");
    pass.read(texture, access::transfer_source);
    out = pass.write(out, buffer_access::transfer_destination);
    pass.record([=](RecordContext& c) {
      if (c.validity(texture) != HistoryValidity::valid) return;
      copy_image(c, c.image(texture), c.buffer(out), VkDeviceSize{4} * age);
    });
    return out;
  }

  std::uint32_t slot(std::uint32_t age) const { return host_.words[age]; }
  std::array<std::uint32_t, kSlots - 1> slots() const { return {slot(1), slot(2)}; }

  std::unique_ptr<Executor> executor_;
  HostBuffer host_;
  std::unique_ptr<Graph> graph_ = std::make_unique<Graph>();
  HistoryValidity validity_ = HistoryValidity::valid;
  VkDeviceSize history_bytes_ = 0;
};

constexpr std::uint32_t kNothing = 0xffff;

TEST_F(GraphHistory, HistorySlotsHoldTheContentsOfThePreviousFrames) {
  for (std::uint32_t frame = 1; frame <= 6; ++frame) {
    run({frame});
    EXPECT_EQ(validity_, frame == 1 ? HistoryValidity::first_frame : HistoryValidity::valid);
    EXPECT_THAT(slots(),
                ElementsAre(frame > 1 ? frame - 1 : kNothing, frame > 2 ? frame - 2 : kNothing));
  }
}

TEST_F(GraphHistory, FrameWithoutAWriterOfTheHistoryOrWithACulledOneDoesNotRotateItsSlots) {
  run({1});
  run({2});
  run({.writes = false});
  EXPECT_THAT(slots(), ElementsAre(2u, 1u));
  run({.value = 9, .wanted = false});
  run({3});
  EXPECT_THAT(slots(), ElementsAre(2u, 1u));
}

TEST_F(GraphHistory, UpdatingAnOlderHistorySlotInPlaceDoesNotRotateTheSlots) {
  run({1});
  run({2});
  run({.value = 5, .in_place = true});
  run({.value = 6, .in_place = true});
  run({.writes = false});
  EXPECT_THAT(slots(), ElementsAre(6u, 1u));
  run({3});
  EXPECT_THAT(slots(), ElementsAre(6u, 1u));
  run({4});
  EXPECT_THAT(slots(), ElementsAre(3u, 6u));
}

TEST_F(GraphHistory, HistoryKeepsItsContentsThroughAFrameThatDoesNotDeclareIt) {
  run({1});
  graph_->reset();
  ASSERT_TRUE(gpu_.run(*executor_, *graph_));
  run({2});
  EXPECT_EQ(validity_, HistoryValidity::valid);
  EXPECT_EQ(slot(1), 1u);
}

TEST_F(GraphHistory, ResizingAHistoryInvalidatesItAndReportsTheReason) {
  run({1});
  run({2});
  run({.value = 3, .size = 16});
  EXPECT_EQ(validity_, HistoryValidity::resized);
  EXPECT_EQ(slot(1), kNothing);
  run({.value = 4, .size = 16});
  EXPECT_EQ(validity_, HistoryValidity::valid);
  EXPECT_THAT(slots(), ElementsAre(3u, kNothing));
}

TEST_F(GraphHistory, ResettingAHistoryInvalidatesItAndReportsTheReason) {
  run({1});
  run({2});
  graph_->reset_history("history");
  run({3});
  EXPECT_EQ(validity_, HistoryValidity::reset);
  EXPECT_EQ(slot(1), kNothing);
  run({4});
  EXPECT_THAT(slots(), ElementsAre(3u, kNothing));
}

TEST_F(GraphHistory, FrameThatIsRecordedAndDiscardedDoesNotChangeTheHistory) {
  run({.value = 1});
  run({.value = 99, .discarded = true});
  run({.value = 2});
  EXPECT_EQ(slot(1), 1u);
  // The first frame of all, and the first one after a change of size.
  run({.value = 98, .size = 16, .discarded = true});
  EXPECT_EQ(validity_, HistoryValidity::resized);
  run({.value = 3, .size = 16});
  EXPECT_EQ(validity_, HistoryValidity::resized);
  run({.value = 97, .size = 16, .discarded = true});
  executor_->discard(*graph_);
  run({.value = 4, .size = 16});
  EXPECT_EQ(slot(1), 3u);
}

TEST_F(GraphHistory, HistoryIsUnchangedIfAFrameThatResizesOrResetsItIsDiscarded) {
  run({.value = 1});
  run({.value = 2});
  const VkDeviceSize bytes = history_bytes_;
  for (const std::uint32_t size : {16u, 4u}) {
    run({.value = 99, .size = size, .discarded = true});
    EXPECT_EQ(validity_, HistoryValidity::resized);
  }
  run({.value = 98, .discarded = true, .reset = true});
  EXPECT_EQ(validity_, HistoryValidity::reset);
  run({.value = 97, .size = 32, .discarded = true, .reset = true});
  run({.value = 3});
  EXPECT_EQ(validity_, HistoryValidity::valid);
  EXPECT_THAT(slots(), ElementsAre(2u, 1u));
  EXPECT_EQ(history_bytes_, bytes);
  // A frame that runs after discarded ones is kept as usual.
  run({.value = 4, .size = 16});
  run({.value = 5, .size = 16, .discarded = true, .reset = true});
  run({.value = 6, .size = 16});
  EXPECT_THAT(slots(), ElementsAre(4u, kNothing));
}

TEST_F(GraphHistory, DeclaredFrameIsRecordedOnlyOnceEvenIfItIsDiscarded) {
  for (const bool discarded : {false, true}) {
    run({.value = 1, .discarded = discarded});
    const auto report = gpu_.record(*executor_, *graph_);
    ASSERT_FALSE(report);
    EXPECT_NE(report.error()[0].message.find("declare the next one"), std::string::npos);
  }
  run({.value = 4});
  EXPECT_EQ(slot(1), 1u);
}

TEST_F(GraphHistory, GraphsThatShareAnExecutorHaveSeparateHistories) {
  run({.value = 1});
  const VkDeviceSize bytes = history_bytes_;
  // Another graph has a history of the same name with another size.
  auto other = std::make_unique<Graph>();
  std::swap(graph_, other);
  run({.value = 10, .size = 16});
  EXPECT_EQ(validity_, HistoryValidity::first_frame);
  EXPECT_GT(history_bytes_, bytes);
  run({.value = 11, .size = 16});
  EXPECT_EQ(slot(1), 10u);
  std::swap(graph_, other);
  run({.value = 2});
  EXPECT_EQ(slot(1), 1u);
  // A destroyed graph leaves no history to later graphs.
  other = std::make_unique<Graph>();
  run({.value = 3});
  EXPECT_EQ(history_bytes_, bytes);
  std::swap(graph_, other);
  other.reset();
  run({.value = 20, .size = 4});
  EXPECT_EQ(validity_, HistoryValidity::first_frame);
  EXPECT_LE(history_bytes_, bytes);
}

// A graph moves to a new executor: the contents of its histories were lost with the first executor.
TEST_F(GraphHistory, GraphMovedToANewExecutorStartsWithoutHistoryContents) {
  run({1});
  run({2});
  EXPECT_EQ(slot(1), 1u);
  Executor second = make();
  const auto refused = gpu_.record(second, *graph_);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error()[0].code, ErrorCode::misuse);
  EXPECT_NE(refused.error()[0].message.find("another executor"), std::string::npos);
  *executor_ = std::move(second);
  const auto late = gpu_.record(*executor_, *graph_);
  ASSERT_FALSE(late) << "the frame was declared with the histories of the first executor";
  run({3});
  EXPECT_EQ(slot(1), 0xffffu) << "the history of the first executor must not be valid";
  run({4});
  EXPECT_EQ(slot(1), 3u);
}

}  // namespace
}  // namespace alcove::framegraph
