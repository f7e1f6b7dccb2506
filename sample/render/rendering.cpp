#include "render/rendering.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "render/display.h"
#include "scene/camera.h"
#include "support/image_io.h"
#include "support/median.h"
#include "support/progress.h"

namespace alcove::sample {
namespace {

// Number of frames, the last ones of a run, over which the median time is taken. At least one frame
// is drawn before them and is not timed, because the first frame also compiles shaders.
constexpr std::uint32_t kTimedFrames = 9;

// Returns the median times. Passes are identified by their index, because all frames of a run have
// the same passes.
Costs medians(const std::vector<FrameCost>& frames) {
  const auto over_frames = [&](auto value) {
    std::vector<double> values;
    values.reserve(frames.size());
    for (const FrameCost& frame : frames) values.push_back(value(frame));
    return median(std::move(values));
  };
  Costs costs;
  for (std::size_t i = 0; i < frames.back().gpu.size(); ++i) {
    const double time = over_frames([i](const FrameCost& frame) {
      return i < frame.gpu.size() ? frame.gpu[i].milliseconds : 0.0;
    });
    costs.passes.push_back({frames.back().gpu[i].pass, time});
  }
  costs.occlusion_ms = over_frames([](const FrameCost& frame) { return frame.occlusion_ms; });
  costs.cpu_ms = over_frames([](const FrameCost& frame) { return frame.cpu_ms; });
  return costs;
}

Camera frame_camera(const ViewRequest& request, const Camera& camera, std::uint32_t frame) {
  return orbited(camera, request.orbit * static_cast<float>(frame));
}

// Returns the method with which specular occlusion is drawn: `slices` if the settings have none.
AlcoveSpecular specular_model(const OcclusionSettings& settings) {
  return settings.specular == ALCOVE_SPECULAR_NONE ? ALCOVE_SPECULAR_SLICES : settings.specular;
}

// The outputs of a frame.
enum class Outputs : std::uint8_t {
  timed,         // visibility, and specular occlusion if the settings have it
  bent_normals,  // visibility, bent normals and multi-bounce
  all,
};

// The frames of a rendering. The camera orbits, and motion is relative to the previous frame.
// Reports progress: the fraction of all frames that have been drawn.
class Run {
 public:
  Run(FrameRenderer& renderer, const ViewRequest& request, const Camera& camera,
      const OcclusionSettings& settings, const IndirectRequest& light)
      : renderer_(renderer),
        request_(request),
        camera_(camera),
        settings_(settings),
        light_(light) {
    if (!light.roughness.empty()) timed_light_.roughness = {light.roughness.front()};
  }

  // Draws the frames and returns the median times of the last kTimedFrames frames. If the run is
  // shorter, its last frame is drawn several times.
  Result<Costs> time() {
    std::vector<FrameCost> costs;
    for (std::uint32_t i = 0; i < timed_frames_; ++i) {
      ALCOVE_TRY(auto cost,
                 renderer_.draw(request(std::min(i, request_.frames - 1), Outputs::timed)));
      count();
      if (i + kTimedFrames >= timed_frames_) costs.push_back(std::move(cost));
    }
    return medians(costs);
  }

  // Returns the images of the last frame. With specular occlusion, slices are rotated towards the
  // GGX lobe, which makes visibility noisier. If the settings have no specular occlusion,
  // visibility is therefore taken from a second run without it, which is also the run that is
  // timed.
  Result<FrameImages> draw() {
    auto all = draw(Outputs::all);
    if (!all || one_run_) return all;
    auto images = draw(Outputs::bent_normals);
    if (images) {
      images->specular_occlusion = std::move(all->specular_occlusion);
      images->lit = std::move(all->lit);
    }
    return images;
  }

 private:
  FrameRequest request(std::uint32_t frame, Outputs outputs) const {
    FrameRequest request;
    request.view = gbuffer_view(frame_camera(request_, camera_, frame),
                                frame_camera(request_, camera_, std::max(frame, 1u) - 1),
                                {request_.width, request_.height});
    request.index = frame;
    request.static_frames = request_.orbit == 0.0f ? frame : 0;
    request.occlusion = settings_;
    if (outputs == Outputs::all) request.occlusion.specular = specular_model(settings_);
    if (outputs != Outputs::timed) request.occlusion.bent_normal = true;
    request.light = outputs == Outputs::all ? &light_ : &timed_light_;
    return request;
  }

  Result<FrameImages> draw(Outputs outputs) {
    for (std::uint32_t i = 0; i + 1 < request_.frames; ++i) {
      ALCOVE_TRY_VOID(renderer_.draw(request(i, outputs)));
      count();
    }
    return renderer_.draw_and_read(request(request_.frames - 1, outputs));
  }

  void count() {
    const std::uint32_t total = timed_frames_ + (one_run_ ? 1 : 2) * (request_.frames - 1);
    progress_(static_cast<double>(++drawn_) / total);
  }

