#include "render/rendering.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "render/display.h"
#include "render/session.h"
#include "scene/camera.h"
#include "support/image_io.h"
#include "support/median.h"
#include "support/progress.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

// Number of frames, the last ones of a run, over which the median time is taken. At least one frame
// is drawn before them and is not timed, because the first frame also compiles shaders.
constexpr std::uint32_t kTimedFrames = 9;

// Returns the median times. Passes are identified by their index, because all frames of a run have
// the same passes.
Costs medians(const std::vector<FrameCost>& frames) {
  const auto over_frames = [&](auto value) {
    std::vector<double> values;
    values.reserve(frames.size());
    for (const FrameCost& frame : frames) {
      values.push_back(value(frame));
    }
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

// The outputs of a frame.
enum class Outputs : std::uint8_t {
  kVisibility,   // visibility, and specular occlusion if the settings have it
  kSpecular,     // also specular occlusion
  kBentNormals,  // visibility, bent normals and multi-bounce
  kAll,
};

// The requests for the frames of a run, by frame number. The camera orbits, and motion is relative
// to the previous frame.
class Run {
 public:
  Run(const RenderRequest& request, const Camera& camera, const passes::OcclusionSettings& settings)
      : request_(request), camera_(camera), settings_(settings) {
    if (!request.light.roughness.empty()) {
      timed_light_.roughness = {request.light.roughness.front()};
    }
  }

  std::uint32_t frames() const { return request_.frames; }

  Camera camera(std::uint32_t frame) const {
    return orbited(camera_, request_.orbit_start + request_.orbit * static_cast<float>(frame));
  }

  FrameRequest request(std::uint32_t frame, Outputs outputs) const {
    const CameraMatrices now = matrices(frame);
    const CameraMatrices before = matrices(frame == 0 ? 0 : frame - 1);
    FrameRequest request;
    request.view = {now.view_from_world, now.clip_from_view, before.view_from_world,
                    before.clip_from_view, camera_.reversed_z};
    request.index = frame;
    request.static_frames = request_.orbit == 0.0f ? frame : 0;
    request.occlusion = settings_;
    if (outputs == Outputs::kSpecular || outputs == Outputs::kAll) {
      request.occlusion.specular = specular_model(settings_);
    }
    if (outputs == Outputs::kBentNormals || outputs == Outputs::kAll) {
      request.occlusion.bent_normal = true;
    }
    request.light = outputs == Outputs::kAll ? &request_.light : &timed_light_;
    return request;
  }

 private:
  CameraMatrices matrices(std::uint32_t frame) const {
    return camera_matrices(camera(frame), request_.width, request_.height);
  }

  const RenderRequest& request_;
  Camera camera_;
  passes::OcclusionSettings settings_;
  IndirectRequest timed_light_;  // one roughness, and no light
};

// Reports progress: the fraction of all frames that have been drawn.
class FrameCounter {
 public:
  explicit FrameCounter(std::uint32_t total) : total_(total) {}
  void count() { progress_(static_cast<double>(++drawn_) / total_); }

 private:
  Progress progress_ = print_progress("frames");
  std::uint32_t drawn_ = 0;
  std::uint32_t total_;
};

std::uint32_t timed_frames(const Run& run) { return std::max(run.frames(), kTimedFrames + 1); }

// Draws the frames of a run and returns the median times of the last kTimedFrames frames. If the
// run is shorter, its last frame is drawn several times.
tl::expected<Costs, std::string> time_run(FrameRenderer& renderer, const Run& run, Outputs outputs,
                                          FrameCounter& counter) {
  std::vector<FrameCost> costs;
  const std::uint32_t drawn = timed_frames(run);
  for (std::uint32_t i = 0; i < drawn; ++i) {
    auto cost = renderer.draw(run.request(std::min(i, run.frames() - 1), outputs));
    if (!cost) {
      return Failure(std::move(cost.error()));
    }
    counter.count();
    if (i + kTimedFrames >= drawn) {
      costs.push_back(std::move(*cost));
    }
  }
  return medians(costs);
}

tl::expected<FrameImages, std::string> draw_run(FrameRenderer& renderer, const Run& run,
                                                Outputs outputs, FrameCounter& counter) {
  for (std::uint32_t i = 0; i + 1 < run.frames(); ++i) {
    if (auto cost = renderer.draw(run.request(i, outputs)); !cost) {
      return Failure(std::move(cost.error()));
    }
    counter.count();
  }
  return renderer.draw_and_read(run.request(run.frames() - 1, outputs));
}

// Returns the images of the last frame. With specular occlusion, slices are rotated towards the GGX
// lobe, which makes visibility noisier. If the settings have no specular occlusion, visibility is
// therefore taken from a second run without it, which is also the run that is timed.
tl::expected<FrameImages, std::string> draw_images(FrameRenderer& renderer, const Run& run,
                                                   bool one_run, FrameCounter& counter) {
  auto all = draw_run(renderer, run, Outputs::kAll, counter);
  if (!all || one_run) {
    return all;
  }
  auto images = draw_run(renderer, run, Outputs::kBentNormals, counter);
  if (images) {
    images->specular_occlusion = std::move(all->specular_occlusion);
    images->lit = std::move(all->lit);
  }
  return images;
}

}  // namespace

passes::Specular specular_model(const passes::OcclusionSettings& settings) {
  return settings.specular == passes::Specular::none ? passes::Specular::slices : settings.specular;
}

tl::expected<Rendering, std::string> render(Session session, const RenderRequest& request) {
  Rendering result;
  result.scene = std::move(session.scene);
  result.load_seconds = session.load_seconds;
  result.settings = session.settings;
  result.light = request.light;
  Gpu& gpu = *session.gpu;
  result.device = gpu.device().properties().deviceName;
  result.driver = gpu.device().driver();

  const Run run(request, session.camera, result.settings);
  result.camera = run.camera(run.frames() - 1);
  auto renderer =
      FrameRenderer::create(gpu, result.scene, {request.width, request.height}, request.normals);
  if (!renderer) {
    return Failure(std::move(renderer.error()));
  }
  const bool one_run = result.settings.specular == specular_model(result.settings);
  FrameCounter counter(2 * timed_frames(run) + (one_run ? 1 : 2) * (run.frames() - 1));
  auto costs = time_run(**renderer, run, Outputs::kVisibility, counter);
  if (!costs) {
    return Failure(std::move(costs.error()));
  }
  result.costs = std::move(*costs);
  result.memory = (*renderer)->memory();
  costs = time_run(**renderer, run, Outputs::kSpecular, counter);
  if (!costs) {
    return Failure(std::move(costs.error()));
  }
  result.costs_with_specular = std::move(*costs);
  auto images = draw_images(**renderer, run, one_run, counter);
  if (!images) {
    return Failure(std::move(images.error()));
  }
  result.images = std::move(*images);
  if (auto valid = check_validation(gpu); !valid) {
    return Failure(std::move(valid.error()));
  }
  return result;
}

Image<float> linear_depth(const Rendering& rendering) {
  return linear_depth(rendering.camera, rendering.images.depth_ndc);
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
  Image<glm::vec3> colours = directions;
  for (glm::vec3& colour : colours.pixels) {
    colour = colour * 0.5f + 0.5f;
  }
  return colours;
}

tl::expected<void, std::string> write_lit(const Rendering& rendering,
                                          const std::filesystem::path& folder) {
  const LitImages& lit = rendering.images.lit;
  const float exposure = exposure_of(rendering.light.environment);
  return write_exr(folder / "lit.exr", lit.all)
      .and_then([&] {
        return write_png(folder / "lit.png",
                         display_colours(with_sky(rendering, lit.all), exposure));
      })
      .and_then([&] {
        return write_png(folder / "lit_diffuse.png", display_colours(lit.diffuse, exposure));
      })
      .and_then([&] {
        return write_png(folder / "lit_specular.png", display_colours(lit.specular, exposure));
      });
}

tl::expected<void, std::string> write_light(const Rendering& rendering,
                                            const std::filesystem::path& folder) {
  const FrameImages& images = rendering.images;
  auto written = write_exr(folder / "multi_bounce.exr", images.multi_bounce).and_then([&] {
    return write_png(folder / "multi_bounce.png", images.multi_bounce);
  });
  for (std::size_t i = 0; written && i < images.specular_occlusion.size(); ++i) {
    const std::string name = specular_name(rendering.light, i);
    written = write_exr(folder / (name + ".exr"), images.specular_occlusion[i]).and_then([&] {
      return write_png(folder / (name + ".png"), images.specular_occlusion[i]);
    });
  }
  return written.and_then([&] { return write_lit(rendering, folder); });
}

}  // namespace

