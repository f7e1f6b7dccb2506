#include "support/progress.h"

#ifdef _WIN32
#include <io.h>
#else
#include <unistd.h>
#endif

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <utility>

namespace alcove::sample {
namespace {

using Clock = std::chrono::steady_clock;

bool stderr_is_terminal() {
#ifdef _WIN32
  return _isatty(_fileno(stderr)) != 0;
#else
  return isatty(STDERR_FILENO) != 0;
#endif
}

struct Line {
  std::string name;
  Clock::time_point start = Clock::now();
  Clock::time_point last = start;
  bool terminal = stderr_is_terminal();
  bool shown = false;
};

// The fraction of the work that must be done before the remaining time is shown.
constexpr double kLeastKnown = 0.01;

void show(Line& line, double done) {
  const auto now = Clock::now();
  const double elapsed = std::chrono::duration<double>(now - line.start).count();
  if (done >= 1.0) {
    if (line.shown) {
      fmt::print(stderr, "{}{} done in {:.0f} s{}\n", line.terminal ? "\r" : "", line.name, elapsed,
                 line.terminal ? "        " : "");
    }
    line.shown = false;
    return;
  }
  const double since = std::chrono::duration<double>(now - line.last).count();
  if (elapsed < 1.0 || done < kLeastKnown || since < (line.terminal ? 0.25 : 5.0)) return;
  fmt::print(stderr, "{}{} {:.0f} %, {:.0f} s left{}", line.terminal ? "\r" : "", line.name,
             100.0 * done, elapsed * (1.0 - done) / done, line.terminal ? "   " : "\n");
  std::fflush(stderr);
  line.last = now;
  line.shown = true;
}

}  // namespace

Progress print_progress(std::string name) {
  auto line = std::make_shared<Line>();
  line->name = std::move(name);
  return [line](double done) { show(*line, done); };
}

}  // namespace alcove::sample
