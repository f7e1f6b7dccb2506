// Tests the list of work: that a backend of its own executes it with the results of the library,
// and what the list says. The latter needs no device.
#include "alcove/alcove_work.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <utility>

#include "c_interface_fixture.h"
#include "work_executor.h"

namespace alcove::passes {
namespace {

using testing::HasSubstr;

class WorkExecution : public CInterface, public testing::WithParamInterface<PresetCase> {
 protected:
  // Executes the list of `view` with outputs of its own.
  HostOutputs execute(AlcoveView view, std::uint32_t index) {
    for (const OutputMember& each : kOutputs) {
      AlcoveImage& image = view.images[each.role];
      if (image.image != VK_NULL_HANDLE) image = output(image.format, image.width, image.height);
    }
    const AlcoveWorkInfo info = work_info(view, index, index > 0 ? work_.get() : nullptr);
    char message[ALCOVE_MAX_MESSAGE];
    EXPECT_EQ(alcoveDescribeWork(&info, work_.get(), message), ALCOVE_SUCCESS) << message;
    std::vector<VkImage> host;
    for (const AlcoveImage& image : view.images)
      if (image.image != VK_NULL_HANDLE) host.push_back(image.image);
    engine().submit(0,
                    [&](VkCommandBuffer commands) { executor_->record(commands, *work_, host); });
    engine().wait();
    return read_results(view);
  }

  // A mask with all values, in columns.
  AlcoveImage create_mask() {
    Bytes bytes(37UL * 26);
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i % 37 / 10);
    return engine().make_filled(VK_FORMAT_R8_UNORM, 37, 26, bytes);
  }

  void SetUp() override {
    CInterface::SetUp();
    executor_ = std::make_unique<WorkExecutor>(engine());
  }
  void TearDown() override {
    executor_.reset();
    CInterface::TearDown();
  }

