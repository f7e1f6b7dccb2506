#include "c_interface_fixture.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "alcove/passes/multi_bounce.h"
#include "c/settings.h"

namespace alcove::passes {
namespace {

using framegraph::Graph;
using framegraph::Texture;

constexpr VkImageUsageFlags kInputUsage =
    VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
constexpr VkImageUsageFlags kOutputUsage =
    VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;

VkFormat format_of(std::uint32_t channels) {
  return channels == 1   ? VK_FORMAT_R32_SFLOAT
         : channels == 2 ? VK_FORMAT_R32G32_SFLOAT
                         : VK_FORMAT_R32G32B32A32_SFLOAT;
}

framegraph::State to_state(const AlcoveState& state) {
  return {state.stages, state.access, state.layout};
}

framegraph::ImportedTexture import_of(const AlcoveImage& image) {
  return {.image = image.image,
          .desc = {image.format, framegraph::Extent::absolute(image.width, image.height)},
          .usage = image.usage,
          .first_layer = image.layer,
          .initial_state = to_state(image.final_state),
          .final_state = to_state(image.final_state)};
}

HostImage uniform(std::uint32_t width, std::uint32_t height, std::vector<float> texel) {
  HostImage image{width, height, {}, static_cast<std::uint32_t>(texel.size())};
  for (std::size_t i = 0; i < std::size_t{width} * height; ++i)
    image.texels.insert(image.texels.end(), texel.begin(), texel.end());
  return image;
}

AlcoveCamera to_camera(const View& view) {
  AlcoveCamera camera;
  std::ranges::copy(view.clip_from_view, camera.clip_from_view);
  std::ranges::copy(view.view_from_world, camera.view_from_world);
  return camera;
}

}  // namespace

GivenView given_view(const TestView& view, std::uint32_t width, std::uint32_t height,
                     const Scene& scene) {
  const Drawing drawing = draw(view, width, height, scene);
  GivenView given{.view = view.view,
                  .depth_ndc = drawing.depth_ndc,
                  .normals = drawing.normal_vs,
                  .motion = uniform(width, height, {0.01f, -0.02f}),
                  .roughness = uniform(width, height, {0.3f, 0.6f}),
                  .back_depth_ndc = draw_back_faces(view, width, height, scene),
                  .second_depth_ndc = draw_second_layer(view, width, height, scene),
                  .albedo = uniform(width, height, {0.8f, 0.4f, 0.1f, 1.0f})};
  given.previous_view = given.view;
  given.settings = quality_settings(Quality::medium, 0.5f);
  given.settings.roughness_channel = 1;
  given.settings.precision = Precision::float32;
  return given;
}

HostImage placed_in(VkExtent2D larger, const HostImage& contents, std::uint32_t x,
                    std::uint32_t y) {
  HostImage around{larger.width, larger.height, {}, contents.channels};
  around.texels.resize(std::size_t{larger.width} * larger.height * contents.channels);
  for (std::size_t i = 0; i < around.texels.size(); ++i) {
    around.texels[i] =
        i / contents.channels % 3 == 0 ? std::numeric_limits<float>::quiet_NaN() : 0.3f;
  }
  place(around, contents, x, y);
  return around;
}

void place(HostImage& image, const HostImage& contents, std::uint32_t x, std::uint32_t y) {
  const std::size_t row = std::size_t{contents.width} * contents.channels;
  for (std::size_t i = 0; i < contents.height; ++i) {
    std::copy_n(contents.texels.begin() + static_cast<std::ptrdiff_t>(i * row), row,
                image.texels.begin() +
                    static_cast<std::ptrdiff_t>(((y + i) * image.width + x) * contents.channels));
  }
}

void CInterface::SetUp() {
  PassTest::SetUp();
  if (!HasFatalFailure()) engine_ = std::make_unique<Engine>(gpu().device());
}

void CInterface::TearDown() {
  engine_.reset();
  PassTest::TearDown();
}

Context CInterface::create_context() {
  AlcoveContextInfo info = engine_->context_info();
  info.debug_utils = VK_TRUE;
  AlcoveContext* made = nullptr;
  char message[ALCOVE_MAX_MESSAGE];
  EXPECT_EQ(alcoveCreateContext(&info, &made, message), ALCOVE_SUCCESS) << message;
  EXPECT_STREQ(message, "");
  return Context(made);
}

AlcoveImage CInterface::input(const HostImage& contents) {
  if (contents.texels.empty()) return {};
  const AlcoveImage image = engine_->make_image(format_of(contents.channels), contents.width,
                                                contents.height, kInputUsage);
  fill_image(image, contents, image.final_state);
  return image;
}

void CInterface::fill_image(const AlcoveImage& image, const HostImage& contents,
                            AlcoveState final_state) {
  run([&](Graph& graph) {
    framegraph::ImportedTexture import = import_of(image);
    import.final_state = to_state(final_state);
    fill(graph, graph.import_texture("image", import), contents);
  });
}

AlcoveImage CInterface::output(VkFormat format, std::uint32_t width, std::uint32_t height) {
  AlcoveImage image = engine_->make_image(format, width, height, kOutputUsage);
  image.initial_state.layout = VK_IMAGE_LAYOUT_UNDEFINED;
  return image;
}

HostImage CInterface::read(const AlcoveImage& image) {
  if (image.image == VK_NULL_HANDLE) return {};
  run([&](Graph& graph) { read_back(graph, graph.import_texture("image", import_of(image))); });
  return result();
}

AlcoveView CInterface::view_of(const GivenView& given, AlcoveSettings& settings) {
  settings = from_settings(given.settings, advanced_.emplace_back());
  AlcoveView view{.struct_size = sizeof(AlcoveView),
                  .id = given.id,
                  .reset_history = given.reset ? VK_TRUE : VK_FALSE,
                  .normals_in_view_space = given.normals_in_view_space ? VK_TRUE : VK_FALSE,
                  .static_frames = given.static_frames,
                  .settings = &settings,
                  .camera = to_camera(given.view),
                  .previous_camera = to_camera(given.previous_view),
                  .largest_width = given.largest_size.width,
                  .largest_height = given.largest_size.height,
                  .previous_width = given.previous_size.width,
                  .previous_height = given.previous_size.height,
                  .depth = input(given.depth_ndc),
                  .depth_format = given.depth_format,
                  .normals = input(given.normals),
                  .motion = input(given.motion),
                  .roughness = input(given.roughness),
                  .back_depth = input(given.back_depth_ndc),
                  .second_depth = input(given.second_depth_ndc),
                  .albedo = input(given.albedo)};
  const bool bytes = given.settings.precision == Precision::unorm8;
  const VkFormat scalar = bytes ? VK_FORMAT_R8_UNORM : VK_FORMAT_R32_SFLOAT;
  const VkFormat direction = bytes ? VK_FORMAT_R8G8B8A8_SNORM : VK_FORMAT_R32G32B32A32_SFLOAT;
  view.half_size_outputs = given.half_size_outputs ? VK_TRUE : VK_FALSE;
  const auto output_size = [&](std::uint32_t pixels) {
    return given.half_size_outputs ? (pixels + 1) / 2 : pixels;
  };
  const auto wanted = [&](bool is_wanted, VkFormat format) {
    return is_wanted ? output(format, output_size(given.depth_ndc.width),
                              output_size(given.depth_ndc.height))
                     : AlcoveImage{};
  };
  view.visibility = wanted(given.settings.visibility, scalar);
  view.bent_normal = wanted(given.settings.bent_normal, direction);
  view.specular = wanted(given.settings.specular != Specular::none, scalar);
  view.multi_bounce = wanted(given.multi_bounce, VK_FORMAT_R32G32B32A32_SFLOAT);
  return view;
}

void CInterface::run_frame(AlcoveContext& context, std::span<const AlcoveView> views,
                           std::uint32_t index) {
  const AlcoveFrame frame{.struct_size = sizeof(AlcoveFrame),
                          .index = index,
                          .slot = index % Engine::kSlots,
                          .view_count = static_cast<std::uint32_t>(views.size()),
                          .views = views.data()};
  engine_->submit(frame.slot, [&](VkCommandBuffer commands) {
    EXPECT_EQ(alcoveRecordFrame(&context, commands, &frame), ALCOVE_SUCCESS)
        << alcoveGetMessage(&context);
  });
}

void CInterface::record_and_throw_away(AlcoveContext& context, const AlcoveView& view,
                                       std::uint32_t index) {
  const AlcoveFrame frame{
      .struct_size = sizeof(AlcoveFrame), .index = index, .view_count = 1, .views = &view};
  engine_->submit(0, [&](VkCommandBuffer commands) {
    EXPECT_EQ(alcoveRecordFrame(&context, commands, &frame), ALCOVE_SUCCESS)
        << alcoveGetMessage(&context);
    throw_away(commands);
  });
}

Results CInterface::results_of(const AlcoveView& view) {
  return {read(view.visibility), read(view.bent_normal), read(view.specular),
          read(view.multi_bounce)};
}

std::vector<Results> CInterface::run_by_c(AlcoveContext& context, std::span<const GivenView> given,
                                          std::uint32_t index) {
  std::vector<AlcoveSettings> settings(given.size());
  std::vector<AlcoveView> views;
  views.reserve(given.size());
  for (std::size_t i = 0; i < given.size(); ++i) views.push_back(view_of(given[i], settings[i]));
  run_frame(context, views, index);
  std::vector<Results> results;
  results.reserve(views.size());
  for (const AlcoveView& view : views) results.push_back(results_of(view));
  engine_->wait();
  return results;
}

Results CInterface::run_by_cpp(const GivenView& given, std::uint32_t index) {
  const std::string name = "by C++ " + std::to_string(given.id);
  run([&](Graph& graph) {
    if (given.reset) graph.reset_history(name);
    const auto upload_of = [&](const HostImage& image) {
      return image.texels.empty() ? Texture{} : upload(graph, image);
    };
    const Frame frame{.graph = graph,
                      .kernels = gpu().kernels(),
                      .view = given.view,
                      .index = index,
                      .previous_view = given.previous_view,
                      .static_frames = given.reset ? 0 : given.static_frames,
                      .largest_size = given.largest_size,
                      .previous_size = given.reset ? VkExtent2D{} : given.previous_size};
    OcclusionSettings settings = given.settings;
    settings.visibility = settings.visibility || given.multi_bounce;
    const auto outputs =
        add_occlusion(frame,
                      {.depth_ndc = upload_of(given.depth_ndc),
                       .depth_format = given.depth_format,
                       .normals = upload_of(given.normals),
                       .normal_convention = {.in_view_space = given.normals_in_view_space},
                       .motion = upload_of(given.motion),
                       .roughness = upload_of(given.roughness),
                       .back_depth_ndc = upload_of(given.back_depth_ndc),
                       .second_depth_ndc = upload_of(given.second_depth_ndc),
                       .half_size_outputs = given.half_size_outputs},
                      settings, name);
    ASSERT_TRUE(outputs) << outputs.error().message;
    if (given.settings.visibility) read_back(graph, outputs->visibility);
    if (given.settings.bent_normal) read_back(graph, outputs->bent_normal);
    if (given.settings.specular != Specular::none) read_back(graph, outputs->specular);
    if (given.multi_bounce) {
      const auto made = add_multi_bounce(frame, {outputs->visibility, upload_of(given.albedo)},
                                         Precision::float32);
      ASSERT_TRUE(made) << made.error().message;
      read_back(graph, *made);
    }
  });
  std::size_t next = 0;
  const auto take = [&](bool wanted) { return wanted ? result(next++) : HostImage{}; };
  Results results;
  results.visibility = take(given.settings.visibility);
  results.bent_normal = take(given.settings.bent_normal);
  results.specular = take(given.settings.specular != Specular::none);
  results.multi_bounce = take(given.multi_bounce);
  return results;
}

void CInterface::expect_same_both_ways(AlcoveContext& context, std::span<const GivenView> views,
                                       std::uint32_t index) {
  const std::vector<Results> found = run_by_c(context, views, index);
  for (std::size_t i = 0; i < views.size(); ++i) {
    SCOPED_TRACE("view " + std::to_string(views[i].id));
    expect_equal(found[i], run_by_cpp(views[i], index));
  }
}

std::string CInterface::plan_of(AlcoveContext& context) {
  std::string text(alcovePrintPlan(&context, nullptr, 0) + 1, '\0');
  alcovePrintPlan(&context, text.data(), text.size());
  text.pop_back();
  return text;
}

AlcoveMemory CInterface::memory_of(AlcoveContext& context) {
  AlcoveMemory memory{.struct_size = sizeof(AlcoveMemory)};
  EXPECT_EQ(alcoveGetMemory(&context, &memory), ALCOVE_SUCCESS) << alcoveGetMessage(&context);
  return memory;
}

void expect_equal(const Results& found, const Results& expected) {
  EXPECT_EQ(found.visibility.texels, expected.visibility.texels);
  EXPECT_EQ(found.bent_normal.texels, expected.bent_normal.texels);
  EXPECT_EQ(found.specular.texels, expected.specular.texels);
  EXPECT_EQ(found.multi_bounce.texels, expected.multi_bounce.texels);
}

}  // namespace alcove::passes
