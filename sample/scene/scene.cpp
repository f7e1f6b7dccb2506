#include "scene/scene.h"

#include <algorithm>
#include <cmath>

namespace alcove::sample {
namespace {

// Returns the texel index within 0..size-1 to which the wrap mode maps an index.
uint32_t wrapped(int64_t texel, uint32_t size, Wrap wrap) {
  const auto count = static_cast<int64_t>(size);
  if (wrap == Wrap::clamp) return static_cast<uint32_t>(std::clamp<int64_t>(texel, 0, count - 1));
  const int64_t period = wrap == Wrap::mirror ? 2 * count : count;
  int64_t rest = texel % period;
  if (rest < 0) rest += period;
  if (rest >= count) rest = period - 1 - rest;
  return static_cast<uint32_t>(rest);
}

glm::vec4 texel(const TextureImage& image, uint32_t x, uint32_t y) {
  const uint8_t* p = &image.rgba[4 * (size_t{y} * image.width + x)];
  return glm::vec4(p[0], p[1], p[2], p[3]) / 255.0f;
}

}  // namespace

uint64_t triangle_count(const Scene& scene) {
  uint64_t count = 0;
  for (const Mesh& mesh : scene.meshes) count += mesh.indices.size() / 3 * instance_count(mesh);
  return count;
}

glm::mat4x3 world_from_mesh(const Mesh& mesh, size_t instance) {
  return mesh.instances.empty() ? glm::mat4x3(1.0f) : mesh.instances[instance];
}

glm::dvec3 area_of(const Mesh& mesh, size_t first) {
  const glm::dvec3 a(mesh.positions[mesh.indices[first]]);
  const glm::dvec3 b(mesh.positions[mesh.indices[first + 1]]);
  const glm::dvec3 c(mesh.positions[mesh.indices[first + 2]]);
  return glm::cross(b - a, c - a);
}

const Camera* find_camera(const Scene& scene, const std::string& name) {
  if (name.empty()) return scene.cameras.empty() ? nullptr : &scene.cameras.front();
  for (const Camera& camera : scene.cameras)
    if (camera.name == name) return &camera;
  return nullptr;
}

MeshUvs uvs_at(const Mesh& mesh, uint32_t vertex) {
  const auto at = [&](const std::vector<glm::vec2>& uvs) {
    return uvs.empty() ? glm::vec2(0.0f) : uvs[vertex];
  };
  return {at(mesh.uvs), at(mesh.second_uvs)};
}

MeshUvs uvs_within(const Mesh& mesh, uint32_t triangle, float u, float v) {
  const uint32_t* i = &mesh.indices[size_t{3} * triangle];
  const auto mean = [&](const std::vector<glm::vec2>& uvs) {
    return uvs.empty() ? glm::vec2(0.0f)
                       : (1.0f - u - v) * uvs[i[0]] + u * uvs[i[1]] + v * uvs[i[2]];
  };
  return {mean(mesh.uvs), mean(mesh.second_uvs)};
}

glm::vec4 color_within(const Mesh& mesh, uint32_t triangle, float u, float v) {
  if (mesh.colors.empty()) return glm::vec4(1.0f);
  const uint32_t* i = &mesh.indices[size_t{3} * triangle];
  return ((1.0f - u - v) * glm::vec4(mesh.colors[i[0]]) + u * glm::vec4(mesh.colors[i[1]]) +
          v * glm::vec4(mesh.colors[i[2]])) /
         255.0f;
}

glm::vec2 texture_uv(const TextureUse& use, const MeshUvs& mesh_uvs) {
  const glm::vec2 uv = use.texture_from_mesh_uv * glm::vec3(mesh_uvs[use.uv_set], 1.0f);
  // Very large coordinates can overflow to infinity, whose difference is NaN.
  return std::isfinite(uv.x) && std::isfinite(uv.y) ? uv : glm::vec2(0.0f);
}

glm::vec4 sample_texture(const Scene& scene, const TextureUse& use, const MeshUvs& mesh_uvs) {
  if (use.image < 0) return glm::vec4(1.0f);
  const TextureImage& image = scene.images[static_cast<size_t>(use.image)];
  const Sampler& sampler = use.sampler;
  const bool nearest = sampler.magnify == Filter::nearest;
  const glm::vec2 uv = texture_uv(use, mesh_uvs);
  // The clamp keeps the cast below defined. At such coordinates a float has no fraction of a texel
  // anyway.
  constexpr float kFar = 1e9f;
  const glm::vec2 at =
      glm::clamp(uv * glm::vec2(image.width, image.height) - (nearest ? 0.0f : 0.5f),
                 glm::vec2(-kFar), glm::vec2(kFar));
  const glm::vec2 corner = glm::floor(at);
  const glm::vec2 f = at - corner;
  const auto x = static_cast<int64_t>(corner.x), y = static_cast<int64_t>(corner.y);
  const uint32_t x0 = wrapped(x, image.width, sampler.wrap_u);
  const uint32_t y0 = wrapped(y, image.height, sampler.wrap_v);
  if (nearest) return texel(image, x0, y0);
  const uint32_t x1 = wrapped(x + 1, image.width, sampler.wrap_u);
  const uint32_t y1 = wrapped(y + 1, image.height, sampler.wrap_v);
  return glm::mix(glm::mix(texel(image, x0, y0), texel(image, x1, y0), f.x),
                  glm::mix(texel(image, x0, y1), texel(image, x1, y1), f.x), f.y);
}

float srgb_to_linear(float encoded) {
  if (encoded <= 0.04045f) return encoded / 12.92f;
  return std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

}  // namespace alcove::sample
