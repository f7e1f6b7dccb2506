#pragma once

#include <vector>

#include "gpu/gpu.h"

namespace alcove::sample {

// The times of a frame's passes, calm enough to be read: each follows what is measured with a lag
// of some twenty frames. Other passes than before begin anew.
class SmoothedTimes {
 public:
  void add(const std::vector<PassTime>& measured);
  const std::vector<PassTime>& passes() const { return passes_; }
  double total_ms() const;

 private:
  std::vector<PassTime> passes_;
};

}  // namespace alcove::sample
