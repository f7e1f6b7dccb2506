// Tests of the GPU cost model, and the check of the presets against their budget.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <ostream>
#include <vector>

#include "alcove/passes/setting_names.h"
#include "gpu_cost/budget.h"

namespace alcove::sample {
namespace {

using passes::cost::CompiledLoop;
using passes::cost::FrameState;
using passes::cost::PassWork;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

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
  const auto blocks = blocks_of(shader_of(kNestedLoops));
  ASSERT_TRUE(blocks) << blocks.error();
  const std::vector<Loop> loops = loops_of(*blocks);
  ASSERT_EQ(loops.size(), 2u);
  EXPECT_EQ(loops[0].first, 1u);
  EXPECT_EQ(loops[0].last, 3u);
  EXPECT_EQ(loops[0].summary.depth, 1u);
  EXPECT_EQ(loops[0].summary.instructions, 3u);
  EXPECT_EQ(loops[1].summary.depth, 2u);
  EXPECT_EQ(loops[1].summary.loads, 1u);
}

TEST(GpuCost, InstructionsAreMultipliedByTheIterationsOfAllLoopsAroundThem) {
  const auto blocks = blocks_of(shader_of(kNestedLoops));
  ASSERT_TRUE(blocks) << blocks.error();
  const WaveWork work = wave_work(*blocks, loops_of(*blocks), {3, 5}, false, 64);
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
  const auto blocks = blocks_of(shader_of(kNestedLoops,
                                          "BB0:\n"
                                          "\tv_cndmask_b32_e32 v0, v1, v2, vcc ; 02000300\n"
                                          "BB2:\n"
                                          "\timage_load v[0:3], v[2:3], s[0:7] dmask:0xf ; f000\n"
                                          "\tds_read2_b64 v[0:3], v4 ; d8ee\n"
                                          "BB4:\n"
                                          "\ts_endpgm ; bf810000\n"));
  ASSERT_TRUE(blocks) << blocks.error();
  const WaveWork work = wave_work(*blocks, loops_of(*blocks), {1, 2}, true, 64);
  EXPECT_EQ(work.selects, 1);
  EXPECT_EQ(work.loads, 2);
  EXPECT_EQ(work.shared_operations, 2);
  EXPECT_EQ(work.shared_words, 2 * 4);
  EXPECT_EQ(work.instructions, 1 + 2 * 2 + 1);
}

TEST(GpuCost, ShaderTextOfAnUnsupportedCompilerIsReported) {
  CompiledShader shader;
  shader.texts = {{"Final Assembly", "mov r0, r1\n"}};
  const auto none = blocks_of(shader);
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error(), HasSubstr("Mesa's AMD driver is needed"));
  EXPECT_FALSE(blocks_of(shader_of("no blocks here")));
}

// The number of times that each loop of the search runs; -1 for one that is not known.
std::vector<double> search_iterations(const passes::OcclusionSettings& settings,
                                      std::vector<CompiledLoop> loops) {
  std::vector<double> found;
  found.reserve(loops.size());
  for (std::uint32_t i = 0; i < loops.size(); ++i) {
    loops[i].index = i;
  }
  const PassWork work{"gtao", settings, FrameState::moving, loops};
  for (const CompiledLoop& loop : loops) {
    found.push_back(passes::cost::iterations(work, loop).value_or(-1.0));
  }
  return found;
}

TEST(GpuCost, LoopsOverSlicesAndStepsAreDistinguishedByTheirNumberOfFetches) {
  passes::OcclusionSettings settings;
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
  EXPECT_THAT(search_iterations(settings, {loop(1, 5), loop(2, 5)}), ElementsAre(-1, -1))
      << "no number of steps has five fetches";
  EXPECT_THAT(search_iterations(settings, {loop(1, 0)}), ElementsAre(-1))
      << "visibility has no loop over occluder runs";
}