std::string roughness_name(const IndirectRequest& light, std::size_t i) {
  if (light.roughness.empty()) {
    return "materials";
  }
  std::array<char, 32> percent{};
  std::snprintf(percent.data(), percent.size(), "r%02g", 100.0 * light.roughness[i]);
  return percent.data();
}

std::string specular_name(const IndirectRequest& light, std::size_t i) {
  std::string name = "specular_occlusion";
  if (light.roughness.size() > 1) {
    name.append("_").append(roughness_name(light, i));
  }
  return name;
}

tl::expected<void, std::string> write_images(const Rendering& rendering,
                                             const std::filesystem::path& folder) {
  const FrameImages& images = rendering.images;
  return write_exr(folder / "ao.exr", images.visibility)
      .and_then([&] { return write_png(folder / "ao.png", images.visibility); })
      .and_then([&] { return write_exr(folder / "bent_normal.exr", images.bent_normal_ws); })
      .and_then(
          [&] { return write_png(folder / "bent_normal.png", as_colours(images.bent_normal_ws)); })
      .and_then([&] { return write_light(rendering, folder); })
      .and_then([&] { return write_exr(folder / "depth.exr", linear_depth(rendering)); })
      .and_then([&] { return write_exr(folder / "normal.exr", images.normal_ws); })
      .and_then([&] { return write_png(folder / "normal.png", as_colours(images.normal_ws)); })
      .and_then([&] { return write_png(folder / "albedo.png", images.albedo); });
}

}  // namespace alcove::sample
