#pragma once

#include <string>

#include "cli/options.h"

namespace CLI {
class App;
}

namespace alcove::sample {

// A mistake in the command line, described by a sentence. It is thrown within parse_options() only,
// as CLI11's own errors are.
struct Mistake {
  std::string text;
};

// Adds the options of options.command to its parser. Each stores its value in `options`, which
// holds the defaults, or throws a Mistake. The help lists those that most users need, or with
// `all` every option.
void add_options(CLI::App& app, Options& options, bool all);

// Throws a Mistake if options that are valid alone contradict each other.
void check_together(const Options& options);

}  // namespace alcove::sample
