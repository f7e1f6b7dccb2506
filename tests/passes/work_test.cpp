// Tests the list of work: that a backend of its own executes it with the results of the library,
// and what the list says. The latter needs no device.
#include "alcove/alcove_work.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <map>

#include "c_interface_fixture.h"
#include "work_executor.h"

namespace alcove::passes {
namespace {

using testing::HasSubstr;

AlcoveWorkInfo info_of(const AlcoveView& view, std::uint32_t index, const AlcoveWork* previous) {
  const auto image = [](const AlcoveImage& of) {
    return AlcoveWorkImage{static_cast<std::uint32_t>(of.format), of.width, of.height};
  };
  return {.struct_size = sizeof(AlcoveWorkInfo),
          .settings = view.settings,
          .camera = view.camera,
          .previous = view.reset_history != VK_FALSE ? nullptr : previous,
          .index = index,
          .static_frames = view.static_frames,
          .largest_width = view.largest_width,
          .largest_height = view.largest_height,
          .normals_in_view_space = view.normals_in_view_space,
          .normal_encoding = view.normal_encoding,
          .normals_forward_z = view.normals_forward_z,
          .read_area = view.read_area,
          .written_area = view.written_area,
          .output_x = view.output_x,
          .output_y = view.output_y,
          .depth = image(view.depth),
          .depth_format = static_cast<std::uint32_t>(view.depth_format),
          .normals = image(view.normals),
          .motion = image(view.motion),
          .roughness = image(view.roughness),
          .back_depth = image(view.back_depth),
          .second_depth = image(view.second_depth),
          .albedo = image(view.albedo),
          .mask = image(view.mask),
          .not_receiving = view.not_receiving,
          .not_occluding = view.not_occluding,
          .visibility = image(view.visibility),
          .bent_normal = image(view.bent_normal),
          .specular = image(view.specular),
          .multi_bounce = image(view.multi_bounce)};
}

// A setting of the comparison.
struct Case {
  const char* name;
  Quality quality;
  void (*change)(HostView& view) = [](HostView&) {};
  bool area_and_mask = false;
};

void PrintTo(const Case& of, std::ostream* out) { *out << of.name; }

class WorkExecution : public CInterface, public testing::WithParamInterface<Case> {
 protected:
  // Executes the list of `view` with outputs of its own.
  Results execute(AlcoveView view, std::uint32_t index) {
    for (const Output& each : kOutputs) {
      AlcoveImage& image = view.*each.image;
      if (image.image != VK_NULL_HANDLE) image = output(image.format, image.width, image.height);
    }
    const AlcoveWorkInfo info = info_of(view, index, index > 0 ? work_.get() : nullptr);
    char message[ALCOVE_MAX_MESSAGE];
    EXPECT_EQ(alcoveDescribeWork(&info, work_.get(), message), ALCOVE_SUCCESS) << message;
    std::vector<VkImage> host;
    for_each_image(view, [&](const AlcoveImage& image) {
      if (image.image != VK_NULL_HANDLE) host.push_back(image.image);
    });
    engine().submit(0,
                    [&](VkCommandBuffer commands) { executor_->record(commands, *work_, host); });
    engine().wait();
    return read_results(view);
  }

  // A mask with all values, in columns.
  AlcoveImage create_mask() {
    const AlcoveImage image = engine().make_image(
        VK_FORMAT_R8_UNORM, 37, 26, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    Bytes bytes(37 * 26);
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i % 37 / 10);
    write_bytes(image, bytes);
    return image;
  }

  void SetUp() override {
    CInterface::SetUp();
    executor_ =
        std::make_unique<WorkExecutor>(gpu().device().physical_device(), gpu().device().device());
  }
  void TearDown() override {
    executor_.reset();
    CInterface::TearDown();
  }

