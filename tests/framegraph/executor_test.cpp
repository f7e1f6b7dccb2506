#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>

#include "executor_fixture.h"
#include "extra_device.h"

namespace alcove::framegraph {
namespace {

// A callback that fails makes submit() return an error before anything is submitted: the history
// keeps its contents, and the copy to the host does not run.
TEST_F(ExecutorTest, FrameWhoseCallbackFailsIsNotSubmitted) {
  Executor executor = make();
  const HostBuffer host = gpu_.make_host_buffer(4);
  Graph graph;
  const auto run = [&](std::uint32_t value, int mistake) {
    graph.reset();
    const TextureHistory history =
        graph.create_texture_history("history", {VK_FORMAT_R32_UINT, Extent::absolute(4, 4)});
    const Texture other =
        graph.create_texture("other", {VK_FORMAT_R32_UINT, Extent::absolute(4, 4)});
    PassBuilder clear = graph.add_pass("clear");
    const Texture cleared = clear.write(history.current, access::clear, {}, Contents::discard);
    clear.record([=](RecordContext& c) {
      clear_image(c, c.image(cleared), value);
      if (mistake == 1) c.fail("table", VK_ERROR_OUT_OF_HOST_MEMORY);
      if (mistake == 2) {
        EXPECT_EQ(c.image(other), VkImage{VK_NULL_HANDLE});
      }
    });
    (void)add_copy(graph, cleared, graph.import_buffer("out", Gpu::imported(host)));
    const auto report = executor.submit(graph);
    EXPECT_EQ(report.has_value(), mistake == 0);
    if (!report) {
      const Error& error = report.error()[0];
      EXPECT_EQ(error.code, mistake == 1 ? ErrorCode::vulkan : ErrorCode::undeclared_use);
      EXPECT_THAT(error.message,
                  testing::HasSubstr(mistake == 1
                                         ? "pass 'clear' cannot be recorded: no table could be made"
                                         : "'clear' uses 'other'"));
    }
    EXPECT_TRUE(executor.wait());
    return history.validity;
  };
  EXPECT_EQ(run(7, 1), HistoryValidity::first_frame);
  EXPECT_EQ(run(7, 2), HistoryValidity::first_frame);
  EXPECT_EQ(host.words[0], 0u);
  EXPECT_EQ(run(8, 0), HistoryValidity::first_frame);
  EXPECT_EQ(run(9, 1), HistoryValidity::valid);
  EXPECT_EQ(run(9, 2), HistoryValidity::valid);
  EXPECT_EQ(host.words[0], 8u);
}

// Counts, over the last 100 of 300 frames, the frames in which the executor recorded a barrier over
// everything, and the changes of RecordContext::handle_epoch. Each frame imports a buffer and an
// image that no frame before has used.
TEST_F(ExecutorTest, ImportsThatAreNewInEveryFrameCostNoFullBarrierAndKeepTheHandleEpoch) {
  Executor executor = make();
  const TextureDesc desc{VK_FORMAT_R32_UINT, Extent::absolute(1, 1)};
  Graph graph;
  std::uint64_t id = 0;
  int changes = 0;
  int full = 0;
  for (int frame = 0; frame < 300; ++frame) {
    if (frame == 200) {
      changes = 0;
      full = failing::full_barriers();
    }
    graph.reset();
    Buffer buffer = graph.import_buffer("buffer", Gpu::imported(gpu_.make_host_buffer(4)));
    Texture texture = graph.import_texture(
        "texture", {.image = gpu_.make_image(
                        desc, VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_STORAGE_BIT),
                    .desc = desc,
                    .usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_STORAGE_BIT});
    PassBuilder pass = graph.add_pass("fill");
    buffer = pass.write(buffer, buffer_access::fill, Contents::discard);
    texture = pass.write(texture, access::clear, {}, Contents::discard);
    pass.record([&, buffer, texture](RecordContext& c) {
      (void)c.view(texture);
      changes += id != c.handle_epoch;
      id = c.handle_epoch;
      vkCmdFillBuffer(c.commands, c.buffer(buffer), 0, VK_WHOLE_SIZE, 5);
    });
    const auto report = gpu_.run(executor, graph);
    ASSERT_TRUE(report) << to_string(report.error());
  }
  EXPECT_EQ(failing::full_barriers(), full);
  EXPECT_LE(changes, 1);
}

// A large frame is followed by small ones. The memory of the large one is freed after a while.
TEST_F(ExecutorTest, MemoryThatSmallerFramesDoNotNeedIsFreed) {
  Executor executor = make();
  Graph graph;
  const auto allocated = [&](std::uint32_t side) {
    graph.reset();
    const TextureDesc desc{VK_FORMAT_R32_UINT, Extent::absolute(side, side)};
    graph.output(add_clear(graph, graph.create_texture("t", desc), side));
    const auto report = gpu_.run(executor, graph);
    EXPECT_TRUE(report) << to_string(report.error());
    return report->memory.allocated;
  };
  const VkDeviceSize large = allocated(1024);
  for (int frame = 0; frame < 300; ++frame) (void)allocated(16);
  EXPECT_LT(allocated(16), large / 16);
}

// Several graphs run in turn on one executor. If the cache has room for the plans of all of them,
// each graph is compiled once; otherwise each is compiled every time.
TEST_F(ExecutorTest, GraphsThatRunInTurnAreCompiledOnceIfThePlanCacheHasRoomForAllOfThem) {
  for (const std::uint32_t graphs : {60u, 3u}) {
    ExecutorOptions options;
    if (graphs == 3) options.cached_plans = 2;
    Executor executor = make(handles(), options);
    Graph graph;
    const HostBuffer host = gpu_.make_host_buffer(graphs * sizeof(std::uint32_t));
    for (int round = 0; round < 2; ++round) {
      for (std::uint32_t length = 1; length <= graphs; ++length) {
        declare_chain(graph, host, length);
        const auto report = gpu_.run(executor, graph);
        ASSERT_TRUE(report) << to_string(report.error());
        EXPECT_EQ(report->compiled, round == 0 || graphs == 3);
      }
    }
  }
}

// In the first frame previous() has no contents. A pass that uses it must have asked for its
// validity.
TEST_F(ExecutorTest, PassThatUsesAHistoryWithoutContentsAndDidNotAskForItsValidityIsReported) {
  Executor executor = make();
  for (const bool asks : {false, true}) {
    Graph graph;
    const TextureHistory history =
        graph.create_texture_history("history", {VK_FORMAT_R32_UINT, Extent::absolute(4, 4)});
    PassBuilder pass = graph.add_pass("reader");
    pass.read(history.previous(), access::sampled_compute);
    pass.side_effect();
    bool has_view = false;
    pass.record([&](RecordContext& context) {
      if (asks) (void)context.validity(history.previous());
      has_view = context.view(history.previous()) != VK_NULL_HANDLE;
    });
    graph.output(add_clear(graph, history.current, 1));
    const auto report = gpu_.record(executor, graph);
    EXPECT_EQ(report.has_value(), asks);
    EXPECT_EQ(has_view, asks);
    if (report) continue;
    EXPECT_NE(to_string(report.error()).find("ask RecordContext::validity before"),
              std::string::npos);
  }
}

// The pass declares only the second of the texture's four mips.
TEST_F(ExecutorTest, ImageViewOfMipsOrLayersThatThePassDidNotDeclareIsRefused) {
  struct Case {
    Range range;
    ErrorCode code;
    bool checked;  // refused only if uses are checked
  };
  const Case cases[] = {{Range::mip(0), ErrorCode::undeclared_use, true},
                        {{1, 2, 0, 1}, ErrorCode::undeclared_use, true},
                        {{}, ErrorCode::undeclared_use, true},
                        {Range::mip(6), ErrorCode::bad_range, false},
                        {Range::layer(1), ErrorCode::bad_range, false},
                        {{3, 2, 0, 1}, ErrorCode::bad_range, false}};
  for (const bool check : {false, true}) {
    Executor executor = make(handles(), {.check_uses = check});
    for (const Case& c : cases) {
      if (c.checked && !check) continue;
      Graph graph;
      Texture texture = graph.create_texture("t", {VK_FORMAT_R32_UINT, Extent::absolute(8, 8), 4});
      PassBuilder pass = graph.add_pass("store");
      texture =
          pass.write(texture, access::storage_write_compute, Range::mip(1), Contents::discard);
      pass.side_effect();
      pass.record([=](RecordContext& context) {
        EXPECT_NE(context.view(texture), VkImageView{VK_NULL_HANDLE});
        EXPECT_EQ(context.view(texture, c.range), VkImageView{VK_NULL_HANDLE});
      });
      const auto report = gpu_.record(executor, graph);
      ASSERT_FALSE(report);
      EXPECT_EQ(report.error()[0].code, c.code) << report.error()[0].message;
      EXPECT_THAT(report.error()[0].message, testing::HasSubstr("pass 'store' asks for a view of"));
    }
  }
}

TEST_F(ExecutorTest, RecordingWithAnExecutorFromInsideOneOfItsPassCallbacksIsRefused) {
  Executor executor = make();
  Graph graph;
  Graph other;
  PassBuilder pass = graph.add_pass("nested");
  pass.side_effect();
  std::size_t refused = 0;
  pass.record([&](RecordContext& c) {
    for (Graph* nested : {&graph, &other}) {
      const auto recorded = executor.record(*nested, c.commands);
      const auto submitted = executor.submit(*nested);
      for (const auto* report : {&recorded, &submitted})
        refused += !*report && report->error()[0].code == ErrorCode::misuse;
      executor.discard(*nested);
    }
  });
  const auto report = gpu_.run(executor, graph);
  ASSERT_TRUE(report) << to_string(report.error());
  EXPECT_EQ(refused, 4u);
}

TEST_F(ExecutorTest, ExecutorReportsTheBufferSizeAndSampleCountLimitsOfItsDevice) {
  const Executor executor = make();
  VkPhysicalDeviceMaintenance4Properties buffers{};
  buffers.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_PROPERTIES;
  VkPhysicalDeviceProperties2 all{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &buffers, {}};
  vkGetPhysicalDeviceProperties2(gpu_.device().physical_device(), &all);
  EXPECT_EQ(executor.limits().max_buffer_size, buffers.maxBufferSize);
  const VkSampleCountFlags counts = all.properties.limits.framebufferColorSampleCounts;
  EXPECT_NE(executor.limits().max_samples & counts, 0u);
  EXPECT_LE(executor.limits().max_samples, 64u);
}

// Textures that the device cannot create are refused with a sentence that says why. The others run
// without a validation message.
TEST_F(ExecutorTest, MultisampledTexturesThatTheDeviceCannotCreateAreRefused) {
  struct Case {
    VkFormat format;
    VkSampleCountFlagBits samples;
    Access access;
    bool history;
    const char* refusal;  // null if the texture is supported
  };
  constexpr auto kFour = VK_SAMPLE_COUNT_4_BIT;
  constexpr VkFormat kFormat = VK_FORMAT_R8G8B8A8_UNORM;
  const Case cases[] = {
      {kFormat, kFour, access::color_attachment, false, nullptr},
      {kFormat, kFour, access::color_attachment, true, nullptr},
      {kFormat, kFour, access::storage_write_compute, false, "the device allows 1 sample(s)"},
      {kFormat, kFour, access::storage_write_compute, true, "the device allows 1 sample(s)"},
      {kFormat, VK_SAMPLE_COUNT_2_BIT, access::color_attachment, false, "sample(s) for it, not 2"},
      {kFormat, VK_SAMPLE_COUNT_2_BIT, access::color_attachment, true, "sample(s) for it, not 2"},
  };
  Executor executor = make();
  const VkSampleCountFlags counts = gpu_.device().properties().limits.framebufferColorSampleCounts;
  for (const Case& c : cases) {
    if (c.samples == VK_SAMPLE_COUNT_2_BIT && (counts & c.samples) != 0) continue;
    Graph graph;
    const TextureDesc desc{c.format, Extent::absolute(8, 8), 1, 1, c.samples};
    Texture texture = c.history ? graph.create_texture_history("t", desc).current
                                : graph.create_texture("t", desc);
    PassBuilder pass = graph.add_pass("write");
    texture = pass.write(texture, c.access, {}, Contents::discard);
    pass.side_effect();
    pass.record([](RecordContext&) {});
    const auto report = gpu_.run(executor, graph);
    if (!c.refusal) {
      EXPECT_TRUE(report) << to_string(report.error());
      continue;
    }
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error()[0].code, ErrorCode::unsupported_format);
    EXPECT_THAT(report.error()[0].message, testing::HasSubstr(c.refusal));
  }
}

// Returns the functions of a Vulkan 1.2 device with VK_KHR_synchronization2: the functions that
// Vulkan 1.3 made core are only found with the suffix KHR.
PFN_vkVoidFunction VKAPI_CALL get_device_proc_addr_1_2(VkDevice device, const char* name) {
  for (const char* core :
       {"vkCmdPipelineBarrier2", "vkQueueSubmit2", "vkCmdWriteTimestamp2", "vkCmdBeginRendering",
        "vkCmdEndRendering", "vkCmdBeginRenderingKHR", "vkCmdEndRenderingKHR", "vkCmdBlitImage2",
        "vkCmdBlitImage2KHR", "vkCmdSetCullMode", "vkCmdSetCullModeEXT", "vkCmdSetFrontFace",
        "vkCmdSetFrontFaceEXT", "vkCreateGraphicsPipelines", "vkGetDeviceBufferMemoryRequirements",
        "vkGetDeviceImageMemoryRequirements", "vkGetDeviceBufferMemoryRequirementsKHR",
        "vkGetDeviceImageMemoryRequirementsKHR"})
    if (std::strcmp(name, core) == 0) return nullptr;
  return vkGetDeviceProcAddr(device, name);
}
PFN_vkVoidFunction VKAPI_CALL get_instance_proc_addr_1_2(VkInstance instance, const char* name) {
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0)
    return reinterpret_cast<PFN_vkVoidFunction>(&get_device_proc_addr_1_2);
  return vkGetInstanceProcAddr(instance, name);
}

