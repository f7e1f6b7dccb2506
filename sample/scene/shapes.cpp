#include "scene/shapes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

namespace alcove::sample {
namespace {

// Returns the outward normal of an edge of a profile: the edge's direction rotated to the right.
glm::vec2 edge_normal(glm::vec2 from, glm::vec2 to) {
  const glm::vec2 along = to - from;
  const float length = glm::length(along);
  return length > 0.0f ? glm::vec2(along.y, -along.x) / length : glm::vec2(1.0f, 0.0f);
}

// Returns the normals at the two ends of every edge of a profile. They are smooth if adjacent edges
// differ little in direction.
std::vector<std::pair<glm::vec2, glm::vec2>> profile_normals(std::span<const glm::vec2> profile) {
  const float gentle = std::cos(glm::radians(40.0f));
  std::vector<glm::vec2> edges;
  for (size_t i = 0; i + 1 < profile.size(); ++i)
    edges.push_back(edge_normal(profile[i], profile[i + 1]));
  const auto blend = [&](size_t own, size_t other) {
    if (glm::dot(edges[own], edges[other]) < gentle) return edges[own];
    return glm::normalize(edges[own] + edges[other]);
  };
  std::vector<std::pair<glm::vec2, glm::vec2>> out;
  for (size_t i = 0; i < edges.size(); ++i) {
    out.emplace_back(i > 0 ? blend(i, i - 1) : edges[i],
                     i + 1 < edges.size() ? blend(i, i + 1) : edges[i]);
  }
  return out;
}

glm::vec3 around_y(glm::vec2 radius_height, float angle) {
  return {radius_height.x * std::cos(angle), radius_height.y, -radius_height.x * std::sin(angle)};
}

}  // namespace

glm::mat4 translation(glm::vec3 by) { return glm::translate(glm::mat4(1.0f), by); }

Camera scene_camera(const char* name, glm::vec3 eye, glm::vec3 target, float fov_degrees,
                    float far_plane) {
  Camera out;
  out.name = name;
  out.eye_ws = eye;
  out.target_ws = target;
  out.fov_y = glm::radians(fov_degrees);
  out.near_plane = 0.05f;
  out.far_plane = far_plane;
  return out;
}

uint32_t SceneBuilder::add_material(const std::string& name, glm::vec3 base_color, float roughness,
                                    float metallic) {
  Material material;
  material.name = name;
  material.base_color = glm::vec4(base_color, 1.0f);
  material.roughness = roughness;
  material.metallic = metallic;
  scene_.materials.push_back(material);
  scene_.meshes.emplace_back();
  scene_.meshes.back().name = name;
  scene_.meshes.back().material = static_cast<uint32_t>(scene_.materials.size() - 1);
  return scene_.meshes.back().material;
}

void SceneBuilder::vertex(glm::vec3 position, glm::vec3 normal) {
  mesh().positions.push_back(glm::vec3(world_from_shape * glm::vec4(position, 1.0f)));
  mesh().normals.push_back(
      glm::normalize(glm::transpose(glm::inverse(glm::mat3(world_from_shape))) * normal));
  mesh().uvs.emplace_back(0.0f);
}

void SceneBuilder::triangle(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
  const glm::vec3 normal = glm::cross(b - a, c - a);
  const auto first = static_cast<uint32_t>(mesh().positions.size());
  for (const glm::vec3& p : {a, b, c}) vertex(p, normal);
  for (uint32_t i = 0; i < 3; ++i) mesh().indices.push_back(first + i);
}

void SceneBuilder::smooth_quad(const glm::vec3 (&positions)[4], const glm::vec3 (&normals)[4]) {
  const auto first = static_cast<uint32_t>(mesh().positions.size());
  for (int i = 0; i < 4; ++i) vertex(positions[i], normals[i]);
  // At a pole of a lathe, one of the two triangles has no area and is left out.
  const auto emit = [&](uint32_t a, uint32_t b, uint32_t c) {
    const glm::dvec3 along(positions[b] - positions[a]), across(positions[c] - positions[a]);
    const double longest = std::max(glm::dot(along, along), glm::dot(across, across));
    if (!(glm::length(glm::cross(along, across)) > 1e-7 * longest)) return;
    for (const uint32_t i : {a, b, c}) mesh().indices.push_back(first + i);
  };
  emit(0, 1, 2);
  emit(0, 2, 3);
}

void SceneBuilder::quad(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
  const glm::vec3 n = glm::cross(c - a, d - b);
  smooth_quad({a, b, c, d}, {n, n, n, n});
}

void SceneBuilder::box(glm::vec3 low, glm::vec3 high) {
  const auto p = [&](int x, int y, int z) {
    return glm::vec3(x ? high.x : low.x, y ? high.y : low.y, z ? high.z : low.z);
  };
  quad(p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1));
  quad(p(1, 0, 0), p(0, 0, 0), p(0, 1, 0), p(1, 1, 0));
  quad(p(1, 0, 1), p(1, 0, 0), p(1, 1, 0), p(1, 1, 1));
  quad(p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0));
  quad(p(0, 1, 1), p(1, 1, 1), p(1, 1, 0), p(0, 1, 0));
  quad(p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1));
}

