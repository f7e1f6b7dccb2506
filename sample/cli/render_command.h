#pragma once

#include <string>
#include <vector>

#include "cli/options.h"
#include "render/session.h"

namespace alcove::sample {

// Returns the command line of `alcove render` that renders the shot: the program's name, then
// arguments that parse_options() reads back. Scene, treatment of materials, environment, normals,
// device and the name of the camera are those of `options`.
[[nodiscard]] std::vector<std::string> render_arguments(const Options& options, const Shot& shot);

// The arguments as a line for a POSIX shell, quoted where necessary.
[[nodiscard]] std::string shell_line(const std::vector<std::string>& arguments);

}  // namespace alcove::sample
