#include "evaluate/engine_run.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <utility>

#include "gpu/gpu_image.h"
#include "render/gbuffer.h"

namespace alcove::sample {
namespace {

using framegraph::Graph;
using framegraph::Texture;
using Failure = tl::unexpected<std::string>;

constexpr std::uint32_t kSlots = 2;
constexpr VkFormat kVisibilityFormat = VK_FORMAT_R8_UNORM;
constexpr AlcoveState kBetweenFrames{kSampledState.stages, kSampledState.access,
                                     kSampledState.layout};

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

// The camera of a frame of the course. The jitter repeats after eight frames.
Camera camera_at(const Camera& camera, const EngineCourse& course, std::uint32_t frame,
                 bool jittered) {
  Camera result = orbited(camera, course.orbit * static_cast<float>(frame));
  if (course.jitter && jittered) {
    result.jitter_px = {static_cast<float>(frame % 8) / 8.0f - 0.4375f,
                        static_cast<float>(5 * frame % 8) / 8.0f - 0.4375f};
  }
  return result;
}

}  // namespace

struct EngineRun::State {
  State(Gpu& on, const Scene& of, VkExtent2D with_size) : gpu(on), scene(of), size(with_size) {}
  ~State();

  tl::expected<void, std::string> create();
  tl::expected<std::unique_ptr<GpuImage>, std::string> create_image(VkFormat format,
                                                                    VkExtent2D of_size,
                                                                    VkImageUsageFlags usage);
  tl::expected<Context, std::string> create_context() const;
  tl::expected<void, std::string> draw_gbuffer(const GbufferView& view, bool geometric);
  EngineFrame describe(const Camera& camera, float radius, const EngineCourse& course,
                       std::uint32_t frame) const;
  AlcoveImage describe(const GpuImage& image, VkFormat format, VkExtent2D of_size,
                       VkImageUsageFlags usage) const;
  tl::expected<void, std::string> record(AlcoveContext& context, const EngineFrame& described,
                                         VkCommandBuffer into) const;
  VkResult submit(VkCommandBuffer recorded) const;
  tl::expected<Image<float>, std::string> read_visibility();

  Gpu& gpu;
  const Scene& scene;
  VkExtent2D size;
  std::array<std::unique_ptr<GbufferRenderer>, 2> gbuffers;  // by `geometric`; made when needed
  std::unique_ptr<GpuImage> depth, normals, half_depth, visibility;
  VkPipelineCache cache = VK_NULL_HANDLE;
  VkCommandPool pool = VK_NULL_HANDLE;
  std::array<VkCommandBuffer, kSlots> commands{};
};

namespace {
constexpr VkImageUsageFlags kDepthUsage =
    VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
constexpr VkImageUsageFlags kNormalUsage =
    VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
constexpr VkImageUsageFlags kVisibilityUsage =
    VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
}  // namespace

EngineRun::State::~State() {
  const VkDevice device = gpu.device().device();
  vkDeviceWaitIdle(device);
  vkDestroyCommandPool(device, pool, nullptr);
  vkDestroyPipelineCache(device, cache, nullptr);
}

tl::expected<std::unique_ptr<GpuImage>, std::string> EngineRun::State::create_image(
    VkFormat format, VkExtent2D of_size, VkImageUsageFlags usage) {
  return GpuImage::create(
      gpu.device(), {format, framegraph::Extent::absolute(of_size.width, of_size.height)}, usage);
}

tl::expected<void, std::string> EngineRun::State::create() {
  const VkExtent2D half{std::max(size.width / 2, 1u), std::max(size.height / 2, 1u)};
  struct Made {
    std::unique_ptr<GpuImage>& image;
    VkFormat format;
    VkExtent2D size;
    VkImageUsageFlags usage;
  };
  for (const Made& made : {Made{depth, kDepthFormat, size, kDepthUsage},
                           Made{normals, kNormalFormat, size, kNormalUsage},
                           Made{half_depth, kDepthFormat, half, kDepthUsage},
                           Made{visibility, kVisibilityFormat, size, kVisibilityUsage}}) {
    auto image = create_image(made.format, made.size, made.usage);
    if (!image) {
      return Failure(std::move(image.error()));
    }
    made.image = std::move(*image);
  }
  const VkDevice device = gpu.device().device();
  const VkPipelineCacheCreateInfo cache_info{.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
  const VkCommandPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                          .queueFamilyIndex = gpu.device().queue_family()};
  VkResult result = vkCreatePipelineCache(device, &cache_info, nullptr, &cache);
  if (result == VK_SUCCESS) {
    result = vkCreateCommandPool(device, &pool_info, nullptr, &pool);
  }
  if (result == VK_SUCCESS) {
    const VkCommandBufferAllocateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                           .commandPool = pool,
                                           .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                           .commandBufferCount = kSlots};
    result = vkAllocateCommandBuffers(device, &info, commands.data());
  }
  if (result != VK_SUCCESS) {
    return device_failure("create a command buffer", result);
  }
  return {};
}

