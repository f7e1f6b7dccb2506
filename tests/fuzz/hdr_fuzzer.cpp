// libFuzzer: bytes are a Radiance picture.
#include "float_image.h"
#include "support/read_hdr.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  alcove::sample::read_any(data, size, 3, alcove::sample::read_hdr);
  return 0;
}
