// Tests frames of typical renderers on the device, and checks their results.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>

#include "executor_fixture.h"

namespace alcove::framegraph {
namespace {

constexpr VkFormat kColor = VK_FORMAT_R8G8B8A8_UNORM;
constexpr std::uint32_t kRed = 0xff0000ff;
constexpr VkClearValue kClearRed{{{1.0f, 0.0f, 0.0f, 1.0f}}};

class Scenario : public ExecutorTest {
 protected:
  void SetUp() override {
    ExecutorTest::SetUp();
    host_ = gpu_.make_host_buffer(64);
  }
  void TearDown() override {
    executor_.reset();
    // The validation layers do not follow timeline semaphores from one submission to another.
    EXPECT_EQ(several_queues_ ? gpu_.messages({"vkQueueSubmit2: Hazard"}) : gpu_.messages(), "");
  }

  Executor& executor() {
    if (!executor_) {
      DeviceHandles three = handles();
      for (QueueHandle& queue : three.queues) queue = three.queues[0];
      executor_ = std::make_unique<Executor>(make(three));
    }
    return *executor_;
  }
  void run(const FrameInfo& info = {}) {
    const auto report = executor().submit(graph_, info);
    ASSERT_TRUE(report) << to_string(report.error());
    plan_ = report->plan;
    ASSERT_TRUE(executor().wait(info.slot));
  }
  Texture texture(const char* name, VkFormat format = kColor,
                  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT) {
    return graph_.create_texture(name, {format, Extent::absolute(16, 16), 1, 1, samples});
  }
  // Copies the first texel of each layer to words of the host's buffer from `word` on.
  void copy_out(Texture from, std::uint32_t word = 0, std::uint32_t layers = 1,
                VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT) {
    ImportedBuffer import = Gpu::imported(host_);
    import.has_contents = word != 0;
    if (!out_) out_ = graph_.import_buffer("host", import);
    PassBuilder pass = graph_.add_pass("copy out");
    pass.read(from, access::transfer_source);
    out_ = pass.write(out_, buffer_access::transfer_destination,
                      out_.version == 0 && word == 0 ? Contents::discard : Contents::keep);
    pass.record([=, out = out_](RecordContext& c) {
      for (std::uint32_t layer = 0; layer < layers; ++layer)
        copy_image(c, c.image(from), c.buffer(out), VkDeviceSize{4} * (word + layer), {1, 1, 1},
                   {aspect, 0, layer, 1});
    });
  }
  void begin() {
    graph_.reset();
    out_ = {};
  }

