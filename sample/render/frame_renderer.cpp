#include "render/frame_renderer.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <ctime>
#include <optional>
#include <utility>

#include "alcove/framegraph/access.h"
#include "alcove/passes/apply.h"
#include "alcove/passes/multi_bounce.h"
#include "gpu/gpu_image.h"
#include "render/frame_read_back.h"
#include "render/probe.h"
#include "render/read_back.h"
#include "render/surfaces.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

// The images that the g-buffer is drawn to. The last two are drawn only if the occlusion passes
// read them.
enum Target : std::size_t {
  kDepth,
  kNormal,
  kAlbedo,
  kMotion,
  kEmissive,
  kBackDepth,
  kSecondDepth,
  kTargetCount
};

struct TargetFormat {
  VkFormat format;
  VkImageUsageFlags attachment;
};
constexpr std::array<TargetFormat, kTargetCount> kTargets{
    {{kDepthFormat, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT},
     {kNormalFormat, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT},
     {kAlbedoFormat, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT},
     {kMotionFormat, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT},
     {kEmissiveFormat, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT},
     {kDepthFormat, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT},
     {kDepthFormat, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT}}};

// Returns the processor time that all threads of the process have used so far, in milliseconds.
double processor_ms() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}

}  // namespace

struct FrameRenderer::State {
  State(Gpu& on, VkExtent2D of_size, NormalSource source)
      : gpu(on), size(of_size), normals(source) {}

  tl::expected<void, std::string> create_target(Target target);
  // Draws the g-buffer, unless it was already drawn with the same view and the same previous view.
  tl::expected<void, std::string> draw_gbuffer(const FrameRequest& request, FrameCost& cost);
  passes::Frame frame_of(Graph& graph, const FrameRequest& request);
  Surfaces surfaces_of(const DeclaredFrame& declared, const FrameRequest& request) const;
  tl::expected<DeclaredFrame, std::string> declare_occlusion(Graph& graph,
                                                             const FrameRequest& request);
  tl::expected<void, std::string> declare_light(Graph& graph, const FrameRequest& request,
                                                DeclaredFrame& declared);
  tl::expected<void, std::string> declare_lit(Graph& graph, const FrameRequest& request,
                                              DeclaredFrame& declared);
  void turn_to_world(const FrameRequest& request, FrameImages& images) const;
  void append_times(FrameCost& cost, bool occlusion);

  Gpu& gpu;
  VkExtent2D size;
  NormalSource normals;
  std::unique_ptr<GbufferRenderer> gbuffer;
  // The view that the targets were drawn with; null before the first drawing.
  std::optional<GbufferView> drawn_view;
  HiddenDepths drawn_depths;  // the hidden depths that were drawn for that view
  // All hidden depths that were ever drawn; null: nothing was drawn yet.
  std::optional<HiddenDepths> compiled;
  std::vector<PassTime> gbuffer_times;  // times of the last drawing of the g-buffer
  std::array<std::unique_ptr<GpuImage>, kTargetCount> targets;
  // Upload buffer of the environment, kept until the lit frame is done.
  std::unique_ptr<HostBuffer> environment;
  framegraph::MemoryStatistics memory;
};

