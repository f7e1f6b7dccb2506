#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "scene/scene.h"

namespace alcove::sample {

[[nodiscard]] glm::mat4 translation(glm::vec3 by);

// Returns a perspective camera with a near plane at 0.05.
[[nodiscard]] Camera scene_camera(const char* name, glm::vec3 eye, glm::vec3 target,
                                  float fov_degrees, float far_plane);

// Adds solids to a scene, one mesh per material. Every shape is transformed by `world_from_shape`,
// which may translate, rotate and scale but not mirror. Triangles are counter-clockwise from
// outside.
class SceneBuilder {
 public:
  // Sets the material of the following shapes.
  uint32_t add_material(const std::string& name, glm::vec3 base_color, float roughness,
                        float metallic = 0.0f);
  void use(uint32_t material) { material_ = material; }
  glm::mat4 world_from_shape{1.0f};

  // Adds one flat face with its corners counter-clockwise from the front.
  void quad(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d);
  // Adds a face with a normal at each corner. The normals need not be unit.
  void smooth_quad(const glm::vec3 (&positions)[4], const glm::vec3 (&normals)[4]);
  void triangle(glm::vec3 a, glm::vec3 b, glm::vec3 c);
  void box(glm::vec3 low, glm::vec3 high);
  // Adds a solid of revolution about +Y. The profile is a list of (radius, height) from bottom to
  // top. Normals are smooth where the profile bends by less than 40 degrees.
  void lathe(std::span<const glm::vec2> profile, uint32_t sides);
  // Adds a sphere as a solid of revolution.
  void sphere(glm::vec3 centre, float radius, uint32_t rings, uint32_t sides);
  // Adds a wall in the XY plane, from `low` to `high` in x and y and from -depth / 2 to depth / 2
  // in z. It has a semicircular opening of `radius`, whose centre is the middle of the wall's lower
  // edge.
  void arch(glm::vec2 low, glm::vec2 high, float radius, float depth, uint32_t segments);
  // Adds a bar with a square cross-section between two points.
  void bar(glm::vec3 from, glm::vec3 to, float width);

  // Returns the scene. The builder is empty afterwards.
  Scene finish(const std::string& name);

 private:
  void vertex(glm::vec3 position, glm::vec3 normal);
  Mesh& mesh() { return scene_.meshes[material_]; }

  Scene scene_;
  uint32_t material_ = 0;
};

}  // namespace alcove::sample
