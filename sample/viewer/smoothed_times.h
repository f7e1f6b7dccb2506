#pragma once

#include <vector>

#include "gpu/gpu.h"

namespace alcove::sample {

// Moving averages of the times of a frame's passes over about twenty frames, so that the times can
// be read. The averages restart if the passes change.
class SmoothedTimes {
 public:
  void add(const std::vector<PassTime>& measured);
  const std::vector<PassTime>& passes() const { return passes_; }
  double total_ms() const;

 private:
  std::vector<PassTime> passes_;
};

}  // namespace alcove::sample
