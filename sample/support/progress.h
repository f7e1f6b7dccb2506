#pragma once

#include <functional>
#include <string>

namespace alcove::sample {

// Called repeatedly with the completed fraction of the work, 0..1, by one thread at a time.
using Progress = std::function<void(double)>;

// Returns a Progress that prints for example `name 42 %, 12 s left` to stderr. It prints nothing in
// the first second. After that, on a terminal it rewrites one line at most four times a second, and
// elsewhere it prints a line every five seconds.
[[nodiscard]] Progress print_progress(std::string name);

}  // namespace alcove::sample
