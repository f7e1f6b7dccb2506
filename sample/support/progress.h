#pragma once

#include <functional>
#include <string>

namespace alcove::sample {

// Called repeatedly with the completed fraction of the work, 0..1, by one thread at a time.
using Progress = std::function<void(double)>;

// Returns a Progress that prints a line such as `name 42 %, 12 s left` to stderr every five
// seconds.
[[nodiscard]] Progress print_progress(std::string name);

}  // namespace alcove::sample
