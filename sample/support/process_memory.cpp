#include "support/process_memory.h"

#if __has_include(<sys/resource.h>)
#include <sys/resource.h>
#endif

namespace alcove::sample {

std::optional<std::uint64_t> peak_memory() {
#if __has_include(<sys/resource.h>)
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return std::nullopt;
#ifdef __APPLE__
  constexpr std::uint64_t kUnit = 1;
#else
  constexpr std::uint64_t kUnit = 1024;
#endif
  return static_cast<std::uint64_t>(usage.ru_maxrss) * kUnit;
#else
  return std::nullopt;
#endif
}

}  // namespace alcove::sample
