#include <cstddef>
#include <cstdint>

#include "gltf.h"

// Any bytes are a scene or a sentence. Small limits keep each run short.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const alcove::sample::GltfLimits limits{1 << 16, 3 << 16, 1 << 20};
  const auto scene = alcove::sample::parse_gltf({data, size}, "fuzz", "", limits);
  if (!scene) return scene.error().empty() ? __builtin_trap(), 0 : 0;
  for (const auto& mesh : scene->meshes) {
    for (const uint32_t i : mesh.indices) {
      if (i >= mesh.positions_ws.size()) __builtin_trap();
    }
    if (mesh.material >= scene->materials.size()) __builtin_trap();
  }
  return 0;
}
