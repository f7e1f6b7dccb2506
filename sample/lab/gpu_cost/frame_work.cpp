#include "gpu_cost/frame_work.h"

#include <algorithm>
#include <span>

#include "alcove/passes/work.h"

namespace alcove::sample {
namespace {

using framegraph::Texture;

// A camera of 60 degrees, or an orthographic view.
passes::View camera(ProjectionKind kind) {
  passes::View view;
  const float scale = 1.7320508f;  // 1 / tan(30 degrees)
  const float near_plane = 0.1f;
  const float far_plane = 100.0f;
  const float range = far_plane - near_plane;
  view.clip_from_view = {scale * 9 / 16, 0, 0, 0, 0, -scale, 0, 0, 0, 0, 0, -1, 0, 0,
                         near_plane,     0};
  if (kind == ProjectionKind::finite_far) {
    view.clip_from_view[10] = near_plane / range;
    view.clip_from_view[14] = near_plane * far_plane / range;
  } else if (kind == ProjectionKind::orthographic) {
    view.clip_from_view = {
        0.09f, 0, 0, 0, 0, -0.16f, 0, 0, 0, 0, -1 / range, 0, 0, 0, -near_plane / range, 1};
  }
  return view;
}

tl::expected<passes::OcclusionOutputs, passes::Error> describe(passes::WorkList& list,
                                                               const CostInputs& inputs,
                                                               FrameState state) {
  passes::WorkFrame frame{camera(inputs.projection), static_cast<std::uint32_t>(state)};
  frame.previous_view = frame.view;
  if (state == FrameState::moving) frame.previous_view.view_from_world[12] = 0.01f;
  frame.static_frames = state == FrameState::unchanged   ? 1
                        : state == FrameState::converged ? 16
                                                         : 0;
  const std::uint32_t band = inputs.guard_band;
  const VkExtent2D size{inputs.width + 2 * band, inputs.height + 2 * band};
  const auto add = [&](bool wanted, const char* name, VkFormat format, std::uint32_t samples = 1) {
    return wanted ? list.add(ALCOVE_RESOURCE_KIND_INPUT, name, format, size, 1, samples)
                  : Texture{};
  };
  if (inputs.area || band > 0) {
    frame.areas.read = {0, 0, size.width, size.height};
    if (band > 0) frame.areas.written = {band, band, inputs.width, inputs.height};
  }
  const passes::OcclusionSettings& settings = inputs.settings;
  passes::OcclusionInputs given;
  given.depth_ndc = add(true, "depth", VK_FORMAT_D32_SFLOAT, inputs.samples ? 4 : 1);
  given.mask = add(inputs.mask, "mask", VK_FORMAT_R8_UNORM);
  given.not_receiving = given.not_occluding = inputs.mask ? 1 : 0;
  given.normals = add(inputs.normals, "normals", VK_FORMAT_R16G16B16A16_SFLOAT);
  given.normal_convention.encoding = inputs.normal_encoding;
  given.motion = add(inputs.motion, "motion vectors", VK_FORMAT_R16G16_SFLOAT);
  given.back_depth_ndc =
      add(passes::needs_back_depth(settings), "back-face depth", VK_FORMAT_D32_SFLOAT);
  given.second_depth_ndc =
      add(passes::needs_second_depth(settings), "second depth", VK_FORMAT_D32_SFLOAT);
  return passes::describe_occlusion(list, frame, given, settings);
}

std::uint32_t texel_bytes(const AlcoveWorkResource& resource) {
  if (resource.kind == ALCOVE_RESOURCE_KIND_INPUT) {  // one of describe()
    return resource.format == VK_FORMAT_R16G16B16A16_SFLOAT ? 8
           : resource.format == VK_FORMAT_R8_UNORM          ? 1
                                                            : 4 * resource.samples;
  }
  return static_cast<std::uint32_t>(resource.size /
                                    (std::uint64_t{resource.width} * resource.height));
}

}  // namespace

Result<std::vector<AlcoveWork>> describe_frames(const CostInputs& inputs) {
  std::vector<AlcoveWork> frames(kFrameStates);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    passes::WorkList list(frames[i], i == 0 ? nullptr : &frames[i - 1]);
    if (const auto described = describe(list, inputs, static_cast<FrameState>(i)); !described)
      return tl::unexpected(described.error().message);
  }
  return frames;
}

std::vector<PassImage> dispatch_images(const AlcoveWork& work, const AlcoveWorkDispatch& dispatch) {
  const auto bindings = std::span(dispatch.bindings).first(dispatch.binding_count);
  std::vector<PassImage> images;
  for (auto binding = bindings.begin(); binding != bindings.end(); ++binding) {
    // A binding that a shader does not use has a resource of another binding.
    const auto is_same = [&](const AlcoveWorkBinding& other) {
      return other.resource == binding->resource && other.mip == binding->mip;
    };
    if (binding->type <= ALCOVE_BINDING_TYPE_TABLE ||
        std::any_of(bindings.begin(), binding, is_same))
      continue;
    std::uint32_t access = 0;
    for (const AlcoveWorkBinding& other : bindings) access |= is_same(other) ? other.access : 0;
    const AlcoveWorkResource& resource = work.resources[binding->resource];
    PassImage image{resource.name, Direction::read, texel_bytes(resource), resource.width,
                    resource.height};
    if (resource.kind == ALCOVE_RESOURCE_KIND_HISTORY_PREVIOUS)
      image.name = "previous " + image.name;
    if ((access & ALCOVE_WORK_ACCESS_READ) != 0) images.push_back(image);
    if ((access & ALCOVE_WORK_ACCESS_WRITE) != 0) {
      image.direction = Direction::write;
      images.push_back(std::move(image));
    }
  }
  return images;
}

}  // namespace alcove::sample
