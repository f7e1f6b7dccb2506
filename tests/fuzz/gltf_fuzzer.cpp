#include <cstddef>
#include <cstdint>

#include "scene/gltf.h"
#include "scene/tangents.h"

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
    const size_t vertices = mesh.positions_ws.size(), second = mesh.second_uvs.size();
    if (mesh.uvs.size() != vertices || (second != 0 && second != vertices)) __builtin_trap();
    const auto& map = scene->materials[mesh.material].normal_texture;
    for (const glm::vec4& t : alcove::sample::corner_tangents(mesh, map)) {
      // Neither unit nor zero: not a number, or a length that is not taken out.
      const float squared = glm::dot(glm::vec3(t), glm::vec3(t));
      if (!(squared == 0.0f || (squared > 0.99f && squared < 1.01f))) __builtin_trap();
    }
  }
  return 0;
}
