#include "gpu_cost/recorded_frame.h"

#include <algorithm>
#include <utility>

#include "alcove/framegraph/access.h"

namespace alcove::sample {
namespace {

using framegraph::AccessRecord;
using framegraph::GraphDescription;
using framegraph::Texture;
using passes::cost::Direction;
using passes::cost::FrameState;
using passes::cost::PassImage;
using Failure = tl::unexpected<std::string>;

constexpr VkFlags64 kReads = VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT |
                             VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;

// Bytes of a texel, for the formats that the passes use; 0 for any other.
std::uint32_t texel_bytes(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R8_UNORM:
    case VK_FORMAT_R8_SNORM:
    case VK_FORMAT_R8_UINT:
      return 1;
    case VK_FORMAT_R8G8_UNORM:
    case VK_FORMAT_R8G8_SNORM:
    case VK_FORMAT_R16_SFLOAT:
    case VK_FORMAT_R16_UNORM:
    case VK_FORMAT_R16_UINT:
    case VK_FORMAT_D16_UNORM:
      return 2;
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_R8G8B8A8_SNORM:
    case VK_FORMAT_R8G8B8A8_UINT:
    case VK_FORMAT_A2B10G10R10_UNORM_PACK32:
    case VK_FORMAT_A2B10G10R10_UINT_PACK32:
    case VK_FORMAT_B10G11R11_UFLOAT_PACK32:
    case VK_FORMAT_R16G16_SFLOAT:
    case VK_FORMAT_R16G16_UNORM:
    case VK_FORMAT_R16G16_SNORM:
    case VK_FORMAT_R16G16_UINT:
    case VK_FORMAT_R32_SFLOAT:
    case VK_FORMAT_R32_UINT:
    case VK_FORMAT_D32_SFLOAT:
      return 4;
    case VK_FORMAT_R16G16B16A16_SFLOAT:
    case VK_FORMAT_R16G16B16A16_UNORM:
    case VK_FORMAT_R16G16B16A16_SNORM:
    case VK_FORMAT_R16G16B16A16_UINT:
    case VK_FORMAT_R32G32_SFLOAT:
    case VK_FORMAT_R32G32_UINT:
      return 8;
    case VK_FORMAT_R32G32B32A32_SFLOAT:
    case VK_FORMAT_R32G32B32A32_UINT:
      return 16;
    default:
      return 0;
  }
}

tl::expected<std::vector<PassImage>, std::string> images_of(const GraphDescription& graph,
                                                            std::uint32_t pass) {
  std::vector<PassImage> images;
  for (const AccessRecord& access : graph.pass_accesses(pass)) {
    const framegraph::ResourceRecord& image = graph.resources[access.resource];
    if (image.kind != framegraph::ResourceKind::texture) {
      continue;
    }
    PassImage found{std::string(graph.resource_name(access.resource)), Direction::read,
                    texel_bytes(image.format), image.width, image.height};
    if (found.texel_bytes == 0) {
      return Failure("The cost model does not know the format of the image '" + found.name +
                     "': add it to sample/lab/gpu_cost/recorded_frame.cpp.");
    }
    if ((access.access & kReads) != 0) {
      images.push_back(found);
    }
    if ((access.access & framegraph::kWriteBits) != 0) {
      found.direction = Direction::write;
      images.push_back(found);
    }
  }
  return images;
}

// Declares and records frames of one view.
class FrameRecorder {
 public:
  FrameRecorder(RecordingDevice& device, const CostInputs& inputs, framegraph::Executor executor,
                passes::Kernels kernels)
      : device_(device),
        inputs_(inputs),
        executor_(std::move(executor)),
        kernels_(std::move(kernels)) {}

  tl::expected<RecordedFrame, std::string> record(FrameState state);

 private:
  Texture import(const char* name, VkFormat format,
                 VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT);
  tl::expected<void, std::string> declare(FrameState state);

