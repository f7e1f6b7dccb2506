#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/open_session.h"
#include "cli/report.h"
#include "evaluate/ablation.h"
#include "evaluate/errors.h"
#include "evaluate/situations.h"
#include "evaluate/variant.h"
#include "render/settings_json.h"
#include "support/mib.h"
#include "support/progress.h"
#include "support/result.h"
#include "support/whole_file.h"

namespace alcove::sample {
namespace {

using Json = nlohmann::ordered_json;

// The difference between two images that should be equal.
struct InvariancePairRow {
  std::string name;
  ErrorSummary difference;
};

// The image with each block of `scale` x `scale` pixels replaced by its mean.
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

// Returns the pixels of the first image at which both images show the same surface. The second
// image may be `pair.scale` times as large; then all pixels of a block of it must show that
// surface.
Mask common_surfaces(const InvariancePair& pair, const FrameImages& images,
                     const FrameImages& others) {
  const std::uint32_t scale = pair.scale;
  const Image<float> depth = linear_depth(pair.first, images.depth_ndc);
  const Image<float> other = linear_depth(pair.second, others.depth_ndc);
  Mask mask(depth.width, depth.height);
  for (std::uint32_t y = 0; y < depth.height * scale; ++y) {
    for (std::uint32_t x = 0; x < depth.width * scale; ++x) {
      const std::size_t i = (y / scale) * depth.width + x / scale;
      const float apart = other.at(x, y) - pair.further - depth.pixels[i];
      const bool here = std::isfinite(apart) && std::abs(apart) <= pair.tolerance;
      mask.pixels[i] = here && (mask.pixels[i] != 0 || (x % scale == 0 && y % scale == 0)) ? 1 : 0;
    }
  }
  return mask;
}

Result<InvariancePairRow> run_invariance_pair(Gpu& gpu, const Session& session,
                                              const Options& options, const InvariancePair& pair) {
  const StaticSetup first = static_setup(options, pair.first);
  StaticSetup second = static_setup(options, pair.second);
  second.width *= pair.scale;
  second.height *= pair.scale;
  ALCOVE_TRY(const auto images, draw_static(gpu, session.scene, first, session.settings));
  ALCOVE_TRY(const auto others, draw_static(gpu, session.scene, second, session.settings));
  return InvariancePairRow{pair.name,
                           compare_images(shrunk(others.visibility, pair.scale), images.visibility,
                                          common_surfaces(pair, images, others))};
}

std::string format_table(const std::vector<Measurement>& rows, Clock clock) {
  std::string out = fmt::format(
      "RMSE of visibility over {} pixels, and cost relative to the first row\n"
      "  {:47}scene truth   height field    bias {:>5}   processor   MiB\n",
      rows.front().scene.count, "", clock == Clock::modelled ? "model" : "GPU");
  std::string part;
  for (const Measurement& row : rows) {
    const bool begins = row.variant.part != part;
    part = row.variant.part;
    out += fmt::format(
        "  {:15}{:32}{:10.4f}{:15.4f}{:+10.3f}{:>6}{:10.2f}{:9.1f}\n", begins ? part : "",
        row.variant.name, row.scene.rmse, row.height_field.rmse, row.scene.bias,
        clock == Clock::processor ? "-" : fmt::format("{:.2f}", row.time_ms / rows.front().time_ms),
        row.cost.processor, mib(row.cost.bytes));
  }
  return out;
}

std::string format_table(const std::vector<InvariancePairRow>& rows) {
  std::string out =
      "Difference of visibility between equal views              RMS   95 % within    pixels\n";
  for (const InvariancePairRow& row : rows) {
    out += fmt::format("  {:50}{:10.4f}{:14.4f}{:10}\n", row.name, row.difference.rmse,
                       row.difference.percentile_95, row.difference.count);
  }
  return out;
}

Json to_json(const Measurement& row, const Measurement& base) {
  return {{"part", row.variant.part},
          {"change", row.variant.name},
          {"scene_truth", to_json(row.scene)},
          {"height_field_truth", to_json(row.height_field)},
          {"time_ratio", row.time_ms / base.time_ms},
          {"processor_time_ratio", row.cost.processor},
          {"bytes", row.cost.bytes}};
}

}  // namespace

Result<void> run_ablate(const Options& options) {
  ALCOVE_TRY(auto session, open_session(options));
  // The folder is created first, because the measurement takes minutes.
  ALCOVE_TRY(const auto folder, OutputFolder::create(options.out));
  ALCOVE_TRY(const auto clock,
             choose_clock(
                 session.gpu->device(), [&] { return modelled_times(options); }, options.clock));
  ALCOVE_TRY(
      const auto rows,
      measure_variants(session, static_setup(options, session.camera), truth_options(options),
                       ablation_variants(session.settings), "changes", &clock));
  std::cout << format_table(rows, clock.clock) << std::flush;
  std::vector<InvariancePairRow> invariance_pair_rows;
  const std::uint32_t largest = session.gpu->device().properties().limits.maxImageDimension2D;
  for (const InvariancePair& pair : invariance_pairs(session.camera, options.view.height)) {
    if (pair.scale * std::max(options.view.width, options.view.height) > largest) {
      std::cout << "Skipped: " << pair.name
                << ": the device does not support images of that size\n";
      continue;
    }
    ALCOVE_TRY(auto row, run_invariance_pair(*session.gpu, session, options, pair));
    invariance_pair_rows.push_back(std::move(row));
  }
  ALCOVE_TRY_VOID(check_validation(*session.gpu));
  std::cout << format_table(invariance_pair_rows);
  Json report;
  report["device"] = session.gpu->device().properties().deviceName;
  report["settings"] = to_json(session.settings);
  report["frames"] = options.view.frames;
  for (const Measurement& row : rows) report["changes"].push_back(to_json(row, rows.front()));
  for (const InvariancePairRow& row : invariance_pair_rows) {
    report["differences"].push_back(
        {{"between", row.name}, {"visibility", to_json(row.difference)}});
  }
  return write_text(options.out / "report.json", report.dump(2) + "\n").map([&] {
    std::cout << "report.json is in " << options.out.string() << "\n";
  });
}

}  // namespace alcove::sample
