// Tests of the GPU cost model, and the check of the presets against their budget.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "alcove/passes/setting_table.h"
#include "gpu_cost/budget.h"
#include "gpu_cost/cache_traffic.h"
#include "gpu_cost/presets.h"
#include "gpu_cost/xegtao.h"

namespace alcove::sample {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::Not;
using ::testing::UnorderedElementsAreArray;

// Two loops, one within the other, as ACO prints them before registers are assigned.
constexpr const char* kNestedLoops =
    "After Spilling:\n"
    "ACO shader stage: compute_cs\n"
    "BB0\n"
    "/* logical preds: / linear preds: / kind: top-level, */\n"
    "\t v1: %1 = v_mul_f32 %2, %3\n"
    "BB1\n"
    "/* logical preds: BB0, BB3, / linear preds: BB0, BB3, / kind: loop-header, */\n"
    "\t v1: %4 = v_rcp_f32 %1\n"
    "\tp_logical_start\n"
    "BB2\n"
    "/* logical preds: BB1, BB2, / linear preds: BB1, BB2, / kind: loop-header, */\n"
    "\t v4: %5 = image_load %6, s8: undef, v1: undef, %4\n"
    "BB3\n"
    "/* logical preds: BB2, / linear preds: BB2, / kind: continue, */\n"
    "\t s1: %7 = s_add_i32 %8, 1\n"
    "BB4\n"
    "/* logical preds: BB3, / linear preds: BB3, / kind: top-level, */\n"
    "\timage_store %6, s8: undef, %5, %4\n"
    "\ts_endpgm\n";

CompiledShader shader_of(const char* aco, const char* assembly = "not supported") {
  CompiledShader shader;
  shader.texts = {{"ACO IR", aco}, {"Assembly", assembly}};
  return shader;
}

TEST(GpuCost, LoopsInACompiledShaderAreFoundWithTheirNestingAndContents) {
  const std::vector<Loop> loops = find_loops(parse_blocks(shader_of(kNestedLoops)).value());
  ASSERT_EQ(loops.size(), 2u);
  EXPECT_EQ(loops[0].first, 1u);
  EXPECT_EQ(loops[0].last, 3u);
  EXPECT_EQ(loops[0].summary.depth, 1u);
  EXPECT_EQ(loops[0].summary.instructions, 3u);
  EXPECT_EQ(loops[1].summary.depth, 2u);
  EXPECT_EQ(loops[1].summary.loads, 1u);
}

TEST(GpuCost, InstructionsAreMultipliedByTheIterationsOfAllLoopsAroundThem) {
  const auto blocks = parse_blocks(shader_of(kNestedLoops));
  ASSERT_TRUE(blocks) << blocks.error();
  std::vector<Loop> loops = find_loops(*blocks);
  loops[0].iterations = 3;
  loops[1].iterations = 5;
  const WaveWork work = wave_work(*blocks, loops, {}, false, 64);
  EXPECT_EQ(work.loads, 15);
  EXPECT_EQ(work.stores, 1);
  EXPECT_EQ(work.transcendentals, 3);
  EXPECT_EQ(work.vector_instructions, 1 + 3);
  EXPECT_EQ(work.instructions, 1 + 3 * (1 + 5 + 1) + 2);
  EXPECT_EQ(work.vector_cycles, 4 + 3 * 16);
  // Loads of four words per lane take twice as long as loads of one or two.
  EXPECT_EQ(work.texture_cycles, 15 * 16 * 2 + 16);
}

TEST(GpuCost, InstructionsAreCountedInTheDisassemblyIfTheCompilerGivesOne) {
  const auto blocks =
      parse_blocks(shader_of(kNestedLoops,
                             "BB0:\n"
                             "\tv_cndmask_b32_e32 v0, v1, v2, vcc ; 02000300\n"
                             "BB2:\n"
                             "\timage_load v[0:3], v[2:3], s[0:7] dmask:0xf ; f000\n"
                             "\tds_read2_b64 v[0:3], v4 ; d8ee\n"
                             "BB4:\n"
                             "\ts_endpgm ; bf810000\n"));
  ASSERT_TRUE(blocks) << blocks.error();
  std::vector<Loop> loops = find_loops(*blocks);
  loops[1].iterations = 2;
  const WaveWork work = wave_work(*blocks, loops, {}, true, 64);
  EXPECT_EQ(work.selects, 1);
  EXPECT_EQ(work.loads, 2);
  EXPECT_EQ(work.shared_operations, 2);
  EXPECT_EQ(work.shared_words, 2 * 4);
  EXPECT_EQ(work.instructions, 1 + 2 * 2 + 1);
}

TEST(GpuCost, ShaderTextOfAnUnsupportedCompilerIsReported) {
  CompiledShader shader;
  shader.texts = {{"Final Assembly", "mov r0, r1\n"}};
  const auto none = parse_blocks(shader);
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error(), HasSubstr("Mesa's AMD driver is needed"));
  EXPECT_FALSE(parse_blocks(shader_of("no blocks here")));
}

