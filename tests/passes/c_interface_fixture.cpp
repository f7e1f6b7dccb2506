#include "c_interface_fixture.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "alcove/passes/setting_table.h"

namespace alcove::passes {
namespace {

constexpr VkImageUsageFlags kOutputUsage =
    VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;

}  // namespace

HostView draw_view(std::uint32_t width, std::uint32_t height, const Scene& scene,
                   const TestView& view) {
  const Drawing drawing = draw(view, width, height, scene);
  HostView host_view{.view = view.view,
                     .depth_ndc = drawing.depth_ndc,
                     .normals = drawing.normal_vs,
                     .motion = uniform(width, height, {0.01f, -0.02f}),
                     .roughness = uniform(width, height, {0.3f, 0.6f}),
                     .back_depth_ndc = draw_back_faces(view, width, height, scene),
                     .second_depth_ndc = draw_second_layer(view, width, height, scene),
                     .albedo = uniform(width, height, {0.8f, 0.4f, 0.1f, 1.0f})};
  host_view.previous_view = host_view.view;
  host_view.settings.roughness_channel = 1;
  host_view.settings.precision = ALCOVE_PRECISION_FLOAT32;
  return host_view;
}

HostView draw_view(std::uint32_t width, std::uint32_t height, const Scene& scene, float radius,
                   const PresetCase& preset) {
  HostView view = draw_view(width, height, scene);
  view.settings = OcclusionSettings(preset.quality, radius);
  view.settings.roughness_channel = 1;
  preset.change(view);
  return view;
}

void request_all_outputs(HostView& view) {
  view.settings.visibility = view.settings.bent_normal = true;
  view.settings.specular = ALCOVE_SPECULAR_SLICES;
  view.multi_bounce = true;
}

void place(HostImage& image, const HostImage& contents, std::uint32_t x, std::uint32_t y) {
  const std::size_t row = std::size_t{contents.width} * contents.channels;
  for (std::size_t i = 0; i < contents.height; ++i)
    std::copy_n(&contents.texels[i * row], row,
                &image.texels[((y + i) * image.width + x) * contents.channels]);
}

HostImage placed_in(VkExtent2D larger, const HostImage& contents, std::uint32_t x,
                    std::uint32_t y) {
  HostImage around{larger.width, larger.height, {}, contents.channels};
  around.texels.resize(std::size_t{larger.width} * larger.height * contents.channels);
  for (std::size_t i = 0; i < around.texels.size(); ++i)
    around.texels[i] = i / contents.channels % 3 == 0 ? kNaN : 0.3f;
  place(around, contents, x, y);
  return around;
}

AlcoveWorkInfo work_info(const AlcoveView& view, std::uint32_t index, const AlcoveWork* previous) {
  AlcoveWorkInfo info{.struct_size = sizeof(AlcoveWorkInfo),
                      .view = view.info,
                      .previous = previous,
                      .index = index};
  for (std::size_t role = 0; role < ALCOVE_IMAGE_COUNT; ++role) {
    const AlcoveImage& image = view.images[role];
    info.images[role] = {static_cast<std::uint32_t>(image.format), image.width, image.height};
  }
  return info;
}

void advance(HostView& view, std::uint32_t index) {
  view.previous_view = view.view;
  if (index == 1 || index == 2) view.view.view_from_world[12] += 0.03f;
  view.static_frames = index < 3 ? 0 : index == 3 ? 1 : 16;
}

AlcoveFrame make_frame(std::span<const AlcoveView> views, std::uint32_t index) {
  return {.struct_size = sizeof(AlcoveFrame),
          .index = index,
          .slot = index % TestEngine::kSlots,
          .view_count = static_cast<std::uint32_t>(views.size()),
          .views = views.data()};
}

std::string print(const std::function<std::size_t(char*, std::size_t)>& write) {
  std::string text(write(nullptr, 0) + 1, '\0');
  text.resize(write(text.data(), text.size()));
  return text;
}

std::string print_plan(AlcoveContext& context) {
  return print([&](char* text, std::size_t size) { return alcovePrintPlan(&context, text, size); });
}

AlcoveMemory get_memory(AlcoveContext& context) {
  AlcoveMemory memory{.struct_size = sizeof(AlcoveMemory)};
  EXPECT_EQ(alcoveGetMemory(&context, &memory), ALCOVE_SUCCESS) << alcoveGetMessage(&context);
  return memory;
}

Context CInterface::shared_context;

void CInterface::SetUp() {
  PassTest::SetUp();
  if (!HasFatalFailure()) engine_ = std::make_unique<TestEngine>(gpu().device());
}

void CInterface::TearDown() {
  if (engine_) engine_->wait();
  replaced_functions.clear();
  plain_context_.reset();
  if (shared_context) {
    engine_->forget_images(*shared_context);
    for (const std::uint32_t id : ids_)
      EXPECT_EQ(alcoveDropView(shared_context.get(), id), ALCOVE_SUCCESS);
  }
  engine_.reset();
  PassTest::TearDown();
}

AlcoveContext& CInterface::context() {
  if (!shared_context) shared_context = create_context();
  return *shared_context;
}

Context CInterface::create_context() {
  AlcoveContextInfo info = engine_->context_info();
  info.debug_utils = VK_TRUE;
  return create_context(info);
}

AlcoveImage CInterface::input(const HostImage& contents) {
  if (contents.texels.empty()) return {};
  const auto entry = std::ranges::find_if(inputs_, [&](const auto& input) {
    return input.first.width == contents.width && input.first.height == contents.height &&
           input.first.texels == contents.texels;
  });
  if (shares_inputs_ && entry != inputs_.end()) return entry->second;
  const AlcoveImage image =
      engine_->make_filled(float_format(contents.channels), contents.width, contents.height,
                           std::as_bytes(std::span(contents.texels)));
  inputs_.emplace_back(contents, image);
  return image;
}

AlcoveImage CInterface::output(VkFormat format, std::uint32_t width, std::uint32_t height) {
  AlcoveImage image = engine_->make_image(format, width, height, kOutputUsage);
  image.initial_state.layout = VK_IMAGE_LAYOUT_UNDEFINED;
  return image;
}

HostImage CInterface::read(const AlcoveImage& image) {
  return decode(engine_->read(image), image.format, image.width, image.height);
}

HostOutputs CInterface::read_results(const AlcoveView& view) {
  HostOutputs results;
  for (const OutputMember& each : kOutputs)
    if (view.images[each.role].image != VK_NULL_HANDLE)
      results.*each.texels = read(view.images[each.role]);
  return results;
}

AlcoveView CInterface::create_view(const HostView& from) {
  AlcoveView view{.struct_size = sizeof(AlcoveView), .info = view_info(from)};
  view.info.settings = &settings_.emplace_back(from.settings);
  for (const InputMember& each : kInputs) view.images[each.role] = input(from.*each.texels);
  const auto request = [&](bool enabled, AlcoveImageRole role, AlcovePrecision precision) {
    if (enabled) {
      view.images[role] =
          output(output_format(role, precision), from.depth_ndc.width, from.depth_ndc.height);
    }
  };
  const auto& settings = from.settings;
  request(settings.visibility, ALCOVE_IMAGE_VISIBILITY, settings.precision);
  request(settings.bent_normal, ALCOVE_IMAGE_BENT_NORMAL, settings.precision);
  request(settings.specular != ALCOVE_SPECULAR_NONE, ALCOVE_IMAGE_SPECULAR, settings.precision);
  request(from.multi_bounce, ALCOVE_IMAGE_MULTI_BOUNCE, ALCOVE_PRECISION_FLOAT32);
  return view;
}

AlcoveResult CInterface::record(AlcoveContext& context, const AlcoveFrame& frame, bool discards) {
  AlcoveResult result = ALCOVE_SUCCESS;
  engine_->submit(frame.slot % TestEngine::kSlots, [&](VkCommandBuffer commands) {
    result = alcoveRecordFrame(&context, commands, &frame);
    if (discards || result != ALCOVE_SUCCESS) throw_away(commands);
  });
  if (result == ALCOVE_SUCCESS)
    for (const AlcoveView& view : std::span(frame.views, frame.view_count))
      ids_.insert(view.info.id);
  return result;
}

void CInterface::run_frame(AlcoveContext& context, std::span<const AlcoveView> views,
                           std::uint32_t index) {
  EXPECT_EQ(record(context, make_frame(views, index)), ALCOVE_SUCCESS)
      << alcoveGetMessage(&context);
}

void CInterface::discard_frame(AlcoveContext& context, std::span<const AlcoveView> views,
                               std::uint32_t index) {
  EXPECT_EQ(record(context, make_frame(views, index), true), ALCOVE_SUCCESS)
      << alcoveGetMessage(&context);
  EXPECT_EQ(alcoveDiscardFrame(&context), ALCOVE_SUCCESS);
}

std::vector<HostOutputs> CInterface::run_views(AlcoveContext& context,
                                               std::span<const AlcoveView> views,
                                               std::uint32_t index) {
  run_frame(context, views, index);
  engine_->wait();
  std::vector<HostOutputs> results(views.size());
  std::ranges::transform(views, results.begin(),
                         [&](const AlcoveView& view) { return read_results(view); });
  return results;
}

HostOutputs CInterface::run_view(const AlcoveView& view, std::uint32_t index) {
  return run_views(context(), {&view, 1}, index)[0];
}

std::vector<HostOutputs> CInterface::run_views(AlcoveContext& context,
                                               std::span<const HostView> from,
                                               std::uint32_t index) {
  std::vector<AlcoveView> views(from.size());
  std::ranges::transform(from, views.begin(),
                         [&](const HostView& each) { return create_view(each); });
  return run_views(context, views, index);
}

HostOutputs CInterface::run_plainly(const HostView& view, std::uint32_t index) {
  if (!plain_context_) plain_context_ = create_context();
  return run_views(*plain_context_, {&view, 1}, index)[0];
}

}  // namespace alcove::passes