TEST(GpuCost, LoopWithoutAKnownNumberOfIterationsIsReported) {
  const passes::OcclusionSettings settings;
  const CompiledLoop loop{.index = 0, .depth = 1, .instructions = 7};
  const PassWork work{"normals", settings, FrameState::moving, {&loop, 1}};
  const auto iterations = passes::cost::iterations(work, loop);
  ASSERT_FALSE(iterations);
  EXPECT_THAT(iterations.error(), HasSubstr("'normals' (moving frame)"));
  EXPECT_THAT(iterations.error(), HasSubstr("7 instructions"));
}

// A group of invocations covers 8x8 pixels. If each pixel loads its own texel of 4 or 8 bytes, each
// row of 8 texels lies in one cache line. A gather of 2x2 texels reads 9 rows of 9 texels if pixels
// are one texel apart, and 16 rows of 16 texels if they are two texels apart.
TEST(GpuCost, NumberOfCacheLinesOfALoadFollowsFromItsAddressPattern) {
  using passes::cost::cache_lines;
  EXPECT_EQ(cache_lines({}), 8);
  EXPECT_EQ(cache_lines({.texel_bytes = 8}), 8);
  EXPECT_EQ(cache_lines({.pitch = 2}), 8);
  EXPECT_EQ(cache_lines({.texel_bytes = 8, .pitch = 2}), 16);
  EXPECT_EQ(cache_lines({.footprint = 2, .anywhere = true}), 9 * 1.5);
  EXPECT_EQ(cache_lines({.pitch = 2, .footprint = 2, .first = -1}), 16 * 2);
}

// The limit of 12 cache lines holds at full resolution, where a pixel loads 4 or 8 bytes at a time.
// It does not hold at half resolution, where each gather reads 16 rows of the depth buffer.
TEST(GpuCost, LoadsOfTheReconstructPassAtFullResolutionTouchAtMost12CacheLines) {
  for (const auto quality :
       {passes::Quality::low, passes::Quality::medium, passes::Quality::high}) {
    const passes::OcclusionSettings settings = passes::quality_settings(quality, 0.5f);
    for (const FrameState state : {FrameState::first, FrameState::moving, FrameState::converged}) {
      const PassWork work{"reconstruct", settings, state, {}};
      EXPECT_LE(passes::cost::cache_lines_per_load(work), 12) << passes::name_of(quality);
    }
  }
}

SettingsCost one_pass(double instructions, double registers, double waves, double spills) {
  ModelledPass pass;
  pass.pass = "gtao";
  pass.instructions_per_pixel = instructions;
  pass.vector_registers = registers;
  pass.waves_per_simd = waves;
  pass.spills = spills;
  return {"medium", "navi21", {{FrameState::moving, {pass}}}, ""};
}

TEST(GpuBudget, EachModelledCostThatExceedsItsBudgetIsReported) {
  const auto budget = budget_of({one_pass(100, 64, 8, 0)}, "compiler");
  EXPECT_THAT(over_budget(budget, {one_pass(100.9, 64, 8, 0)}), IsEmpty());
  EXPECT_THAT(over_budget(budget, {one_pass(80, 48, 10, 0)}), IsEmpty());
  EXPECT_THAT(over_budget(budget, {one_pass(101.5, 64, 8, 0)}),
              ElementsAre("navi21, medium, moving frame, gtao: instructions_per_pixel is 101.5, "
                          "the budget is 100."));
  EXPECT_THAT(over_budget(budget, {one_pass(100, 68, 8, 0)}), ElementsAre(HasSubstr("registers")));
  EXPECT_THAT(over_budget(budget, {one_pass(100, 64, 7, 0)}), ElementsAre(HasSubstr("waves")));
  EXPECT_THAT(over_budget(budget, {one_pass(100, 64, 8, 1)}), ElementsAre(HasSubstr("spilled")));
}