// The number of times that each loop of the search runs; empty if one is not known.
std::vector<double> search_iterations(const OcclusionSettings& settings,
                                      const std::vector<CompiledLoop>& loops) {
  return loop_iterations({Pass::gtao, settings}, loops).value_or(std::vector<double>{});
}

TEST(GpuCost, LoopsOverSlicesAndStepsAreDistinguishedByTheirNumberOfFetches) {
  OcclusionSettings settings;
  settings.slices = 2;
  settings.steps = 16;
  const auto loop = [](std::uint32_t depth, std::uint32_t loads) {
    return CompiledLoop{.depth = depth, .loads = loads};
  };
  EXPECT_THAT(search_iterations(settings, {loop(1, 4), loop(2, 4), loop(3, 2)}),
              ElementsAre(2, 2, 7))
      << "slices, half-slices, steps";
  EXPECT_THAT(search_iterations(settings, {loop(1, 16), loop(2, 16)}), ElementsAre(2, 2))
      << "the loop over steps is unrolled";
  EXPECT_THAT(search_iterations(settings, {loop(1, 8), loop(2, 2), loop(2, 2)}),
              ElementsAre(2, 7, 7))
      << "the loop over half-slices is unrolled";
  EXPECT_THAT(search_iterations(settings, {loop(1, 16), loop(1, 16)}), ElementsAre(2, 2))
      << "the loop over slices is unrolled";
  EXPECT_THAT(search_iterations(settings, {loop(1, 5), loop(2, 5)}), IsEmpty())
      << "no number of steps has five fetches";
  EXPECT_THAT(search_iterations(settings, {loop(1, 0)}), IsEmpty())
      << "visibility has no loop over occluder runs";
  settings.depth_layers = 2;
  EXPECT_THAT(search_iterations(settings, {loop(1, 8), loop(2, 8), loop(3, 2), loop(3, 2)}),
              ElementsAre(2, 2, 7, 2))
      << "16 steps in the first layer, 6 in the second";
  EXPECT_THAT(search_iterations(settings, {loop(1, 10), loop(2, 10), loop(3, 2)}),
              ElementsAre(2, 2, 7))
      << "the loop over steps of the second layer is unrolled";
  settings.thickness_limit = ALCOVE_THICKNESS_LIMIT_BACK_FACES;
  EXPECT_THAT(search_iterations(settings, {loop(1, 44), loop(2, 44)}), ElementsAre(2, 2))
      << "both layers load the depth of back faces";
}

