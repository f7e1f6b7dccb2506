// libFuzzer: bytes are a glTF file of either kind.
#include "check_scene.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  alcove::sample::check_scene({data, size});
  return 0;
}
