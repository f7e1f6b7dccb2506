#include "viewer/smoothed_times.h"

#include <algorithm>

namespace alcove::sample {

void SmoothedTimes::add(const std::vector<PassTime>& measured) {
  if (measured.empty()) {
    return;
  }
  if (!std::ranges::equal(measured, passes_, {}, &PassTime::pass, &PassTime::pass)) {
    passes_ = measured;
    return;
  }
  constexpr double kShare = 0.05;  // of the newest
  for (std::size_t i = 0; i < passes_.size(); ++i) {
    passes_[i].milliseconds += kShare * (measured[i].milliseconds - passes_[i].milliseconds);
  }
}

double SmoothedTimes::total_ms() const {
  double total = 0.0;
  for (const PassTime& time : passes_) {
    total += time.milliseconds;
  }
  return total;
}

}  // namespace alcove::sample
