#pragma once

#include <functional>
#include <string>
#include <vector>

#include "support/float_rows.h"
#include "support/result.h"

namespace alcove::sample {

// Reads channels of an OpenEXR file, scanline or tiled, with any compression. If the file has
// several parts, the first one is read. `choose` receives a function that tells whether a channel
// exists, and returns the names of the channels to read, in the order of the floats of a pixel. The
// file may be hostile: size, channels and tiles are checked before memory is allocated, at most
// about 512 MiB. Error texts are the end of a sentence that begins with the file's name.
using ChannelExists = std::function<bool(const std::string& name)>;
using ChooseChannels = std::function<std::vector<std::string>(const ChannelExists& exists)>;
[[nodiscard]] Result<void> read_exr(std::FILE* file, const ChooseChannels& choose,
                                    const FloatRows& rows);

}  // namespace alcove::sample
