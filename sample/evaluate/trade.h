// The trade of speed for accuracy: what can be spent, what it buys, and the least that will do.
#pragma once

#include <array>
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

// `base` with 8, 16, 32 and 64 steps and 1, 2, 4 and 8 slices, by steps first: whether the
// estimator converges, so that more samples never err by more.
inline constexpr std::array<std::uint32_t, 4> kGridSteps{8, 16, 32, 64};
inline constexpr std::array<std::uint32_t, 4> kGridSlices{1, 2, 4, 8};
[[nodiscard]] std::vector<Variant> sampling_grid(const passes::OcclusionSettings& base);

// What a trade's times are.
enum class Clock : std::uint8_t {
  modelled,    // GPU time of a frame with a moving camera by the cost model (gpu_cost)
  timestamps,  // GPU time by the device's timestamps
  processor,   // processor time of all threads, for software devices
};

// Settings with what they cost on a device and how far their visibility is from the truth.
struct TradePoint {
  std::string name;
  passes::OcclusionSettings settings;
  double rmse = 0;               // against ray-traced scene truth
  double height_field_rmse = 0;  // against brute force on the same depth buffer
  double time_ms = 0;            // of the occlusion passes of a frame, by the trade's clock
  double spread_ms = 0;          // of that time; 0 where it is modelled
  double processor_ms = 0;       // processor time of all threads for them; 0 where it was not taken
  std::uint64_t bytes = 0;       // of transients at their peak, and histories
};

// In order of time. `on_pareto_front[i]` says that every point that errs by as little as point i or
// less is slower by more than the spread of both: a lead within the spread may be chance.
struct Trade {
  std::vector<TradePoint> points;
  std::vector<bool> on_pareto_front;
};
[[nodiscard]] Trade trade_of(std::vector<TradePoint> points);

// Of the same ways in several scenes: mean times, root mean squares of errors, most bytes. All
// lists are as long and in the same order; there is at least one.
[[nodiscard]] std::vector<TradePoint> over_scenes(std::span<const std::vector<TradePoint>> scenes);

// The nearest to the truth that takes at most so many milliseconds, and the fastest
// that errs by at most so much; null where none does.
[[nodiscard]] const TradePoint* nearest_within_ms(std::span<const TradePoint> points, double ms);
[[nodiscard]] const TradePoint* fastest_within_rmse(std::span<const TradePoint> points,
                                                    double rmse);

}  // namespace alcove::sample
