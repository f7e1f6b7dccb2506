#include "engine_run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "maths/octahedral.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

constexpr VkFormat kVisibilityFormat = VK_FORMAT_R8_UNORM;
constexpr VkImageUsageFlags kDepthUsage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                          VK_IMAGE_USAGE_SAMPLED_BIT |
                                          VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
constexpr VkImageUsageFlags kColourUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                           VK_IMAGE_USAGE_SAMPLED_BIT |
                                           VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
constexpr VkImageUsageFlags kVisibilityUsage =
    VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;

AlcoveCamera to_camera(const CameraMatrices& matrices, const glm::vec3& origin) {
  glm::mat4 view = matrices.view_from_world;
  view[3] = view * glm::vec4(origin, 1.0f);
  AlcoveCamera camera;
  std::memcpy(camera.clip_from_view, &matrices.clip_from_view, sizeof camera.clip_from_view);
  std::memcpy(camera.view_from_world, &view, sizeof camera.view_from_world);
  return camera;
}

// Imports an image that the frame fills.
Texture import(Graph& graph, const AlcoveImage& image) {
  framegraph::ImportedTexture texture = passes::import_of(image);
  texture.initial_state = {texture.final_state.stages, 0, VK_IMAGE_LAYOUT_UNDEFINED};
  return graph.import_texture("image of the engine", texture);
}

}  // namespace

template <typename Texel>
AlcoveImage EngineRun::create_filled(VkFormat format, VkExtent2D size,
                                     const std::vector<Texel>& texels) {
  return device_.make_filled(format, size.width, size.height, std::as_bytes(std::span(texels)));
}

template <typename Texel>
std::vector<Texel> EngineRun::read(const AlcoveImage& image) {
  const passes::Bytes bytes = device_.read(image);
  std::vector<Texel> texels(bytes.size() / sizeof(Texel));
  std::memcpy(texels.data(), bytes.data(), bytes.size());
  return texels;
}

Result<GbufferRenderer*> Engine::gbuffer(bool geometric) {
  std::unique_ptr<GbufferRenderer>& gbuffer = gbuffers_.at(geometric ? 1 : 0);
  if (!gbuffer) {
    ALCOVE_TRY(gbuffer, GbufferRenderer::create(gpu_, scene_, geometric));
  }
  return gbuffer.get();
}

AlcoveContext* Engine::context() {
  if (!context_)
    context_ = passes::create_context(passes::TestEngine(gpu_.device()).context_info());
  return context_.get();
}

Result<std::unique_ptr<EngineRun>> EngineRun::create(Engine& engine, const Camera& camera,
                                                     const EngineCourse& course) {
  std::unique_ptr<EngineRun> run(new EngineRun(engine, camera, course));
  for (std::uint32_t frame = 0; frame < course.frames; ++frame)
    ALCOVE_TRY_VOID(run->draw_frame(frame));
  return run;
}

EngineRun::~EngineRun() {
  device_.wait();
  if (AlcoveContext* const context = engine_.context()) device_.forget_images(*context);
}

VkExtent2D EngineRun::size_at(std::uint32_t frame) const {
  const bool small = course_.resize && frame < course_.change_at;
  return small ? VkExtent2D{course_.size.width * 3 / 4, course_.size.height * 2 / 3} : course_.size;
}

// The jitter repeats after eight frames.
CameraMatrices EngineRun::matrices_at(std::uint32_t frame, bool with_jitter) const {
  const float cut = course_.cut && frame < course_.change_at ? 0.4f : 0.0f;
  Camera now = orbited(camera_, cut + course_.orbit * static_cast<float>(frame));
  const auto step = static_cast<float>(frame);
  const glm::vec3 ahead = glm::normalize(now.target_ws - now.eye_ws);
  const glm::vec3 right = glm::normalize(glm::cross(ahead, now.up_ws));
  const glm::vec3 shift =
      (course_.straight ? step * (0.06f * right + 0.03f * ahead) : glm::vec3(0)) +
      (course_.stereo && frame % 2 == 1 ? 0.4f * right : glm::vec3(0)) +
      (frame % 2 == 1 ? course_.tremble * right : glm::vec3(0));
  now.eye_ws += shift;
  now.target_ws += shift;
  if (course_.zoom) now.fov_y *= std::pow(0.985f, step);
  if (course_.jitter && with_jitter) {
    now.jitter_px = {static_cast<float>(frame % 8) / 8.0f - 0.4375f,
                     static_cast<float>(5 * frame % 8) / 8.0f - 0.4375f};
  }
  const VkExtent2D size = size_at(frame);
  return camera_matrices(now, size.width, size.height);
}

