#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "scene/gltf.h"
#include "scene/tangents.h"

namespace alcove::sample {

// Any bytes are a scene that holds together, or a sentence. Small limits keep each run short.
inline void check_scene(std::span<const uint8_t> bytes) {
  const GltfLimits limits{.primitives = 1 << 16,
                          .vertices = 3 << 16,
                          .indices = 1 << 20,
                          .instances = 1 << 12,
                          .drawn_triangles = 1 << 20,
                          .images = {1 << 16, 1 << 20}};
  const auto scene = parse_gltf(bytes, "fuzz", "", limits);
  if (!scene) {
    if (scene.error().empty()) __builtin_trap();
    return;
  }
  for (const TextureImage& image : scene->images)
    if (image.rgba.size() != size_t{4} * image.width * image.height) __builtin_trap();
  for (const Mesh& mesh : scene->meshes) {
    for (const uint32_t i : mesh.indices)
      if (i >= mesh.positions.size()) __builtin_trap();
    if (mesh.material >= scene->materials.size()) __builtin_trap();
    for (const size_t count : {mesh.normals.size(), mesh.uvs.size(), mesh.second_uvs.size(),
                               mesh.tangents.size(), mesh.colors.size()})
      if (count != 0 && count != mesh.positions.size()) __builtin_trap();
    if (mesh.normals.empty()) continue;  // without normals there are no tangents
    const TextureUse& map = scene->materials[mesh.material].normal_texture;
    for (const glm::vec4& tangent : corner_tangents(mesh, map)) {
      // Unit or zero; NaN fails both comparisons.
      const float squared = glm::dot(glm::vec3(tangent), glm::vec3(tangent));
      if (!(squared == 0.0f || (squared > 0.99f && squared < 1.01f))) __builtin_trap();
    }
  }
}

}  // namespace alcove::sample