  std::unique_ptr<AlcoveWork> work_ = std::make_unique<AlcoveWork>();
  std::unique_ptr<WorkExecutor> executor_;
};

TEST_P(WorkExecution, BackendOfItsOwnMakesTheImagesOfTheLibrary) {
  HostView from = draw_view(37, 26, groove(0.8), 0.5f, GetParam());
  for (std::uint32_t index = 0; index < kSeriesFrames; ++index) {
    SCOPED_TRACE("frame " + std::to_string(index));
    advance(from, index);
    AlcoveView view = create_view(from);
    if (GetParam().area_and_mask) {
      const AlcoveImage& depth = view.images[ALCOVE_IMAGE_DEPTH];
      view.info.read_area = {0, 0, depth.width, depth.height};
      view.images[ALCOVE_IMAGE_MASK] = create_mask();
      view.info.not_receiving = 1;
      view.info.not_occluding = 2;
    }
    const HostOutputs expected = run_view(view, index);
    expect_equal(execute(view, index), expected);
    EXPECT_EQ(work_->history_valid, index > 0 && from.settings.history_frames > 0 ? 1u : 0u);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Settings, WorkExecution,
    testing::Values(PresetCase{"Console", ALCOVE_QUALITY_CONSOLE, request_all_outputs},
                    PresetCase{"Low", ALCOVE_QUALITY_LOW, request_all_outputs},
                    PresetCase{"Medium", ALCOVE_QUALITY_MEDIUM, request_all_outputs},
                    PresetCase{"High", ALCOVE_QUALITY_HIGH, request_all_outputs},
                    PresetCase{"Ultra", ALCOVE_QUALITY_ULTRA, request_all_outputs},
                    PresetCase{"HeightField", ALCOVE_QUALITY_HEIGHT_FIELD, request_all_outputs},
                    PresetCase{"VisibilityAlone", ALCOVE_QUALITY_MEDIUM},
                    PresetCase{"ConsoleVisibilityAlone", ALCOVE_QUALITY_CONSOLE},
                    PresetCase{"DepthCopiedFrom16Bits", ALCOVE_QUALITY_MEDIUM,
                               [](HostView& view) { view.depth_format = VK_FORMAT_D16_UNORM; }},
                    PresetCase{"BentNormalAlone", ALCOVE_QUALITY_MEDIUM,
                               [](HostView& view) {
                                 view.settings.visibility = false;
                                 view.settings.bent_normal = true;
                               }},
                    PresetCase{"MultiBounceAlone", ALCOVE_QUALITY_LOW,
                               [](HostView& view) {
                                 view.settings.visibility = false;
                                 view.multi_bounce = true;
                               }},
                    PresetCase{"SpecularByTableWithoutNormals", ALCOVE_QUALITY_MEDIUM,
                               [](HostView& view) {
                                 view.settings.specular = ALCOVE_SPECULAR_TABLE;
                                 view.normals = {};
                               }},
                    PresetCase{"SpecularByTableAtHalfResolution", ALCOVE_QUALITY_LOW,
                               [](HostView& view) {
                                 view.settings.specular = ALCOVE_SPECULAR_TABLE;
                                 view.settings.half_resolution = 1;
                               }},
                    PresetCase{"TwoDepthLayers", ALCOVE_QUALITY_HIGH,
                               [](HostView& view) {
                                 request_all_outputs(view);
                                 view.settings.depth_layers = 2;
                                 view.motion = {};
                               }},
                    PresetCase{"AreaAndMask", ALCOVE_QUALITY_MEDIUM, request_all_outputs, true},
                    PresetCase{"HalfResolutionAreaAndMask", ALCOVE_QUALITY_CONSOLE,
                               request_all_outputs, true},
                    PresetCase{"HalfResolutionWithoutHistory", ALCOVE_QUALITY_LOW,
                               [](HostView& view) {
                                 request_all_outputs(view);
                                 view.settings.half_resolution = 1;
                                 view.settings.history_frames = 0;
                               }}),
    [](const auto& of) { return std::string(of.param.name); });

// The list of a frame of 64x48 pixels with a depth image and visibility.
struct Description {
  AlcoveResult result = ALCOVE_SUCCESS;
  std::string message;
  std::unique_ptr<AlcoveWork> work = std::make_unique<AlcoveWork>();
};

class WorkOfView : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(alcoveGetSettings(ALCOVE_QUALITY_MEDIUM, 0.5f, &settings_), ALCOVE_SUCCESS);
    info_.view.settings = &settings_;
    info_.view.camera = test_views()[2].view;
    image(ALCOVE_IMAGE_DEPTH) = {VK_FORMAT_D32_SFLOAT, 64, 48};
    image(ALCOVE_IMAGE_NORMALS) = {VK_FORMAT_R16G16B16A16_SFLOAT, 64, 48};
    image(ALCOVE_IMAGE_VISIBILITY) = {VK_FORMAT_R8_UNORM, 64, 48};
  }
  Description describe() const {
    Description description;
    char message[ALCOVE_MAX_MESSAGE];
    description.result = alcoveDescribeWork(&info_, description.work.get(), message);
    description.message = message;
    return description;
  }

  AlcoveSettings settings_{.struct_size = sizeof(AlcoveSettings)};
  AlcoveWorkImage& image(AlcoveImageRole role) { return info_.images[role]; }

  AlcoveWorkInfo info_{.struct_size = sizeof(AlcoveWorkInfo)};
};

TEST_F(WorkOfView, TransientsLiveFromTheDispatchThatWritesThemToTheLastThatReadsThem) {
  const Description description = describe();
  ASSERT_EQ(description.result, ALCOVE_SUCCESS) << description.message;
  ASSERT_EQ(description.work->dispatch_count, 2u);
  const AlcoveWorkResource* const raw = std::ranges::find(
      description.work->resources, std::string_view("raw occlusion"), &AlcoveWorkResource::name);
  EXPECT_EQ(raw->kind, ALCOVE_RESOURCE_KIND_TRANSIENT);
  EXPECT_EQ(raw->first_dispatch, 0u);
  EXPECT_EQ(raw->last_dispatch, 1u);
  EXPECT_EQ(raw->size, 16u * 12u * 8u);
  EXPECT_EQ(description.work->dispatches[0].groups[0], 2u);
}