TEST(GpuBudget, PassWithoutABudgetIsReported) {
  EXPECT_THAT(over_budget(nlohmann::ordered_json::object(), {one_pass(1, 1, 1, 0)}),
              testing::Contains(HasSubstr("the budget is missing")));
}

SettingsCost frames_of(const std::string& label, const std::string& family, double moving_ms,
                       double static_ms, const std::string& label_without = "") {
  ModelledPass moving, unchanged;
  moving.alu_ms = moving_ms;
  unchanged.alu_ms = static_ms;
  return {label,
          family,
          {{FrameState::moving, {moving}}, {FrameState::unchanged, {unchanged}}},
          label_without};
}

TEST(CostReport, TimeWithAnOptionalOutputIsComparedWithTheTimeWithoutItOnTheSameGpu) {
  const std::vector<SettingsCost> costs{
      frames_of("low", "navi21", 1, 1), frames_of("medium", "bonaire", 10, 10),
      frames_of("medium", "navi21", 2, 4),
      frames_of("medium with bent normals", "navi21", 3, 5, "medium")};
  EXPECT_THAT(output_ratios(costs[3], costs), ElementsAre(1.5, 1.25));
  EXPECT_THAT(output_ratios(costs[2], costs), IsEmpty()) << "medium is compared with nothing";
  EXPECT_THAT(output_ratios(costs[3], std::span(costs).first(2)), IsEmpty())
      << "medium is not among the costs of this GPU";
  EXPECT_THAT(table_of(costs, false),
              HasSubstr("medium with bent normals                  1.500      1.250\n"));
  EXPECT_THAT(table_of(std::span(costs).first(3), false), Not(HasSubstr("without the output")));
  EXPECT_EQ(to_json(costs)[1]["settings"][2]["frames"][0]["of_time_without_output"], 1.5);
}

TEST(CostReport, EachOptionalOutputIsAddedToAPresetAlone) {
  const LabelledSettings plain{"high", {}, ""};
  const auto [bent, specular] = with_each_output(plain);
  EXPECT_EQ(bent.label, "high with bent normals");
  EXPECT_EQ(bent.label_without, "high");
  EXPECT_TRUE(bent.inputs.settings.bent_normal);
  EXPECT_EQ(bent.inputs.settings.specular, passes::Specular::none);
  EXPECT_EQ(specular.label_without, "high");
  EXPECT_FALSE(specular.inputs.settings.bent_normal);
  EXPECT_EQ(specular.inputs.settings.specular, passes::Specular::slices);
}

struct Budgeted {
  const GpuPart* part;
  LabelledSettings settings;
};
// GoogleTest prints the GPU and the settings in the names that ctest lists.
std::ostream& operator<<(std::ostream& out, const Budgeted& budgeted) {
  return out << budgeted.part->family << ", " << budgeted.settings.label;
}

std::vector<Budgeted> all_budgeted() {
  std::vector<Budgeted> all;
  for (const GpuPart& part : kGpuParts) {
    for (const LabelledSettings& settings : budgeted_settings()) {
      all.push_back({&part, settings});
    }
  }
  return all;
}

std::string name_of_test(const testing::TestParamInfo<Budgeted>& info) {
  std::string name(info.param.part->family);
  name += "_" + info.param.settings.label;
  std::ranges::replace(name, ' ', '_');
  return name;
}

// Expects that every pass holds enough waves to hide the latency of its loads, and spills nothing.
void expect_enough_waves(const GpuPart& part, const SettingsCost& cost) {
  const double fewest = part.rdna ? 6.0 : 3.0;
  for (const ModelledFrame& frame : cost.frames) {
    for (const ModelledPass& pass : frame.passes) {
      EXPECT_GE(pass.waves_per_simd, fewest)
          << part.family << ", " << cost.label << ", " << passes::cost::name_of(frame.state) << ", "
          << pass.pass << ": " << pass.vector_registers << " vector registers";
      EXPECT_EQ(pass.spills, 0.0) << part.family << ", " << cost.label << ", " << pass.pass;
    }
  }
}

