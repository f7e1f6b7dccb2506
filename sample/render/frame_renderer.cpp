#include "render/frame_renderer.h"

#include <algorithm>
#include <ctime>
#include <utility>

namespace alcove::sample {
namespace {

// Returns the processor time that all threads of the process have used so far, in milliseconds.
double processor_ms() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}

}  // namespace

Result<std::unique_ptr<GpuImage>> FrameRenderer::create_target(VkFormat format) {
  const VkImageUsageFlags attachment = format == kDepthFormat
                                           ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT
                                           : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  return GpuImage::create(
      gpu_.device(),
      {format, framegraph::Extent::absolute(size_.width + 2 * guard_band_.width,
                                            size_.height + 2 * guard_band_.height)},
      attachment | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
}

bool FrameRenderer::is_drawn(const GbufferTarget& target, const HiddenDepths& hidden) {
  return (target.texture != &Gbuffer::back_depth || hidden.back_faces) &&
         (target.texture != &Gbuffer::second_depth || hidden.second_layer);
}

void FrameRenderer::append_times(FrameCost& cost, bool occlusion) {
  for (const framegraph::PassTiming& timing : gpu_.timings()) {
    cost.gpu.push_back({std::string(timing.name), timing.milliseconds});
    if (occlusion) cost.occlusion_ms += timing.milliseconds;
  }
}

Result<void> FrameRenderer::draw_gbuffer(const FrameRequest& request, FrameCost& cost) {
  const HiddenDepths hidden = hidden_depths_of(request.occlusion);
  const auto same = std::ranges::find(stored_, request.view, &StoredGbuffer::view);
  const bool first = !stored_.front().view;
  if (same != stored_.end())
    current_ = static_cast<std::size_t>(same - stored_.begin());
  else if (!first)
    current_ = (current_ + 1) % stored_.size();
  StoredGbuffer& stored = stored_[current_];
  if (same != stored_.end() && stored.depths.covers(hidden)) {
    cost.gpu = stored.times;
    return {};
  }
  for (std::size_t i = 0; i < stored.targets.size(); ++i) {
    if (is_drawn(kGbufferTargets[i], hidden) && !stored.targets[i]) {
      ALCOVE_TRY(stored.targets[i], create_target(kGbufferTargets[i].format));
    }
  }
  const auto declare = [&](Graph& graph) -> Result<void> {
    Gbuffer gbuffer;
    for (std::size_t i = 0; i < stored.targets.size(); ++i)
      if (is_drawn(kGbufferTargets[i], hidden))
        gbuffer.*kGbufferTargets[i].texture =
            graph.import_texture("g-buffer", stored.targets[i]->import_to_fill(kSampledState));
    (void)gbuffer_->add(graph, request.view, gbuffer);
    return {};
  };
  // The first drawing also compiles shaders, so that only a second one is timed.
  for (int i = first ? 0 : 1; i < 2; ++i) ALCOVE_TRY_VOID(gpu_.run(declare));
  append_times(cost, false);
  stored.view = request.view;
  stored.depths = hidden;
  stored.times = cost.gpu;
  return {};
}

Result<FrameRenderer::DeclaredFrame> FrameRenderer::declare_occlusion(Graph& graph,
                                                                      const FrameRequest& request) {
  const HiddenDepths hidden = hidden_depths_of(request.occlusion);
  const std::vector<float> roughness =
      request.light != nullptr ? request.light->roughness : std::vector<float>();
  Surfaces surfaces{.normals = normals_, .motion_vectors = request.motion_vectors};
  const StoredGbuffer& stored = stored_[current_];
  for (std::size_t i = 0; i < stored.targets.size(); ++i) {
    if (is_drawn(kGbufferTargets[i], hidden)) {
      surfaces.gbuffer.*kGbufferTargets[i].texture =
          graph.import_texture("g-buffer", stored.targets[i]->import_to_read(kSampledState));
    }
  }
  if (!roughness.empty()) surfaces.roughness = roughness.front();
  if (request.index == 0 || request.restart) graph.reset_histories();
  DeclaredFrame declared{surfaces, {}, {}};
  const auto add = [&](std::uint32_t id, bool multi_bounce) {
    return add_occlusion(graph, gpu_, view_info(request.view, id, request.static_frames),
                         request.index, surfaces, request.occlusion, multi_bounce);
  };
  ALCOVE_TRY(declared.outputs, add(0, request.light != nullptr && request.occlusion.bent_normal));
  if (declared.outputs.specular) declared.specular_occlusion.push_back(declared.outputs.specular);
  // Specular occlusion for each further roughness value runs all occlusion passes again, with its
  // own history.
  for (std::size_t i = 1; i < roughness.size() && declared.outputs.specular; ++i) {
    surfaces.roughness = roughness[i];
    ALCOVE_TRY(const auto more, add(static_cast<std::uint32_t>(i), false));
    declared.specular_occlusion.push_back(more.specular);
  }
  return declared;
}

void FrameRenderer::read_occlusion(Graph& graph, const DeclaredFrame& declared, ReadBack& read_back,
                                   FrameImages& images) {
  const Gbuffer& gbuffer = declared.surfaces.gbuffer;
  const Occlusion& outputs = declared.outputs;
  const auto read = [&](Texture texture, std::function<void(const Texels&)> store) {
    read_back.add(graph, texture, std::move(store));
  };
  read(gbuffer.depth, [&](const Texels& t) { images.depth_ndc = channel(t, 0); });
  read(outputs.normals, [&](const Texels& t) { images.normal_ws = rgb(t); });
  read(gbuffer.albedo, [&](const Texels& t) {
    images.albedo = rgb(t);
    images.roughness = channel(t, 3);
  });
  read(gbuffer.emissive, [&](const Texels& t) { images.metallic = channel(t, 3); });
  read(outputs.visibility, [&](const Texels& t) { images.visibility = channel(t, 0); });
  read(outputs.bent_normal, [&](const Texels& t) { images.bent_normal_ws = rgb(t); });
  read(outputs.multi_bounce, [&](const Texels& t) { images.multi_bounce = rgb(t); });
  for (const Texture specular : declared.specular_occlusion)
    read(specular, [&](const Texels& t) { images.specular_occlusion.push_back(channel(t, 0)); });
}

// Adds the lighting of the surfaces. Emission is left out, because the ray-traced reference does
// not have it.
void FrameRenderer::declare_light(Graph& graph, const FrameRequest& request,
                                  const DeclaredFrame& declared, const Light& light,
                                  ReadBack& read_back, FrameImages& images) {
  const Occlusion& outputs = declared.outputs;
  const Texture environment = light.import(graph);
  const auto add = [&](const LightOcclusion& occlusion, Image<glm::vec3> LitImages::*image) {
    const Lit lit =
        light.add(graph, environment, request.view, declared.surfaces, outputs.normals, occlusion);
    read_back.add(graph, lit.all,
                  [&images, image](const Texels& t) { images.lit.*image = rgb(t); });
    return lit;
  };
  const LightOcclusion all{outputs.visibility, outputs.bent_normal,
                           declared.specular_occlusion.front(), true};
  const Lit lit = add(all, &LitImages::all);
  read_back.add(graph, lit.diffuse, [&](const Texels& t) { images.lit.diffuse = rgb(t); });
  read_back.add(graph, lit.specular, [&](const Texels& t) { images.lit.specular = rgb(t); });
  if (!request.light->lit_steps) return;
  add({}, &LitImages::unoccluded);
  add({outputs.visibility}, &LitImages::unbent);
  add({outputs.visibility, outputs.bent_normal}, &LitImages::occluded);
  add({outputs.visibility, outputs.bent_normal, outputs.visibility, true}, &LitImages::bounced);
}

Result<std::unique_ptr<FrameRenderer>> FrameRenderer::create(Gpu& gpu, const Scene& scene,
                                                             const ViewRequest& view,
                                                             std::size_t kept_views,
                                                             std::optional<VkExtent2D> guard_band) {
  const std::uint32_t band = guard_band_pixels(view.guard_band, view.height);
  std::unique_ptr<FrameRenderer> made(
      new FrameRenderer(gpu, {view.width, view.height}, view.normals, kept_views,
                        guard_band.value_or(VkExtent2D{band, band})));
  ALCOVE_TRY(made->gbuffer_,
             GbufferRenderer::create(gpu, scene, view.normals == NormalSource::geometric));
  return made;
}

Result<FrameCost> FrameRenderer::draw(const FrameRequest& shown) {
  const FrameRequest request = with_band(shown);
  FrameCost cost;
  ALCOVE_TRY_VOID(draw_gbuffer(request, cost));
  const double before = processor_ms();
  const auto declare = [&](Graph& graph) -> Result<void> {
    ALCOVE_TRY(const auto declared, declare_occlusion(graph, request));
    graph.output(declared.outputs.visibility);
    if (request.occlusion.bent_normal) graph.output(declared.outputs.bent_normal);
    for (const Texture specular : declared.specular_occlusion) graph.output(specular);
    return {};
  };
  ALCOVE_TRY(const auto report, gpu_.run(declare));
  cost.cpu_ms = processor_ms() - before;
  memory_ = report.memory;
  append_times(cost, true);
  return cost;
}

Result<FrameImages> FrameRenderer::draw_and_read(const FrameRequest& shown) {
  const FrameRequest request = with_band(shown);
  FrameCost ignored;
  ALCOVE_TRY_VOID(draw_gbuffer(request, ignored));
  std::unique_ptr<Light> light;
  if (request.light != nullptr && !request.light->environment.empty()) {
    ALCOVE_TRY(light, Light::create(gpu_, request.light->environment));
  }
  FrameImages images;
  ReadBack read_back(gpu_.device(), guard_band_);
  const auto declare = [&](Graph& graph) -> Result<void> {
    ALCOVE_TRY(const auto declared, declare_occlusion(graph, request));
    read_occlusion(graph, declared, read_back, images);
    if (light && declared.outputs.bent_normal)
      declare_light(graph, request, declared, *light, read_back, images);
    return read_back.added();
  };
  ALCOVE_TRY_VOID(gpu_.run(declare));
  read_back.finish();
  // Eight bits hold no exact unit vectors.
  if (request.occlusion.precision == ALCOVE_PRECISION_UNORM8)
    for (glm::vec3& bent : images.bent_normal_ws.pixels) bent = glm::normalize(bent);
  // Normals that are computed from depth are in view space, with their bent normals.
  if (normals_ == NormalSource::depth) {
    const glm::mat3 world_from_view = glm::transpose(glm::mat3(request.view.view_from_world));
    for (Image<glm::vec3>* image : {&images.normal_ws, &images.bent_normal_ws})
      for (glm::vec3& normal : image->pixels) normal = world_from_view * normal;
  }
  return images;
}

}  // namespace alcove::sample
