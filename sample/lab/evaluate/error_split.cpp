#include "evaluate/error_split.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "alcove/passes/setting_table.h"
#include "evaluate/errors.h"
#include "support/image_io.h"
#include "support/progress.h"

namespace alcove::sample {
namespace {

double mean_squared_error(const Image<float>& image, const Image<float>& truth, const Mask& mask) {
  const double rmse = compare_images(image, truth, mask).rmse;
  return rmse * rmse;
}

// The error's limit for the given model of occluders: nothing is interpolated, and samples are
// many.
OcclusionSettings sampled_fully(OcclusionSettings settings) {
  settings.tile_size = 1;
  settings.half_resolution = false;
  settings.slices = std::max(settings.slices, 8u);
  settings.steps = std::max(settings.steps, 16u);
  settings.history_frames = std::max(settings.history_frames, 32u);
  return settings;
}
constexpr std::uint32_t kAveragedFrames = 8;

// Applies one remedy after the other.
class Splitter {
 public:
  Splitter(Gpu& gpu, const Scene& scene, const Image<float>& truth, const Mask& surfaces)
      : gpu_(gpu), scene_(scene), truth_(truth), surfaces_(surfaces) {}

  Result<ErrorSplit> split(const StaticSetup& setup, const OcclusionSettings& settings);

 private:
  // `guard_band`, in pixels, replaces that of the setup.
  Result<Image<float>> draw(const StaticSetup& setup, const OcclusionSettings& settings,
                            std::optional<VkExtent2D> guard_band = {});
  Result<void> add_noise(const StaticSetup& setup, const OcclusionSettings& settings);
  // Adds a cause whose remedy changes the current visibility to `after`. Returns whether it lowers
  // the error.
  bool add(const char* key, const char* name, Image<float> after);

  Gpu& gpu_;
  const Scene& scene_;
  const Image<float>& truth_;
  const Mask& surfaces_;
  ErrorSplit split_;
  Image<float> current_;
  double current_error_ = 0;  // mean squared
  double whole_error_ = 0;    // mean squared, of the given settings
  int drawn_ = 0;
  Progress progress_ = print_progress("causes of the error");
};

Result<Image<float>> Splitter::draw(const StaticSetup& setup, const OcclusionSettings& settings,
                                    std::optional<VkExtent2D> guard_band) {
  constexpr int kDrawings = 6;
  progress_(static_cast<double>(drawn_++) / kDrawings);
  return draw_static(gpu_, scene_, setup, settings, guard_band).map([](FrameImages images) {
    return std::move(images.visibility);
  });
}

Result<void> Splitter::add_noise(const StaticSetup& setup, const OcclusionSettings& settings) {
  ALCOVE_TRY(const Image<float> own, draw(setup, settings));
  StaticSetup other_setup = setup;
  // An odd number of frames, after which the golden pattern has turned the directions by a quarter
  // of their period (and by .19 if it moves), so that the noise of both is hardly correlated.
  other_setup.first_frame += 1023;
  ALCOVE_TRY(const Image<float> other, draw(other_setup, settings));
  const double noise = 0.5 * mean_squared_error(own, other, surfaces_);
  whole_error_ = std::max(mean_squared_error(own, truth_, surfaces_), 1e-12);
  split_.rmse = std::sqrt(whole_error_);
  current_error_ = whole_error_ - noise;
  current_ = mapped([](float a, float b) { return 0.5f * (a + b); }, other, own);
  split_.causes.push_back({"noise", "noise", noise / whole_error_, own, current_});
  return {};
}

bool Splitter::add(const char* key, const char* name, Image<float> after) {
  const double error = mean_squared_error(after, truth_, surfaces_);
  const bool lowers = error < current_error_;
  split_.causes.push_back({key, name, (current_error_ - error) / whole_error_, current_, after});
  if (lowers) {
    current_error_ = error;
    current_ = std::move(after);
  }
  return lowers;
}

Result<ErrorSplit> Splitter::split(const StaticSetup& setup, const OcclusionSettings& settings) {
  ALCOVE_TRY_VOID(add_noise(setup, settings));
  StaticSetup averaged = setup;
  averaged.frames = kAveragedFrames;
  OcclusionSettings best = sampled_fully(settings);
  const auto try_settings = [&](const char* key, const char* name,
                                const OcclusionSettings& changed) -> Result<void> {
    if (!passes::validate(changed)) {  // an estimator without thickness
      split_.causes.push_back({key, name, 0.0, current_, current_});
      return {};
    }
    ALCOVE_TRY(Image<float> drawn, draw(averaged, changed));
    best = add(key, name, std::move(drawn)) ? changed : best;
    return {};
  };
  ALCOVE_TRY_VOID(try_settings("sampling", "filter, tiles and few steps", best));
  OcclusionSettings layers = best;
  layers.depth_layers = 2;
  ALCOVE_TRY_VOID(try_settings("layer", "hidden surfaces, which a second layer shows", layers));
  OcclusionSettings back_faces = best;
  back_faces.thickness_limit = ALCOVE_THICKNESS_LIMIT_BACK_FACES;
  ALCOVE_TRY_VOID(try_settings("back_faces", "thickness, which back faces tell", back_faces));
  ALCOVE_TRY(Image<float> wide,
             draw(averaged, best, VkExtent2D{setup.width / 2, setup.height / 2}));
  add("outside", "occluders outside the image", std::move(wide));
  split_.causes.push_back({"rest", "the rest", current_error_ / whole_error_, current_, truth_});
  return std::move(split_);
}

}  // namespace

Result<ErrorSplit> split_error(Gpu& gpu, const Scene& scene, const StaticSetup& setup,
                               const OcclusionSettings& settings, const Image<float>& truth,
                               const Mask& surfaces) {
  return Splitter(gpu, scene, truth, surfaces).split(setup, settings);
}

std::string format_table(const ErrorSplit& split) {
  std::string out = fmt::format("Causes of the squared error, RMSE {:.4f}\n", split.rmse);
  for (const ErrorCause& cause : split.causes) {
    out += fmt::format("  {:46}{:7.1f} %{}\n", cause.name, 100.0 * cause.share,
                       cause.share < 0 ? ": more error, so it is not used below" : "");
  }
  return out;
}

nlohmann::ordered_json to_json(const ErrorSplit& split) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ErrorCause& cause : split.causes)
    list.push_back({{"cause", cause.key}, {"share", cause.share}});
  return list;
}

Image<glm::vec3> cause_picture(const ErrorCause& cause) {
  return error_colours(cause.before, cause.after);
}

Result<void> write_pictures(const ErrorSplit& split, const std::filesystem::path& folder) {
  for (const ErrorCause& cause : split.causes)
    ALCOVE_TRY_VOID(write_png(folder / ("split_" + cause.key + ".png"), cause_picture(cause)));
  return {};
}

}  // namespace alcove::sample
