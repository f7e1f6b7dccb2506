#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace alcove::sample {

// Puts solids into a scene, one mesh per material. Every shape is placed by `world_from_shape`,
// which may move, turn and scale but not mirror. Faces look outwards, counter-clockwise.
class SceneBuilder {
 public:
  // What the next shapes are made of.
  uint32_t add_material(const std::string& name, glm::vec3 base_color, float roughness,
                        float metallic = 0.0f);
  void use(uint32_t material) { material_ = material; }
  glm::mat4 world_from_shape{1.0f};

  // One flat face, corners counter-clockwise from the front.
  void quad(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d);
  void triangle(glm::vec3 a, glm::vec3 b, glm::vec3 c);
  void box(glm::vec3 low, glm::vec3 high);
  // Turned around +Y: a profile of (radius, height) from bottom to top. Edges of the profile that
  // bend by less than 40 degrees are smooth.
  void lathe(std::span<const glm::vec2> profile, uint32_t sides);
  // A sphere as a lathe.
  void sphere(glm::vec3 centre, float radius, uint32_t rings, uint32_t sides);
  // A wall in the XY plane, from `low` to `high` in x and y and `depth` thick about z = 0, that a
  // half-round arch opens from its foot: the arch of that radius springs at low.y, in the middle.
  void arch(glm::vec2 low, glm::vec2 high, float radius, float depth, uint32_t segments);
  // A bar of square section between two points.
  void bar(glm::vec3 from, glm::vec3 to, float width);

  // The scene; the builder is empty afterwards.
  Scene finish(const std::string& name);

 private:
  void vertex(glm::vec3 position, glm::vec3 normal);
  void smooth_quad(const glm::vec3 (&positions)[4], const glm::vec3 (&normals)[4]);
  Mesh& mesh() { return scene_.meshes[material_]; }

  Scene scene_;
  uint32_t material_ = 0;
};

}  // namespace alcove::sample