tl::expected<void, std::string> FrameRenderer::State::create_target(Target target) {
  auto made = GpuImage::create(
      gpu.device(),
      {kTargets[target].format, framegraph::Extent::absolute(size.width, size.height)},
      kTargets[target].attachment | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
  if (!made) {
    return Failure(std::move(made.error()));
  }
  targets[target] = std::move(*made);
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
  const HiddenDepths hidden = hidden_depths_of(request.occlusion);
  if (drawn_view == request.view && drawn_depths.covers(hidden)) {
    cost.gpu = gbuffer_times;
    return {};
  }
  for (const auto& [wanted, target] :
       {std::pair(hidden.back_faces, kBackDepth), {hidden.second_layer, kSecondDepth}}) {
    if (wanted && !targets[target]) {
      if (auto made = create_target(target); !made) {
        return made;
      }
    }
  }
  const auto declare = [&](Graph& graph) -> tl::expected<void, std::string> {
    const auto fill = [&](Target target) {
      return graph.import_texture("g-buffer", targets[target]->import_to_fill(kSampledState));
    };
    const Gbuffer drawn =
        gbuffer->add(graph, request.view,
                     {fill(kDepth), fill(kNormal), fill(kAlbedo), fill(kMotion), fill(kEmissive)});
    if (hidden.back_faces) {
      (void)gbuffer->add_back_faces(graph, request.view, fill(kBackDepth));
    }
    if (hidden.second_layer) {
      (void)gbuffer->add_second_layer(graph, request.view, drawn.depth, fill(kSecondDepth));
    }
    return {};
  };
  // The first drawing also compiles shaders, so that only a second one is timed.
  const int drawings = compiled && compiled->covers(hidden) ? 1 : 2;
  for (int i = 0; i < drawings; ++i) {
    auto report = gpu.run(declare);
    if (!report) {
      return Failure(std::move(report.error()));
    }
  }
  compiled = hidden.with(compiled.value_or(hidden));
  append_times(cost, false);
  drawn_view = request.view;
  drawn_depths = hidden;
  gbuffer_times = cost.gpu;
  return {};
}

passes::Frame FrameRenderer::State::frame_of(Graph& graph, const FrameRequest& request) {
  return {graph,
          gpu.kernels(),
          {to_matrix(request.view.clip_from_view), to_matrix(request.view.view_from_world)},
          request.index,
          {to_matrix(request.view.previous_clip_from_view),
           to_matrix(request.view.previous_view_from_world)},
          request.static_frames};
}

Surfaces FrameRenderer::State::surfaces_of(const DeclaredFrame& declared,
                                           const FrameRequest& request) const {
  Surfaces surfaces{.gbuffer = {.depth = declared.depth,
                                .normal = declared.normal,
                                .albedo = declared.albedo,
                                .emissive = declared.emissive},
                    .normals = normals};
  if (request.light != nullptr && !request.light->roughness.empty()) {
    surfaces.roughness = request.light->roughness.front();
  }
  return surfaces;
}

tl::expected<DeclaredFrame, std::string> FrameRenderer::State::declare_occlusion(
    Graph& graph, const FrameRequest& request) {
  const auto import = [&](Target target) {
    return graph.import_texture("g-buffer", targets[target]->import_to_read(kSampledState));
  };
  DeclaredFrame declared{.depth = import(kDepth),
                         .normal = import(kNormal),
                         .albedo = import(kAlbedo),
                         .emissive = import(kEmissive)};
  const passes::Frame frame = frame_of(graph, request);
  Surfaces surfaces = surfaces_of(declared, request);
  const HiddenDepths hidden = hidden_depths_of(request.occlusion);
  surfaces.back_depth = hidden.back_faces ? import(kBackDepth) : Texture{};
  surfaces.second_depth = hidden.second_layer ? import(kSecondDepth) : Texture{};
  passes::OcclusionInputs inputs = occlusion_inputs(surfaces);
  passes::OcclusionSettings settings = with_roughness(request.occlusion, surfaces);
  settings.linear_depth = request.light != nullptr;
  if (request.motion_vectors) {
    inputs.motion = import(kMotion);
  }
  if (request.index == 0 || request.restart) {
    graph.reset_histories();
  }
  auto outputs = passes::add_occlusion(frame, inputs, settings);
  if (!outputs) {
    return Failure(std::move(outputs.error().message));
  }
  declared.outputs = *outputs;
  if (outputs->specular) {
    declared.specular_occlusion.push_back(outputs->specular);
  }
  // Specular occlusion for each further roughness value runs all occlusion passes again, with its
  // own history.
  const std::vector<float> roughness =
      request.light != nullptr ? request.light->roughness : std::vector<float>();
  for (std::size_t i = 1; i < roughness.size() && outputs->specular; ++i) {
    settings.roughness = roughness[i];
    auto more = passes::add_occlusion(frame, inputs, settings, "roughness " + std::to_string(i));
    if (!more) {
      return Failure(std::move(more.error().message));
    }
    declared.specular_occlusion.push_back(more->specular);
  }
  return declared;
}

// Adds the passes that use visibility and bent normals: multi-bounce and lighting. Adds nothing if
// no bent normals are computed.
tl::expected<void, std::string> FrameRenderer::State::declare_light(Graph& graph,
                                                                    const FrameRequest& request,
                                                                    DeclaredFrame& declared) {
  const passes::OcclusionOutputs& outputs = declared.outputs;
  if (!outputs.bent_normal || request.light == nullptr) {
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
  return request.light->environment.empty() ? tl::expected<void, std::string>()
                                            : declare_lit(graph, request, declared);
}

// Adds the passes that light the surfaces with the environment. Emission is left out, because the
// ray-traced reference does not have it.
tl::expected<void, std::string> FrameRenderer::State::declare_lit(Graph& graph,
                                                                  const FrameRequest& request,
                                                                  DeclaredFrame& declared) {
  const auto probe =
      add_probe(frame_of(graph, request), gpu, request.light->environment, environment);
  if (!probe) {
    return Failure(probe.error());
  }
  const passes::OcclusionOutputs& outputs = declared.outputs;
  const Surfaces surfaces = surfaces_of(declared, request);
  std::string error;
  const auto light = [&](passes::ApplyInputs inputs, bool multi_bounce, bool parts) {
    give_surfaces(inputs, surfaces, outputs);
    inputs.harmonics = probe->harmonics;
    inputs.map = probe->map;
    passes::ApplySettings settings = apply_settings(surfaces);
    settings.multi_bounce = multi_bounce;
    settings.parts = parts;
    auto lit = passes::add_apply(frame_of(graph, request), inputs, settings);
    if (!lit) {
      error = std::move(lit.error().message);
    }
    return lit.value_or(passes::AppliedLight{});
  };
  declared.lit = light({.visibility = outputs.visibility,
                        .bent_normal = outputs.bent_normal,
                        .specular_occlusion = declared.specular_occlusion.front()},
                       true, true);
  if (request.light->lit_steps) {
    const passes::ApplyInputs bent{.visibility = outputs.visibility,
                                   .bent_normal = outputs.bent_normal};
    declared.unoccluded = light({}, false, false).lit;
    declared.unbent = light({.visibility = outputs.visibility}, false, false).lit;
    declared.occluded = light(bent, false, false).lit;
    passes::ApplyInputs bounced = bent;
    bounced.specular_occlusion = outputs.visibility;
    declared.bounced = light(bounced, true, false).lit;
  }
  if (!error.empty()) {
    return Failure(std::move(error));
  }
  return {};
}

// Rotates normals and bent normals from view space to world space if the normals were computed from
// depth. Otherwise they are already in world space.
void FrameRenderer::State::turn_to_world(const FrameRequest& request, FrameImages& images) const {
  if (normals == NormalSource::kDepth) {
    const glm::mat3 world_from_view = glm::transpose(glm::mat3(request.view.view_from_world));
    for (glm::vec3& normal : images.normal_ws.pixels) {
      normal = world_from_view * normal;
    }
    for (glm::vec3& bent : images.bent_normal_ws.pixels) {
      bent = world_from_view * bent;
    }
  }
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
  for (const Target target : {kDepth, kNormal, kAlbedo, kMotion, kEmissive}) {
    if (auto made = state->create_target(target); !made) {
      return Failure(std::move(made.error()));
    }
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
    return state_->declare_occlusion(graph, request).map([&](const DeclaredFrame& declared) {
      graph.output(declared.outputs.visibility);
      if (request.occlusion.bent_normal) {
        graph.output(declared.outputs.bent_normal);
      }
      for (const Texture specular : declared.specular_occlusion) {
        graph.output(specular);
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
  // The textures to read back and the buffers that they are copied to. Both are filled while the
  // frame is declared.
  std::vector<Wanted> wanted;
  std::vector<std::unique_ptr<HostBuffer>> buffers;
  auto report = state_->gpu.run([&](Graph& graph) -> tl::expected<void, std::string> {
    auto declared = state_->declare_occlusion(graph, request);
    if (!declared) {
      return Failure(std::move(declared.error()));
    }
    if (auto lit = state_->declare_light(graph, request, *declared); !lit) {
      return lit;
    }
    wanted = wanted_of(*declared, state_->size, request.occlusion.precision);
    for (const Wanted& one : wanted) {
      auto buffer = HostBuffer::create(state_->gpu.device(),
                                       VkDeviceSize{state_->size.width} * state_->size.height *
                                           texel_bytes(graph.format(one.texture)),
                                       VK_BUFFER_USAGE_TRANSFER_DST_BIT);
      if (!buffer) {
        return Failure(std::move(buffer.error()));
      }
      add_read_back(graph, one.texture, **buffer);
      buffers.push_back(std::move(*buffer));
    }
    return {};
  });
  if (!report) {
    return Failure(std::move(report.error()));
  }
  FrameImages images;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    wanted[i].store(*buffers[i], images);
  }
  state_->turn_to_world(request, images);
  return images;
}

const framegraph::MemoryStatistics& FrameRenderer::memory() const { return state_->memory; }

}  // namespace alcove::sample
