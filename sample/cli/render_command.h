#pragma once

#include <string>
#include <vector>

#include "cli/options.h"
#include "evaluate/recommendation.h"
#include "render/session.h"

namespace alcove::sample {

// Returns the command line of `alcove render` that renders the shot: the program's name, then
// arguments that parse_options() reads back. Scene, treatment of materials, environment and device
// are those of `options`.
[[nodiscard]] std::vector<std::string> render_arguments(const Options& options, const Shot& shot);

// Returns every setting of a choice that is not the default, as options of the commands.
[[nodiscard]] std::string choice_text(const Choice& choice);

// Returns the shortest text of a coordinate from which the same float is parsed. The text is in the
// space of the scene's file, which is `value` plus `origin`.
[[nodiscard]] std::string coordinate_text(float value, double origin);

// The arguments as a line for a POSIX shell, quoted where necessary.
[[nodiscard]] std::string shell_line(const std::vector<std::string>& arguments);

}  // namespace alcove::sample