tl::expected<Context, std::string> EngineRun::State::create_context() const {
  AlcoveContextInfo info{.struct_size = sizeof info};
  info.queue_family = gpu.device().queue_family();
  info.instance = gpu.device().instance();
  info.physical_device = gpu.device().physical_device();
  info.device = gpu.device().device();
  info.get_instance_proc_addr = vkGetInstanceProcAddr;
  info.frames_in_flight = kSlots;
  info.pipeline_cache = cache;
  AlcoveContext* made = nullptr;
  std::array<char, ALCOVE_MAX_MESSAGE> message{};
  if (alcoveCreateContext(&info, &made, message.data()) != ALCOVE_SUCCESS) {
    return Failure(message.data());
  }
  return Context(made);
}

tl::expected<void, std::string> EngineRun::State::draw_gbuffer(const GbufferView& view,
                                                               bool geometric) {
  std::unique_ptr<GbufferRenderer>& renderer = gbuffers.at(geometric ? 1 : 0);
  if (!renderer) {
    auto made = GbufferRenderer::create(gpu, scene, geometric);
    if (!made) {
      return Failure(std::move(made.error()));
    }
    renderer = std::move(*made);
  }
  auto report = gpu.run([&](Graph& graph) -> tl::expected<void, std::string> {
    const auto fill = [&](const std::unique_ptr<GpuImage>& image) {
      return graph.import_texture("g-buffer", image->import_to_fill(kSampledState));
    };
    (void)renderer->add(graph, view, {.depth = fill(depth), .normal = fill(normals)});
    (void)renderer->add(graph, view, {.depth = fill(half_depth)});
    return {};
  });
  if (!report) {
    return Failure(std::move(report.error()));
  }
  return {};
}

AlcoveImage EngineRun::State::describe(const GpuImage& image, VkFormat format, VkExtent2D of_size,
                                       VkImageUsageFlags usage) const {
  AlcoveImage result{};
  result.image = image.image();
  result.format = format;
  result.width = of_size.width;
  result.height = of_size.height;
  result.usage = usage;
  result.initial_state = kBetweenFrames;
  result.final_state = kBetweenFrames;
  return result;
}

EngineFrame EngineRun::State::describe(const Camera& camera, float radius,
                                       const EngineCourse& course, std::uint32_t frame) const {
  const auto matrices = [&](std::uint32_t of, bool jittered) {
    return to_camera(
        camera_matrices(camera_at(camera, course, of, jittered), size.width, size.height));
  };
  EngineFrame result;
  result.settings.struct_size = sizeof result.settings;
  alcoveGetSettings(ALCOVE_QUALITY_MEDIUM, radius, &result.settings);
  const std::uint32_t before = frame == 0 ? 0 : frame - 1;
  AlcoveView& view = result.view;
  view.struct_size = sizeof view;
  view.static_frames = course.orbit == 0.0f && !course.jitter ? frame : 0;
  view.camera = matrices(frame, true);
  view.previous_camera = matrices(before, true);
  result.camera_without_jitter = matrices(frame, false);
  result.previous_without_jitter = matrices(before, false);
  result.first_camera = matrices(0, true);
  view.depth = describe(*depth, kDepthFormat, size, kDepthUsage);
  view.normals = describe(*normals, kNormalFormat, size, kNormalUsage);
  view.visibility = describe(*visibility, kVisibilityFormat, size, kVisibilityUsage);
  view.visibility.initial_state.layout = VK_IMAGE_LAYOUT_UNDEFINED;
  result.half_depth = view.depth;
  result.half_depth.image = half_depth->image();
  result.frame.struct_size = sizeof result.frame;
  result.frame.index = frame;
  result.frame.slot = course.submit_late ? 0 : frame % kSlots;
  result.frame.view_count = 1;
  result.frame.diagnose_pixels = VK_TRUE;
  return result;
}

