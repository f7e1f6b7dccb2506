// Tests how timings() converts the timestamps of a device. A wrapped device reports the timestamps
// that each test sets.
#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "executor_fixture.h"

namespace alcove::framegraph {
namespace {

std::uint32_t valid_bits = 64;
std::array<std::uint64_t, 2> ticks{};  // at the beginning and the end of each pass
int written = 0;                       // number of timestamps written

VKAPI_ATTR void VKAPI_CALL get_families(VkPhysicalDevice device, std::uint32_t* count,
                                        VkQueueFamilyProperties* families) {
  vkGetPhysicalDeviceQueueFamilyProperties(device, count, families);
  for (std::uint32_t i = 0; families && i < *count; ++i)
    families[i].timestampValidBits = valid_bits;
}

VKAPI_ATTR VkResult VKAPI_CALL get_results(VkDevice /*device*/, VkQueryPool /*pool*/,
                                           std::uint32_t /*first*/, std::uint32_t count,
                                           std::size_t /*size*/, void* data, VkDeviceSize stride,
                                           VkQueryResultFlags /*flags*/) {
  for (std::uint32_t i = 0; i < count; ++i)
    std::memcpy(static_cast<char*>(data) + i * stride, &ticks[i % 2], sizeof ticks[0]);
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL write_timestamp(VkCommandBuffer commands, VkPipelineStageFlags2 stage,
                                           VkQueryPool pool, std::uint32_t query) {
  ++written;
  vkCmdWriteTimestamp2(commands, stage, pool, query);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_proc_addr(VkDevice device, const char* name) {
  if (std::strcmp(name, "vkGetQueryPoolResults") == 0)
    return reinterpret_cast<PFN_vkVoidFunction>(&get_results);
  if (std::strcmp(name, "vkCmdWriteTimestamp2") == 0)
    return reinterpret_cast<PFN_vkVoidFunction>(&write_timestamp);
  return vkGetDeviceProcAddr(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_instance_proc_addr(VkInstance instance,
                                                                const char* name) {
  if (std::strcmp(name, "vkGetPhysicalDeviceQueueFamilyProperties") == 0)
    return reinterpret_cast<PFN_vkVoidFunction>(&get_families);
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0)
    return reinterpret_cast<PFN_vkVoidFunction>(&get_device_proc_addr);
  return vkGetInstanceProcAddr(instance, name);
}

class TimestampsTest : public ExecutorTest {
 protected:
  void SetUp() override {
    ExecutorTest::SetUp();
    written = 0;
    host_ = gpu_.make_host_buffer(4);
  }
  Executor make(std::uint32_t bits) {
    valid_bits = bits;
    DeviceHandles handles = gpu_.handles();
    handles.get_instance_proc_addr = get_instance_proc_addr;
    return ExecutorTest::make(handles);
  }
  // Declares a frame with one pass.
  Graph& declare() {
    graph_.reset();
    Buffer out = graph_.import_buffer("host", Gpu::imported(host_));
    PassBuilder pass = graph_.add_pass("fill");
    out = pass.write(out, buffer_access::fill, Contents::discard);
    pass.record([out](RecordContext& c) {
      vkCmdFillBuffer(c.commands, c.buffer(out), 0, VK_WHOLE_SIZE, 1);
    });
    return graph_;
  }
  double milliseconds(std::uint64_t of_ticks) {
    return static_cast<double>(of_ticks) * gpu_.device().properties().limits.timestampPeriod * 1e-6;
  }

  HostBuffer host_;
  Graph graph_;
};

TEST_F(TimestampsTest, PassTimesAreRightWhenTheTimestampCounterWrapsAround) {
  for (const std::uint32_t bits : {36u, 63u, 64u}) {
    Executor executor = make(bits);
    const std::uint64_t all = ~std::uint64_t{0} >> (64 - bits);
    ticks = {all - 99, 50};
    ASSERT_TRUE(gpu_.run(executor, declare()));
    ASSERT_EQ(executor.timings().size(), 1u);
    EXPECT_DOUBLE_EQ(executor.timings()[0].milliseconds, milliseconds(150)) << bits;
  }
}

TEST_F(TimestampsTest, QueueWithoutTimestampSupportGivesNoTimings) {
  Executor executor = make(0);
  ASSERT_TRUE(gpu_.run(executor, declare()));
  EXPECT_TRUE(executor.timings().empty());
  ASSERT_TRUE(executor.submit(declare()));
  ASSERT_TRUE(executor.wait());
  EXPECT_TRUE(executor.timings().empty());
  EXPECT_EQ(written, 0);
}

TEST_F(TimestampsTest, TimingsRequestedBeforeTheFrameFinishedAreRightWhenRequestedAgainLater) {
  Executor executor = make(64);
  gpu_.begin();
  ASSERT_TRUE(executor.record(declare(), gpu_.commands()));
  ticks = {1000, 1007};  // the previous frame's ticks
  EXPECT_EQ(executor.timings().size(), 1u);
  gpu_.end();
  gpu_.submit_and_wait();
  ticks = {2000, 2003};
  ASSERT_EQ(executor.timings().size(), 1u);
  EXPECT_DOUBLE_EQ(executor.timings()[0].milliseconds, milliseconds(3));
}

}  // namespace
}  // namespace alcove::framegraph
