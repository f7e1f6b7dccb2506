// Tests that each invalid declaration gives an error whose sentence says what is wrong and what to
// change.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "fake_handle.h"
#include "small_frames.h"

namespace alcove::framegraph {
namespace {

using testing::HasSubstr;

class Validate : public testing::Test {
 protected:
  PassBuilder pass(const char* name, QueueClass queue = QueueClass::graphics) {
    PassBuilder made = graph_.add_pass(name, queue);
    made.side_effect();
    return made;
  }
  Texture written(const char* name) {
    Texture texture = graph_.create_texture(name, kSmall);
    return pass("writer").write(texture, access::storage_write_compute, {}, Contents::discard);
  }
  // Checks that compiling gives exactly this error, and that its sentence contains `text`.
  void expect(ErrorCode code, const char* text, const Limits& limits = {}) {
    const auto plan = compile(graph_.description(), limits);
    ASSERT_FALSE(plan);
    EXPECT_EQ(plan.error().size(), 1u) << to_string(plan.error());
    EXPECT_EQ(plan.error()[0].code, code) << plan.error()[0].message;
    EXPECT_THAT(plan.error()[0].message, HasSubstr(text));
  }
  Graph graph_;
};

TEST_F(Validate, ValidGraphCompilesWithoutErrors) {
  const Texture texture = written("t");
  pass("reader").read(texture, access::sampled_compute);
  EXPECT_TRUE(compile(graph_.description()));
}

TEST_F(Validate, ReadModifyWriteOfUnwrittenContentsIsRefused) {
  const Texture texture = graph_.create_texture("t", kSmall);
  (void)pass("update").write(texture, access::storage_read_write_compute);
  expect(
      ErrorCode::read_before_write,
      "pass 'update' reads and writes texture 't' version 0, parts of which nothing has written");
}

TEST_F(Validate, WriteThatKeepsContentsThatNothingWroteIsRefusedUnlessItIsAnAttachment) {
  const char* const text = "pass 'writer' writes";
  (void)pass("writer").write(graph_.create_texture("t", kSmall), access::storage_write_compute);
  expect(ErrorCode::read_before_write, text);
  graph_.reset();
  (void)pass("writer").write(graph_.create_buffer("b", {64}), buffer_access::fill);
  expect(ErrorCode::read_before_write, "nothing has written any: write it with Contents::discard");
  graph_.reset();
  (void)pass("writer").write(graph_.create_texture_history("h", kSmall).current, access::clear);
  expect(ErrorCode::read_before_write, text);
  graph_.reset();
  Texture window = graph_.import_texture(
      "w", {.image = fake_handle<VkImage>(), .desc = kSmall, .usage = ~VkImageUsageFlags{0}});
  (void)pass("writer").write(window, access::storage_write_compute);
  expect(ErrorCode::read_before_write, "or import it with its contents");
  graph_.reset();
  // A part of the range has contents.
  Texture mips = graph_.create_texture("m", {kSmall.format, kSmall.extent, 2});
  mips = pass("mip").write(mips, access::clear, Range::mip(1), Contents::discard);
  (void)pass("writer").write(mips, access::storage_write_compute);
  EXPECT_TRUE(compile(graph_.description()));
}

TEST_F(Validate, AttachmentsAndDiscardingWritesOfUnwrittenTexturesAreAllowed) {
  const Texture drawn = graph_.create_texture("drawn", kSmall);
  (void)pass("draw").write(drawn, access::color_attachment);
  const Texture stored = graph_.create_texture("stored", kSmall);
  (void)pass("update").write(stored, access::storage_read_write_compute, {}, Contents::discard);
  EXPECT_TRUE(compile(graph_.description()));
}

TEST_F(Validate, LayerOrMipIndexAbove16BitsIsRefused) {
  const Texture texture = written("t");
  pass("reader").read(texture, access::sampled_compute, Range::layer(65536));
  expect(ErrorCode::bad_range, "pass 'reader' reads texture 't'");
  graph_.reset();
  const Texture other = written("t");
  pass("reader").read(other, access::sampled_compute, Range::mip(65536));
  expect(ErrorCode::bad_range, "pass 'reader' reads texture 't'");
}

TEST_F(Validate, PassBuilderUsedAfterGraphResetIsRefused) {
  using Use = void (*)(PassBuilder&, Texture, Buffer);
  const Use uses[] = {
      [](PassBuilder& old, Texture t, Buffer) { old.read(t, access::sampled_compute); },
      [](PassBuilder& old, Texture t, Buffer) { (void)old.write(t, access::clear); },
      [](PassBuilder& old, Texture, Buffer b) { old.read(b, buffer_access::indirect); },
      [](PassBuilder& old, Texture, Buffer b) { (void)old.write(b, buffer_access::fill); },
      [](PassBuilder& old, Texture, Buffer) { old.side_effect(); },
      [](PassBuilder& old, Texture, Buffer) { old.record([](RecordContext&) {}); },
  };
  for (const Use use : uses) {
    PassBuilder old = pass("old");
    graph_.reset();
    const Texture texture = written("t");
    use(old, texture, graph_.create_buffer("b", {4}));
    expect(ErrorCode::closed_pass, "a PassBuilder of a frame before reset() was used");
    graph_.reset();
  }
}

TEST_F(Validate, DepthTestAndSamplingOfOneTextureCanBeDeclaredAsOneAccess) {
  constexpr Access kBoth = access::depth_test | access::sampled_fragment;
  static_assert(kBoth.layout == VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL);
  Texture depth = graph_.create_texture("depth", {VK_FORMAT_D32_SFLOAT, kSmall.extent});
  depth = pass("prepass").write(depth, access::depth_attachment);
  pass("soft particles").read(depth, kBoth);
  EXPECT_EQ(compile_verified(graph_).placements[depth.index].usage,
            VkFlags{VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT});
}

TEST_F(Validate, EmptyGraphIsValid) { EXPECT_TRUE(compile(graph_.description())); }

TEST_F(Validate, UseOfAnOutdatedHandleIsReportedWithItsVersionAndTheCurrentOne) {
  for (const bool writes : {false, true}) {
    graph_.reset();
    const Texture old = written("t");
    (void)pass("second").write(old, access::storage_read_write_compute);
    PassBuilder third = pass("third");
    if (writes)
      (void)third.write(old, access::storage_read_write_compute);
    else
      third.read(old, access::sampled_compute);
    expect(ErrorCode::stale_handle, writes ? "pass 'third' writes texture 't' version 1"
                                           : "pass 'third' reads texture 't' version 1, but the "
                                             "version then is 2: pass 'second'");
  }
}

TEST_F(Validate, ResourceHandleOfAnotherGraphIsRefused) {
  Graph other;
  const Texture foreign = other.create_texture("foreign", kSmall);
  pass("reader").read(foreign, access::sampled_compute);
  expect(ErrorCode::foreign_handle, "'reader' reads a texture through a handle of another graph");
}

TEST_F(Validate, ResourceHandleFromBeforeGraphResetIsRefused) {
  const Texture old = graph_.create_texture("t", kSmall);
  graph_.reset();
  (void)pass("writer").write(old, access::storage_write_compute);
  expect(ErrorCode::foreign_handle, "of a frame before reset");
}

TEST_F(Validate, NullResourceHandleIsRefused) {
  pass("reader").read(Buffer{}, buffer_access::vertex_buffer);
  expect(ErrorCode::null_handle, "'reader' reads a buffer through a null handle");
}

TEST_F(Validate, ReadingATextureBeforeAnyWriteIsRefused) {
  pass("reader").read(graph_.create_texture("t", kSmall), access::sampled_compute);
  expect(ErrorCode::read_before_write, "'reader' reads texture 't' version 0");
}

TEST_F(Validate, ReadingAMipThatNoPassWroteIsRefused) {
  TextureDesc desc = kSmall;
  desc.mips = 3;
  Texture texture = graph_.create_texture("t", desc);
  texture = pass("writer").write(texture, access::storage_write_compute, Range::mip(1),
                                 Contents::discard);
  pass("fine").read(texture, access::sampled_compute, Range::mip(1));
  pass("reader").read(texture, access::sampled_compute, Range::mip(2));
  expect(ErrorCode::read_before_write, "'reader'");
}

TEST_F(Validate, PassThatDeclaresBothAReadAndAWriteOfOneSubresourceIsRefused) {
  const Texture texture = written("t");
  PassBuilder both = pass("both");
  both.read(texture, access::sampled_compute);
  (void)both.write(texture, access::storage_write_compute);
  expect(ErrorCode::read_and_write, "'both' uses a subresource of texture 't'");
}

TEST_F(Validate, PassMayReadOneMipAndWriteAnotherMipOfTheSameTexture) {
  TextureDesc desc = kSmall;
  desc.mips = 2;
  Texture texture = graph_.create_texture("t", desc);
  texture =
      pass("first").write(texture, access::storage_write_compute, Range::mip(0), Contents::discard);
  PassBuilder both = pass("both");
  both.read(texture, access::sampled_general(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT),
            Range::mip(0));
  (void)both.write(texture, access::storage_write_compute, Range::mip(1), Contents::discard);
  EXPECT_TRUE(compile(graph_.description()));
}

TEST_F(Validate, TwoWritesOfOneSubresourceInAPassAreRefused) {
  Texture texture = graph_.create_texture("t", kSmall);
  PassBuilder twice = pass("twice");
  texture = twice.write(texture, access::storage_write_compute, {}, Contents::discard);
  (void)twice.write(texture, access::storage_write_compute);
  expect(ErrorCode::two_writers, "'twice' writes a subresource of texture 't' twice");
}

TEST_F(Validate, ImportWithoutTheVulkanUsageThatAPassNeedsIsRefused) {
  ImportedTexture import;
  import.image = fake_handle<VkImage>();
  import.desc = kSmall;
  import.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  Texture texture = graph_.import_texture("swap", import);
  (void)pass("writer").write(texture, access::storage_write_compute, {}, Contents::discard);
  expect(ErrorCode::missing_usage,
         "with usage STORAGE, but it was imported with SAMPLED: create it with STORAGE too");
}

TEST_F(Validate, ImportWithoutAVulkanHandleIsRefused) {
  ImportedTexture import;
  import.desc = kSmall;
  (void)graph_.import_texture("swap", import);
  expect(ErrorCode::bad_import, "set ImportedTexture::image");
}

TEST_F(Validate, TextureFormatThatTheDeviceCannotUseAsDeclaredIsRefused) {
  (void)written("t");
  Limits limits;
  limits.formats.query = [](const void*, VkFormat) {
    return VkImageUsageFlags{VK_IMAGE_USAGE_SAMPLED_BIT};
  };
  expect(ErrorCode::unsupported_format, "does not support on this device", limits);
}

TEST_F(Validate, AccessToMipsThatTheTextureDoesNotHaveIsRefused) {
  const Texture texture = written("t");
  pass("reader").read(texture, access::sampled_compute, Range::mip(3));
  expect(ErrorCode::bad_range, "but it has 1 mips and 1 layers");
}

TEST_F(Validate, ResourcesOfSizeZeroOrOverTheDeviceLimitsAreRefused) {
  (void)graph_.create_texture("none", {VK_FORMAT_R8_UNORM, Extent::absolute(0, 4)});
  (void)graph_.create_texture("huge", {VK_FORMAT_R8_UNORM, Extent::absolute(1 << 20, 4)});
  (void)graph_.create_texture("deep", {VK_FORMAT_R8_UNORM, Extent::absolute(4, 4), 9});
  (void)graph_.create_texture("formless", {VK_FORMAT_UNDEFINED, Extent::absolute(4, 4)});
  (void)graph_.create_buffer("empty", {0});
  const auto plan = compile(graph_.description());
  ASSERT_FALSE(plan);
  ASSERT_EQ(plan.error().size(), 5u) << to_string(plan.error());
  for (const Error& error : plan.error()) EXPECT_EQ(error.code, ErrorCode::bad_description);
}

TEST_F(Validate, ReadingAHistoryThatNoPassWritesIsRefused) {
  const TextureHistory history = graph_.create_texture_history("h", kSmall);
  pass("reader").read(history.previous(), access::sampled_compute);
  expect(ErrorCode::history_never_written, "write its current slot");
}

// A write that keeps contents that do not exist is the default of every first write. It must cost
// nothing: the plan is that of a write that discards.
TEST_F(Validate, AttachmentThatKeepsContentsThatDoNotExistHasThePlanOfOneThatDiscardsThem) {
  Plan plans[2];
  for (const Contents contents : {Contents::keep, Contents::discard}) {
    graph_.reset();
    const Texture texture = pass("writer").write(graph_.create_texture("t", kSmall),
                                                 access::color_attachment, {}, contents);
    graph_.output(texture);
    plans[static_cast<std::size_t>(contents)] = compile_verified(graph_);
  }
  ASSERT_EQ(plans[0].transitions.size(), 1u);
  EXPECT_EQ(std::memcmp(&plans[0].transitions[0], &plans[1].transitions[0], sizeof(Transition)), 0);
  EXPECT_EQ(plans[0].contents, plans[1].contents);
}

TEST_F(Validate, HistoryWithOnlyOneSlotIsRefused) {
  (void)graph_.create_texture_history("h", kSmall, 1);
  expect(ErrorCode::history_cycle, "at least 2 slots");
}

TEST_F(Validate, AccessInAGraphicsStageOnTheComputeQueueIsRefused) {
  Texture texture = graph_.create_texture("t", kSmall);
  PassBuilder draw = pass("draw", QueueClass::compute);
  (void)draw.write(texture, access::color_attachment);
  expect(ErrorCode::bad_access, "put the pass on QueueClass::graphics");
}

TEST_F(Validate, AccessDeclaredForAPassAfterTheNextPassWasAddedIsRefused) {
  Texture texture = graph_.create_texture("t", kSmall);
  PassBuilder early = pass("early");
  (void)pass("late");
  (void)early.write(texture, access::storage_write_compute);
  expect(ErrorCode::closed_pass, "before the next add_pass");
}

TEST_F(Validate, WriteDeclaredWithAReadOnlyAccessIsRefused) {
  Texture texture = graph_.create_texture("t", kSmall);
  (void)pass("writer").write(texture, access::sampled_compute);
  expect(ErrorCode::bad_access, "declare it with read()");
}

TEST_F(Validate, GraphOutputThatNoPassWritesIsRefused) {
  graph_.output(graph_.create_texture("t", kSmall));
  expect(ErrorCode::read_before_write, "output texture 't' is written by no pass");
}

TEST_F(Validate, AllErrorsOfAGraphAreReportedByOneCompilation) {
  pass("one").read(Texture{}, access::sampled_compute);
  pass("two").read(graph_.create_texture("t", kSmall), access::sampled_compute);
  (void)graph_.create_buffer("empty", {0});
  const auto plan = compile(graph_.description());
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().size(), 3u);
}

TEST_F(Validate, OneImageOrBufferImportedUnderTwoNamesIsRefused) {
  const ImportedTexture image{.image = fake_handle<VkImage>(), .desc = kSmall};
  (void)graph_.import_texture("swap", image);
  (void)graph_.import_texture("back buffer", image);
  expect(ErrorCode::bad_import,
         "texture 'back buffer' and texture 'swap' are imported with one VkImage: import it once");
  graph_.reset();
  const ImportedBuffer buffer{.buffer = fake_handle<VkBuffer>(), .desc = {4}};
  (void)graph_.import_buffer("counter", buffer);
  (void)graph_.import_buffer("count", buffer);
  expect(ErrorCode::bad_import,
         "buffer 'count' and buffer 'counter' are imported with one VkBuffer: import it once");
}

TEST_F(Validate, DisjointLayersOfOneImageMayBeImportedUnderTwoNames) {
  ImportedTexture import;
  import.image = fake_handle<VkImage>();
  import.desc = kSmall;
  import.desc.layers = 2;
  (void)graph_.import_texture("first two", import);
  import.first_layer = 2;
  (void)graph_.import_texture("next two", import);
  EXPECT_TRUE(compile(graph_.description()));
  import.first_layer = 3;
  (void)graph_.import_texture("overlapping", import);
  expect(ErrorCode::bad_import,
         "'overlapping' and texture 'next two' are imported with one VkImage");
}

// Write access bits of Vulkan extensions, each with a stage that supports it.
constexpr Access kExtensionWrites[] = {
    {VK_PIPELINE_STAGE_2_TRANSFORM_FEEDBACK_BIT_EXT, VK_ACCESS_2_TRANSFORM_FEEDBACK_WRITE_BIT_EXT},
    {VK_PIPELINE_STAGE_2_TRANSFORM_FEEDBACK_BIT_EXT,
     VK_ACCESS_2_TRANSFORM_FEEDBACK_COUNTER_WRITE_BIT_EXT}};

TEST_F(Validate, WriteAccessBitsOfVulkanExtensionsAreTreatedAsWrites) {
  for (const Access& access : kExtensionWrites) {
    graph_.reset();
    PassBuilder writer = pass("writer");
    (void)writer.write(graph_.create_buffer("b", {64}), access, Contents::discard);
    EXPECT_TRUE(compile(graph_.description()));
    graph_.reset();
    Buffer buffer = graph_.create_buffer("b", {64});
    buffer = pass("writer").write(buffer, buffer_access::fill, Contents::discard);
    pass("reader").read(buffer, access);
    expect(ErrorCode::bad_access, "with an access that writes: declare it with write()");
  }
}

TEST_F(Validate, ImportWrittenByAVulkanExtensionStageGetsABarrierBeforeItsReader) {
  for (const Access& access : kExtensionWrites) {
    graph_.reset();
    const Buffer buffer = graph_.import_buffer(
        "b", {.buffer = fake_handle<VkBuffer>(),
              .desc = {64},
              .usage = ~VkBufferUsageFlags{0},
              .initial_state = {access.stages, access.access, VK_IMAGE_LAYOUT_UNDEFINED}});
    pass("reader").read(buffer, buffer_access::storage_read_compute);
    Plan plan = compile_verified(graph_);
    ASSERT_EQ(plan.transitions.size(), 1u);
    EXPECT_EQ(plan.transitions[0].src_access, access.access & kWriteBits);
    plan.transitions[0].src_access = 0;
    EXPECT_FALSE(verify(graph_.description(), {}, plan));
  }
}

TEST_F(Validate, QueuesRefuseEachStageThatTheyCannotRun) {
  constexpr VkPipelineStageFlags2 kGraphics[] = {VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT,
                                                 VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
                                                 VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT,
                                                 VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
                                                 VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                                 VK_PIPELINE_STAGE_2_BLIT_BIT,
                                                 VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT,
                                                 VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT};
  constexpr VkPipelineStageFlags2 kCompute[] = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                                VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT,
                                                VK_PIPELINE_STAGE_2_CLEAR_BIT};
  const auto is_refused = [&](VkPipelineStageFlags2 stage, QueueClass queue) {
    graph_.reset();
    const Buffer buffer = pass("writer").write(
        graph_.create_buffer("b", {64}), buffer_access::storage_write_compute, Contents::discard);
    pass("reader", queue).read(buffer, {stage, VK_ACCESS_2_MEMORY_READ_BIT});
    return !compile(graph_.description());
  };
  for (const VkPipelineStageFlags2 stage : kGraphics) {
    EXPECT_FALSE(is_refused(stage, QueueClass::graphics)) << stage;
    EXPECT_TRUE(is_refused(stage, QueueClass::compute)) << stage;
    EXPECT_TRUE(is_refused(stage, QueueClass::transfer)) << stage;
  }
  for (const VkPipelineStageFlags2 stage : kCompute) {
    EXPECT_FALSE(is_refused(stage, QueueClass::compute)) << stage;
    EXPECT_TRUE(is_refused(stage, QueueClass::transfer)) << stage;
  }
}