TEST(GpuCost, LoopWithoutAKnownNumberOfIterationsIsReported) {
  const OcclusionSettings settings;
  const CompiledLoop loop{.depth = 1, .instructions = 7};
  const auto iterations =
      loop_iterations({Pass::mask_depth, settings, FrameState::moving}, {&loop, 1});
  ASSERT_FALSE(iterations);
  EXPECT_THAT(iterations.error(), HasSubstr("'mask depth' (moving frame)"));
  EXPECT_THAT(iterations.error(), HasSubstr("7 instructions"));
}

constexpr const char* kBranch =
    "BB0\n"
    "/* logical preds: / linear preds: / kind: top-level, branch, */\n"
    "\t v1: %1 = v_mul_f32 %2, %3\n"
    "BB1\n"
    "/* logical preds: BB0, / linear preds: BB0, / kind: */\n"
    "\t v1: %4 = v_rcp_f32 %1\n"
    "\t v1: %5 = image_load %6, s8: undef, v1: undef, %4\n"
    "BB2\n"
    "/* logical preds: / linear preds: BB0, / kind: */\n"
    "BB3\n"
    "/* logical preds: / linear preds: BB1, BB2, / kind: invert, */\n"
    "BB4\n"
    "/* logical preds: BB0, / linear preds: BB3, / kind: */\n"
    "\t v1: %7 = v_add_f32 %2, %3\n"
    "BB5\n"
    "/* logical preds: / linear preds: BB3, / kind: */\n"
    "BB6\n"
    "/* logical preds: BB1, BB4, / linear preds: BB4, BB5, / kind: top-level, merge, */\n"
    "\ts_endpgm\n";

TEST(GpuCost, BranchCountsByTheShareOfWavesThatExecuteIt) {
  const auto blocks = parse_blocks(shader_of(kBranch));
  ASSERT_TRUE(blocks) << blocks.error();
  std::vector<Branch> branches = find_branches(*blocks);
  ASSERT_EQ(branches.size(), 2u);
  EXPECT_EQ(branches[0].summary.instructions, 2u);
  EXPECT_EQ(branches[0].summary.loads, 1u);
  EXPECT_EQ(branches[1].summary.instructions, 1u);
  branches[0].share = 0.25;
  const WaveWork work = wave_work(*blocks, {}, branches, false, 64);
  EXPECT_EQ(work.loads, 0.25);
  EXPECT_EQ(work.instructions, 1 + 0.25 * 2 + 1 + 1);
}

constexpr double kWaves = 4;  // on a SIMD

// A label or a name that the passes do not give would leave accesses and loops undeclared.
TEST(GpuCost, PassesAndImagesOfTheModelAreThoseOfTheListOfWork) {
  std::set<std::string_view> labels, images;
  for (unsigned bits = 0; bits < 32; ++bits) {
    const bool simple = bits % 2 == 0, half = bits / 2 % 2 == 0;
    CostInputs inputs{.normals = simple, .mask = half, .samples = half};
    inputs.settings.tile_size = 8;
    inputs.settings.depth_layers = simple ? 1 : 2;
    inputs.settings.thickness_limit = static_cast<AlcoveThicknessLimit>(!simple);
    inputs.settings.bent_normal = half;
    inputs.settings.half_resolution = half ? 1 : 0;
    inputs.settings.specular = static_cast<AlcoveSpecular>(bits / 4 % 4 % 3);
    inputs.settings.history_frames = bits < 16 ? 0 : 8;
    const auto frames = describe_frames(inputs);
    ASSERT_TRUE(frames) << frames.error();
    for (const AlcoveWork& frame : *frames) {
      for (const auto& dispatch : std::span(frame.dispatches).first(frame.dispatch_count))
        labels.insert(dispatch.label);
      for (const auto& image : std::span(frame.resources).first(frame.resource_count))
        images.insert(image.name);
    }
  }
  EXPECT_THAT(labels, UnorderedElementsAreArray(kPassLabels));
  EXPECT_THAT(images, IsSupersetOf(names::kAll));
}

