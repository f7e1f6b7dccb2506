#pragma once

#include <string>

namespace alcove::sample {

// Returns whether the reader supports an extension completely.
[[nodiscard]] bool is_extension_read(const std::string& name);

// Returns whether a file that requires an extension can be drawn without it, because the extension
// changes no shape or position, only appearance, light or metadata.
[[nodiscard]] bool changes_no_shape(const std::string& name);

}  // namespace alcove::sample