// The stages of accesses that are not in access.h: those that the graph does not know are refused,
// as are accesses that no stage can make. The verifier accepts the plans of all others.
TEST_F(Validate, AccessIsRefusedIfItsStagesCannotMakeItAndVerifiedOtherwise) {
  const auto storage = [](VkPipelineStageFlags2 stages) {
    return buffer_access::storage_write(stages);
  };
  constexpr VkPipelineStageFlags2 kRays = VK_PIPELINE_STAGE_2_RAY_TRACING_SHADER_BIT_KHR;
  constexpr VkPipelineStageFlags2 kBuild = VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR;
  const struct {
    Access write;
    Access read;
    bool is_valid;
  } cases[] = {
      {storage(kRays), buffer_access::storage_read_compute, true},
      {storage(kRays), buffer_access::storage_read(VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT), true},
      {buffer_access::fill, {kBuild, VK_ACCESS_2_SHADER_READ_BIT}, true},
      {{kBuild, VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR},
       {kRays, VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR},
       true},
      {storage(VK_PIPELINE_STAGE_2_MESH_SHADER_BIT_EXT), buffer_access::vertex_buffer, true},
      {storage(VK_PIPELINE_STAGE_2_COPY_BIT), buffer_access::indirect, false},
      {{kRays, VK_ACCESS_2_TRANSFER_WRITE_BIT}, buffer_access::indirect, false},
      {buffer_access::fill,
       {VK_PIPELINE_STAGE_2_VIDEO_DECODE_BIT_KHR, VK_ACCESS_2_MEMORY_READ_BIT},
       false},
      {buffer_access::fill, {kBuild, VK_ACCESS_2_INPUT_ATTACHMENT_READ_BIT}, false},
  };
  for (const auto& c : cases) {
    graph_.reset();
    Buffer buffer = graph_.create_buffer("b", {64});
    buffer = pass("writer").write(buffer, c.write, Contents::discard);
    pass("reader").read(buffer, c.read);
    if (c.is_valid)
      (void)compile_verified(graph_);
    else
      expect(ErrorCode::bad_access, "access that none of its stages can make, or in a stage that");
  }
}