TEST_F(ExecutorTest, ExecutorRunsOnAVulkan12DeviceWithTheSynchronization2Extension) {
  VkPhysicalDeviceSynchronization2Features synchronization{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES, nullptr, VK_TRUE};
  const VkPhysicalDeviceTimelineSemaphoreFeatures timeline{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES, &synchronization, VK_TRUE};
  const ExtraDevice device(gpu_, &timeline, {VK_KHR_SYNCHRONIZATION_2_EXTENSION_NAME});
  DeviceHandles old = device.handles();
  old.get_instance_proc_addr = get_instance_proc_addr_1_2;
  Executor executor = make(old);
  EXPECT_GT(executor.limits().max_buffer_size, 1u << 20);
  Graph graph;
  const TextureDesc desc{VK_FORMAT_R32_UINT, Extent::absolute(16, 16)};
  const Texture texture = add_clear(graph, graph.create_texture("t", desc), 3);
  Texture other = graph.create_texture("u", desc);
  PassBuilder copy = graph.add_pass("copy");
  copy.read(texture, access::transfer_source);
  other = copy.write(other, access::transfer_destination, {}, Contents::discard);
  copy.side_effect();
  copy.record([](RecordContext&) {});
  auto report = executor.submit(graph);
  ASSERT_TRUE(report) << to_string(report.error());
  ASSERT_TRUE(executor.wait());
  // The error of a pass that uses dynamic rendering names the missing feature.
  graph.reset();
  Texture color = graph.create_texture("c", {VK_FORMAT_R8G8B8A8_UNORM, Extent::absolute(16, 16)});
  PassBuilder draw = graph.add_pass("draw");
  color = draw.write(color, access::color_attachment);
  draw.side_effect();
  draw.record([=](RecordContext& c) {
    const Attachment attachment{color};
    EXPECT_FALSE(c.begin_rendering({&attachment, 1}));
  });
  report = executor.submit(graph);
  ASSERT_FALSE(report);
  EXPECT_THAT(report.error()[0].message,
              testing::HasSubstr("pass 'draw' begins a rendering, but the device has no "
                                 "vkCmdBeginRendering"));
}

