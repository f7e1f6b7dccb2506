#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "commands/commands.h"
#include "commands/report.h"
#include "measure/ablation.h"
#include "measure/errors.h"
#include "measure/trial_errors.h"
#include "options/settings.h"
#include "render/stage.h"
#include "support/whole_file.h"
#include "support/mib.h"
#include "support/progress.h"
#include "truth/surface_points.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;
using Done = tl::expected<void, std::string>;
using Json = nlohmann::ordered_json;

// How far two images are apart that should look the same.
struct TwinsRow {
  std::string name;
  ErrorSummary difference;
};

// The mean of each block of `scale` pixels a side.
Image<float> shrunk(const Image<float>& image, std::uint32_t scale) {
  Image<float> small(image.width / scale, image.height / scale);
  for (std::uint32_t y = 0; y < small.height * scale; ++y) {
    for (std::uint32_t x = 0; x < small.width * scale; ++x) {
      small.pixels[(y / scale) * small.width + x / scale] +=
          image.pixels[y * image.width + x] / static_cast<float>(scale * scale);
    }
  }
  return small;
}

// Where both images show a surface; a block of pixels does where all of them do.
Mask common_surfaces(const Twins& twins, const FrameImages& images, const FrameImages& others) {
  const std::uint32_t scale = twins.scale;
  const Image<float> depth = linear_depth(twins.first, images.depth_ndc);
  const Image<float> other = linear_depth(twins.second, others.depth_ndc);
  Mask mask(depth.width, depth.height);
  for (std::uint32_t y = 0; y < depth.height * scale; ++y) {
    for (std::uint32_t x = 0; x < depth.width * scale; ++x) {
      const std::size_t i = (y / scale) * depth.width + x / scale;
      const float apart = other.at(x, y) - twins.further - depth.pixels[i];
      const bool here = std::isfinite(apart) && std::abs(apart) <= twins.tolerance;
      mask.pixels[i] = here && (mask.pixels[i] != 0 || (x % scale == 0 && y % scale == 0)) ? 1 : 0;
    }
  }
  return mask;
}

tl::expected<TwinsRow, std::string> run_twins(Gpu& gpu, const Stage& stage, const Options& options,
                                              const Twins& twins) {
  const StillSetup first = still_setup(options, twins.first);
  StillSetup second = still_setup(options, twins.second);
  second.width *= twins.scale;
  second.height *= twins.scale;
  const auto images = draw_still(gpu, stage.scene, first, stage.settings);
  if (!images) {
    return Failure(images.error());
  }
  const auto others = draw_still(gpu, stage.scene, second, stage.settings);
  if (!others) {
    return Failure(others.error());
  }
  return TwinsRow{twins.name,
                  compare_images(shrunk(others->visibility, twins.scale), images->visibility,
                                 common_surfaces(twins, *images, *others))};
}

std::string table_of(const std::vector<TrialErrors>& rows) {
  std::ostringstream out;
  out << "RMSE of visibility over " << rows.front().scene.count
      << " pixels, and cost beside the first row's\n"
      << "  " << std::left << std::setw(43) << "" << std::right
      << "scene truth   height field    bias   GPU   processor   MiB\n";
  std::string part;
  for (const TrialErrors& row : rows) {
    const bool begins = row.trial.part != part;
    part = row.trial.part;
    out << "  " << std::left << std::setw(11) << (begins ? part : "") << std::setw(32)
        << row.trial.name << std::right << std::fixed << std::setprecision(4) << std::setw(10)
        << row.scene.rmse << std::setw(15) << row.height_field.rmse << std::showpos << std::setw(10)
        << std::setprecision(3) << row.scene.bias << std::noshowpos << std::setprecision(2)
        << std::setw(6) << row.cost.gpu << std::setw(10) << row.cost.processor
        << std::setprecision(1) << std::setw(9) << mib(row.cost.bytes) << "\n";
  }
  return out.str();
}

std::string table_of(const std::vector<TwinsRow>& rows) {
  std::ostringstream out;
  out << "Difference of visibility where there should be none       RMS   95 % within    pixels\n"
      << std::fixed << std::setprecision(4);
  for (const TwinsRow& row : rows) {
    out << "  " << std::left << std::setw(50) << row.name << std::right << std::setw(10)
        << row.difference.rmse << std::setw(14) << row.difference.percentile_95 << std::setw(10)
        << row.difference.count << "\n";
  }
  return out.str();
}

Json to_json(const TrialErrors& row) {
  return {{"part", row.trial.part},
          {"change", row.trial.name},
          {"scene_truth", to_json(row.scene)},
          {"height_field_truth", to_json(row.height_field)},
          {"gpu_time_ratio", row.cost.gpu},
          {"processor_time_ratio", row.cost.processor},
          {"bytes", row.cost.bytes}};
}

}  // namespace

Done run_ablate(const Options& options) {
  auto stage = stage_of(options);
  if (!stage) {
    return Failure(std::move(stage.error()));
  }
  // Before minutes of work, not after.
  const auto folder = OutputFolder::create(options.out);
  if (!folder) {
    return tl::unexpected(folder.error());
  }
  const auto trials = run_trials(*stage, options, trials_of(stage->settings), "changes");
  if (!trials) {
    return Failure(trials.error());
  }
  std::cout << table_of(trials->rows) << std::flush;
  std::vector<TwinsRow> twins_rows;
  const std::uint32_t largest = stage->gpu->device().properties().limits.maxImageDimension2D;
  for (const Twins& twins : twins_of(stage->camera, options.view.height)) {
    if (twins.scale * std::max(options.view.width, options.view.height) > largest) {
      std::cout << "Left out: " << twins.name << ", which the device has no image for\n";
      continue;
    }
    auto row = run_twins(*stage->gpu, *stage, options, twins);
    if (!row) {
      return Failure(std::move(row.error()));
    }
    twins_rows.push_back(std::move(*row));
  }
  if (auto valid = check_validation(*stage->gpu); !valid) {
    return valid;
  }
  std::cout << table_of(twins_rows);
  Json report;
  report["device"] = stage->gpu->device().properties().deviceName;
  report["settings"] = to_json(stage->settings);
  report["frames"] = options.view.frames;
  for (const TrialErrors& row : trials->rows) {
    report["changes"].push_back(to_json(row));
  }
  for (const TwinsRow& row : twins_rows) {
    report["differences"].push_back(
        {{"between", row.name}, {"visibility", to_json(row.difference)}});
  }
  return write_text(options.out / "report.json", report.dump(2) + "\n").map([&] {
    std::cout << "report.json is in " << options.out.string() << "\n";
  });
}

}  // namespace alcove::sample
