#include "support/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

namespace alcove::sample {

Progress print_progress(std::string name) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  return [name = std::move(name), start, last = start, left = kUnknown](double done) mutable {
    constexpr std::chrono::seconds kInterval(5);
    constexpr double kLeastKnown = 0.01;  // fraction of the work, before the rest can be estimated
    const auto now = Clock::now();
    if (now - last < kInterval || done < kLeastKnown || done >= 1.0) return;
    last = now;
    const double elapsed = std::chrono::duration<double>(now - start).count();
    left = std::min(left, elapsed * (1.0 - done) / done);  // never more than was said before
    fmt::print(stderr, "{} {:.0f} %, {:.0f} s left\n", name, 100.0 * done, left);
  };
}

}  // namespace alcove::sample
