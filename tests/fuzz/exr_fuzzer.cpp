// libFuzzer: bytes are an OpenEXR file.
#include "float_image.h"
#include "support/read_exr.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace alcove::sample;
  read_any(data, size, 3, [](std::FILE* file, const FloatRows& rows) {
    const auto colours = [](const ChannelExists&) {
      return std::vector<std::string>{"R", "G", "B"};
    };
    return read_exr(file, colours, rows);
  });
  return 0;
}