TEST_F(ExecutorTest, RenderingWithAViewMaskIsAcceptedOnADeviceWithMultiview) {
  VkPhysicalDeviceVulkan11Features v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES};
  v11.multiview = VK_TRUE;
  VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &v11};
  v12.timelineSemaphore = VK_TRUE;
  VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES, &v12};
  v13.synchronization2 = v13.dynamicRendering = VK_TRUE;
  const ExtraDevice device(gpu_, &v13);
  Executor executor = make(device.handles());
  Graph graph;
  Texture eyes =
      graph.create_texture("eyes", {VK_FORMAT_R8G8B8A8_UNORM, Extent::absolute(16, 16), 1, 2});
  PassBuilder draw = graph.add_pass("draw");
  eyes = draw.write(eyes, access::color_attachment);
  draw.side_effect();
  draw.record([=](RecordContext& c) {
    const Attachment target{eyes};
    if (c.begin_rendering({&target, 1}, {}, {.view_mask = 3})) c.end_rendering();
  });
  const auto report = executor.submit(graph);
  EXPECT_TRUE(report) << to_string(report.error());
}

// The two frames declare a buffer without a device address and one with an address in the same
// heap.
TEST_F(ExecutorTest, BuffersUsedByDeviceAddressGetMemoryThatAllowsDeviceAddresses) {
  VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
  v12.bufferDeviceAddress = v12.timelineSemaphore = VK_TRUE;
  VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES, &v12};
  v13.synchronization2 = VK_TRUE;
  const ExtraDevice device(gpu_, &v13);
  Executor executor = make(device.handles());
  Access addressed = buffer_access::storage_write_compute;
  addressed.usage |= VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
  Graph graph;
  std::uint32_t found = 0;
  for (const bool by_address : {false, true}) {
    graph.reset();
    Buffer buffer = graph.create_buffer("b", {64});
    PassBuilder pass = graph.add_pass("store");
    buffer = pass.write(buffer, by_address ? addressed : buffer_access::storage_write_compute,
                        Contents::discard);
    pass.side_effect();
    pass.record([&, buffer](RecordContext& c) {
      const VkBufferDeviceAddressInfo info{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO, nullptr,
                                           c.buffer(buffer)};
      if (by_address) found += vkGetBufferDeviceAddress(device.device(), &info) != 0;
    });
    const auto report = executor.submit(graph);
    ASSERT_TRUE(report) << to_string(report.error());
  }
  EXPECT_EQ(found, 1u);
}