  RecordingDevice& device_;
  CostInputs inputs_;
  framegraph::Executor executor_;
  passes::Kernels kernels_;
  framegraph::Graph graph_;
  std::uint32_t frame_ = 0;
};

Texture FrameRecorder::import(const char* name, VkFormat format, VkSampleCountFlagBits samples) {
  framegraph::ImportedTexture image;
  image.image = device_.next_image();
  image.desc = {format, framegraph::Extent::absolute(inputs_.width, inputs_.height)};
  image.desc.samples = samples;
  image.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  image.initial_state = {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                         VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
                         VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  return graph_.import_texture(name, image);
}

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

tl::expected<void, std::string> FrameRecorder::declare(FrameState state) {
  passes::Frame frame{graph_, kernels_, camera(inputs_.projection), frame_};
  frame.previous_view = frame.view;
  if (state == FrameState::moving) {
    frame.previous_view.view_from_world[12] = 0.01f;
  } else if (state == FrameState::unchanged) {
    frame.static_frames = 1;
  } else if (state == FrameState::converged) {
    frame.static_frames = 16;
  }
  const passes::OcclusionSettings& settings = inputs_.settings;
  passes::OcclusionInputs inputs;
  if (inputs_.area) {
    frame.areas.read = {0, 0, inputs_.width, inputs_.height};
  }
  inputs.depth_ndc = import("depth", VK_FORMAT_D32_SFLOAT,
                            inputs_.samples ? VK_SAMPLE_COUNT_4_BIT : VK_SAMPLE_COUNT_1_BIT);
  if (inputs_.mask) {
    inputs.mask = import("mask", VK_FORMAT_R8_UNORM);
    inputs.not_receiving = inputs.not_occluding = 1;
  }
  if (inputs_.normals) {
    inputs.normals = import("normals", VK_FORMAT_R16G16B16A16_SFLOAT);
    inputs.normal_encoding = inputs_.normal_encoding;
  }
  if (inputs_.motion) {
    inputs.motion = import("motion", VK_FORMAT_R16G16_SFLOAT);
  }
  if (passes::needs_back_depth(settings)) {
    inputs.back_depth_ndc = import("back-face depth", VK_FORMAT_D32_SFLOAT);
  }
  if (passes::needs_second_depth(settings)) {
    inputs.second_depth_ndc = import("second depth", VK_FORMAT_D32_SFLOAT);
  }
  const auto outputs = passes::add_occlusion(frame, inputs, settings);
  if (!outputs) {
    return Failure(device_.error().empty() ? outputs.error().message : device_.error());
  }
  const bool linear_depth = settings.linear_depth;
  for (const Texture texture :
       {settings.visibility ? outputs->visibility : Texture{},
        settings.bent_normal ? outputs->bent_normal : Texture{}, outputs->specular,
        linear_depth ? outputs->linear_depth : Texture{}}) {
    if (texture) {
      graph_.output(texture);
    }
  }
  return {};
}

tl::expected<RecordedFrame, std::string> FrameRecorder::record(FrameState state) {
  graph_.reset();
  kernels_.begin_frame(0);
  if (auto declared = declare(state); !declared) {
    return Failure(std::move(declared.error()));
  }
  const auto report = executor_.record(graph_, device_.commands());
  if (!report) {
    return Failure(framegraph::to_string(report.error()));
  }
  ++frame_;
  RecordedFrame frame{state, {}};
  const std::vector<RecordedDispatch> dispatches = device_.take_dispatches();
  auto next = dispatches.begin();
  for (const framegraph::PlannedPass& planned : report->plan->passes) {
    RecordedPass pass{std::string(graph_.description().pass_name(planned.pass)), {}, {}};
    for (; next != dispatches.end() && next->pass == pass.name; ++next) {
      pass.dispatches.push_back(*next);
    }
    auto images = images_of(graph_.description(), planned.pass);
    if (!images) {
      return Failure(std::move(images.error()));
    }
    pass.images = std::move(*images);
    frame.passes.push_back(std::move(pass));
  }
  return frame;
}

}  // namespace

tl::expected<std::vector<RecordedFrame>, std::string> record_frames(RecordingDevice& device,
                                                                    const CostInputs& inputs) {
  auto executor =
      framegraph::Executor::create(device.handles(), {.frames_in_flight = 1, .timestamps = false});
  if (!executor) {
    return Failure(framegraph::to_string(executor.error()));
  }
  auto kernels = passes::Kernels::create(device.handles(), 1);
  if (!kernels) {
    return Failure(kernels.error().message);
  }
  FrameRecorder recorder(device, inputs, std::move(*executor), std::move(*kernels));
  std::vector<RecordedFrame> frames;
  for (std::size_t i = 0; i < passes::cost::kFrameStates; ++i) {
    auto frame = recorder.record(static_cast<FrameState>(i));
    if (!frame) {
      return Failure(std::move(frame.error()));
    }
    frames.push_back(std::move(*frame));
  }
  return frames;
}

}  // namespace alcove::sample
