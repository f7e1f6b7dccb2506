// Tests recording with several threads, if one of them throws or cannot be created.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <latch>
#include <new>
#include <optional>
#include <system_error>
#include <thread>
#ifdef __linux__
#include <pthread.h>
#endif

#include "allocation_counter.h"
#include "gpu.h"

namespace alcove::framegraph {
namespace {

constexpr std::uint32_t kWords = 8;

class RecordingThreads : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(gpu_.problem(), "");
    host_ = gpu_.make_host_buffer(kWords * sizeof(std::uint32_t));
    options_.recording_threads = 2;
  }
  void TearDown() override { EXPECT_EQ(gpu_.messages(), ""); }

  // Adds one pass for each word of the host buffer. The pass calls during_ and writes `value` to
  // its word.
  void declare(std::uint32_t value) {
    graph_.reset();
    Buffer out = graph_.import_buffer("host", Gpu::imported(host_));
    for (std::uint32_t i = 0; i < kWords; ++i) {
      PassBuilder pass = graph_.add_pass("a pass with a name of some length");
      out = pass.write(out, buffer_access::fill);
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
      gpu_.throw_away();
      return true;
    }
    return false;
  }
  void expect_right(Executor& executor, std::uint32_t value) {
    during_ = nullptr;
    declare(value);
    const auto report = gpu_.run(executor, graph_);
    ASSERT_TRUE(report) << to_string(report.error());
    const auto* words = static_cast<const std::uint32_t*>(host_.mapped);
    for (std::uint32_t i = 0; i < kWords; ++i) EXPECT_EQ(words[i], value);
  }

  Gpu gpu_;
  HostBuffer host_;
  ExecutorOptions options_;
  Graph graph_;
  std::function<void()> during_;
};

TEST_F(RecordingThreads, ExceptionThrownByAPassCallbackInAWorkerThreadReachesTheCaller) {
  auto executor = Executor::create(gpu_.handles(), options_);
  ASSERT_TRUE(executor) << to_string(executor.error());
  const std::thread::id caller = std::this_thread::get_id();
  std::latch thrown(1);
  during_ = [&] {
    if (std::this_thread::get_id() == caller) return thrown.wait();
    if (thrown.try_wait()) return;
    thrown.count_down();
    throw std::bad_alloc();
  };
  declare(1);
  EXPECT_TRUE(throws(*executor));
  expect_right(*executor, 2);
}

TEST_F(RecordingThreads, ExceptionThrownInTheCallingThreadIsRethrownAfterAllWorkerThreadsFinished) {
  auto executor = Executor::create(gpu_.handles(), options_);
  ASSERT_TRUE(executor) << to_string(executor.error());
  const std::thread::id caller = std::this_thread::get_id();
  std::latch begun(1);
  std::atomic<bool> recording = false;
  during_ = [&] {
    if (std::this_thread::get_id() == caller) {
      begun.wait();
      throw std::bad_alloc();
    }
    recording = true;
    if (!begun.try_wait()) begun.count_down();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    recording = false;
  };
  declare(1);
  EXPECT_TRUE(throws(*executor));
  EXPECT_FALSE(recording);
  expect_right(*executor, 2);
}

// Creates an executor and records its first frame. Repeats this with each allocation of the calling
// thread failing in turn.
TEST_F(RecordingThreads, NextFrameIsRecordedCorrectlyAfterAnyHostAllocationFailed) {
  options_.recording_threads = 4;
  bool failed = true;
  std::size_t which = 1;
  for (; failed; ++which) {
    SCOPED_TRACE(which);
    fail_allocation(which);
    std::optional<Executor> executor;
    try {
      if (auto made = Executor::create(gpu_.handles(), options_)) executor = std::move(*made);
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

#ifdef __GLIBC__
// During the object's lifetime, no thread can be created: the stack size of new threads is set to
// more than any machine has.
class NoThreads {
 public:
  NoThreads() {
    pthread_getattr_default_np(&before_);
    pthread_attr_t none;
    pthread_attr_init(&none);
    pthread_attr_setstacksize(&none, std::size_t{1} << 46);
    EXPECT_EQ(pthread_setattr_default_np(&none), 0);
    pthread_attr_destroy(&none);
  }
  ~NoThreads() {
    pthread_setattr_default_np(&before_);
    pthread_attr_destroy(&before_);
  }
  NoThreads(const NoThreads&) = delete;
  NoThreads& operator=(const NoThreads&) = delete;

 private:
  pthread_attr_t before_;
};

TEST_F(RecordingThreads, CallingThreadRecordsTheFrameAloneIfNoOtherThreadCanBeCreated) {
  options_.recording_threads = 4;
  const auto create = [&] {
    const NoThreads none;
    EXPECT_THROW(std::thread([] {}).join(), std::system_error);
    return Executor::create(gpu_.handles(), options_);
  };
  auto executor = create();
  ASSERT_TRUE(executor) << to_string(executor.error());
  expect_right(*executor, 1);
}
#endif

}  // namespace
}  // namespace alcove::framegraph
