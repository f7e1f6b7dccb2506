#pragma once

#include <functional>
#include <string>

namespace alcove::sample {

// Called repeatedly with the completed fraction of the work, 0..1, by one thread at a time.
using Progress = std::function<void(double)>;

// A Progress that prints `name 42 %, 12 s left` to stderr: nothing in the first second, then at
// most four times a second on a terminal (one line, rewritten) and every five seconds elsewhere.
[[nodiscard]] Progress print_progress(std::string name);

}  // namespace alcove::sample