class ShippedPresets : public testing::TestWithParam<Budgeted> {};

TEST_P(ShippedPresets, ModelledCostOfThePresetStaysWithinItsGpuBudget) {
  const auto device = create_null_device(GetParam().part->family);
  if (!device) {
    GTEST_SKIP() << device.error();
  }
  std::ifstream file(ALCOVE_GPU_BUDGET);
  const auto budget = nlohmann::ordered_json::parse(file, nullptr, false);
  ASSERT_TRUE(budget.is_object()) << ALCOVE_GPU_BUDGET << " is not a JSON object.";
  const std::string compiler = compiler_name(*device);
  if (budget.value("compiler", "") != compiler) {
    GTEST_SKIP() << "The budget was written with " << budget["compiler"]
                 << "; the compiler here is " << compiler << ", which makes other code.";
  }
  const auto cost = cost_of(*GetParam().part, *device, GetParam().settings);
  ASSERT_TRUE(cost) << cost.error();
  if (cost->label_without.empty()) {
    expect_enough_waves(*GetParam().part, *cost);
  }
  const auto complaints = over_budget(budget, {*cost});
  for (const std::string& complaint : complaints) {
    ADD_FAILURE() << complaint << " If it is meant: alcove cost --write-budget " ALCOVE_GPU_BUDGET;
  }
}

// Instructions per pixel of the passes of a moving frame.
tl::expected<double, std::string> instructions_of(const GpuPart& part, const NullDevice& device,
                                                  const CostInputs& inputs) {
  const auto frames = modelled_frames(part, device, inputs);
  if (!frames) {
    return tl::unexpected(frames.error());
  }
  const auto moving = std::ranges::find(*frames, FrameState::moving, &ModelledFrame::state);
  double sum = 0.0;
  for (const ModelledPass& pass : moving->passes) {
    sum += pass.instructions_per_pixel;
  }
  return sum;
}

TEST(NormalEncodings, DecodingPackedNormalsTakesAtMostTheStatedInstructionsPerPixel) {
  using passes::NormalEncoding;
  struct Named {
    const char* name;
    NormalEncoding encoding;
    double most;  // instructions per pixel, a little above the measured ones
  };
  constexpr Named kPacked[] = {{"unsigned xyz", NormalEncoding::unsigned_xyz, 6.0},
                               {"octahedral", NormalEncoding::octahedral, 13.0},
                               {"unsigned octahedral", NormalEncoding::unsigned_octahedral, 15.5}};
  for (const GpuPart& part : kGpuParts) {
    const auto device = create_null_device(part.family);
    if (!device) {
      GTEST_SKIP() << device.error();
    }
    for (const bool bent_normal : {false, true}) {
      CostInputs inputs;
      inputs.settings = passes::quality_settings(passes::Quality::medium, 0.5f);
      inputs.settings.bent_normal = bent_normal;
      const auto plain = instructions_of(part, *device, inputs);
      ASSERT_TRUE(plain) << plain.error();
      std::printf("%s, bent normals %s: signed xyz %.1f instructions per pixel", part.family.data(),
                  bent_normal ? "on" : "off", *plain);
      for (const Named& packed : kPacked) {
        inputs.normal_encoding = packed.encoding;
        const auto found = instructions_of(part, *device, inputs);
        ASSERT_TRUE(found) << found.error();
        std::printf(", %s %+.1f", packed.name, *found - *plain);
        EXPECT_LE(*found - *plain, packed.most) << part.family << ", " << packed.name;
        EXPECT_GT(*found, *plain) << part.family << ", " << packed.name;
      }
      std::printf("\n");
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Gpu, ShippedPresets, testing::ValuesIn(all_budgeted()), name_of_test);

}  // namespace
}  // namespace alcove::sample
