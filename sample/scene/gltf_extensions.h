#pragma once

#include <string>

namespace alcove::sample {

// Whether the reader supports all of an extension.
[[nodiscard]] bool is_extension_read(const std::string& name);

// Whether a file that requires an extension can be drawn without it: the extension changes no
// shape or position, only appearance, light or metadata.
[[nodiscard]] bool changes_no_shape(const std::string& name);

}  // namespace alcove::sample
