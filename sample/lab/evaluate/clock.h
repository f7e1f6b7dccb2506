#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace alcove::sample {

// The clock of a trade's times. Modelled times are the same in every run.
enum class Clock : std::uint8_t {
  modelled,    // GPU time of a frame with a moving camera by the cost model (gpu_cost)
  timestamps,  // GPU time by the device's timestamps
  processor,   // processor time of all threads, for software devices
};
// Names in the order of the enumerators.
inline constexpr std::array<std::string_view, 3> kClockNames{"modelled", "timestamps", "processor"};

}  // namespace alcove::sample
