#include "evaluate/situations.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "evaluate/errors.h"
#include "render/settings_json.h"
#include "support/median.h"

namespace alcove::sample {
namespace {

constexpr std::uint32_t kMovingFrames = 16;  // of the orbit

// A hash of the running program, because the shaders that it contains determine the times; empty if
// the system does not give its file.
std::string program_hash() {
  static const std::string hash = [] {
    std::ifstream file("/proc/self/exe", std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    CacheKey key;
    key.add(std::string_view(bytes));
    return bytes.empty() ? std::string() : key.hex();
  }();
  return hash;
}

// The settings that determine the time. Radius, thickness and hidden occlusion are parameters of
// the shaders; the model's searches have a fixed length.
OcclusionSettings timed_settings(OcclusionSettings settings) {
  const OcclusionSettings defaults;
  settings.radius = defaults.radius;
  settings.thickness = defaults.thickness;
  settings.hidden_occlusion = defaults.hidden_occlusion;
  return settings;
}

// Reads three values from the cache, or computes and writes them.
template <typename Compute>
Result<std::array<double, 3>> cached(const TruthCache& cache, const CacheKey& key,
                                     const Compute& compute) {
  std::array<double, 3> values{};
  if (const auto known = cache.read(key, values.size())) {
    std::ranges::copy(*known, values.begin());
    return values;
  }
  Result<std::array<double, 3>> computed = compute();
  if (computed) {
    const std::vector<float> floats(computed->begin(), computed->end());
    cache.write(key, floats);
    std::ranges::copy(floats, values.begin());  // as a later run reads them
    return values;
  }
  return computed;
}

}  // namespace

Result<SituationErrors> SituationErrors::create(const Session& session, const StaticSetup& setup,
                                                const TruthOptions& truth_options) {
  SituationErrors errors(session, setup);
  ALCOVE_TRY(FrameRenderer* const renderer, errors.renderer(0.0));
  ALCOVE_TRY(const auto images, renderer->draw_and_read(frame_request(setup, session.settings, 0)));
  ALCOVE_TRY(errors.truths_, compute_truths({session.scene, setup.camera, session.settings.radius,
                                             images.depth_ndc, images.normal_ws},
                                            truth_options));
  if (truth_options.use_cache && !program_hash().empty())
    errors.cache_ = TruthCache(TruthCache::default_folder());
  const VkPhysicalDeviceProperties& device = session.gpu->device().properties();
  errors.key_.add(std::string_view("situation errors"), std::string_view(program_hash()),
                  std::string_view(device.deviceName), device.driverVersion, session.scene,
                  setup.camera, setup.width, setup.height, setup.frames,
                  static_cast<std::uint8_t>(setup.normals), truth_options.spp);
  return errors;
}

Result<FrameRenderer*> SituationErrors::renderer(double guard_band) {
  std::unique_ptr<FrameRenderer>& renderer = renderers_[guard_band];
  if (!renderer) {
    ViewRequest view = setup_;
    view.guard_band = guard_band;
    // All choices show the same views: those of the orbit, and the static one. Their g-buffers are
    // kept if they are small.
    constexpr std::size_t kMostPixels = 4'000'000;
    const std::size_t views = kMovingFrames + 1;
    const bool kept = views * view.width * view.height <= kMostPixels;
    ALCOVE_TRY(renderer,
               FrameRenderer::create(*session_->gpu, session_->scene, view, kept ? views : 1));
  }
  return renderer.get();
}

Result<Image<float>> SituationErrors::draw(const Choice& choice, std::uint32_t frames,
                                           float orbit) {
  StaticSetup setup = setup_;
  setup.frames = frames;
  setup.orbit = orbit;
  ALCOVE_TRY(FrameRenderer* const drawn, renderer(choice.guard_band));
  return draw_frames(*drawn, setup, choice.settings).map([&](const FrameImages& images) {
    return images.visibility;
  });
}

Result<std::array<double, 3>> SituationErrors::measure(const Choice& choice) {
  CacheKey key = key_;
  key.add(std::string_view(to_json(choice.settings).dump()), choice.guard_band);
  return cached(cache_, key, [&] { return compute(choice); });
}

Result<std::array<double, 3>> SituationErrors::compute(const Choice& choice) {
  struct Course {
    std::uint32_t frames;
    float orbit;
  };
  const std::array<Course, 3> courses{{{1, 0.0f}, {kMovingFrames, kOrbit}, {setup_.frames, 0.0f}}};
  std::array<double, 3> rmse{};
  for (std::size_t i = 0; i < courses.size(); ++i) {
    ALCOVE_TRY(const auto visibility, draw(choice, courses[i].frames, courses[i].orbit));
    rmse[i] = compare_images(visibility, truths_.scene.visibility, truths_.surfaces).rmse;
  }
  return rmse;
}

Result<SettingTimes> modelled_times(const GpuPart& part, const CostInputs& view, bool use_cache) {
  ALCOVE_TRY(const NullDevice device, create_null_device(part.family));
  const TruthCache cache(use_cache && !program_hash().empty() ? TruthCache::default_folder()
                                                              : std::filesystem::path());
  return [&part, view, device, cache](const Choice& choice) -> Result<std::array<double, 3>> {
    CostInputs inputs = view;
    inputs.guard_band = guard_band_pixels(choice.guard_band, inputs.height);
    inputs.settings = timed_settings(choice.settings);
    CacheKey key;
    key.add(std::string_view("modelled times"), std::string_view(program_hash()), part.family,
            inputs.width, inputs.height, inputs.normals, inputs.motion, inputs.guard_band,
            std::string_view(to_json(inputs.settings).dump()));
    return cached(cache, key, [&]() -> Result<std::array<double, 3>> {
      ALCOVE_TRY(const auto frames, modelled_frames(part, device, inputs));
      constexpr std::array<FrameState, 3> kStates{FrameState::first, FrameState::moving,
                                                  FrameState::converged};
      std::array<double, 3> ms{};
      for (std::size_t i = 0; i < kStates.size(); ++i) {
        ms[i] = std::ranges::find(frames, kStates[i], &ModelledFrame::state)->milliseconds();
      }
      return ms;
    });
  };
}

SettingTimes measured_times(const Session& session, const StaticSetup& view, Clock clock,
                            double scale) {
  return [&session, view, clock, scale](const Choice& choice) -> Result<std::array<double, 3>> {
    constexpr std::uint32_t kWarmUp = 4;  // frames that compile shaders
    constexpr std::uint32_t kTimed = 11;
    StaticSetup setup = view;
    setup.guard_band = choice.guard_band;
    setup.frames = kWarmUp + kTimed;
    ALCOVE_TRY(const auto renderer, FrameRenderer::create(*session.gpu, session.scene, setup));
    std::array<double, 3> medians{};
    for (const Situation situation : {Situation::first, Situation::moving, Situation::standing}) {
      setup.orbit = situation == Situation::moving ? kOrbit : 0.0f;
      std::vector<double> times;
      for (std::uint32_t i = 0; i < setup.frames; ++i) {
        const std::uint32_t frame = situation == Situation::first ? 0 : i;
        ALCOVE_TRY(const FrameCost cost,
                   renderer->draw(frame_request(setup, choice.settings, frame)));
        if (i >= kWarmUp)
          times.push_back(scale * (clock == Clock::processor ? cost.cpu_ms : cost.occlusion_ms));
      }
      medians[static_cast<std::size_t>(situation)] = median(std::move(times));
    }
    if (!(*std::ranges::min_element(medians) > 0.0)) {
      return Failure("The device " + std::string(session.gpu->device().properties().deviceName) +
                     " does not time its passes; give --clock processor, or another --device.");
    }
    return medians;
  };
}

}  // namespace alcove::sample
