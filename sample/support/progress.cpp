#include "support/progress.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>

namespace alcove::sample {

Progress print_progress(std::string name) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  return [name = std::move(name), start, last = start](double done) mutable {
    constexpr std::chrono::seconds kInterval(5);
    constexpr double kLeastKnown = 0.01;  // fraction of the work, before the rest can be estimated
    const auto now = Clock::now();
    if (now - last < kInterval || done < kLeastKnown || done >= 1.0) return;
    last = now;
    const double elapsed = std::chrono::duration<double>(now - start).count();
    fmt::print(stderr, "{} {:.0f} %, {:.0f} s left\n", name, 100.0 * done,
               elapsed * (1.0 - done) / done);
  };
}

}  // namespace alcove::sample