glm::mat4 EngineRun::world_from_moving_at(std::uint32_t frame) const {
  const float angle = course_.sway ? 0.02f * std::sin(1.3f * static_cast<float>(frame)) : 0.0f;
  return glm::rotate(glm::mat4(1.0f), angle, glm::vec3(0.6f, 0.0f, 0.8f));
}

Result<void> EngineRun::draw_frame(std::uint32_t frame) {
  const VkExtent2D size = size_at(frame);
  const CameraMatrices now = matrices_at(frame, true);
  const std::uint32_t back = course_.stereo ? 2 : 1;
  const std::uint32_t previous = frame < back ? frame : frame - back;
  const CameraMatrices before = matrices_at(previous, true);
  const GbufferView gbuffer_view{.view_from_world = now.view_from_world,
                                 .clip_from_view = now.clip_from_view,
                                 .previous_view_from_world = before.view_from_world,
                                 .previous_clip_from_view = before.clip_from_view,
                                 .reversed_z = camera_.reversed_z,
                                 .world_from_moving = world_from_moving_at(frame),
                                 .previous_world_from_moving = world_from_moving_at(previous)};
  ALCOVE_TRY(GbufferRenderer * gbuffer, engine_.gbuffer(course_.geometric));
  DrawnFrame targets;
  AlcoveView& view = targets.view;
  struct Target {
    AlcoveImage& image;
    VkFormat format;
    VkExtent2D size;
    VkImageUsageFlags usage;
  };
  for (const Target& target :
       {Target{view.images[ALCOVE_IMAGE_DEPTH], kDepthFormat, size, kDepthUsage},
        Target{view.images[ALCOVE_IMAGE_NORMALS], kNormalFormat, size, kColourUsage},
        Target{view.images[ALCOVE_IMAGE_MOTION], kMotionFormat, size, kColourUsage},
        Target{view.images[ALCOVE_IMAGE_VISIBILITY], kVisibilityFormat, size, kVisibilityUsage},
        Target{targets.other[Other::albedo], kAlbedoFormat, size, kColourUsage},
        Target{targets.other.half_depth,
               kDepthFormat,
               {size.width / 2, size.height / 2},
               kDepthUsage}})
    target.image =
        device_.make_image(target.format, target.size.width, target.size.height, target.usage);
  const auto report = gpu_.run([&](Graph& graph) -> Result<void> {
    (void)gbuffer->add(graph, gbuffer_view,
                       {.depth = import(graph, view.images[ALCOVE_IMAGE_DEPTH]),
                        .normal = import(graph, view.images[ALCOVE_IMAGE_NORMALS]),
                        .albedo = import(graph, targets.other[Other::albedo]),
                        .motion = import(graph, view.images[ALCOVE_IMAGE_MOTION])});
    if (course_.other_inputs)
      (void)gbuffer->add(graph, gbuffer_view, {.depth = import(graph, targets.other.half_depth)});
    return {};
  });
  if (!report) return Failure(report.error());
  if (course_.other_inputs) create_other_inputs(targets, frame);
  targets.other.half_depth.width = size.width;
  targets.other.half_depth.height = size.height;
  view.struct_size = sizeof view;
  const glm::vec3 origin = course_.relative ? glm::vec3(now.world_from_view[3]) : glm::vec3(0.0f);
  view.info.camera = to_camera(now, origin);
  view.info.previous_camera = to_camera(before, origin);
  view.images[ALCOVE_IMAGE_VISIBILITY].initial_state.layout = VK_IMAGE_LAYOUT_UNDEFINED;
  const bool changes = (course_.cut || course_.resize) && frame == course_.change_at;
  view.info.reset_history = changes ? VK_TRUE : VK_FALSE;
  view.info.static_frames = course_.orbit != 0.0f || course_.jitter ? 0 : frame;
  targets.other.camera_without_jitter = to_camera(matrices_at(frame, false), origin);
  frames_.push_back(targets);
  return {};
}

