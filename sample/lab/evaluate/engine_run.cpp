#include "evaluate/engine_run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "gpu/gpu_image.h"
#include "maths/octahedral.h"
#include "render/gbuffer.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

constexpr std::uint32_t kSlots = 2;
constexpr VkFormat kVisibilityFormat = VK_FORMAT_R8_UNORM;
constexpr AlcoveState kBetweenFrames{kSampledState.stages, kSampledState.access,
                                     kSampledState.layout};
constexpr VkImageUsageFlags kDepthUsage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                          VK_IMAGE_USAGE_SAMPLED_BIT |
                                          VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
constexpr VkImageUsageFlags kColourUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                           VK_IMAGE_USAGE_SAMPLED_BIT |
                                           VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
constexpr VkImageUsageFlags kFilledUsage =
    VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
constexpr VkImageUsageFlags kVisibilityUsage =
    VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;

struct DestroyContext {
  void operator()(AlcoveContext* context) const { alcoveDestroyContext(context); }
};
using Context = std::unique_ptr<AlcoveContext, DestroyContext>;

AlcoveCamera to_camera(const CameraMatrices& matrices) {
  AlcoveCamera camera;
  std::memcpy(camera.clip_from_view, &matrices.clip_from_view, sizeof camera.clip_from_view);
  std::memcpy(camera.view_from_world, &matrices.view_from_world, sizeof camera.view_from_world);
  return camera;
}

// A frame of the course, before a mistake is made.
struct DrawnFrame {
  AlcoveView view{};
  OtherInputs other;
};

}  // namespace

struct EngineRun::State {
  State(Gpu& on, const Scene& of, const Camera& from, const EngineCourse& along)
      : gpu(on), scene(of), camera(from), course(along) {}
  ~State();

  Result<void> create();
  Result<void> create_context();
  Result<AlcoveImage> create_image(VkFormat format, VkExtent2D size, VkImageUsageFlags usage);
  template <typename Texel>
  Result<AlcoveImage> create_filled(VkFormat format, VkExtent2D size,
                                    const std::vector<Texel>& texels);
  framegraph::Texture import(Graph& graph, const AlcoveImage& image, bool fill) const;
  template <typename Texel>
  Result<std::vector<Texel>> read(const AlcoveImage& image);
  VkExtent2D size_at(std::uint32_t frame) const;
  CameraMatrices matrices_at(std::uint32_t frame, bool with_jitter) const;
  Result<void> draw_frame(std::uint32_t frame);
  Result<void> create_other_inputs(DrawnFrame& drawn, std::uint32_t frame);
  EngineFrame describe(std::uint32_t frame) const;
  VkResult begin(VkCommandBuffer commands_of_slot) const;
  VkResult submit(VkCommandBuffer recorded) const;

  Gpu& gpu;
  const Scene& scene;
  Camera camera;
  EngineCourse course;
  std::unique_ptr<GbufferRenderer> gbuffer;
  std::vector<std::unique_ptr<GpuImage>> images;
  std::vector<DrawnFrame> frames;
  Context context;
  std::uint32_t next_id = 0;
  VkCommandPool pool = VK_NULL_HANDLE;
  std::array<VkCommandBuffer, kSlots> commands{};
};

EngineRun::State::~State() {
  const VkDevice device = gpu.device().device();
  vkDeviceWaitIdle(device);
  vkDestroyCommandPool(device, pool, nullptr);
}

Result<AlcoveImage> EngineRun::State::create_image(VkFormat format, VkExtent2D size,
                                                   VkImageUsageFlags usage) {
  ALCOVE_TRY(
      auto made,
      GpuImage::create(gpu.device(),
                       {format, framegraph::Extent::absolute(size.width, size.height)}, usage));
  images.push_back(std::move(made));
  AlcoveImage image{};
  image.image = images.back()->image();
  image.format = format;
  image.width = size.width;
  image.height = size.height;
  image.usage = usage;
  image.initial_state = image.final_state = kBetweenFrames;
  return image;
}

framegraph::Texture EngineRun::State::import(Graph& graph, const AlcoveImage& image,
                                             bool fill) const {
  const auto& found = **std::ranges::find(images, image.image, &GpuImage::image);
  return graph.import_texture("image of the engine", fill ? found.import_to_fill(kSampledState)
                                                          : found.import_to_read(kSampledState));
}