// An image of 4 bytes a texel, and a dispatch that has an invocation for each texel.
constexpr std::uint32_t kSide = 1024;
const PassImage kImage{"image", Direction::read, 4, kSide, kSide};
DispatchAccesses over_image(std::vector<ImageAccess> accesses) {
  return {kSide / 8, kSide / 8, std::move(accesses)};
}

TEST(CacheTraffic, LoadsOfNeighbouringTexelsTouchFewerLinesThanScatteredOnes) {
  const auto scattered = [](Texel at) {
    auto hash =
        static_cast<std::uint32_t>(at.x + at.y * static_cast<std::int32_t>(kSide)) * 2654435761u;
    hash = (hash ^ hash >> 15u) * 2246822519u;
    hash ^= hash >> 13u;
    return Texel{static_cast<std::int32_t>(hash % kSide),
                 static_cast<std::int32_t>((hash >> 16u) % kSide)};
  };
  for (const GpuPart& part : kGpuParts) {
    const CacheTraffic near_traffic =
        cache_traffic(part, over_image({at_invocation(kImage)}), kWaves);
    const CacheTraffic far_traffic =
        cache_traffic(part, over_image({{kImage, 1, scattered}}), kWaves);
    EXPECT_EQ(near_traffic.lines_per_load, 8 * 8 * 4 / part.line_bytes) << part.name;
    EXPECT_GT(far_traffic.lines_per_load, 60) << part.name;
    EXPECT_GT(far_traffic.texture_ms, 3.5 * near_traffic.texture_ms) << part.name;
    EXPECT_GT(far_traffic.l2_bytes, 10 * near_traffic.l2_bytes) << part.name;
  }
}

TEST(CacheTraffic, RepeatedLoadsAreServedByCachesAndMovedFromMemoryOnce) {
  for (const GpuPart& part : kGpuParts) {
    const double bytes = 4.0 * kSide * kSide;
    const CacheTraffic once = cache_traffic(part, over_image({at_invocation(kImage)}), kWaves);
    EXPECT_DOUBLE_EQ(once.memory_bytes, bytes) << part.name;
    const CacheTraffic often = cache_traffic(
        part, over_image({at_invocation(kImage), at_invocation(kImage), at_invocation(kImage)}),
        kWaves);
    EXPECT_DOUBLE_EQ(often.memory_bytes, bytes) << part.name;
    EXPECT_LT(often.l2_bytes, 1.1 * once.l2_bytes) << part.name;
    EXPECT_GT(often.texture_ms, 2.5 * once.texture_ms) << part.name;
  }
}

TEST(CacheTraffic, TexelsThatAreReadAgainAfterOthersHaveReplacedThemAreMovedTwice) {
  // The second load reads the opposite end of an image that is larger than every cache.
  const auto mirrored = [](Texel at) {
    return Texel{at.x, static_cast<std::int32_t>(kSide) - 1 - at.y};
  };
  const CacheTraffic traffic = cache_traffic(
      kGpuParts[0], over_image({at_invocation(kImage), {kImage, 1, mirrored}}), kWaves);
  EXPECT_GT(traffic.memory_bytes, 1.7 * 4 * kSide * kSide);
}

TEST(CacheTraffic, StoresAreWrittenToMemoryOnce) {
  const PassImage written{"result", Direction::write, 4, kSide, kSide};
  const CacheTraffic traffic =
      cache_traffic(kGpuParts[0], over_image({at_invocation(written)}), kWaves);
  EXPECT_DOUBLE_EQ(traffic.memory_bytes, 4.0 * kSide * kSide);
  EXPECT_EQ(traffic.lines_per_load, 0);
}

