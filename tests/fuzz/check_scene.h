#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "scene/gltf.h"
#include "scene/tangents.h"

namespace alcove::sample {

// Any bytes are a scene that holds together, or a sentence. Small limits keep each run short.
inline void check_scene(std::span<const uint8_t> bytes) {
  const GltfLimits limits{1 << 16, 3 << 16, 1 << 20, {1 << 16, 1 << 20}};
  const auto scene = parse_gltf(bytes, "fuzz", "", limits);
  if (!scene) {
    if (scene.error().empty()) __builtin_trap();
    return;
  }
  for (const TextureImage& image : scene->images) {
    if (image.rgba.size() != size_t{4} * image.width * image.height) __builtin_trap();
  }
  for (const Mesh& mesh : scene->meshes) {
    for (const uint32_t i : mesh.indices) {
      if (i >= mesh.positions_ws.size()) __builtin_trap();
    }
    if (mesh.material >= scene->materials.size()) __builtin_trap();
    const size_t vertices = mesh.positions_ws.size(), second = mesh.second_uvs.size();
    if (mesh.uvs.size() != vertices || (second != 0 && second != vertices)) __builtin_trap();
    const TextureUse& map = scene->materials[mesh.material].normal_texture;
    for (const glm::vec4& tangent : corner_tangents(mesh, map)) {
      // Unit or zero; NaN fails both comparisons.
      const float squared = glm::dot(glm::vec3(tangent), glm::vec3(tangent));
      if (!(squared == 0.0f || (squared > 0.99f && squared < 1.01f))) __builtin_trap();
    }
  }
}

}  // namespace alcove::sample