TEST_F(WorkOfView, LargestTilesSearchACopyOfEverySecondPixelOfDepth) {
  const auto search_image_of = [&](std::uint32_t tile_size) -> std::string_view {
    settings_.tile_size = tile_size;
    const Description description = describe();
    EXPECT_EQ(description.result, ALCOVE_SUCCESS) << description.message;
    const AlcoveWorkDispatch& search =
        description.work->dispatches[description.work->dispatch_count - 2];
    EXPECT_STREQ(search.label, "gtao");
    const AlcoveWorkBinding* const image = std::ranges::find(
        search.bindings, std::string_view("search_image"), &AlcoveWorkBinding::name);
    return description.work->resources[image->resource].name;
  };
  EXPECT_EQ(search_image_of(8), "half depth");
  EXPECT_EQ(search_image_of(4), "depth");
  settings_.thickness_limit = ALCOVE_THICKNESS_LIMIT_BACK_FACES;
  image(ALCOVE_IMAGE_BACK_DEPTH) = image(ALCOVE_IMAGE_DEPTH);
  EXPECT_EQ(search_image_of(8), "depth");
}

TEST_F(WorkOfView, HistoryContinuesOnlyFromAListWithTheSameHistories) {
  const Description first = describe();
  EXPECT_EQ(first.work->history_valid, 0u);
  info_.previous = first.work.get();
  EXPECT_EQ(describe().work->history_valid, 1u);
  image(ALCOVE_IMAGE_BENT_NORMAL) = {VK_FORMAT_R8G8B8A8_SNORM, 64, 48};
  EXPECT_EQ(describe().work->history_valid, 0u) << "the bent normals have no history yet";
  image(ALCOVE_IMAGE_BENT_NORMAL) = {};
  for (AlcoveWorkImage& image : info_.images) image.width = std::min(image.width, 60u);
  info_.view.largest_width = 64;
  info_.view.largest_height = 48;
  EXPECT_EQ(describe().work->history_valid, 1u) << "the largest size is that of the list";
  info_.view.largest_width = info_.view.largest_height = 0;
  EXPECT_EQ(describe().result, ALCOVE_SUCCESS) << "a window was made smaller";
  EXPECT_EQ(describe().work->history_valid, 0u);
}

TEST_F(WorkOfView, ListThatWasNeverFilledIsRefusedAsThePreviousOne) {
  const auto previous = std::make_unique<AlcoveWork>();
  previous->history_count = 1;
  previous->histories[0].current = 1000000;
  info_.previous = previous.get();
  EXPECT_THAT(describe().message, HasSubstr("not a list that alcoveDescribeWork has filled"));
}

