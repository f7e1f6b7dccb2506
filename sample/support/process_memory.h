#pragma once

#include <cstdint>
#include <optional>

namespace alcove::sample {

// The most memory in bytes that this process has had at once (its resident set); none where the
// system does not tell.
[[nodiscard]] std::optional<std::uint64_t> peak_memory();

}  // namespace alcove::sample
