#include "frame_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <ctime>
#include <utility>

#include "alcove/framegraph/access.h"
#include "alcove/passes/multi_bounce.h"
#include "gpu_image.h"

namespace alcove::sample {
namespace {

using framegraph::Graph;
using framegraph::Texture;
using Failure = tl::unexpected<std::string>;

enum Target : std::size_t { kDepth, kNormal, kAlbedo, kMotion, kEmissive, kTargetCount };

struct TargetFormat {
  VkFormat format;
  VkImageUsageFlags attachment;
};
constexpr std::array<TargetFormat, kTargetCount> kTargets{
    {{kDepthFormat, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT},
     {kNormalFormat, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT},
     {kAlbedoFormat, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT},
     {kMotionFormat, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT},
     {kEmissiveFormat, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT}}};

// Processor time that all threads of the process have spent, in milliseconds.
double processor_ms() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}

// Turns texels of a read-back buffer into an image, one call of `convert` each.
template <typename Pixel, typename Texel, typename Convert>
Image<Pixel> to_image(const HostBuffer& buffer, VkExtent2D size, Convert convert) {
  Image<Pixel> image(size.width, size.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    Texel texel;
    std::memcpy(&texel, buffer.bytes().data() + i * sizeof(Texel), sizeof(Texel));
    image.pixels[i] = convert(texel);
  }
  return image;
}

using Half4 = std::array<std::uint16_t, 4>;
using Byte4 = std::array<std::uint8_t, 4>;
using SignedByte4 = std::array<std::int8_t, 4>;

glm::vec3 from_half(const Half4& texel) {
  return {half_to_float(texel[0]), half_to_float(texel[1]), half_to_float(texel[2])};
}

std::uint32_t texel_bytes(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R8_UNORM:
      return 1;
    case VK_FORMAT_R16_SFLOAT:
      return 2;
    case VK_FORMAT_R16G16B16A16_SFLOAT:
      return 8;
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return 16;
    default:
      return 4;
  }
}

Image<float> read_visibility(const HostBuffer& buffer, VkExtent2D size,
                             passes::Precision precision) {
  switch (precision) {
    case passes::Precision::unorm8:
      return to_image<float, std::uint8_t>(buffer, size,
                                           [](std::uint8_t x) { return float(x) / 255.0f; });
    case passes::Precision::float16:
      return to_image<float, std::uint16_t>(buffer, size, half_to_float);
    default:
      return to_image<float, float>(buffer, size, [](float x) { return x; });
  }
}

Image<glm::vec3> read_vectors(const HostBuffer& buffer, VkExtent2D size,
                              passes::Precision precision) {
  switch (precision) {
    case passes::Precision::unorm8:
      return to_image<glm::vec3, SignedByte4>(buffer, size, [](const SignedByte4& t) {
        return glm::normalize(glm::vec3(t[0], t[1], t[2]) / 127.0f);
      });
    case passes::Precision::float16:
      return to_image<glm::vec3, Half4>(buffer, size, from_half);
    default:
      return to_image<glm::vec3, glm::vec4>(buffer, size,
                                            [](const glm::vec4& t) { return glm::vec3(t); });
  }
}

Image<glm::vec3> read_colours(const HostBuffer& buffer, VkExtent2D size,
                              passes::Precision precision) {
  if (precision == passes::Precision::unorm8) {
    return to_image<glm::vec3, Byte4>(
        buffer, size, [](const Byte4& t) { return glm::vec3(t[0], t[1], t[2]) / 255.0f; });
  }
  return read_vectors(buffer, size, precision);
}

}  // namespace

// The occlusion's frame: what it was given and what it makes.
struct Declared {
  Texture depth;
  Texture normal;
  Texture albedo;
  passes::OcclusionOutputs outputs;
  Texture multi_bounce;
  std::vector<Texture> specular_occlusion;
};

// What is read back of a frame, in the order that FrameRenderer::State::convert takes it.
std::vector<Texture> wanted_of(const Declared& declared) {
  const passes::OcclusionOutputs& outputs = declared.outputs;
  std::vector<Texture> wanted{declared.depth, outputs.normals, declared.albedo, outputs.visibility};
  if (outputs.bent_normal) {
    wanted.push_back(outputs.bent_normal);
    wanted.push_back(declared.multi_bounce);
    wanted.insert(wanted.end(), declared.specular_occlusion.begin(),
                  declared.specular_occlusion.end());
  }
  return wanted;
}

struct FrameRenderer::State {
  State(Gpu& on, VkExtent2D of_size, NormalSource source)
      : gpu(on), size(of_size), normals(source) {}