tl::expected<void, std::string> EngineRun::State::record(AlcoveContext& context,
                                                         const EngineFrame& described,
                                                         VkCommandBuffer into) const {
  AlcoveView view = described.view;
  view.settings = &described.settings;
  AlcoveFrame frame = described.frame;
  frame.views = &view;
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  VkResult result = vkBeginCommandBuffer(into, &begin);
  if (result == VK_SUCCESS && alcoveRecordFrame(&context, into, &frame) != ALCOVE_SUCCESS) {
    return Failure(alcoveGetMessage(&context));
  }
  if (result == VK_SUCCESS) {
    result = vkEndCommandBuffer(into);
  }
  if (result != VK_SUCCESS) {
    return device_failure("record a frame", result);
  }
  return {};
}

VkResult EngineRun::State::submit(VkCommandBuffer recorded) const {
  const VkSubmitInfo info{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                          .commandBufferCount = 1,
                          .pCommandBuffers = &recorded};
  const VkResult result = vkQueueSubmit(gpu.device().queue(), 1, &info, VK_NULL_HANDLE);
  return result == VK_SUCCESS ? vkQueueWaitIdle(gpu.device().queue()) : result;
}

tl::expected<Image<float>, std::string> EngineRun::State::read_visibility() {
  auto buffer = HostBuffer::create(gpu.device(), VkDeviceSize{size.width} * size.height,
                                   VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  if (!buffer) {
    return Failure(std::move(buffer.error()));
  }
  auto report = gpu.run([&](Graph& graph) -> tl::expected<void, std::string> {
    add_read_back(graph,
                  graph.import_texture("visibility", visibility->import_to_read(kSampledState)),
                  **buffer);
    return {};
  });
  if (!report) {
    return Failure(std::move(report.error()));
  }
  Image<float> result(size.width, size.height, 0.0f);
  std::ranges::transform((*buffer)->bytes(), result.pixels.begin(), [](std::byte value) {
    return static_cast<float>(std::to_integer<unsigned>(value)) / 255.0f;
  });
  return result;
}

EngineRun::EngineRun(std::unique_ptr<State> state) : state_(std::move(state)) {}
EngineRun::~EngineRun() = default;

tl::expected<std::unique_ptr<EngineRun>, std::string> EngineRun::create(Gpu& gpu,
                                                                        const Scene& scene,
                                                                        VkExtent2D size) {
  auto state = std::make_unique<State>(gpu, scene, size);
  if (auto made = state->create(); !made) {
    return Failure(std::move(made.error()));
  }
  return std::unique_ptr<EngineRun>(new EngineRun(std::move(state)));
}

tl::expected<EngineResult, std::string> EngineRun::draw(const Camera& camera, float radius,
                                                        const EngineCourse& course) {
  auto context = state_->create_context();
  if (!context) {
    return Failure(std::move(context.error()));
  }
  for (std::uint32_t i = 0; i < course.frames; ++i) {
    const Camera jittered = camera_at(camera, course, i, true);
    const CameraMatrices matrices =
        camera_matrices(jittered, state_->size.width, state_->size.height);
    const GbufferView view{.view_from_world = matrices.view_from_world,
                           .clip_from_view = matrices.clip_from_view,
                           .previous_view_from_world = matrices.view_from_world,
                           .previous_clip_from_view = matrices.clip_from_view,
                           .reversed_z = camera.reversed_z};
    EngineFrame described = state_->describe(camera, radius, course, i);
    if (course.change) {
      course.change(described);
    }
    const VkCommandBuffer commands = state_->commands.at(i % kSlots);
    const bool last = i + 1 == course.frames;
    auto done = state_->draw_gbuffer(view, course.geometric).and_then([&] {
      return state_->record(**context, described, commands);
    });
    VkResult result = VK_SUCCESS;
    if (done && course.submit_late && i > 0) {
      result = state_->submit(state_->commands.at((i - 1) % kSlots));
    }
    if (done && result == VK_SUCCESS && (!course.submit_late || last)) {
      result = state_->submit(commands);
    }
    if (!done) {
      return Failure(std::move(done.error()));
    }
    if (result != VK_SUCCESS) {
      return device_failure("run a frame", result);
    }
  }
  EngineResult result;
  result.said.resize(alcoveDiagnose(context->get(), nullptr, 0) + 1);
  alcoveDiagnose(context->get(), result.said.data(), result.said.size());
  result.said.pop_back();
  auto visibility = state_->read_visibility();
  if (!visibility) {
    return Failure(std::move(visibility.error()));
  }
  result.visibility = std::move(*visibility);
  return result;
}

}  // namespace alcove::sample
