#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace alcove::sample {

// A corner of a triangle as the rasteriser takes it: three in a row are a triangle, none is shared,
// since each carries the triangle's own normal too. In the space of the mesh where that moves.
struct Vertex {
  glm::vec3 position_ws;
  glm::vec3 normal_ws;
  glm::vec3 face_normal_ws;  // unit, by the winding
  glm::vec4 tangent_ws;      // of the normal map; zero where there is none
  glm::vec2 base_color_uv;   // these as each texture is looked up
  glm::vec2 metal_roughness_uv;
  glm::vec2 emissive_uv;
  glm::vec2 normal_uv;
};

struct TriangleDraw {
  uint32_t first_vertex;
  uint32_t vertex_count;
  uint32_t material;
  bool moves;
};

struct Triangles {
  std::vector<Vertex> vertices;
  std::vector<TriangleDraw> draws;
};

// All triangles of the scene, one draw a mesh. Those without area are left out.
[[nodiscard]] Triangles flatten(const Scene& scene);

}  // namespace alcove::sample