  tl::expected<void, std::string> create_targets();
  tl::expected<void, std::string> draw_gbuffer(const FrameRequest& request, FrameCost& cost);
  passes::Frame frame_of(Graph& graph, const FrameRequest& request);
  tl::expected<Declared, std::string> declare_occlusion(Graph& graph, const FrameRequest& request);
  tl::expected<void, std::string> declare_light(Graph& graph, const FrameRequest& request,
                                                Declared& declared);
  FrameImages convert(const FrameRequest& request,
                      const std::vector<std::unique_ptr<HostBuffer>>& buffers) const;
  void append_times(FrameCost& cost, bool occlusion);

  Gpu& gpu;
  VkExtent2D size;
  NormalSource normals;
  std::unique_ptr<GbufferRenderer> gbuffer;
  std::array<std::unique_ptr<GpuImage>, kTargetCount> targets;
  framegraph::MemoryStatistics memory;
};

tl::expected<void, std::string> FrameRenderer::State::create_targets() {
  for (std::size_t i = 0; i < kTargetCount; ++i) {
    auto made = GpuImage::create(
        gpu.device(), kTargets[i].format, size,
        kTargets[i].attachment | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    if (!made) {
      return Failure(std::move(made.error()));
    }
    targets[i] = std::move(*made);
  }
  return {};
}

void FrameRenderer::State::append_times(FrameCost& cost, bool occlusion) {
  for (const framegraph::PassTiming& timing : gpu.timings()) {
    cost.gpu.push_back({std::string(timing.name), timing.milliseconds});
    if (occlusion) {
      cost.occlusion_ms += timing.milliseconds;
    }
  }
}

tl::expected<void, std::string> FrameRenderer::State::draw_gbuffer(const FrameRequest& request,
                                                                   FrameCost& cost) {
  const auto declare = [&](Graph& graph) -> tl::expected<void, std::string> {
    std::array<Texture, kTargetCount> filled;
    for (std::size_t i = 0; i < kTargetCount; ++i) {
      filled[i] = graph.import_texture("g-buffer", targets[i]->import_to_fill(kSampledState));
    }
    (void)gbuffer->add(
        graph, request.view,
        {filled[kDepth], filled[kNormal], filled[kAlbedo], filled[kMotion], filled[kEmissive]});
    return {};
  };
  auto report = gpu.run(declare);
  if (!report) {
    return Failure(std::move(report.error()));
  }
  append_times(cost, false);
  return {};
}

passes::Frame FrameRenderer::State::frame_of(Graph& graph, const FrameRequest& request) {
  return {graph,
          gpu.kernels(),
          {to_matrix(request.view.clip_from_view), to_matrix(request.view.view_from_world)},
          request.index};
}

tl::expected<Declared, std::string> FrameRenderer::State::declare_occlusion(
    Graph& graph, const FrameRequest& request) {
  const auto import = [&](Target target) {
    return graph.import_texture("g-buffer", targets[target]->import_to_read(kSampledState));
  };
  Declared declared{import(kDepth), import(kNormal), import(kAlbedo), {}, {}, {}};
  const passes::Frame frame = frame_of(graph, request);
  passes::OcclusionInputs inputs{.depth_ndc = declared.depth};
  if (normals != NormalSource::kDepth) {
    inputs.normals = declared.normal;
  }
  if (request.index == 0) {
    graph.reset_histories();
  }
  auto outputs = passes::add_occlusion(frame, inputs, request.occlusion);
  if (!outputs) {
    return Failure(std::move(outputs.error().message));
  }
  declared.outputs = *outputs;
  return declared;
}

// Adds what is made of visibility and bent normal; nothing without bent normals.
tl::expected<void, std::string> FrameRenderer::State::declare_light(Graph& graph,
                                                                    const FrameRequest& request,
                                                                    Declared& declared) {
  const passes::OcclusionOutputs& outputs = declared.outputs;
  if (!outputs.bent_normal) {
    return {};
  }
  const passes::Frame frame = frame_of(graph, request);
  const passes::Precision precision = request.occlusion.precision;
  const auto bounced =
      passes::add_multi_bounce(frame, {outputs.visibility, declared.albedo}, precision);
  if (!bounced) {
    return Failure(bounced.error().message);
  }
  declared.multi_bounce = *bounced;
  passes::GtsoInputs inputs{.visibility = outputs.visibility,
                            .bent_normal = outputs.bent_normal,
                            .normals = outputs.normals,
                            .depth = outputs.linear_depth,
                            .normals_in_view_space = normals == NormalSource::kDepth};
  passes::GtsoSettings settings{.model = request.light.specular_model, .precision = precision};
  std::vector<float> roughness = request.light.roughness;
  if (roughness.empty()) {
    inputs.roughness = declared.albedo;
    settings.roughness_channel = 3;
    roughness.push_back(settings.roughness);
  }
  for (const float value : roughness) {
    settings.roughness = value;
    const auto occluded = passes::add_gtso(frame, inputs, settings);
    if (!occluded) {
      return Failure(occluded.error().message);
    }
    declared.specular_occlusion.push_back(*occluded);
  }
  return {};
}

FrameImages FrameRenderer::State::convert(
    const FrameRequest& request, const std::vector<std::unique_ptr<HostBuffer>>& buffers) const {
  FrameImages images;
  images.depth_ndc = to_image<float, float>(*buffers[0], size, [](float x) { return x; });
  images.normal_ws = to_image<glm::vec3, Half4>(*buffers[1], size, from_half);
  images.albedo = to_image<glm::vec3, Byte4>(
      *buffers[2], size, [](const Byte4& t) { return glm::vec3(t[0], t[1], t[2]) / 255.0f; });
  images.roughness = to_image<float, Byte4>(*buffers[2], size,
                                            [](const Byte4& t) { return float(t[3]) / 255.0f; });
  const passes::Precision precision = request.occlusion.precision;
  images.visibility = read_visibility(*buffers[3], size, precision);
  if (buffers.size() > 4) {
    images.bent_normal_ws = read_vectors(*buffers[4], size, precision);
    images.multi_bounce = read_colours(*buffers[5], size, precision);
    for (std::size_t i = 6; i < buffers.size(); ++i) {
      images.specular_occlusion.push_back(read_visibility(*buffers[i], size, precision));
    }
  }
  if (normals == NormalSource::kDepth) {
    const glm::mat3 world_from_view = glm::transpose(glm::mat3(request.view.view_from_world));
    for (glm::vec3& normal : images.normal_ws.pixels) {
      normal = world_from_view * normal;
    }
    for (glm::vec3& bent : images.bent_normal_ws.pixels) {
      bent = world_from_view * bent;
    }
  }
  return images;
}

passes::Matrix to_matrix(const glm::mat4& matrix) {
  passes::Matrix result;
  std::memcpy(result.data(), &matrix, sizeof(result));
  return result;
}

FrameRenderer::FrameRenderer(std::unique_ptr<State> state) : state_(std::move(state)) {}
FrameRenderer::~FrameRenderer() = default;

tl::expected<std::unique_ptr<FrameRenderer>, std::string> FrameRenderer::create(
    Gpu& gpu, const Scene& scene, VkExtent2D size, NormalSource normals) {
  auto state = std::make_unique<State>(gpu, size, normals);
  auto gbuffer = GbufferRenderer::create(gpu, scene, normals == NormalSource::kGeometric);
  if (!gbuffer) {
    return Failure(std::move(gbuffer.error()));
  }
  state->gbuffer = std::move(*gbuffer);
  if (auto made = state->create_targets(); !made) {
    return Failure(std::move(made.error()));
  }
  return std::unique_ptr<FrameRenderer>(new FrameRenderer(std::move(state)));
}

tl::expected<FrameCost, std::string> FrameRenderer::draw(const FrameRequest& request) {
  FrameCost cost;
  if (auto drawn = state_->draw_gbuffer(request, cost); !drawn) {
    return Failure(std::move(drawn.error()));
  }
  const double before = processor_ms();
  auto report = state_->gpu.run([&](Graph& graph) {
    return state_->declare_occlusion(graph, request).map([&](const Declared& declared) {
      graph.output(declared.outputs.visibility);
      if (declared.outputs.bent_normal) {
        graph.output(declared.outputs.bent_normal);
      }
    });
  });
  if (!report) {
    return Failure(std::move(report.error()));
  }
  cost.cpu_ms = processor_ms() - before;
  state_->memory = report->memory;
  state_->append_times(cost, true);
  return cost;
}

tl::expected<FrameImages, std::string> FrameRenderer::draw_and_read(const FrameRequest& request) {
  FrameCost ignored;
  if (auto drawn = state_->draw_gbuffer(request, ignored); !drawn) {
    return Failure(std::move(drawn.error()));
  }
  // Filled while the frame is declared: what is read back, and into which buffer.
  std::vector<std::unique_ptr<HostBuffer>> buffers;
  auto report = state_->gpu.run([&](Graph& graph) -> tl::expected<void, std::string> {
    auto declared = state_->declare_occlusion(graph, request);
    if (!declared) {
      return Failure(std::move(declared.error()));
    }
    if (auto lit = state_->declare_light(graph, request, *declared); !lit) {
      return lit;
    }
    for (const Texture texture : wanted_of(*declared)) {
      auto buffer = HostBuffer::create(state_->gpu.device(),
                                       VkDeviceSize{state_->size.width} * state_->size.height *
                                           texel_bytes(graph.format(texture)),
                                       VK_BUFFER_USAGE_TRANSFER_DST_BIT);
      if (!buffer) {
        return Failure(std::move(buffer.error()));
      }
      add_read_back(graph, texture, **buffer);
      buffers.push_back(std::move(*buffer));
    }
    return {};
  });
  if (!report) {
    return Failure(std::move(report.error()));
  }
  return state_->convert(request, buffers);
}

const framegraph::MemoryStatistics& FrameRenderer::memory() const { return state_->memory; }

}  // namespace alcove::sample
