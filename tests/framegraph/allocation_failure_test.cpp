// Tests recording if a callback throws an exception or host memory runs out.
#include <gtest/gtest.h>

#include <functional>
#include <new>
#include <optional>

#include "allocation_counter.h"
#include "executor_fixture.h"

namespace alcove::framegraph {
namespace {

constexpr std::uint32_t kWords = 8;

class AllocationFailure : public ExecutorTest {
 protected:
  void SetUp() override {
    ExecutorTest::SetUp();
    host_ = gpu_.make_host_buffer(kWords * sizeof(std::uint32_t));
  }

  // Adds one pass for each word of the host buffer. The pass calls during_ and writes `value` to
  // its word.
  void declare(std::uint32_t value) {
    graph_.reset();
    Buffer out = graph_.import_buffer("host", Gpu::imported(host_));
    for (std::uint32_t i = 0; i < kWords; ++i) {
      PassBuilder pass = graph_.add_pass("a pass with a name of some length");
      out = pass.write(out, buffer_access::fill,
                       out.version == 0 ? Contents::discard : Contents::keep);
      pass.record([=, this](RecordContext& c) {
        if (during_) during_();
        vkCmdFillBuffer(c.commands, c.buffer(out), i * sizeof value, sizeof value, value);
      });
    }
  }
  // Returns whether recording the declared frame throws std::bad_alloc. The frame is not submitted.
  bool throws(Executor& executor) {
    try {
      (void)gpu_.record(executor, graph_);
    } catch (const std::bad_alloc&) {
      gpu_.end();
      return true;
    }
    return false;
  }
  void expect_right(Executor& executor, std::uint32_t value) {
    during_ = nullptr;
    declare(value);
    const auto report = gpu_.run(executor, graph_);
    ASSERT_TRUE(report) << to_string(report.error());
    for (std::uint32_t i = 0; i < kWords; ++i) EXPECT_EQ(host_.words[i], value);
  }

  HostBuffer host_;
  Graph graph_;
  std::function<void()> during_;
};

TEST_F(AllocationFailure, ExceptionThrownByAPassCallbackReachesTheCaller) {
  Executor executor = make();
  during_ = [] { throw std::bad_alloc(); };
  declare(1);
  EXPECT_TRUE(throws(executor));
  expect_right(executor, 2);
}

// Creates an executor and records its first frame. Repeats this with each allocation failing in
// turn.
TEST_F(AllocationFailure, NextFrameIsRecordedCorrectlyAfterAnyHostAllocationFailed) {
  bool failed = true;
  std::size_t which = 1;
  for (; failed; ++which) {
    SCOPED_TRACE(which);
    fail_allocation(which);
    std::optional<Executor> executor;
    try {
      if (auto made = Executor::create(gpu_.handles())) executor = std::move(*made);
      declare(1);
    } catch (const std::bad_alloc&) {
    }
    const bool made = executor.has_value();
    const bool threw = made && !allocation_failed() && throws(*executor);
    failed = allocation_failed();
    fail_allocation(0);
    EXPECT_TRUE(made || failed);
    EXPECT_TRUE(failed || !threw);
    if (made) expect_right(*executor, static_cast<std::uint32_t>(which));
    ASSERT_LT(which, 2000u);
  }
  EXPECT_GT(which, 20u) << "too few allocations were made to fail";
}

}  // namespace
}  // namespace alcove::framegraph
