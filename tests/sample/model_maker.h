#pragma once

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <string>
#include <vector>

#include "gltf_maker.h"
#include "support/glm.h"
#include "temporary_folder.h"

namespace alcove::sample {

// Triangles without vertex normals, so that each is shaded with its geometric normal.
struct Triangles {
  std::vector<glm::vec3> positions;
  std::vector<uint32_t> indices;

  // Counter-clockwise seen from the front.
  void add_quad(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
    const auto first = static_cast<uint32_t>(positions.size());
    positions.insert(positions.end(), {a, b, c, d});
    for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) indices.push_back(first + i);
  }

  // Faces look outwards, or inwards.
  void add_box(glm::vec3 low, glm::vec3 high, bool inward = false) {
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (const bool top : {false, true}) {
        glm::vec3 corner[4];
        for (int i = 0; i < 4; ++i) {
          corner[i][axis] = top ? high[axis] : low[axis];
          corner[i][u] = i == 1 || i == 2 ? high[u] : low[u];
          corner[i][v] = i >= 2 ? high[v] : low[v];
        }
        if (top != inward)
          add_quad(corner[0], corner[1], corner[2], corner[3]);
        else
          add_quad(corner[3], corner[2], corner[1], corner[0]);
      }
    }
  }

  // Adds a surface of revolution about the vertical axis through `bottom`, from there up to the
  // height `top`. `radii` has its radius at equally spaced heights; the surface is closed if the
  // first and the last radius are 0. With `inward`, its faces point towards the axis.
  void add_lathe(glm::vec3 bottom, float top, const std::vector<float>& radii,
                 bool inward = false) {
    constexpr int kSides = 24;
    const auto point = [&](size_t ring, int side) {
      const float angle = glm::two_pi<float>() * static_cast<float>(side) / kSides;
      const float share = static_cast<float>(ring) / static_cast<float>(radii.size() - 1);
      return bottom + glm::vec3(radii[ring] * std::cos(angle), share * (top - bottom.y),
                                -radii[ring] * std::sin(angle));
    };
    for (size_t ring = 0; ring + 1 < radii.size(); ++ring) {
      for (int side = 0; side < kSides; ++side) {
        const glm::vec3 a = point(ring, side), b = point(ring, side + 1);
        const glm::vec3 c = point(ring + 1, side + 1), d = point(ring + 1, side);
        if (inward)
          add_quad(d, c, b, a);
        else
          add_quad(a, b, c, d);
      }
    }
  }
};

// A .glb file of meshes made of triangles.
class ModelMaker {
 public:
  ModelMaker() {
    gltf.json["nodes"] = nlohmann::json::array();
    gltf.json["scenes"][0]["nodes"] = nlohmann::json::array();
  }

  // Returns the mesh's index.
  int mesh(const Triangles& triangles, const nlohmann::json& material = nullptr) {
    std::vector<float> values;
    glm::vec3 low = triangles.positions.at(0), high = low;
    for (const glm::vec3& p : triangles.positions) {
      values.insert(values.end(), {p.x, p.y, p.z});
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    const int positions = gltf.add("VEC3", values);
    gltf.json["accessors"].back()["min"] = {low.x, low.y, low.z};
    gltf.json["accessors"].back()["max"] = {high.x, high.y, high.z};
    const int indices = gltf.add("SCALAR", triangles.indices);
    nlohmann::json primitive = {{"attributes", {{"POSITION", positions}}}, {"indices", indices}};
    if (!material.is_null()) {
      gltf.json["materials"].push_back(material);
      primitive["material"] = gltf.json["materials"].size() - 1;
    }
    gltf.json["meshes"].push_back({{"primitives", {primitive}}});
    return static_cast<int>(gltf.json["meshes"].size()) - 1;
  }

  // Returns the node's index. It is in the scene unless another node has it as a child.
  int node(const nlohmann::json& node, bool in_scene = true) {
    gltf.json["nodes"].push_back(node);
    const int index = static_cast<int>(gltf.json["nodes"].size()) - 1;
    if (in_scene) gltf.json["scenes"][0]["nodes"].push_back(index);
    return index;
  }

  void add(const Triangles& triangles, const nlohmann::json& material = nullptr) {
    node({{"mesh", mesh(triangles, material)}});
  }

  [[nodiscard]] std::string write(const TemporaryFolder& folder, const std::string& name) const {
    return folder.write(name + ".glb", gltf.glb());
  }

  GltfMaker gltf;
};

}  // namespace alcove::sample