TEST_F(ExecutorTest, MemoryOfAReplacedResourceIsCountedAsAllocatedUntilItIsFreed) {
  struct GraphOwner {
    Executor executor;
    Graph graph;
  };
  const auto allocated = [&](GraphOwner& made, std::uint32_t side) {
    auto& [executor, graph] = made;
    graph.reset();
    const TextureDesc desc{VK_FORMAT_R32_UINT, Extent::absolute(side, side)};
    for (const Texture texture : {graph.create_texture_history("history", desc).current,
                                  graph.create_texture("transient", desc)})
      graph.output(add_clear(graph, texture, side));
    const auto report = gpu_.run(executor, graph);
    EXPECT_TRUE(report) << to_string(report.error());
    return report->memory.allocated;
  };
  GraphOwner resized{make(), {}};
  GraphOwner large{make(), {}};
  const VkDeviceSize before = allocated(resized, 64);
  const VkDeviceSize after = allocated(large, 128);
  EXPECT_GT(before, 0u);
  // While the second frame is recorded, the executor does not yet know that the first frame has
  // finished.
  EXPECT_EQ(allocated(resized, 128), before + after);
  // The old history was kept while the frame that replaced it could still be discarded. Now it is
  // freed.
  EXPECT_GT(allocated(resized, 128), allocated(large, 128));
  EXPECT_EQ(allocated(resized, 128), allocated(large, 128));
}

}  // namespace
}  // namespace alcove::framegraph
