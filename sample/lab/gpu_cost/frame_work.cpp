#include "gpu_cost/frame_work.h"

#include <algorithm>
#include <span>

#include "alcove/passes/setting_table.h"

namespace alcove::sample {
namespace {

// A camera of 60 degrees, or an orthographic view.
AlcoveCamera camera_of(ProjectionKind kind) {
  constexpr float kScale = 1.7320508f;  // 1 / tan(30 degrees)
  constexpr float kNear = 0.1f, kFar = 100.0f, kRange = kFar - kNear;
  AlcoveCamera camera{{kScale * 9 / 16, 0, 0, 0, 0, -kScale, 0, 0, 0, 0, 0, -1, 0, 0, kNear, 0},
                      {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
  float* const clip = camera.clip_from_view;
  if (kind == ProjectionKind::finite_far) {
    clip[10] = kNear / kRange;
    clip[14] = kNear * kFar / kRange;
  } else if (kind == ProjectionKind::orthographic) {
    clip[0] = 0.09f;
    clip[5] = -0.16f;
    clip[10] = -1 / kRange;
    clip[11] = 0;
    clip[14] = -kNear / kRange;
    clip[15] = 1;
  }
  return camera;
}

AlcoveWorkInfo work_info(const CostInputs& inputs) {
  AlcoveWorkInfo info{.struct_size = sizeof info};
  AlcoveViewInfo& view = info.view;
  view.settings = &inputs.settings;
  view.camera = camera_of(inputs.projection);
  view.normal_encoding = inputs.normal_encoding;
  view.not_receiving = view.not_occluding = inputs.mask ? 1 : 0;
  const std::uint32_t band = inputs.guard_band;
  const VkExtent2D size{inputs.width + 2 * band, inputs.height + 2 * band};
  if (inputs.area || band > 0) view.read_area = {0, 0, size.width, size.height};
  if (band > 0) view.written_area = {band, band, inputs.width, inputs.height};
  const auto add = [&](bool wanted, AlcoveImageRole role, VkFormat format,
                       std::uint32_t samples = 1) {
    const VkExtent2D written{inputs.width, inputs.height};
    const auto& [width, height] = role < ALCOVE_IMAGE_FIRST_OUTPUT ? size : written;
    if (wanted) info.images[role] = {static_cast<std::uint32_t>(format), width, height, samples};
  };
  const OcclusionSettings& settings = inputs.settings;
  add(true, ALCOVE_IMAGE_DEPTH, VK_FORMAT_D32_SFLOAT, inputs.samples ? 4 : 1);
  add(inputs.mask, ALCOVE_IMAGE_MASK, VK_FORMAT_R8_UNORM);
  add(inputs.normals, ALCOVE_IMAGE_NORMALS, VK_FORMAT_R16G16B16A16_SFLOAT);
  add(inputs.motion, ALCOVE_IMAGE_MOTION, VK_FORMAT_R16G16_SFLOAT);
  add(passes::needs_back_depth(settings), ALCOVE_IMAGE_BACK_DEPTH, VK_FORMAT_D32_SFLOAT);
  add(passes::needs_second_depth(settings), ALCOVE_IMAGE_SECOND_DEPTH, VK_FORMAT_D32_SFLOAT);
  const auto add_output = [&](bool wanted, AlcoveImageRole role) {
    add(wanted, role, passes::output_format(role, settings.precision));
  };
  add_output(settings.visibility, ALCOVE_IMAGE_VISIBILITY);
  add_output(settings.bent_normal, ALCOVE_IMAGE_BENT_NORMAL);
  add_output(settings.specular != ALCOVE_SPECULAR_NONE, ALCOVE_IMAGE_SPECULAR);
  return info;
}

std::uint32_t texel_bytes(const AlcoveWorkResource& resource) {
  switch (resource.role == ALCOVE_WORK_NONE ? VK_FORMAT_UNDEFINED
                                            : static_cast<VkFormat>(resource.format)) {
    case VK_FORMAT_UNDEFINED:
      return static_cast<std::uint32_t>(resource.size /
                                        (std::uint64_t{resource.width} * resource.height));
    case VK_FORMAT_R8_UNORM:
      return 1;
    case VK_FORMAT_R16_SFLOAT:
      return 2;
    case VK_FORMAT_R16G16B16A16_SFLOAT:
      return 8;
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return 16;
    default:
      return 4 * resource.samples;
  }
}

}  // namespace

Result<std::vector<AlcoveWork>> describe_frames(const CostInputs& inputs) {
  std::vector<AlcoveWork> frames(kFrameStates);
  AlcoveWorkInfo info = work_info(inputs);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto state = static_cast<FrameState>(i);
    info.previous = i == 0 ? nullptr : &frames[i - 1];
    info.index = static_cast<std::uint32_t>(i);
    info.view.camera.view_from_world[12] = state == FrameState::first ? 0.01f : 0.0f;
    info.view.static_frames = state == FrameState::unchanged   ? 1
                              : state == FrameState::converged ? 16
                                                               : 0;
    char message[ALCOVE_MAX_MESSAGE];
    if (alcoveDescribeWork(&info, &frames[i], message) != ALCOVE_SUCCESS)
      return tl::unexpected(std::string(message));
  }
  return frames;
}

std::vector<PassImage> dispatch_images(const AlcoveWork& work, const AlcoveWorkDispatch& dispatch) {
  const auto bindings = std::span(dispatch.bindings).first(dispatch.binding_count);
  std::vector<PassImage> images;
  for (auto binding = bindings.begin(); binding != bindings.end(); ++binding) {
    // A binding that a shader does not use has a resource of another binding.
    const auto is_same = [&](const AlcoveWorkBinding& other) {
      return other.resource == binding->resource;
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
      image.name.insert(0, names::kPrevious);
    if ((access & ALCOVE_WORK_ACCESS_READ) != 0) images.push_back(image);
    if ((access & ALCOVE_WORK_ACCESS_WRITE) != 0) {
      image.direction = Direction::write;
      images.push_back(std::move(image));
    }
  }
  return images;
}

}  // namespace alcove::sample
