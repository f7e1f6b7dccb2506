#pragma once

#include <string>

#include "truth/truth.h"

namespace alcove::sample {

// A Progress that prints `name 42 %, 12 s left` to stderr: nothing in the first second, then at
// most four times a second on a terminal (one line, rewritten) and every five seconds elsewhere.
[[nodiscard]] Progress print_progress(std::string name);

}  // namespace alcove::sample