  FrameRenderer& renderer_;
  const ViewRequest& request_;
  Camera camera_;
  OcclusionSettings settings_;
  const IndirectRequest& light_;
  bool one_run_ = settings_.specular == specular_model(settings_);
  std::uint32_t timed_frames_ = std::max(request_.frames, kTimedFrames + 1);
  IndirectRequest timed_light_;  // one roughness, and no light
  Progress progress_ = print_progress("frames");
  std::uint32_t drawn_ = 0;
};

}  // namespace

Result<Rendering> render(Session session, const ViewRequest& request, IndirectRequest light) {
  Rendering result;
  result.scene = std::move(session.scene);
  result.load_seconds = session.load_seconds;
  result.settings = session.settings;
  result.light = std::move(light);
  Gpu& gpu = *session.gpu;
  result.device = gpu.device().properties().deviceName;
  result.driver = gpu.device().driver();

  result.camera = frame_camera(request, session.camera, request.frames - 1);
  ALCOVE_TRY(const auto renderer, FrameRenderer::create(gpu, result.scene, request));
  Run run(*renderer, request, session.camera, result.settings, result.light);
  ALCOVE_TRY(result.costs, run.time());
  result.memory = renderer->memory();
  ALCOVE_TRY(result.images, run.draw());
  ALCOVE_TRY_VOID(check_validation(gpu));
  return result;
}

Image<float> linear_depth(const Rendering& rendering) {
  return linear_depth(rendering.camera, rendering.images.depth_ndc);
}

bool shows_surfaces(const Rendering& rendering) {
  const Image<float> depth = linear_depth(rendering);
  return std::ranges::any_of(depth.pixels, [](float z) { return std::isfinite(z); });
}

Image<glm::vec3> with_sky(const Rendering& rendering, Image<glm::vec3> picture) {
  const Camera& camera = rendering.camera;
  const Image<float> depth = linear_depth(rendering);
  const CameraMatrices matrices = camera_matrices(camera, picture.width, picture.height);
  for (std::uint32_t y = 0; y < picture.height; ++y) {
    for (std::uint32_t x = 0; x < picture.width; ++x) {
      if (!std::isfinite(depth.at(x, y))) {
        const Ray ray = camera_ray(matrices, camera.orthographic,
                                   {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f},
                                   picture.width, picture.height);
        picture.at(x, y) = radiance(rendering.light.environment, ray.direction_ws);
      }
    }
  }
  return picture;
}

namespace {

// Converts directions to colours: each component from -1..1 to 0..1.
Image<glm::vec3> as_colours(const Image<glm::vec3>& directions) {
  return mapped([](glm::vec3 direction) { return direction * 0.5f + 0.5f; }, directions);
}

// Writes images to a folder, until one cannot be written.
struct ImageWriter {
  const std::filesystem::path& folder;
  Result<void> written;

  template <typename Pixel>
  void exr(const std::string& name, const Image<Pixel>& image) {
    written = written.and_then([&] { return write_exr(folder / (name + ".exr"), image); });
  }
  template <typename Pixel>
  void png(const std::string& name, const Image<Pixel>& image) {
    written = written.and_then([&] { return write_png(folder / (name + ".png"), image); });
  }
  template <typename Pixel>
  void both(const std::string& name, const Image<Pixel>& image) {
    exr(name, image);
    png(name, image);
  }
};

// Returns the file name, without its extension, of the specular occlusion of index `i`:
// specular_occlusion, followed by for example _r30 if several roughness values were requested.
std::string specular_name(const IndirectRequest& light, std::size_t i) {
  std::string name = "specular_occlusion";
  if (light.roughness.size() > 1) name.append("_").append(roughness_name(light, i));
  return name;
}

}  // namespace

std::string roughness_name(const IndirectRequest& light, std::size_t i) {
  if (light.roughness.empty()) return "materials";
  std::array<char, 32> percent{};
  std::snprintf(percent.data(), percent.size(), "r%02g", 100.0 * light.roughness[i]);
  return percent.data();
}

Result<void> write_images(const Rendering& rendering, const std::filesystem::path& folder) {
  const FrameImages& images = rendering.images;
  const LitImages& lit = images.lit;
  const float exposure = exposure_of(rendering.light.environment);
  ImageWriter writer{folder, {}};
  writer.both("ao", images.visibility);
  writer.exr("bent_normal", images.bent_normal_ws);
  writer.png("bent_normal", as_colours(images.bent_normal_ws));
  writer.both("multi_bounce", images.multi_bounce);
  for (std::size_t i = 0; i < images.specular_occlusion.size(); ++i)
    writer.both(specular_name(rendering.light, i), images.specular_occlusion[i]);
  writer.exr("lit", lit.all);
  writer.png("lit", display_colours(lit.all, exposure));
  writer.png("lit_diffuse", display_colours(lit.diffuse, exposure));
  writer.png("lit_specular", display_colours(lit.specular, exposure));
  writer.exr("depth", linear_depth(rendering));
  writer.exr("normal", images.normal_ws);
  writer.png("normal", as_colours(images.normal_ws));
  writer.png("albedo", images.albedo);
  return writer.written;
}

}  // namespace alcove::sample