// Describes first, moving, static and converged frames, with the histories of the list before and
// without.
TEST_F(WorkOfView, EveryPipelineOfEveryFrameIsListed) {
  const auto is_listed = [&](const AlcoveWorkDispatch& dispatch) {
    std::array<AlcoveWorkPipeline, ALCOVE_MAX_WORK_PIPELINES> pipelines{};
    std::uint32_t count = pipelines.size();
    EXPECT_EQ(alcoveListPipelines(&info_, &count, pipelines.data(), nullptr), ALCOVE_SUCCESS);
    return std::any_of(pipelines.begin(), pipelines.begin() + count, [&](const auto& pipeline) {
      return std::string_view(pipeline.shader) == dispatch.shader &&
             std::ranges::equal(std::span(pipeline.constants).first(pipeline.constant_count),
                                std::span(dispatch.constants).first(dispatch.constant_count), {},
                                &AlcoveWorkConstant::value, &AlcoveWorkConstant::value);
    });
  };
  const auto with_all_images = [&] {
    for (const auto& [role, format] : {std::pair{ALCOVE_IMAGE_MOTION, VK_FORMAT_R16G16_SFLOAT},
                                       {ALCOVE_IMAGE_ALBEDO, VK_FORMAT_R8G8B8A8_UNORM},
                                       {ALCOVE_IMAGE_MASK, VK_FORMAT_R8_UINT},
                                       {ALCOVE_IMAGE_BENT_NORMAL, VK_FORMAT_R8G8B8A8_SNORM},
                                       {ALCOVE_IMAGE_SPECULAR, VK_FORMAT_R8_UNORM},
                                       {ALCOVE_IMAGE_MULTI_BOUNCE, VK_FORMAT_R8G8B8A8_UNORM}})
      image(role) = {static_cast<std::uint32_t>(format), 64, 48};
    image(ALCOVE_IMAGE_DEPTH).samples = 4;
    info_.view.not_receiving = 1;
  };
  for (const bool all : {false, true}) {
    if (all) with_all_images();
    for (const AlcoveQuality quality : {ALCOVE_QUALITY_CONSOLE, ALCOVE_QUALITY_MEDIUM}) {
      settings_ = get_settings(quality, 0.5f);
      for (const AlcoveSpecular specular : {ALCOVE_SPECULAR_SLICES, ALCOVE_SPECULAR_TABLE}) {
        settings_.specular = specular;
        info_.previous = nullptr;
        Description before, last = describe();
        for (std::uint32_t frame = 0; frame < 24; ++frame) {
          SCOPED_TRACE(frame);
          ASSERT_EQ(last.result, ALCOVE_SUCCESS) << last.message;
          for (std::uint32_t i = 0; i < last.work->dispatch_count; ++i)
            EXPECT_TRUE(is_listed(last.work->dispatches[i])) << last.work->dispatches[i].label;
          info_.previous = frame == 5 ? nullptr : last.work.get();
          info_.view.static_frames = frame < 6 ? 0 : frame - 5;
          if (frame < 3) info_.view.camera.view_from_world[12] += 0.1f;
          Description next = describe();
          before = std::exchange(last, std::move(next));  // info_.previous may be its list
        }
      }
    }
  }
}

TEST_F(WorkOfView, EveryBindingHasAResourceOfItsTypeAndEveryResourceItsLifetime) {
  image(ALCOVE_IMAGE_SPECULAR) = image(ALCOVE_IMAGE_VISIBILITY);
  settings_.specular = ALCOVE_SPECULAR_TABLE;
  const Description description = describe();
  ASSERT_EQ(description.result, ALCOVE_SUCCESS) << description.message;
  const AlcoveWork& work = *description.work;
  for (std::uint32_t i = 0; i < work.dispatch_count; ++i) {
    for (std::uint32_t b = 0; b < work.dispatches[i].binding_count; ++b) {
      const AlcoveWorkBinding& binding = work.dispatches[i].bindings[b];
      if (binding.type == ALCOVE_BINDING_TYPE_PARAMETERS ||
          binding.type == ALCOVE_BINDING_TYPE_SAMPLER)
        continue;
      ASSERT_LT(binding.resource, work.resource_count);
      const AlcoveWorkResource& resource = work.resources[binding.resource];
      EXPECT_EQ(binding.type == ALCOVE_BINDING_TYPE_TABLE,
                resource.kind == ALCOVE_RESOURCE_KIND_TABLE);
      EXPECT_LE(resource.first_dispatch, i);
      EXPECT_GE(resource.last_dispatch, i);
      if ((binding.access & ALCOVE_WORK_ACCESS_WRITE) != 0) {
        EXPECT_NE(resource.kind, ALCOVE_RESOURCE_KIND_INPUT) << resource.name;
        EXPECT_NE(resource.kind, ALCOVE_RESOURCE_KIND_HISTORY_PREVIOUS);
      }
    }
  }
}

