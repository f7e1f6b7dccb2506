// Counts the pipelines that are created by preparing and recording frames, and checks from which
// pipeline cache they come.
#include <gmock/gmock.h>

#include <cstring>
#include <set>

#include "c_interface_fixture.h"
#include "gtao_scenes.h"

namespace alcove::passes {
namespace {

// Number of pipelines created since the test began, and the pipeline caches that they were created
// with.
std::uint32_t pipelines = 0;
std::set<VkPipelineCache> caches;

VKAPI_ATTR VkResult VKAPI_CALL create_pipelines(VkDevice device, VkPipelineCache cache,
                                                std::uint32_t count,
                                                const VkComputePipelineCreateInfo* infos,
                                                const VkAllocationCallbacks* callbacks,
                                                VkPipeline* made) {
  pipelines += count;
  caches.insert(cache);
  return vkCreateComputePipelines(device, cache, count, infos, callbacks, made);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_device_proc_addr(VkDevice device, const char* name) {
  return std::strcmp(name, "vkCreateComputePipelines") == 0
             ? reinterpret_cast<PFN_vkVoidFunction>(&create_pipelines)
             : vkGetDeviceProcAddr(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_instance_proc_addr(VkInstance instance,
                                                                const char* name) {
  return std::strcmp(name, "vkGetDeviceProcAddr") == 0
             ? reinterpret_cast<PFN_vkVoidFunction>(&get_device_proc_addr)
             : vkGetInstanceProcAddr(instance, name);
}

class CPipelines : public CInterface {
 protected:
  void SetUp() override {
    CInterface::SetUp();
    pipelines = 0;
    caches.clear();
  }

  // Creates a context whose calls of vkCreateComputePipelines are counted.
  Context create_counted(VkPipelineCache cache = VK_NULL_HANDLE) {
    AlcoveContextInfo info = engine().context_info();
    info.get_instance_proc_addr = get_instance_proc_addr;
    info.pipeline_cache = cache;
    AlcoveContext* made = nullptr;
    char message[ALCOVE_MAX_MESSAGE];
    EXPECT_EQ(alcoveCreateContext(&info, &made, message), ALCOVE_SUCCESS) << message;
    return Context(made);
  }

  void prepare(AlcoveContext& context, const AlcoveView& view) {
    const AlcoveFrame frame{.struct_size = sizeof frame, .view_count = 1, .views = &view};
    EXPECT_EQ(alcovePrepareFrame(&context, &frame), ALCOVE_SUCCESS) << alcoveGetMessage(&context);
  }

  // Records frames of every kind that a view has: its first frame, frames in motion, static frames,
  // a cut, motion again, a static camera with static_frames 0, a smaller size within largest_width
  // and largest_height, and a change of the largest size.
  void run_life(AlcoveContext& context, AlcoveView view) {
    std::uint32_t index = 0;
    const auto run_at = [&](float x) {
      view.previous_camera = view.camera;
      view.camera.view_from_world[12] = x;
      run_frame(context, {&view, 1}, index++);
      view.reset_history = VK_FALSE;
    };
    run_at(0.0f);
    run_at(0.1f);
    for (view.static_frames = 1; view.static_frames <= 20; ++view.static_frames) run_at(0.1f);
    view.static_frames = 0;
    view.reset_history = VK_TRUE;
    run_at(0.5f);
    run_at(0.6f);
    run_at(0.6f);
    view.previous_width = view.depth.width;
    view.previous_height = view.depth.height;
    for (AlcoveImage* image : {&view.depth, &view.normals, &view.motion, &view.roughness,
                               &view.back_depth, &view.second_depth, &view.albedo, &view.visibility,
                               &view.bent_normal, &view.specular, &view.multi_bounce})
      image->height -= 2;
    run_at(0.6f);
    view.largest_height = view.previous_height = view.depth.height;
    run_at(0.7f);
    engine().wait();
  }
};

TEST_F(CPipelines, PipelinesAreCreatedWithTheEnginesPipelineCacheWhichIsNotDestroyed) {
  GivenView given = given_view(test_views()[2], 16, 12, groove(0.8));
  (void)run_by_c(*create_counted(), {&given, 1}, 0);
  EXPECT_THAT(caches, testing::ElementsAre(VkPipelineCache{VK_NULL_HANDLE})) << "by default";

  const VkDevice device = gpu().device().device();
  const VkPipelineCacheCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
  VkPipelineCache cache = VK_NULL_HANDLE;
  ASSERT_EQ(vkCreatePipelineCache(device, &info, nullptr, &cache), VK_SUCCESS);
  caches.clear();
  (void)run_by_c(*create_counted(cache), {&given, 1}, 0);
  EXPECT_THAT(caches, testing::ElementsAre(cache));
  std::size_t size = 0;
  EXPECT_EQ(vkGetPipelineCacheData(device, cache, &size, nullptr), VK_SUCCESS);
  vkDestroyPipelineCache(device, cache, nullptr);
}

// The number of pipelines that alcovePrepareFrame creates equals the number that recording creates
// for a view that was not prepared. Recording a prepared view creates none.
TEST_F(CPipelines, PreparingAFrameCreatesAllPipelinesThatItsViewsEverNeed) {
  struct Case {
    const char* name;
    void (*change)(GivenView&);
  };
  const Case cases[] = {
      {"normals and motion", [](GivenView&) {}},
      {"depth alone", [](GivenView& g) { g.normals = g.motion = {}; }},
      {"low, every output by slices",
       [](GivenView& g) {
         g.settings = quality_settings(Quality::low, 0.4f);
         g.settings.bent_normal = true;
         g.settings.specular = Specular::slices;
         g.multi_bounce = true;
       }},
      {"hidden depths and the table",
       [](GivenView& g) {
         g.settings.advanced.thickness_unit = ThicknessUnit::back_faces;
         g.settings.depth_layers = 2;
         g.settings.specular = Specular::table;
       }},
      {"orthographic and clamped",
       [](GivenView& g) {
         g.view = g.previous_view = orthographic_view("", 3.0, 2.0, 0.1, 20.0).view;
         g.settings.advanced.clamp_width = 1.0f;
         g.motion = {};
       }},
      {"without a history", [](GivenView& g) { g.settings.history_frames = 0; }},
  };
  for (const Case& each : cases) {
    SCOPED_TRACE(each.name);
    GivenView given = given_view(test_views()[2], 16, 12, ball_on_floor());
    given.largest_size = {16, 12};
    each.change(given);
    AlcoveSettings settings;
    AlcoveView view = view_of(given, settings);
    pipelines = 0;
    run_life(*create_counted(), view);
    const std::uint32_t needed = pipelines;
    // A moving and a static frame prepare the same pipelines.
    for (const std::uint32_t static_frames : {0u, 20u}) {
      const Context context = create_counted();
      view.static_frames = static_frames;
      pipelines = 0;
      prepare(*context, view);
      EXPECT_EQ(pipelines, needed);
      run_life(*context, view);
      EXPECT_EQ(pipelines, needed);
    }
  }
}

TEST_F(CPipelines, PreparingAFrameDoesNotAffectRecordedFrames) {
  const Context context = create_counted();
  for (std::uint32_t i = 0; i < 4; ++i) {
    GivenView given = given_view(test_views()[2], 33, 17, ball_on_floor());
    given.settings.bent_normal = true;
    given.static_frames = i;
    GivenView other = given_view(test_views()[2], 16, 12, ball_on_floor());
    other.reset = i % 2 == 0;
    AlcoveSettings settings;
    prepare(*context, view_of(other, settings));
    expect_same_both_ways(*context, {&given, 1}, i);
    const std::string plan = plan_of(*context);
    const VkDeviceSize transients = memory_of(*context).transients;
    prepare(*context, view_of(other, settings));
    EXPECT_EQ(plan_of(*context), plan);
    EXPECT_EQ(memory_of(*context).transients, transients);
  }
}

}  // namespace
}  // namespace alcove::passes