TEST_F(Validate, StateOfAnImportIsRefusedIfItsStagesCannotMakeItsAccess) {
  for (const bool initial : {false, true}) {
    graph_.reset();
    ImportedBuffer import{.buffer = fake_handle<VkBuffer>(), .desc = {64}};
    (initial ? import.initial_state : import.final_state) = {VK_PIPELINE_STAGE_2_COPY_BIT,
                                                             VK_ACCESS_2_SHADER_READ_BIT};
    (void)graph_.import_buffer("b", import);
    expect(ErrorCode::bad_import, "with a state whose access none of its stages can make");
  }
}

TEST_F(Validate, ImageAtTheDevicesLimitsIsAcceptedAndBeyondEachOfThemRefused) {
  const ImageLimits most{.extent = {8, 8, 1}, .mips = 3, .layers = 2, .samples = 1};
  Texture texture = graph_.create_texture("t", {kSmall.format, Extent::absolute(8, 8), 3, 2});
  texture = pass("writer").write(texture, access::storage_write_compute, {}, Contents::discard);
  ImageLimits allowed = most;
  Limits limits;
  limits.images = {[](const void* context, const ResourceRecord&, VkFlags) {
                     return *static_cast<const ImageLimits*>(context);
                   },
                   &allowed};
  EXPECT_TRUE(compile(graph_.description(), limits));
  for (const auto& [change, text] :
       {std::pair<void (*)(ImageLimits&), const char*>{[](ImageLimits& l) { l.mips = 2; },
                                                       "at most 2 mips for it, not 3"},
        {[](ImageLimits& l) { l.layers = 1; }, "at most 1 layers for it, not 2"},
        {[](ImageLimits& l) { l.extent.width = 7; }, "at most 7 texels of width for it, not 8"},
        {[](ImageLimits& l) { l.extent.height = 7; }, "at most 7 texels of height for it, not 8"},
        {[](ImageLimits& l) { l.extent.depth = 0; }, "at most 0 slices for it, not 1"},
        {[](ImageLimits& l) { l.samples = 0; }, "the device does not support it"}}) {
    allowed = most;
    change(allowed);
    expect(ErrorCode::unsupported_format, text, limits);
  }
}

}  // namespace
}  // namespace alcove::framegraph