// WebGPU forbids to bind an image twice of which one binding is written, and guarantees 4 storage
// images.
TEST_F(WorkOfView, ImageThatADispatchWritesIsBoundOnceAndVisibilityNeedsAtMostFourStorageImages) {
  for (std::uint32_t choice = 0; choice < 32; ++choice) {
    const auto image_if = [&](std::uint32_t bit, VkFormat format) {
      return (choice & bit) != 0 ? AlcoveWorkImage{static_cast<std::uint32_t>(format), 64, 48}
                                 : AlcoveWorkImage{};
    };
    image(ALCOVE_IMAGE_VISIBILITY) = image_if(1, VK_FORMAT_R8_UNORM);
    image(ALCOVE_IMAGE_BENT_NORMAL) = image_if(2, VK_FORMAT_R8G8B8A8_SNORM);
    image(ALCOVE_IMAGE_SPECULAR) = image_if(4, VK_FORMAT_R8_UNORM);
    settings_.specular = ALCOVE_SPECULAR_SLICES;
    settings_.half_resolution = (choice & 8) != 0 ? 1 : 0;
    settings_.history_frames = (choice & 16) != 0 ? 32 : 0;
    const Description description = describe();
    if ((choice & 7) == 0) continue;  // a view without an output is an error
    ASSERT_EQ(description.result, ALCOVE_SUCCESS) << description.message;
    for (const AlcoveWorkDispatch& dispatch :
         std::span(description.work->dispatches).first(description.work->dispatch_count)) {
      SCOPED_TRACE(testing::Message() << dispatch.label << ", choice " << choice);
      std::map<std::uint32_t, std::uint32_t> bindings;  // of each resource
      std::uint32_t storage_images = 0;
      const auto all = std::span(dispatch.bindings).first(dispatch.binding_count);
      for (const AlcoveWorkBinding& binding : all) ++bindings[binding.resource];
      for (const AlcoveWorkBinding& binding : all) {
        if (binding.type != ALCOVE_BINDING_TYPE_STORAGE_IMAGE) continue;
        EXPECT_EQ(bindings[binding.resource], 1u) << binding.name;
        ++storage_images;
      }
      if ((choice & 7) == 1) {
        EXPECT_LE(storage_images, 4u);
      }
    }
  }
}

// c_refusals_test.cpp has the rules that a frame and a list share.
TEST_F(WorkOfView, InvalidInputIsASentence) {
  image(ALCOVE_IMAGE_DEPTH).format = 0;
  EXPECT_THAT(describe().message, HasSubstr("no image of depth"));
  info_.struct_size = 3;
  EXPECT_THAT(describe().message, HasSubstr("AlcoveWorkInfo::struct_size"));
  AlcoveWork work;
  EXPECT_EQ(alcoveDescribeWork(nullptr, &work, nullptr), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcoveDescribeWork(&info_, nullptr, nullptr), ALCOVE_ERROR_INVALID_INPUT);
  AlcoveShader shader;
  EXPECT_EQ(alcoveGetShader("none", &shader), ALCOVE_ERROR_INVALID_INPUT);
  EXPECT_EQ(alcoveGetShader(nullptr, &shader), ALCOVE_ERROR_INVALID_INPUT);
}

TEST_F(WorkOfView, PrintedListNamesResourcesShadersConstantsAndHistories) {
  const Description description = describe();
  const std::string text = print([&](char* buffer, std::size_t size) {
    return alcovePrintWork(description.work.get(), buffer, size);
  });
  EXPECT_THAT(text, HasSubstr("raw occlusion: transient, VK_FORMAT_R32G32_UINT, 16x12"));
  EXPECT_THAT(text, HasSubstr("0 gtao: shader gtao, 2x2x1 groups"));
  EXPECT_THAT(text, HasSubstr("kSliceCount=2"));
  EXPECT_THAT(text, HasSubstr("visibility history: 5 becomes 4 of the next frame"));
  EXPECT_EQ(alcovePrintWork(nullptr, nullptr, 0), 0u);
}

}  // namespace
}  // namespace alcove::passes
