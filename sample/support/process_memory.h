#pragma once

#include <cstdint>
#include <optional>

namespace alcove::sample {

// The peak resident set size of this process in bytes; none if the system does not report it.
[[nodiscard]] std::optional<std::uint64_t> peak_memory();

// Converts bytes to MiB.
[[nodiscard]] constexpr double mib(std::uint64_t bytes) {
  return static_cast<double>(bytes) / (1 << 20);
}

}  // namespace alcove::sample