template <typename Texel>
Result<AlcoveImage> EngineRun::State::create_filled(VkFormat format, VkExtent2D size,
                                                    const std::vector<Texel>& texels) {
  const VkDeviceSize bytes = texels.size() * sizeof(Texel);
  auto buffer = HostBuffer::create(gpu.device(), bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  auto image = create_image(format, size, kFilledUsage);
  if (!buffer || !image) return Failure(buffer ? image.error() : buffer.error());
  std::memcpy((*buffer)->bytes().data(), texels.data(), bytes);
  return gpu
      .run([&](Graph& graph) -> Result<void> {
        (void)add_copy(graph, **buffer, import(graph, *image, true));
        return {};
      })
      .map([&](const framegraph::FrameReport&) { return *image; });
}

template <typename Texel>
Result<std::vector<Texel>> EngineRun::State::read(const AlcoveImage& image) {
  std::vector<Texel> texels(std::size_t{image.width} * image.height);
  ALCOVE_TRY(auto buffer, HostBuffer::create(gpu.device(), texels.size() * sizeof(Texel),
                                             VK_BUFFER_USAGE_TRANSFER_DST_BIT));
  return gpu
      .run([&](Graph& graph) -> Result<void> {
        add_read_back(graph, import(graph, image, false), *buffer);
        return {};
      })
      .map([&](const framegraph::FrameReport&) {
        std::memcpy(texels.data(), buffer->bytes().data(), texels.size() * sizeof(Texel));
        return texels;
      });
}

Result<void> EngineRun::State::create() {
  const VkDevice device = gpu.device().device();
  const VkCommandPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                          .queueFamilyIndex = gpu.device().queue_family()};
  VkResult result = vkCreateCommandPool(device, &pool_info, nullptr, &pool);
  if (result == VK_SUCCESS) {
    const VkCommandBufferAllocateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                           .commandPool = pool,
                                           .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                           .commandBufferCount = kSlots};
    result = vkAllocateCommandBuffers(device, &info, commands.data());
  }
  if (result != VK_SUCCESS) return device_failure("create a command buffer", result);
  ALCOVE_TRY(auto made, GbufferRenderer::create(gpu, scene, course.geometric));
  gbuffer = std::move(made);
  auto done = create_context();
  for (std::uint32_t frame = 0; done && frame < course.frames; ++frame) done = draw_frame(frame);
  return done;
}

Result<void> EngineRun::State::create_context() {
  AlcoveContextInfo info{.struct_size = sizeof info};
  info.queue_family = gpu.device().queue_family();
  info.instance = gpu.device().instance();
  info.physical_device = gpu.device().physical_device();
  info.device = gpu.device().device();
  info.get_instance_proc_addr = vkGetInstanceProcAddr;
  info.frames_in_flight = kSlots;
  AlcoveContext* made = nullptr;
  std::array<char, ALCOVE_MAX_MESSAGE> message{};
  if (alcoveCreateContext(&info, &made, message.data()) != ALCOVE_SUCCESS)
    return Failure(message.data());
  context = Context(made);
  return {};
}

VkExtent2D EngineRun::State::size_at(std::uint32_t frame) const {
  const bool small = course.resize && frame < course.change_at;
  return small ? VkExtent2D{course.size.width * 3 / 4, course.size.height * 2 / 3} : course.size;
}

// The jitter repeats after eight frames.
CameraMatrices EngineRun::State::matrices_at(std::uint32_t frame, bool with_jitter) const {
  const float cut = course.cut && frame < course.change_at ? 0.4f : 0.0f;
  Camera now = orbited(camera, cut + course.orbit * static_cast<float>(frame));
  if (course.jitter && with_jitter) {
    now.jitter_px = {static_cast<float>(frame % 8) / 8.0f - 0.4375f,
                     static_cast<float>(5 * frame % 8) / 8.0f - 0.4375f};
  }
  const VkExtent2D size = size_at(frame);
  return camera_matrices(now, size.width, size.height);
}