// The figures of another program, which simulates the same caches independently, for the search of
// tiles of 4x4 pixels with two slices of 12 steps.
TEST(CacheTraffic, TrafficOfTheSearchAgreesWithAnotherModel) {
  struct Expected {
    double waves, lines, l2_bytes_per_pixel, memory_bytes_per_pixel;
  };
  constexpr std::array<Expected, kGpuParts.size()> kExpected{
      {{3, 52.0, 152.8, 70.9}, {6, 42.6, 242.5, 14.1}, {6, 42.6, 240.8, 27.3}}};
  OcclusionSettings settings;
  settings.tile_size = 4;
  settings.slices = 2;
  settings.steps = 12;
  constexpr double kPixels = 1920.0 * 1080.0;
  const std::vector<PassImage> images{{"depth", Direction::read, 4, 1920, 1080},
                                      {"normals", Direction::read, 8, 1920, 1080},
                                      {"raw occlusion", Direction::write, 8, 480, 270}};
  for (std::size_t i = 0; i < kGpuParts.size(); ++i) {
    const Expected& expected = kExpected[i];
    const CacheTraffic found = cache_traffic(
        kGpuParts[i], accesses_of({Pass::gtao, settings, FrameState::moving, images, {17, 60, 2}}),
        expected.waves);
    EXPECT_NEAR(found.lines_per_load / expected.lines, 1, 0.1) << kGpuParts[i].name;
    EXPECT_NEAR(found.l2_bytes / kPixels / expected.l2_bytes_per_pixel, 1, 0.1)
        << kGpuParts[i].name;
    EXPECT_NEAR(found.memory_bytes / kPixels / expected.memory_bytes_per_pixel, 1, 0.1)
        << kGpuParts[i].name;
  }
}

TEST(CostReport, FramesAreComparedWithXeGtaoAtTheSameSizeIfTheCompilerIsTheSame) {
  ModelledPass pass;
  pass.limits_ms[0] = 1;
  SettingsCost cost;
  cost.settings.label = "medium";
  cost.part = &kGpuParts[1];
  cost.frames = {{FrameState::moving, {pass}}};
  cost.settings.inputs.width = 960;
  cost.settings.inputs.height = 540;
  cost.compiler = kXeGtaoCompiler;
  const auto frame = [&] { return to_json({&cost, 1})[0]["settings"][0]["frames"][0]; };
  EXPECT_NEAR(frame()["of_xegtao_high"], 1 / xegtao_ms(kGpuParts[1], kXeGtaoHigh, 960, 540), 1e-9);
  EXPECT_THAT(format_table({&cost, 1}), HasSubstr("of XeGTAO high"));
  cost.compiler = "radv, Mesa 25.0.7";
  EXPECT_FALSE(frame().contains("of_xegtao_high"));
  EXPECT_THAT(format_table({&cost, 1}), Not(HasSubstr("of XeGTAO high")));
}

TEST(GpuBudget, InstructionsAndRegistersOfThePresetsAreThoseOfTheFile) {
  const auto budget = gpu_budget();
  if (!budget) GTEST_SKIP() << budget.error();
  std::ifstream file(ALCOVE_GPU_BUDGET);
  const std::string written{std::istreambuf_iterator<char>(file), {}};
  const auto lines = [](const std::string& text) {
    std::vector<std::string> found;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) found.push_back(line);
    return found;
  };
  if (lines(*budget).front() != lines(written).front())
    GTEST_SKIP() << "The budget was written with another compiler: " << lines(written).front();
  EXPECT_EQ(lines(*budget), lines(written))
      << "If it is meant: alcove cost --write-budget " ALCOVE_GPU_BUDGET;
}

// The parameter is the index of the first GPU of a family.
class CompiledPresets : public testing::TestWithParam<std::size_t> {
 protected:
  void SetUp() override {
    const auto device = create_null_device(part_.family);
    if (!device) GTEST_SKIP() << device.error();
    device_ = *device;
  }

  const GpuPart& part_ = kGpuParts[GetParam()];
  NullDevice device_;
};

// Instructions per pixel of the passes of a moving frame.
Result<double> instructions_of(const GpuPart& part, const NullDevice& device,
                               const CostInputs& inputs) {
  ALCOVE_TRY(const auto frame, modelled_frame(part, device, inputs, FrameState::moving, nullptr));
  double sum = 0.0;
  for (const ModelledPass& pass : frame.passes) sum += pass.instructions_per_pixel;
  return sum;
}