  HostBuffer host_;
  std::unique_ptr<Executor> executor_;
  Graph graph_;
  Buffer out_;
  const Plan* plan_ = nullptr;
  bool several_queues_ = false;
};

// The multisampled texture is cleared, resolved within its pass, and not stored.
TEST_F(Scenario, MultisampledColorIsResolvedInThePassThatDrawsIt) {
  begin();
  Texture msaa = texture("msaa", kColor, VK_SAMPLE_COUNT_4_BIT);
  Texture resolved = texture("resolved");
  PassBuilder draw = graph_.add_pass("draw");
  msaa = draw.write(msaa, access::color_attachment);
  resolved = draw.write(resolved, access::resolve_target, {}, Contents::discard);
  draw.record([=](RecordContext& c) {
    const Attachment color{msaa, &kClearRed, resolved};
    const VkRenderingAttachmentInfo info = c.attachment(color);
    EXPECT_EQ(info.loadOp, VK_ATTACHMENT_LOAD_OP_CLEAR);
    EXPECT_EQ(info.storeOp, VK_ATTACHMENT_STORE_OP_DONT_CARE);
    ASSERT_TRUE(c.begin_rendering({&color, 1}));
    c.end_rendering();
  });
  copy_out(resolved);
  run();
  EXPECT_EQ(host_.words[0], kRed);
}

TEST_F(Scenario, MultisampledDepthIsResolvedInThePassThatDrawsIt) {
  begin();
  static constexpr VkClearValue kDepth{.depthStencil = {0.25f, 0}};
  Texture msaa = texture("msaa", VK_FORMAT_D32_SFLOAT, VK_SAMPLE_COUNT_4_BIT);
  Texture resolved = texture("resolved", VK_FORMAT_D32_SFLOAT);
  for (int i = 0; i < 2; ++i) {
    PassBuilder draw = graph_.add_pass("draw");
    msaa = draw.write(msaa, access::depth_attachment | access::depth_resolve_source, {},
                      Contents::discard);
    resolved = draw.write(resolved, access::depth_resolve_target, {}, Contents::discard);
    draw.record([=](RecordContext& c) {
      ASSERT_TRUE(c.begin_rendering({}, {msaa, &kDepth, resolved}));
      c.end_rendering();
    });
    if (i == 0) draw.side_effect();
  }
  copy_out(resolved, 0, 1, VK_IMAGE_ASPECT_DEPTH_BIT);
  run();
  EXPECT_EQ(host_.words[0], std::bit_cast<std::uint32_t>(0.25f));
}

// A pass draws to two layers of one texture as two attachments, and to a mip of another texture
// whose other mip it tests against.
TEST_F(Scenario, AttachmentsArePartsOfATextureThatThePassDeclares) {
  begin();
  static constexpr VkClearValue kGreen{{{0.0f, 1.0f, 0.0f, 1.0f}}};
  static constexpr VkClearValue kDepth{.depthStencil = {0.5f, 0}};
  Texture layers = graph_.create_texture("layers", {kColor, Extent::absolute(16, 16), 2, 3});
  Texture depths =
      graph_.create_texture("depths", {VK_FORMAT_D32_SFLOAT, Extent::absolute(32, 32), 2});
  PassBuilder draw = graph_.add_pass("draw");
  constexpr Range kFirst{0, 1, 0, 1};
  constexpr Range kLast{0, 1, 2, 1};
  layers = draw.write(layers, access::color_attachment, kFirst);
  layers = draw.write(layers, access::color_attachment, kLast);
  depths = draw.write(depths, access::depth_attachment, Range::mip(0));
  depths = draw.write(depths, access::depth_attachment, Range::mip(1));
  draw.record([=](RecordContext& c) {
    const Attachment colors[] = {{layers, &kClearRed, {}, {}, kFirst},
                                 {layers, &kGreen, {}, {}, kLast}};
    ASSERT_TRUE(c.begin_rendering(colors, {depths, &kDepth, {}, {}, Range::mip(1)}));
    c.end_rendering();
  });
  PassBuilder copy = graph_.add_pass("copy out");
  copy.read(layers, access::transfer_source, kLast);
  Buffer out = graph_.import_buffer("host", Gpu::imported(host_));
  out = copy.write(out, buffer_access::transfer_destination, Contents::discard);
  copy.record([=](RecordContext& c) {
    EXPECT_EQ(c.layout(layers), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    copy_image(c, c.image(layers), c.buffer(out), 0, {1, 1, 1},
               {VK_IMAGE_ASPECT_COLOR_BIT, 0, 2, 1});
  });
  run();
  EXPECT_EQ(host_.words[0], 0xff00ff00u);
}

// The first rendering clears the whole texture, and the second one all texels but the first.
TEST_F(Scenario, RenderingDrawsOnlyToItsArea) {
  begin();
  Texture color = texture("color");
  PassBuilder draw = graph_.add_pass("draw");
  color = draw.write(color, access::color_attachment);
  draw.record([=](RecordContext& c) {
    static constexpr VkClearValue kClearGreen{{{0.0f, 1.0f, 0.0f, 1.0f}}};
    const Attachment red{color, &kClearRed};
    const Attachment green{color, &kClearGreen};
    ASSERT_TRUE(c.begin_rendering({&red, 1}));
    c.end_rendering();
    order(c, access::color_attachment);
    ASSERT_TRUE(c.begin_rendering({&green, 1}, {}, {.area = {{1, 0}, {15, 16}}}));
    c.end_rendering();
  });
  copy_out(color);
  run();
  EXPECT_EQ(host_.words[0], kRed);
}

TEST_F(Scenario, RenderingOverTexelsOrViewsThatItsAttachmentsDoNotHaveIsRefused) {
  for (const Rendering& rendering :
       {Rendering{.area = {{1, 0}, {16, 16}}}, Rendering{.area = {{0, -1}, {4, 4}}},
        Rendering{.area = {{0, 16}, {1, 1}}}, Rendering{.area = {{0, 0}, {~0u, 1}}},
        Rendering{.view_mask = 2}}) {
    begin();
    const Texture color = texture("color");
    PassBuilder draw = graph_.add_pass("draw");
    const Texture drawn = draw.write(color, access::color_attachment);
    draw.side_effect();
    draw.record([=](RecordContext& c) {
      const Attachment target{drawn, &kClearRed};
      EXPECT_FALSE(c.begin_rendering({&target, 1}, {}, rendering));
    });
    const auto report = executor().submit(graph_);
    ASSERT_FALSE(report);
    EXPECT_THAT(report.error()[0].message,
                testing::HasSubstr("pass 'draw' begins a rendering over texels or views that its "
                                   "attachments do not have"));
  }
}

TEST_F(Scenario, RenderingWithAttachmentsOfDifferentSizesIsRefused) {
  begin();
  PassBuilder draw = graph_.add_pass("draw");
  const Texture color = draw.write(texture("color"), access::color_attachment);
  const Texture small = draw.write(
      graph_.create_texture("small", {VK_FORMAT_R8G8B8A8_UNORM, Extent::absolute(8, 16)}),
      access::color_attachment);
  draw.side_effect();
  draw.record([=](RecordContext& c) {
    const Attachment targets[] = {{color, &kClearRed}, {small, &kClearRed}};
    EXPECT_FALSE(c.begin_rendering(targets));
  });
  const auto report = executor().submit(graph_);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error()[0].code, ErrorCode::attachment_mismatch);
}

// The second pass must load the contents that the first one stored. A pass that discards must not
// load.
TEST_F(Scenario, AttachmentsAreLoadedAndStoredOnlyIfContentsAreNeeded) {
  begin();
  Texture color = texture("color");
  Texture depth = texture("depth", VK_FORMAT_D32_SFLOAT);
  static constexpr VkClearValue kFar{{{1.0f, 0.0f, 0.0f, 0.0f}}};
  struct Ops {
    VkAttachmentLoadOp load;
    VkAttachmentStoreOp store;
    bool operator==(const Ops&) const = default;
  };
  std::array<Ops, 4> ops{};
  const auto ops_of = [](const VkRenderingAttachmentInfo& info) {
    return Ops{info.loadOp, info.storeOp};
  };
  PassBuilder first = graph_.add_pass("opaque");
  color = first.write(color, access::color_attachment);
  depth = first.write(depth, access::depth_attachment);
  first.record([&, color, depth](RecordContext& c) {
    const Attachment target{color, &kClearRed};
    const Attachment tested{depth, &kFar};
    ops[0] = ops_of(c.attachment(target));
    ops[1] = ops_of(c.attachment(tested));
    ASSERT_TRUE(c.begin_rendering({&target, 1}, tested));
    c.end_rendering();
  });
  PassBuilder second = graph_.add_pass("transparent");
  color = second.write(color, access::color_attachment);
  second.read(depth, access::depth_test);
  second.record([&, color, depth](RecordContext& c) {
    const Attachment target{color, &kClearRed};
    const Attachment tested{depth, &kFar};
    ops[2] = ops_of(c.attachment(target));
    ops[3] = ops_of(c.attachment(tested));
    ASSERT_TRUE(c.begin_rendering({&target, 1}, tested));
    c.end_rendering();
  });
  copy_out(color);
  run();
  EXPECT_EQ(host_.words[0], kRed);
  EXPECT_EQ(ops[0], (Ops{VK_ATTACHMENT_LOAD_OP_CLEAR, VK_ATTACHMENT_STORE_OP_STORE}));
  EXPECT_EQ(ops[1], (Ops{VK_ATTACHMENT_LOAD_OP_CLEAR, VK_ATTACHMENT_STORE_OP_STORE}));
  EXPECT_EQ(ops[2], (Ops{VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_STORE}));
  EXPECT_EQ(ops[3], (Ops{VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_NONE}));
}

// A separate pass draws each face. The cube is then read through a cube view.
TEST_F(Scenario, CubeShadowMapCanBeDrawnFaceByFaceAndReadThroughACubeView) {
  begin();
  TextureDesc desc{VK_FORMAT_D32_SFLOAT, Extent::absolute(16, 16), 1, 6};
  desc.flags = VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT;
  Texture cube = graph_.create_texture("shadow", desc);
  static std::array<VkClearValue, 6> depths;
  for (std::uint32_t face = 0; face < 6; ++face) {
    depths.at(face).depthStencil.depth = static_cast<float>(face) / 8.0f;
    PassBuilder pass = graph_.add_pass("face");
    cube = pass.write(cube, access::depth_attachment, Range::layer(face));
    pass.record([=](RecordContext& c) {
      ASSERT_TRUE(c.begin_rendering({}, {cube, &depths.at(face)}));
      c.end_rendering();
    });
  }
  PassBuilder lit = graph_.add_pass("light");
  lit.read(cube, access::depth_read_fragment);
  lit.side_effect();
  lit.record([=](RecordContext& c) {
    EXPECT_NE(c.view(cube, {}, VK_IMAGE_VIEW_TYPE_CUBE), VkImageView{VK_NULL_HANDLE});
    EXPECT_NE(c.view(cube, {}, VK_IMAGE_VIEW_TYPE_CUBE), c.view(cube));
    EXPECT_EQ(c.view(cube, {}, VK_IMAGE_VIEW_TYPE_CUBE), c.view(cube, {}, VK_IMAGE_VIEW_TYPE_CUBE));
  });
  copy_out(cube, 0, 6, VK_IMAGE_ASPECT_DEPTH_BIT);
  run();
  for (std::uint32_t face = 0; face < 6; ++face)
    EXPECT_EQ(std::bit_cast<float>(host_.words[face]), static_cast<float>(face) / 8.0f);
}

// The frame runs a graphics pass, then a compute and a graphics pass that may overlap, and then a
// graphics pass. It waits for a semaphore of the caller and signals another. All queue classes use
// one queue, so that one vkQueueSubmit2 is enough.
TEST_F(Scenario, FrameWithAsyncComputeWaitsForAndSignalsSemaphoresOfTheCaller) {
  several_queues_ = true;
  const VkDevice device = gpu_.device().device();
  VkSemaphoreTypeCreateInfo type{};
  type.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO;
  type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
  const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &type, 0};
  VkSemaphore semaphore = VK_NULL_HANDLE;
  ASSERT_EQ(vkCreateSemaphore(device, &info, nullptr, &semaphore), VK_SUCCESS);
  begin();
  Texture scene = texture("scene", VK_FORMAT_R32_UINT);
  Texture ao = texture("ao", VK_FORMAT_R32_UINT);
  scene = add_clear(graph_, scene, 7);
  ao = add_clear(graph_, ao, 8, Contents::discard, QueueClass::compute);
  copy_out(scene, 0);
  copy_out(ao, 1);
  const int submits = failing::submits();
  const QueueSemaphore wait{semaphore, 1};
  const QueueSemaphore signal{semaphore, 2};
  const auto report = executor().submit(graph_, {0, {&wait, 1}, {&signal, 1}});
  ASSERT_TRUE(report) << to_string(report.error());
  EXPECT_GT(report->plan->submissions.size(), 2u);
  EXPECT_EQ(failing::submits() - submits, 1);
  std::uint64_t value = 9;
  vkGetSemaphoreCounterValue(device, semaphore, &value);
  EXPECT_EQ(value, 0u);
  VkSemaphoreSignalInfo release{VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO, nullptr, semaphore, 1};
  ASSERT_EQ(vkSignalSemaphore(device, &release), VK_SUCCESS);
  const std::uint64_t done = 2;
  VkSemaphoreWaitInfo until{
      VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO, nullptr, 0, 1, &semaphore, &done};
  ASSERT_EQ(vkWaitSemaphores(device, &until, ~std::uint64_t{0}), VK_SUCCESS);
  ASSERT_TRUE(executor().wait());
  EXPECT_EQ(host_.words[0], 7u);
  EXPECT_EQ(host_.words[1], 8u);
  executor_.reset();
  vkDestroySemaphore(device, semaphore, nullptr);
}

// Particles run on the compute queue and the scene on the graphics queue, with no resource in
// common. From the second frame of a plan on, no queue waits for the other queue's work of the
// previous frame.
TEST_F(Scenario, WorkOfTwoQueuesWithoutCommonResourcesOverlapsAcrossFrames) {
  several_queues_ = true;
  const auto declare = [&](std::uint32_t frame, std::uint32_t size) {
    begin();
    const TextureHistory particles =
        graph_.create_texture_history("particles", {VK_FORMAT_R32_UINT, Extent::absolute(size, 1)});
    graph_.output(
        add_clear(graph_, particles.current, frame, Contents::discard, QueueClass::compute));
    Texture scene = texture("scene");
    PassBuilder draw = graph_.add_pass("draw");
    scene = draw.write(scene, access::color_attachment);
    draw.side_effect();
    draw.record([=](RecordContext& c) {
      const Attachment target{scene, &kClearRed};
      ASSERT_TRUE(c.begin_rendering({&target, 1}));
      c.end_rendering();
    });
  };
  for (std::uint32_t frame = 0; frame < 5; ++frame) {
    // The last frame has another plan, and therefore begins after all earlier work is done.
    declare(frame, frame < 4 ? 64 : 128);
    const int before = failing::semaphore_waits();
    run({frame % 2});
    const int waits = failing::semaphore_waits() - before;
    // The first frames have other plans, because one more slot of the history gets contents in each
    // of them.
    if (frame == 3)
      EXPECT_EQ(waits, 0);
    else if (frame == 4) {
      EXPECT_GT(waits, 0);
    }
  }
}

}  // namespace
}  // namespace alcove::framegraph