Result<void> EngineRun::State::draw_frame(std::uint32_t frame) {
  const VkExtent2D size = size_at(frame);
  const CameraMatrices now = matrices_at(frame, true);
  const CameraMatrices before = matrices_at(frame == 0 ? 0 : frame - 1, true);
  const GbufferView seen{.view_from_world = now.view_from_world,
                         .clip_from_view = now.clip_from_view,
                         .previous_view_from_world = before.view_from_world,
                         .previous_clip_from_view = before.clip_from_view,
                         .reversed_z = camera.reversed_z};
  DrawnFrame drawn;
  AlcoveView& view = drawn.view;
  struct Target {
    AlcoveImage& image;
    VkFormat format;
    VkExtent2D size;
    VkImageUsageFlags usage;
  };
  for (const Target& target : {Target{view.depth, kDepthFormat, size, kDepthUsage},
                               Target{view.normals, kNormalFormat, size, kColourUsage},
                               Target{view.motion, kMotionFormat, size, kColourUsage},
                               Target{view.visibility, kVisibilityFormat, size, kVisibilityUsage},
                               Target{drawn.other.albedo, kAlbedoFormat, size, kColourUsage},
                               Target{drawn.other.half_depth,
                                      kDepthFormat,
                                      {size.width / 2, size.height / 2},
                                      kDepthUsage}}) {
    ALCOVE_TRY(auto made, create_image(target.format, target.size, target.usage));
    target.image = made;
  }
  drawn.other.half_depth.width = size.width;
  drawn.other.half_depth.height = size.height;
  const auto report = gpu.run([&](Graph& graph) -> Result<void> {
    (void)gbuffer->add(graph, seen,
                       {.depth = import(graph, view.depth, true),
                        .normal = import(graph, view.normals, true),
                        .albedo = import(graph, drawn.other.albedo, true),
                        .motion = import(graph, view.motion, true)});
    if (course.other_inputs)
      (void)gbuffer->add(graph, seen, {.depth = import(graph, drawn.other.half_depth, true)});
    return {};
  });
  if (!report) return Failure(report.error());
  view.struct_size = sizeof view;
  view.camera = to_camera(now);
  view.previous_camera = to_camera(before);
  view.visibility.initial_state.layout = VK_IMAGE_LAYOUT_UNDEFINED;
  const bool changes = (course.cut || course.resize) && frame == course.change_at;
  view.reset_history = changes ? VK_TRUE : VK_FALSE;
  view.static_frames = course.orbit != 0.0f || course.jitter ? 0 : frame;
  drawn.other.camera_without_jitter = to_camera(matrices_at(frame, false));
  auto done = course.other_inputs ? create_other_inputs(drawn, frame) : Result<void>();
  frames.push_back(drawn);
  return done;
}

Result<void> EngineRun::State::create_other_inputs(DrawnFrame& drawn, std::uint32_t frame) {
  const VkExtent2D size = size_at(frame);
  const CameraMatrices now = matrices_at(frame, true);
  const auto depths = read<float>(drawn.view.depth);
  const auto halves = read<std::array<std::uint16_t, 4>>(drawn.view.normals);
  if (!depths || !halves) return Failure(depths ? halves.error() : depths.error());
  std::vector<float> linear, coarse;
  std::vector<glm::vec4> octahedral, in_view;
  for (std::size_t i = 0; i < depths->size(); ++i) {
    const double distance = view_depth(now.clip_from_view, (*depths)[i]);
    linear.push_back(static_cast<float>(std::min(distance, 1e3)));
    coarse.push_back(std::round((*depths)[i] * 65535.0f) / 65535.0f);
    const auto& half = (*halves)[i];
    const glm::vec3 normal(half_to_float(half[0]), half_to_float(half[1]), half_to_float(half[2]));
    const bool is_sky = glm::dot(normal, normal) < 0.25f;
    octahedral.emplace_back(is_sky ? glm::vec2(0.0f) : maths::octahedral_encode(normal), 0.0f,
                            0.0f);
    in_view.emplace_back(glm::mat3(now.view_from_world) * normal, 0.0f);
  }
  const auto fill = [&](AlcoveImage& into, VkFormat format, const auto& texels) {
    return create_filled(format, size, texels).map([&](const AlcoveImage& made) { into = made; });
  };
  return fill(drawn.other.linear_depth, VK_FORMAT_R32_SFLOAT, linear)
      .and_then([&] { return fill(drawn.other.coarse_depth, VK_FORMAT_R32_SFLOAT, coarse); })
      .and_then([&] {
        return fill(drawn.other.octahedral_normals, VK_FORMAT_R32G32B32A32_SFLOAT, octahedral);
      })
      .and_then(
          [&] { return fill(drawn.other.view_normals, VK_FORMAT_R32G32B32A32_SFLOAT, in_view); });
}