void SceneBuilder::lathe(std::span<const glm::vec2> profile, uint32_t sides) {
  const auto normals = profile_normals(profile);
  for (uint32_t s = 0; s < sides; ++s) {
    const float a = glm::two_pi<float>() * static_cast<float>(s) / static_cast<float>(sides);
    const float b = s + 1 == sides ? 0.0f
                                   : glm::two_pi<float>() * static_cast<float>(s + 1) /
                                         static_cast<float>(sides);
    for (size_t i = 0; i + 1 < profile.size(); ++i) {
      const auto& [below, above] = normals[i];
      smooth_quad({around_y(profile[i], a), around_y(profile[i], b), around_y(profile[i + 1], b),
                   around_y(profile[i + 1], a)},
                  {around_y(below, a), around_y(below, b), around_y(above, b), around_y(above, a)});
    }
  }
}

void SceneBuilder::sphere(glm::vec3 centre, float radius, uint32_t rings, uint32_t sides) {
  std::vector<glm::vec2> profile;
  for (uint32_t i = 0; i <= rings; ++i) {
    const float t = glm::pi<float>() * static_cast<float>(i) / static_cast<float>(rings);
    const bool pole = i == 0 || i == rings;
    profile.emplace_back(pole ? 0.0f : radius * std::sin(t), -radius * std::cos(t));
  }
  const glm::mat4 before = world_from_shape;
  world_from_shape[3] += glm::vec4(glm::mat3(before) * centre, 0.0f);
  lathe(profile, sides);
  world_from_shape = before;
}

void SceneBuilder::arch(glm::vec2 low, glm::vec2 high, float radius, float depth,
                        uint32_t segments) {
  const float z = 0.5f * depth;
  const float middle = 0.5f * (low.x + high.x);
  const auto at = [&](uint32_t i) {
    const float t =
        glm::pi<float>() * (1.0f - static_cast<float>(i) / static_cast<float>(segments));
    return glm::vec2(middle + radius * std::cos(t), low.y + radius * std::sin(t));
  };
  const auto side = [&](glm::vec2 a, glm::vec2 b, glm::vec2 c, glm::vec2 d) {
    quad({a, z}, {b, z}, {c, z}, {d, z});
    quad({b, -z}, {a, -z}, {d, -z}, {c, -z});
  };
  side(low, {at(0).x, low.y}, {at(0).x, high.y}, {low.x, high.y});
  side({at(segments).x, low.y}, {high.x, low.y}, high, {at(segments).x, high.y});
  for (uint32_t i = 0; i < segments; ++i) {
    const glm::vec2 a = at(i), b = at(i + 1);
    side(a, b, {b.x, high.y}, {a.x, high.y});
    const glm::vec2 centre(middle, low.y);
    const glm::vec3 na(centre - a, 0.0f), nb(centre - b, 0.0f);
    smooth_quad({glm::vec3(a, -z), glm::vec3(b, -z), glm::vec3(b, z), glm::vec3(a, z)},
                {na, nb, nb, na});
  }
  quad({low.x, high.y, z}, {high.x, high.y, z}, {high.x, high.y, -z}, {low.x, high.y, -z});
  quad({low.x, low.y, -z}, {low.x, low.y, z}, {low.x, high.y, z}, {low.x, high.y, -z});
  quad({high.x, low.y, z}, {high.x, low.y, -z}, {high.x, high.y, -z}, {high.x, high.y, z});
  quad({low.x, low.y, -z}, {at(0).x, low.y, -z}, {at(0).x, low.y, z}, {low.x, low.y, z});
  quad({at(segments).x, low.y, -z}, {high.x, low.y, -z}, {high.x, low.y, z},
       {at(segments).x, low.y, z});
}

void SceneBuilder::bar(glm::vec3 from, glm::vec3 to, float width) {
  const glm::vec3 along = glm::normalize(to - from);
  const glm::vec3 helper = std::abs(along.y) > 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  const glm::vec3 x = glm::normalize(glm::cross(helper, along));
  const glm::mat4 before = world_from_shape;
  world_from_shape = before * glm::mat4(glm::vec4(x, 0), glm::vec4(glm::cross(along, x), 0),
                                        glm::vec4(along, 0), glm::vec4(from, 1));
  const float half = 0.5f * width;
  box({-half, -half, 0.0f}, {half, half, glm::length(to - from)});
  world_from_shape = before;
}

Scene SceneBuilder::finish(const std::string& name) {
  scene_.name = name;
  std::erase_if(scene_.meshes, [](const Mesh& m) { return m.indices.empty(); });
  scene_.bounds_ws = bounds_of(scene_.meshes);
  return std::exchange(scene_, {});
}

}  // namespace alcove::sample
