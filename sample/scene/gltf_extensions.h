#pragma once

#include <string>

namespace alcove::sample {

// Whether the reader takes everything that an extension adds.
[[nodiscard]] bool is_extension_read(const std::string& name);

// Whether a file that requires an extension can be drawn without it: the extension changes neither
// shapes nor where they stand, only appearance, light or metadata.
[[nodiscard]] bool changes_no_shape(const std::string& name);

}  // namespace alcove::sample
