// Tests that a part of the occlusion passes that is turned off, or whose result nobody reads, costs
// no pass, no memory and no pipeline.
#include <gmock/gmock.h>

#include "frame_plan.h"
#include "gtao_scenes.h"
#include "pass_fixture.h"

namespace alcove::passes {
namespace {

using framegraph::Graph;
using testing::Contains;
using testing::ElementsAre;
using testing::Not;

// The inputs of a frame besides depth.
struct InputImages {
  bool normals = true;
  bool motion = false;
  bool hidden_depths = false;
  bool roughness = false;
};

// The outputs that the frame reads.
struct OutputChoice {
  bool visibility = true;
  bool bent_normal = false;
  bool specular = false;
};

void expect_same(const FramePlan& a, const FramePlan& b) {
  EXPECT_EQ(a.passes, b.passes);
  EXPECT_EQ(a.transients, b.transients);
  EXPECT_EQ(a.bytes, b.bytes);
}

class OcclusionPlan : public PassTest {
 protected:
  const AlcoveViewInfo view_{.camera = test_views()[2].view, .normals_in_view_space = 1};

  void SetUp() override { open_gpu(); }

  FramePlan plan(const OcclusionSettings& settings, OutputChoice choice = {},
                 InputImages images = {}) {
    const Drawing drawing = draw(test_views()[2], 32, 24, groove(0.8));
    FramePlan result;
    run([&](Graph& graph) {
      ViewTextures textures{upload(graph, drawing.depth_ndc)};
      if (images.normals) textures[ALCOVE_IMAGE_NORMALS] = upload(graph, drawing.normal_vs);
      if (images.motion)
        textures[ALCOVE_IMAGE_MOTION] = upload(graph, uniform(32, 24, {0.0f, 0.0f}));
      if (images.hidden_depths) {
        textures[ALCOVE_IMAGE_BACK_DEPTH] = upload(graph, drawing.depth_ndc);
        textures[ALCOVE_IMAGE_SECOND_DEPTH] = upload(graph, drawing.depth_ndc);
      }
      if (images.roughness)
        textures[ALCOVE_IMAGE_ROUGHNESS] = upload(graph, uniform(32, 24, {0.5f, 0.5f, 0.5f, 0.5f}));
      add_view_of(graph, view_, 0, settings, textures);
      if (choice.visibility) read_back(graph, textures[ALCOVE_IMAGE_VISIBILITY]);
      if (choice.bent_normal) read_back(graph, textures[ALCOVE_IMAGE_BENT_NORMAL]);
      if (choice.specular) read_back(graph, textures[ALCOVE_IMAGE_SPECULAR]);
      result = plan_frame(graph);
    });
    return result;
  }
};

OcclusionSettings least() {
  OcclusionSettings settings;
  settings.tile_size = 1;
  settings.estimator = ALCOVE_ESTIMATOR_HORIZONS;
  settings.steps = 4;
  settings.history_frames = 0;
  return settings;
}

// Without a history, one texel is bound in the place of the history.
TEST_F(OcclusionPlan, FrameThatOnlyComputesVisibilityHasTwoPassesAndTwoTextures) {
  const FramePlan frame = plan(least());
  EXPECT_THAT(frame.passes, ElementsAre("gtao", "reconstruct"));
  EXPECT_THAT(frame.transients,
              testing::UnorderedElementsAre("raw occlusion", "visibility", "unused output"));
  EXPECT_THAT(frame.histories, testing::IsEmpty());
  EXPECT_EQ(gpu().pipelines().pipeline_count(), 2u);
}

TEST_F(OcclusionPlan, FrameWithoutNormalsHasNoFurtherPassesAndTextures) {
  const FramePlan from_depth = plan(least(), {}, {.normals = false});
  const FramePlan with_normals = plan(least());
  EXPECT_EQ(from_depth.passes, with_normals.passes);
  EXPECT_EQ(from_depth.transients, with_normals.transients);
}

TEST_F(OcclusionPlan, BentNormalsAndHistoryAddTexturesOnlyWhenTheyAreOn) {
  const FramePlan without = plan(least());
  OcclusionSettings bent = least();
  bent.bent_normal = true;
  const FramePlan with_bent = plan(bent, {.bent_normal = true});
  EXPECT_THAT(with_bent.transients, Contains("bent normal"));
  EXPECT_GT(with_bent.bytes, without.bytes);

  OcclusionSettings history = least();
  history.history_frames = 8;
  EXPECT_THAT(plan(history).histories, testing::SizeIs(2));
  history.bent_normal = true;
  EXPECT_THAT(plan(history, {.bent_normal = true}).histories, testing::SizeIs(4));
}

// Motion vectors are only needed to reproject the history.
TEST_F(OcclusionPlan, MotionVectorsAreNotReadIfHistoryIsOff) {
  const InputImages moving{.motion = true};
  OcclusionSettings history = least();
  history.history_frames = 8;
  (void)plan(least());
  const std::size_t pipelines = gpu().pipelines().pipeline_count();
  EXPECT_EQ(plan(least(), {}, moving).uploads, 2u) << "depth and normals";
  EXPECT_EQ(gpu().pipelines().pipeline_count(), pipelines);
  EXPECT_EQ(plan(history, {}, moving).uploads, 3u);
}

// AlcoveEstimator horizons assumes infinitely thick occluders, which already cover hidden surfaces.
TEST_F(OcclusionPlan, BackFacesAndSecondDepthLayersCostNothingUnlessTheSettingsReadThem) {
  constexpr void (*kReads[])(OcclusionSettings&) = {
      [](OcclusionSettings& s) { s.thickness_limit = ALCOVE_THICKNESS_LIMIT_BACK_FACES; },
      [](OcclusionSettings& s) { s.depth_layers = 2; }};
  for (const auto read : kReads) {
    const FramePlan horizons = plan(least());
    const std::size_t first_pipelines = gpu().pipelines().pipeline_count();
    OcclusionSettings settings = least();
    read(settings);
    expect_same(plan(settings), horizons);
    EXPECT_EQ(gpu().pipelines().pipeline_count(), first_pipelines);

    settings = least();
    settings.estimator = ALCOVE_ESTIMATOR_CONNECTED;
    const FramePlan connected = plan(settings);
    const std::size_t pipelines = gpu().pipelines().pipeline_count();
    expect_same(plan(settings, {}, {.hidden_depths = true}), connected);
    EXPECT_EQ(gpu().pipelines().pipeline_count(), pipelines);
    read(settings);
    expect_same(plan(settings, {}, {.hidden_depths = true}), connected);
    EXPECT_EQ(gpu().pipelines().pipeline_count(), pipelines + 1) << "the variant that reads them";
  }
}

TEST_F(OcclusionPlan, SpecularOcclusionAddsMemoryAndPassesOnlyWhenItIsOnAndRead) {
  const FramePlan without = plan(least());
  OcclusionSettings settings = least();
  settings.roughness = 0.2f;  // no pass reads it
  EXPECT_EQ(plan(settings).bytes, without.bytes);

  settings.specular = ALCOVE_SPECULAR_SLICES;
  const FramePlan by_slices = plan(settings, {.specular = true});
  EXPECT_EQ(by_slices.passes, without.passes);
  EXPECT_THAT(by_slices.transients, Contains("specular occlusion"));
  EXPECT_THAT(by_slices.transients, Not(Contains("bent normal")));

  settings.specular = ALCOVE_SPECULAR_TABLE;
  EXPECT_THAT(plan(settings, {.specular = true}).transients, Contains("bent normal"));
  const FramePlan unread = plan(settings);
  EXPECT_THAT(unread.passes, Not(Contains("specular occlusion")));
}

TEST_F(OcclusionPlan, RoughnessChannelCreatesAPipelineOnlyIfARoughnessTextureIsRead) {
  for (const AlcoveSpecular specular :
       {ALCOVE_SPECULAR_NONE, ALCOVE_SPECULAR_SLICES, ALCOVE_SPECULAR_TABLE}) {
    OcclusionSettings settings = least();
    settings.specular = specular;
    const bool read = specular != ALCOVE_SPECULAR_NONE;
    (void)plan(settings, {.specular = read});
    (void)plan(settings, {.specular = read}, {.roughness = true});
    const std::size_t pipelines = gpu().pipelines().pipeline_count();
    settings.roughness_channel = 2;
    (void)plan(settings, {.specular = read});
    EXPECT_EQ(gpu().pipelines().pipeline_count(), pipelines);
    (void)plan(settings, {.specular = read}, {.roughness = true});
    // With specular occlusion from slices, the passes gtao and reconstruct both read the roughness.
    // Each gets another pipeline for another channel.
    const std::size_t readers = !read ? 0 : specular == ALCOVE_SPECULAR_SLICES ? 2 : 1;
    EXPECT_EQ(gpu().pipelines().pipeline_count(), pipelines + readers);
  }
}

TEST_F(OcclusionPlan, LargerTracingTilesTakeLessMemory) {
  OcclusionSettings half = least();
  half.tile_size = 2;
  EXPECT_LT(plan(half).bytes, plan(least()).bytes);
}

TEST_F(OcclusionPlan, ChangedRadiusCreatesNoNewPipeline) {
  (void)plan(least());
  const std::size_t pipelines = gpu().pipelines().pipeline_count();
  OcclusionSettings other = least();
  other.radius = 3.0f;
  (void)plan(other);
  EXPECT_EQ(gpu().pipelines().pipeline_count(), pipelines);
}

}  // namespace
}  // namespace alcove::passes