void EngineRun::create_other_inputs(DrawnFrame& targets, std::uint32_t frame) {
  const VkExtent2D size = size_at(frame);
  const CameraMatrices now = matrices_at(frame, true);
  const std::vector<float> depths = read<float>(targets.view.images[ALCOVE_IMAGE_DEPTH]);
  const auto halves = read<std::array<std::uint16_t, 4>>(targets.view.images[ALCOVE_IMAGE_NORMALS]);
  const int width = static_cast<int>(size.width), height = static_cast<int>(size.height);
  const auto at = [&](int x, int y) {
    return depths[static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * size.width +
                  static_cast<std::size_t>(std::clamp(x, 0, width - 1))];
  };
  // The distance along the view axis, at most 1e3.
  const auto distance = [&](float depth) {
    return static_cast<float>(std::min(view_depth(now.clip_from_view, depth), 1e3));
  };
  const float sky = camera_.reversed_z ? 0.0f : 1.0f;
  const std::pair<Other, std::function<float(int, int)>> kinds[] = {
      {Other::linear_depth, [&](int x, int y) { return distance(at(x, y)); }},
      {Other::linear_to_far_depth,
       [&](int x, int y) { return distance(at(x, y)) / distance(sky); }},
      {Other::log_depth,
       [&](int x, int y) { return std::log1p(distance(at(x, y))) / std::log1p(distance(sky)); }},
      {Other::coarse_depth,
       [&](int x, int y) { return std::round(at(x, y) * 65535.0f) / 65535.0f; }},
      {Other::float16_depth,
       [&](int x, int y) { return glm::unpackHalf1x16(glm::packHalf1x16(at(x, y))); }},
      {Other::gamma_depth, [&](int x, int y) { return std::pow(at(x, y), 1.0f / 2.2f); }},
      {Other::filtered_depth,
       [&](int x, int y) {
         const int left = (x + 1) / 2 * 2 - 2, top = (y + 1) / 2 * 2 - 2;
         const float s = x % 2 == 1 ? 0.25f : 0.75f, t = y % 2 == 1 ? 0.25f : 0.75f;
         return std::lerp(std::lerp(at(left, top), at(left + 2, top), s),
                          std::lerp(at(left, top + 2), at(left + 2, top + 2), s), t);
       }},
      {Other::maximum_depth,
       [&](int x, int y) {
         float most = 0.0f;
         for (int i = 0; i < 16; ++i)
           most = std::max(most, at(x / 4 * 4 + i % 4, y / 4 * 4 + i / 4));
         return most;
       }},
      {Other::chequered_depth, [&](int x, int y) { return (x + y) % 2 == 1 ? sky : at(x, y); }},
      {Other::letterbox_depth,
       [&](int x, int y) {
         return std::abs(2 * y + 1 - height) * 4 > 3 * height ? sky : at(x, y);
       }},
      {Other::noise, [](int x, int y) {
         const float s =
             std::sin(12.9898f * static_cast<float>(x) + 78.233f * static_cast<float>(y));
         return 43758.547f * s - std::floor(43758.547f * s);
       }}};
  for (const auto& [which, depth_at] : kinds) {
    std::vector<float> texels;
    texels.reserve(static_cast<std::size_t>(width * height));
    for (int i = 0; i < width * height; ++i) texels.push_back(depth_at(i % width, i / width));
    targets.other[which] = create_filled(VK_FORMAT_R32_SFLOAT, size, texels);
  }
  std::array<std::vector<glm::vec4>, 3> normals;
  for (const auto& half : halves) {
    const glm::vec3 normal(glm::unpackHalf(glm::u16vec3(half[0], half[1], half[2])));
    const bool is_sky = glm::dot(normal, normal) < 0.25f;
    normals[0].emplace_back(is_sky ? glm::vec2(0.0f) : maths::octahedral_encode(normal), 0.0f,
                            0.0f);
    normals[1].emplace_back(glm::mat3(now.view_from_world) * normal, 0.0f);
    normals[2].emplace_back(normal * glm::mat3(now.view_from_world), 0.0f);
  }
  for (std::size_t i = 0; i < normals.size(); ++i) {
    targets.other.images.at(static_cast<std::size_t>(Other::octahedral_normals) + i) =
        create_filled(VK_FORMAT_R32G32B32A32_SFLOAT, size, normals.at(i));
  }
}

