// The trade of speed for accuracy: what can be spent, what it buys, and the least that will do.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "alcove/passes/occlusion.h"
#include "evaluate/variant.h"

namespace alcove::sample {

// The qualities, and what lies between and beyond them: resolution, slices and steps vary, all else
// is as in `base`. Each is there once, `base` among them if it is one of them.
[[nodiscard]] std::vector<Variant> preset_sweep(const passes::OcclusionSettings& base);

// Settings with what they cost on a device and how far their visibility is from the truth.
struct TradePoint {
  std::string name;
  passes::OcclusionSettings settings;
  double rmse = 0;               // against ray-traced scene truth
  double height_field_rmse = 0;  // against brute force on the same depth buffer
  double gpu_ms = 0;             // GPU time of the occlusion passes of a frame
  double processor_ms = 0;       // processor time of all threads for them
  std::uint64_t bytes = 0;       // of transients at their peak, and histories
};

// In order of GPU time; `on_pareto_front[i]` says that no other point is both faster and nearer to
// the truth than point i.
struct Trade {
  std::vector<TradePoint> points;
  std::vector<bool> on_pareto_front;
};
[[nodiscard]] Trade trade_of(std::vector<TradePoint> points);

// Of the same ways in several scenes: mean times, root mean squares of errors, most bytes. All
// lists are as long and in the same order; there is at least one.
[[nodiscard]] std::vector<TradePoint> over_scenes(std::span<const std::vector<TradePoint>> scenes);

// The nearest to the truth that takes at most so many milliseconds of GPU time, and the fastest
// that errs by at most so much; null where none does.
[[nodiscard]] const TradePoint* nearest_within_ms(std::span<const TradePoint> points, double ms);
[[nodiscard]] const TradePoint* fastest_within_rmse(std::span<const TradePoint> points,
                                                    double rmse);

}  // namespace alcove::sample
