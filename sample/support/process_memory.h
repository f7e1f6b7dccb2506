#pragma once

#include <cstdint>
#include <optional>

namespace alcove::sample {

// The peak resident set size of this process in bytes; none if the system does not report it.
[[nodiscard]] std::optional<std::uint64_t> peak_memory();

}  // namespace alcove::sample