EngineFrame EngineRun::describe(std::uint32_t frame) const {
  const auto frame_before = [&](std::uint32_t back) -> const DrawnFrame& {
    return frames_.at(frame - std::min(frame, back));
  };
  EngineFrame result;
  result.settings.struct_size = sizeof result.settings;
  alcoveGetSettings(ALCOVE_QUALITY_MEDIUM, course_.radius, &result.settings);
  result.settings.slices = 1;  // few samples, as nobody looks at the visibility
  result.settings.steps = 2;
  result.back = course_.stereo ? 2 : 1;
  result.view = frame_before(0).view;
  result.view.info.id = 2 * next_id_ + (course_.stereo ? frame % 2 : 0);
  result.correct = result.view;
  result.view.images[ALCOVE_IMAGE_MOTION] = {};
  result.other = frame_before(0).other;
  result.other_before = frame_before(1).other;
  result.correct_before = frame_before(1).view;
  result.correct_before_that = frame_before(2).view;
  result.correct_first = frames_.front().view;
  result.frame.struct_size = sizeof result.frame;
  result.frame.index = frame;
  result.frame.slot = frame % passes::TestEngine::kSlots;
  result.frame.view_count = 1;
  result.frame.diagnose_pixels = VK_TRUE;
  return result;
}

Result<std::string> EngineRun::draw(const ChangeFrame& change, std::uint32_t begin,
                                    bool submit_late) {
  AlcoveContext* const context = engine_.context();
  std::string report;
  std::optional<std::uint32_t> waiting;  // the slot that is recorded and not submitted
  std::vector<std::uint32_t> ids;
  for (std::uint32_t i = 0; report.empty() && i < course_.frames; ++i) {
    EngineFrame engine_frame = describe(i);
    const bool late = submit_late && i >= begin;
    if (late) engine_frame.frame.slot = 0;
    if (change && i >= begin) change(engine_frame);
    ids.push_back(engine_frame.view.info.id);
    engine_frame.view.info.settings = &engine_frame.settings;
    engine_frame.frame.views = &engine_frame.view;
    const std::uint32_t slot = i % passes::TestEngine::kSlots;
    device_.record(slot, [&](VkCommandBuffer commands) {
      for (std::uint32_t record = 0; record < engine_frame.records; ++record)
        if (alcoveRecordFrame(context, commands, &engine_frame.frame) != ALCOVE_SUCCESS)
          report = std::string(alcoveGetMessage(context)) + "\n";
    });
    if (waiting) device_.submit(*waiting);
    waiting = slot;
    if (!late) device_.submit(*std::exchange(waiting, std::nullopt));
    device_.wait();
  }
  if (waiting) device_.submit(*waiting);
  device_.wait();
  if (report.empty()) {
    report.resize(alcoveDiagnose(context, nullptr, 0) + 1);
    alcoveDiagnose(context, report.data(), report.size());
    report.pop_back();
  }
  ++next_id_;
  if (submit_late) {
    // Memory of a slot that is recorded too early may be freed too early.
    engine_.drop_context();
  } else {
    for (const std::uint32_t id : ids) alcoveDropView(context, id);
  }
  return report;
}

}  // namespace alcove::sample