EngineFrame EngineRun::State::describe(std::uint32_t frame) const {
  const auto drawn = [&](std::uint32_t back) -> const DrawnFrame& {
    return frames.at(frame - std::min(frame, back));
  };
  EngineFrame result;
  result.settings.struct_size = sizeof result.settings;
  alcoveGetSettings(ALCOVE_QUALITY_MEDIUM, course.radius, &result.settings);
  if (course.quick) {
    result.settings.slices = 1;
    result.settings.steps = 2;
  }
  result.view = drawn(0).view;
  result.view.id = next_id;
  result.right = result.view;
  result.view.motion = {};
  result.other = drawn(0).other;
  result.other_before = drawn(1).other;
  result.right_before = drawn(1).view;
  result.right_before_that = drawn(2).view;
  result.right_first = frames.front().view;
  result.frame.struct_size = sizeof result.frame;
  result.frame.index = frame;
  result.frame.slot = frame % kSlots;
  result.frame.view_count = 1;
  result.frame.diagnose_pixels = VK_TRUE;
  return result;
}

VkResult EngineRun::State::begin(VkCommandBuffer commands_of_slot) const {
  const VkCommandBufferBeginInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  return vkBeginCommandBuffer(commands_of_slot, &info);
}

VkResult EngineRun::State::submit(VkCommandBuffer recorded) const {
  const VkSubmitInfo info{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                          .commandBufferCount = 1,
                          .pCommandBuffers = &recorded};
  const VkResult result = vkQueueSubmit(gpu.device().queue(), 1, &info, VK_NULL_HANDLE);
  return result == VK_SUCCESS ? vkQueueWaitIdle(gpu.device().queue()) : result;
}

EngineRun::EngineRun(std::unique_ptr<State> state) : state_(std::move(state)) {}
EngineRun::~EngineRun() = default;

Result<std::unique_ptr<EngineRun>> EngineRun::create(Gpu& gpu, const Scene& scene,
                                                     const Camera& camera,
                                                     const EngineCourse& course) {
  auto state = std::make_unique<State>(gpu, scene, camera, course);
  ALCOVE_TRY_VOID(state->create());
  return std::unique_ptr<EngineRun>(new EngineRun(std::move(state)));
}

Result<EngineResult> EngineRun::draw(const ChangeFrame& change, std::uint32_t begin,
                                     bool submit_late) {
  State& s = *state_;
  AlcoveContext* const context = s.context.get();
  EngineResult result;
  VkCommandBuffer waiting = VK_NULL_HANDLE;  // recorded and not submitted
  AlcoveImage visibility{};
  VkResult device = VK_SUCCESS;
  std::vector<std::uint32_t> ids;
  for (std::uint32_t i = 0; result.said.empty() && i < s.course.frames; ++i) {
    EngineFrame described = s.describe(i);
    const bool late = submit_late && i >= begin;
    if (late) described.frame.slot = 0;
    if (change && i >= begin) change(described);
    ids.push_back(described.view.id);
    visibility = s.frames.at(i).view.visibility;
    described.view.settings = &described.settings;
    described.frame.views = &described.view;
    const VkCommandBuffer commands = s.commands.at(i % kSlots);
    device = s.begin(commands);
    if (device == VK_SUCCESS &&
        alcoveRecordFrame(context, commands, &described.frame) != ALCOVE_SUCCESS)
      result.said = std::string(alcoveGetMessage(context)) + "\n";
    device = device == VK_SUCCESS ? vkEndCommandBuffer(commands) : device;
    if (device == VK_SUCCESS && waiting != VK_NULL_HANDLE) device = s.submit(waiting);
    waiting = late ? commands : VK_NULL_HANDLE;
    if (device == VK_SUCCESS && !late) device = s.submit(commands);
    if (device != VK_SUCCESS) return device_failure("run a frame", device);
  }
  if (waiting != VK_NULL_HANDLE && s.submit(waiting) != VK_SUCCESS)
    return Failure("The last frame could not be run.");
  if (result.said.empty()) {
    result.said.resize(alcoveDiagnose(context, nullptr, 0) + 1);
    alcoveDiagnose(context, result.said.data(), result.said.size());
    result.said.pop_back();
    ALCOVE_TRY(auto texels, s.read<std::uint8_t>(visibility));
    result.visibility = Image<float>(visibility.width, visibility.height);
    std::ranges::transform(texels, result.visibility.pixels.begin(),
                           [](std::uint8_t texel) { return static_cast<float>(texel) / 255.0f; });
  }
  ++s.next_id;
  if (submit_late) {
    // Memory of a slot that is recorded too early may be freed too early.
    ALCOVE_TRY_VOID(s.create_context());
  } else {
    for (const std::uint32_t id : ids) alcoveDropView(context, id);
  }
  return result;
}

}  // namespace alcove::sample