// Loops, rare branches and strips of groups must not hide samples from the model.
TEST_P(CompiledPresets, SearchIsChargedWithEverySampleOfEveryTracedPixel) {
  for (const AlcoveQuality quality : {ALCOVE_QUALITY_LOW, ALCOVE_QUALITY_MEDIUM}) {
    CostInputs inputs;
    inputs.settings = OcclusionSettings(quality, 0.5f);
    const auto frame = modelled_frame(part_, device_, inputs, FrameState::moving, nullptr);
    ASSERT_TRUE(frame) << frame.error();
    const ModelledPass& search = frame->passes.front();
    ASSERT_EQ(search.pass, "gtao");
    const double tile = inputs.settings.tile_size;
    EXPECT_GE(search.fetches_per_pixel,
              2.0 * inputs.settings.slices * inputs.settings.steps / (tile * tile));
  }
}

// A texel that a shader loads and accesses.cpp does not know would cost no byte.
TEST_P(CompiledPresets, DeclaredAccessesAreTheLoadsOfTheCompiledShaders) {
  CostInputs inputs;
  inputs.width = 384;
  inputs.height = 216;
  for (const AlcoveQuality quality : presets()) {
    for (const bool mask : {false, true}) {
      inputs.settings = OcclusionSettings(quality, 0.5f);
      inputs.mask = mask;
      const auto frame = modelled_frame(part_, device_, inputs, FrameState::moving);
      ASSERT_TRUE(frame) << frame.error();
      for (const ModelledPass& pass : frame->passes) {
        // The loads of rare branches, such as those of a missing normal, are less than half a load.
        EXPECT_NEAR(pass.wave.loads, pass.declared_loads, 0.5)
            << passes::kQualityNames.at(quality) << ", " << pass.pass << ", mask " << mask;
      }
    }
  }
}

// Bent normals need the normals once more. They are on for the GPU for which that costs most.
TEST_P(CompiledPresets, DecodingPackedNormalsTakesAtMostTheStatedInstructionsPerPixel) {
  struct PackedEncoding {
    const char* name;
    AlcoveNormalEncoding encoding;
    std::array<double, 2> most;  // instructions per pixel by GPU, a little above the measured ones
  };
  constexpr PackedEncoding kPacked[] = {
      {"unsigned xyz", ALCOVE_NORMAL_ENCODING_UNSIGNED_XYZ, {4.5, 1.2}},
      {"octahedral", ALCOVE_NORMAL_ENCODING_OCTAHEDRAL, {13.0, 3.2}},
      {"unsigned octahedral", ALCOVE_NORMAL_ENCODING_UNSIGNED_OCTAHEDRAL, {16.0, 3.5}}};
  CostInputs inputs;
  inputs.settings = OcclusionSettings(ALCOVE_QUALITY_MEDIUM, 0.5f);
  inputs.settings.bent_normal = !part_.rdna;
  const auto plain = instructions_of(part_, device_, inputs);
  ASSERT_TRUE(plain) << plain.error();
  for (const PackedEncoding& packed : kPacked) {
    inputs.normal_encoding = packed.encoding;
    const auto found = instructions_of(part_, device_, inputs);
    ASSERT_TRUE(found) << found.error();
    std::printf("%s: %.1f instructions per pixel more than %.1f\n", packed.name, *found - *plain,
                *plain);
    EXPECT_LE(*found - *plain, packed.most.at(GetParam())) << packed.name;
    EXPECT_GT(*found, *plain) << packed.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Gcn, CompiledPresets, testing::Values(0));
INSTANTIATE_TEST_SUITE_P(Rdna2, CompiledPresets, testing::Values(1));

}  // namespace
}  // namespace alcove::sample
