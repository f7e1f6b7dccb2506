#include "support/parallel.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace alcove::sample {

void parallel_rows(uint32_t rows, const std::function<void(uint32_t)>& row,
                   const Progress& progress) {
  std::atomic<uint32_t> next{0};
  const auto work = [&](bool reports) {
    for (uint32_t y = next.fetch_add(1); y < rows; y = next.fetch_add(1)) {
      row(y);
      if (reports && progress) progress(static_cast<double>(std::min(next.load(), rows)) / rows);
    }
  };
  const uint32_t threads = std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::jthread> others;
  for (uint32_t i = 1; i < std::min(threads, rows); ++i) others.emplace_back(work, false);
  work(true);
  others.clear();
  if (progress) progress(1.0);
}

}  // namespace alcove::sample