  std::unique_ptr<AlcoveWork> work_ = std::make_unique<AlcoveWork>();
  std::unique_ptr<WorkExecutor> executor_;
};

TEST_P(WorkExecution, BackendOfItsOwnMakesTheImagesOfTheLibrary) {
  HostView from = draw_view(37, 26, groove(0.8));
  const OcclusionSettings defaults = from.settings;
  from.settings = quality_settings(GetParam().quality, 0.5f);
  from.settings.roughness_channel = defaults.roughness_channel;
  GetParam().change(from);
  // A first frame, frames in motion, and frames without motion up to a converged one.
  for (std::uint32_t index = 0; index < 5; ++index) {
    SCOPED_TRACE("frame " + std::to_string(index));
    from.previous_view = from.view;
    if (index == 1 || index == 2) from.view.view_from_world[12] += 0.03f;
    from.static_frames = index < 3 ? 0 : index == 3 ? 1 : 16;
    AlcoveView view = create_view(from);
    if (GetParam().area_and_mask) {
      view.read_area = {0, 0, view.depth.width, view.depth.height};
      view.mask = create_mask();
      view.not_receiving = 1;
      view.not_occluding = 2;
    }
    const Results expected = run_view(view, index);
    expect_equal(execute(view, index), expected);
    EXPECT_EQ(work_->history_valid, index > 0 && from.settings.history_frames > 0 ? 1u : 0u);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Settings, WorkExecution,
    testing::Values(Case{"Console", Quality::console, request_all_outputs},
                    Case{"Low", Quality::low, request_all_outputs},
                    Case{"Medium", Quality::medium, request_all_outputs},
                    Case{"High", Quality::high, request_all_outputs},
                    Case{"Ultra", Quality::ultra, request_all_outputs},
                    Case{"Reference", Quality::reference, request_all_outputs},
                    Case{"VisibilityAlone", Quality::medium},
                    Case{"ConsoleVisibilityAlone", Quality::console},
                    Case{"DepthCopiedFrom16Bits", Quality::medium,
                         [](HostView& view) { view.depth_format = VK_FORMAT_D16_UNORM; }},
                    Case{"BentNormalAlone", Quality::medium,
                         [](HostView& view) {
                           view.settings.visibility = false;
                           view.settings.bent_normal = true;
                         }},
                    Case{"MultiBounceAlone", Quality::low,
                         [](HostView& view) {
                           view.settings.visibility = false;
                           view.multi_bounce = true;
                         }},
                    Case{"SpecularByTableWithoutNormals", Quality::medium,
                         [](HostView& view) {
                           view.settings.specular = Specular::table;
                           view.normals = {};
                         }},
                    Case{"SpecularByConeAtHalfResolution", Quality::low,
                         [](HostView& view) {
                           view.settings.specular = Specular::table;
                           view.settings.half_resolution = true;
                         }},
                    Case{"TwoDepthLayers", Quality::high,
                         [](HostView& view) {
                           request_all_outputs(view);
                           view.settings.depth_layers = 2;
                           view.motion = {};
                         }},
                    Case{"AreaAndMask", Quality::medium, request_all_outputs, true},
                    Case{"HalfResolutionAreaAndMask", Quality::console, request_all_outputs, true},
                    Case{"HalfResolutionWithoutHistory", Quality::low,
                         [](HostView& view) {
                           request_all_outputs(view);
                           view.settings.half_resolution = true;
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
    info_.settings = &settings_;
    std::ranges::copy(test_views()[2].view.clip_from_view, info_.camera.clip_from_view);
    std::ranges::copy(kIdentity, info_.camera.view_from_world);
  }
  Description describe() const {
    Description made;
    char message[ALCOVE_MAX_MESSAGE];
    made.result = alcoveDescribeWork(&info_, made.work.get(), message);
    made.message = message;
    return made;
  }

  AlcoveSettings settings_{.struct_size = sizeof(AlcoveSettings)};
  AlcoveWorkInfo info_{.struct_size = sizeof(AlcoveWorkInfo),
                       .depth = {VK_FORMAT_D32_SFLOAT, 64, 48},
                       .normals = {VK_FORMAT_R16G16B16A16_SFLOAT, 64, 48},
                       .visibility = {VK_FORMAT_R8_UNORM, 64, 48}};
};

TEST_F(WorkOfView, TransientsLiveFromTheDispatchThatWritesThemToTheLastThatReadsThem) {
  const Description made = describe();
  ASSERT_EQ(made.result, ALCOVE_SUCCESS) << made.message;
  ASSERT_EQ(made.work->dispatch_count, 2u);
  const AlcoveWorkResource* const raw = std::ranges::find(
      made.work->resources, std::string_view("raw occlusion"), &AlcoveWorkResource::name);
  EXPECT_EQ(raw->kind, ALCOVE_RESOURCE_KIND_TRANSIENT);
  EXPECT_EQ(raw->first_dispatch, 0u);
  EXPECT_EQ(raw->last_dispatch, 1u);
  EXPECT_EQ(raw->size, 16u * 12u * 8u);
  EXPECT_EQ(made.work->dispatches[0].groups[0], 2u);
}

TEST_F(WorkOfView, HistoryContinuesOnlyFromAListWithTheSameHistories) {
  const Description first = describe();
  EXPECT_EQ(first.work->history_valid, 0u);
  info_.previous = first.work.get();
  EXPECT_EQ(describe().work->history_valid, 1u);
  info_.bent_normal = {VK_FORMAT_R8G8B8A8_SNORM, 64, 48};
  EXPECT_EQ(describe().work->history_valid, 0u) << "the bent normals have no history yet";
  info_.bent_normal = {};
  for (AlcoveWorkImage* image : {&info_.depth, &info_.normals, &info_.visibility})
    image->width = 60;
  info_.largest_width = 64;
  info_.largest_height = 48;
  EXPECT_EQ(describe().work->history_valid, 1u) << "the largest size is that of the list";
  info_.largest_width = info_.largest_height = 0;
  EXPECT_NE(describe().result, ALCOVE_SUCCESS) << "the previous size is above the largest";
}

TEST_F(WorkOfView, EveryBindingHasAResourceOfItsTypeAndEveryResourceItsLifetime) {
  info_.specular = info_.visibility;
  settings_.specular = ALCOVE_SPECULAR_TABLE;
  const Description made = describe();
  ASSERT_EQ(made.result, ALCOVE_SUCCESS) << made.message;
  const AlcoveWork& work = *made.work;
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
    const auto chosen = [&](std::uint32_t bit, VkFormat format) {
      return (choice & bit) != 0 ? AlcoveWorkImage{format, 64, 48} : AlcoveWorkImage{};
    };
    info_.visibility = chosen(1, VK_FORMAT_R8_UNORM);
    info_.bent_normal = chosen(2, VK_FORMAT_R8G8B8A8_SNORM);
    info_.specular = chosen(4, VK_FORMAT_R8_UNORM);
    settings_.half_resolution = choice & 8;
    settings_.history_frames = (choice & 16) != 0 ? 32 : 0;
    const Description made = describe();
    if ((choice & 7) == 0) continue;  // a view without an output is an error
    ASSERT_EQ(made.result, ALCOVE_SUCCESS) << made.message;
    for (const AlcoveWorkDispatch& dispatch :
         std::span(made.work->dispatches).first(made.work->dispatch_count)) {
      SCOPED_TRACE(testing::Message() << dispatch.label << ", choice " << choice);
      std::map<std::uint32_t, std::uint32_t> bindings;  // of each resource
      std::uint32_t written = 0;
      const auto all = std::span(dispatch.bindings).first(dispatch.binding_count);
      for (const AlcoveWorkBinding& binding : all) ++bindings[binding.resource];
      for (const AlcoveWorkBinding& binding : all) {
        if (binding.type != ALCOVE_BINDING_TYPE_STORAGE_IMAGE) continue;
        EXPECT_EQ(bindings[binding.resource], 1u) << binding.name;
        ++written;
      }
      if ((choice & 7) == 1) {
        EXPECT_LE(written, 4u);
      }
    }
  }
}

TEST_F(WorkOfView, InvalidInputIsASentence) {
  info_.depth.format = 0;
  EXPECT_THAT(describe().message, HasSubstr("no image of depth"));
  info_.depth = {VK_FORMAT_R8G8B8A8_UNORM, 64, 48};
  EXPECT_THAT(describe().message, HasSubstr("the image of depth has the format"));
  info_.depth = {VK_FORMAT_D32_SFLOAT, 63, 48};
  EXPECT_THAT(describe().message, HasSubstr("make them equal"));
  info_.depth = {VK_FORMAT_D32_SFLOAT, 64, 48};
  info_.camera.clip_from_view[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(describe().message, HasSubstr("The view"));
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
  const Description made = describe();
  std::string text(alcovePrintWork(made.work.get(), nullptr, 0) + 1, '\0');
  alcovePrintWork(made.work.get(), text.data(), text.size());
  EXPECT_THAT(text, HasSubstr("raw occlusion: transient, VK_FORMAT_R32G32_UINT, 16x12"));
  EXPECT_THAT(text, HasSubstr("0 gtao: shader gtao, 2x2x1 groups"));
  EXPECT_THAT(text, HasSubstr("kSliceCount=2"));
  EXPECT_THAT(text, HasSubstr("visibility history: 5 becomes 4 of the next frame"));
  EXPECT_EQ(alcovePrintWork(nullptr, nullptr, 0), 0u);
}

}  // namespace
}  // namespace alcove::passes
