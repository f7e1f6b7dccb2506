// libFuzzer: bytes are a JPEG.
#include "decode_any.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  alcove::sample::decode_any({data, size});
  return 0;
}
