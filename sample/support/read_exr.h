#pragma once

#include <vector>

#include "support/float_rows.h"

namespace alcove::sample {

// Reads channels of an OpenEXR file, scanline or tiled, of any compression; for a file of several
// parts, those of the first. `choose` gets the question whether a channel of some name exists and
// answers with the names to read, in the order in which the floats of a pixel are handed out. The
// file may be hostile: size, channels and tiles are checked before memory is taken, at most about
// 512 MiB. Errors are the end of a sentence that begins with the file's name.
using ChannelExists = std::function<bool(const std::string& name)>;
using ChooseChannels = std::function<std::vector<std::string>(const ChannelExists& exists)>;
[[nodiscard]] tl::expected<void, std::string> read_exr(std::FILE* file,
                                                       const ChooseChannels& choose,
                                                       const FloatRows& rows);

}  // namespace alcove::sample
