#include "scene/gltf_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "scene/area.h"
#include "scene/direction.h"
#include "scene/gltf_accessor.h"
#include "scene/gltf_placement.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

int attribute(const tinygltf::Primitive& primitive, const std::string& name) {
  const auto found = primitive.attributes.find(name);
  return found == primitive.attributes.end() ? -1 : found->second;
}

bool finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Converts strips and fans to lists. Every second triangle of a strip is reversed, so that all
// triangles have the same winding.
std::vector<uint32_t> as_list(std::vector<uint32_t> in, int mode) {
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    in.resize(in.size() - in.size() % 3);
    return in;
  }
  std::vector<uint32_t> out;
  for (size_t i = 2; i < in.size(); ++i) {
    const bool fan = mode == TINYGLTF_MODE_TRIANGLE_FAN;
    const size_t odd = fan ? 0 : i % 2;
    const uint32_t a = fan ? in[0] : in[i - 2];
    const uint32_t b = in[i - 1];
    // The triangles of a strip are (i, i+1+odd, i+2-odd), those of a fan (0, i, i+1).
    out.insert(out.end(), {a, odd ? in[i] : b, odd ? b : in[i]});
  }
  return out;
}

tl::expected<std::vector<glm::vec3>, std::string> world_positions(const tinygltf::Model& model,
                                                                  int accessor,
                                                                  const VertexPlacement& placement,
                                                                  uint64_t most) {
  const auto values = read_floats(model, accessor, 3, most);
  if (!values) return Failure(values.error());
  std::vector<glm::vec3> out(values->size() / 3);
  // The squares of larger lengths overflow a float.
  constexpr float kFarthest = 1e15f;
  for (size_t i = 0; i < out.size(); ++i) {
    const glm::dvec4 local((*values)[3 * i], (*values)[3 * i + 1], (*values)[3 * i + 2], 1.0);
    out[i] = glm::vec3(placement.at(i) * local);
    if (!finite(out[i]) ||
        std::max({std::abs(out[i].x), std::abs(out[i].y), std::abs(out[i].z)}) > kFarthest) {
      return Failure("has a vertex " + std::to_string(i) +
                     " that is not a finite position within 1e15 of the origin");
    }
  }
  return out;
}

// Reads normals in world space. Normals that are zero or not finite become zero.
tl::expected<std::vector<glm::vec3>, std::string> world_normals(const tinygltf::Model& model,
                                                                int accessor,
                                                                const VertexPlacement& placement,
                                                                uint64_t most) {
  const auto values = read_floats(model, accessor, 3, most);
  if (!values) return Failure(values.error());
  std::vector<glm::vec3> out(values->size() / 3);
  for (size_t i = 0; i < out.size(); ++i) {
    // Normals are transformed by the cofactor matrix, the inverse transpose times the determinant.
    // It exists even if the determinant is 0.
    const glm::dmat3 m(placement.at(i));
    const double side = glm::determinant(m) < 0.0 ? -1.0 : 1.0;
    const glm::dmat3 cofactor(side * glm::cross(m[1], m[2]), side * glm::cross(m[2], m[0]),
                              side * glm::cross(m[0], m[1]));
    const float* in = &(*values)[3 * i];
    out[i] = glm::vec3(direction_of(cofactor * glm::dvec3(in[0], in[1], in[2])));
  }
  return out;
}

// Reads tangents in world space. Tangents that are zero or not finite become zero.
tl::expected<std::vector<glm::vec4>, std::string> world_tangents(const tinygltf::Model& model,
                                                                 int accessor,
                                                                 const VertexPlacement& placement,
                                                                 uint64_t most) {
  const auto values = read_floats(model, accessor, 4, most);
  if (!values) return Failure(values.error());
  std::vector<glm::vec4> out(values->size() / 4);
  for (size_t i = 0; i < out.size(); ++i) {
    const glm::dmat3 m(placement.at(i));
    const float side = glm::determinant(m) < 0.0 ? -1.0f : 1.0f;
    const float* in = &(*values)[4 * i];
    out[i] = glm::vec4(glm::vec3(direction_of(m * glm::dvec3(in[0], in[1], in[2]))),
                       in[3] < 0.0f ? -side : side);
  }
  return out;
}

// Reverses the winding of triangles that their transform mirrors.
void turn_mirrored(const VertexPlacement& placement, std::vector<uint32_t>& indices) {
  for (size_t i = 0; i + 2 < indices.size(); i += 3) {
    if (glm::determinant(glm::dmat3(placement.at(indices[i]))) < 0.0) {
      std::swap(indices[i + 1], indices[i + 2]);
    }
  }
}

// Removes triangles without an area. They have no normal, cover no pixel and block no ray.
void drop_flat_faces(Mesh& mesh) {
  size_t kept = 0;
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const double length = glm::length(area_of(mesh, i));
    if (!(length > 0.0)) continue;
    for (size_t c = 0; c < 3; ++c) mesh.indices[kept + c] = mesh.indices[i + c];
    kept += 3;
  }
  mesh.indices.resize(kept);
}

// Gives each corner its own vertex with the normal of its triangle.
void make_flat_normals(Mesh& mesh) {
  Mesh flat;
  const auto copy = [](auto& from, auto& to, uint32_t v) {
    if (!from.empty()) to.push_back(from[v]);
  };
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::vec3 normal(glm::normalize(area_of(mesh, i)));
    for (size_t c = 0; c < 3; ++c) {
      const uint32_t v = mesh.indices[i + c];
      flat.positions.push_back(mesh.positions[v]);
      flat.normals.push_back(normal);
      copy(mesh.uvs, flat.uvs, v);
      copy(mesh.second_uvs, flat.second_uvs, v);
      copy(mesh.colors, flat.colors, v);
    }
  }
  flat.indices.resize(flat.positions.size());
  std::iota(flat.indices.begin(), flat.indices.end(), 0u);
  mesh.positions = std::move(flat.positions);
  mesh.normals = std::move(flat.normals);
  mesh.uvs = std::move(flat.uvs);
  mesh.second_uvs = std::move(flat.second_uvs);
  mesh.colors = std::move(flat.colors);
  mesh.indices = std::move(flat.indices);
}

// Replaces zero normals by the area-weighted mean normal of the triangles at the vertex.
void mend_normals(Mesh& mesh) {
  if (std::ranges::find(mesh.normals, glm::vec3(0.0f)) == mesh.normals.end()) return;
  std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    const glm::dvec3 area = area_of(mesh, i);
    for (size_t c = 0; c < 3; ++c) sums[mesh.indices[i + c]] += area;
  }
  for (size_t v = 0; v < sums.size(); ++v) {
    if (mesh.normals[v] != glm::vec3(0.0f)) continue;
    const double length = glm::length(sums[v]);
    mesh.normals[v] = length > 0.0 ? glm::vec3(sums[v] / length) : glm::vec3(0, 1, 0);
  }
}

bool reads_by(const Material& material, uint32_t uv_set) {
  const auto uses = {&material.base_color_texture, &material.metal_roughness_texture,
                     &material.emissive_texture, &material.normal_texture};
  return std::any_of(uses.begin(), uses.end(), [&](const TextureUse* use) {
    return use->image >= 0 && use->uv_set == uv_set;
  });
}

// Returns texture coordinates, or an empty array if the file has none. Coordinates that are not
// finite become zero.
tl::expected<std::vector<glm::vec2>, std::string> texture_coordinates(
    const tinygltf::Model& model, const tinygltf::Primitive& primitive, uint32_t uv_set,
    size_t vertices) {
  const int accessor = attribute(primitive, "TEXCOORD_" + std::to_string(uv_set));
  if (accessor < 0) return {};
  const auto values = read_floats(model, accessor, 2, vertices);
  if (!values) return Failure(values.error());
  if (values->size() != 2 * vertices) {
    return Failure("has texture coordinates for some of its vertices only");
  }
  std::vector<glm::vec2> out(vertices, glm::vec2(0.0f));
  for (size_t i = 0; i < vertices; ++i) {
    const glm::vec2 uv((*values)[2 * i], (*values)[2 * i + 1]);
    if (std::isfinite(uv.x) && std::isfinite(uv.y)) out[i] = uv;
  }
  return out;
}

// Adds the sets of texture coordinates that the textures of the material use.
tl::expected<void, std::string> add_texture_coordinates(const tinygltf::Model& model,
                                                        const tinygltf::Primitive& primitive,
                                                        Mesh& mesh, Scene& scene) {
  const size_t vertices = mesh.positions.size();
  for (const uint32_t set : {0u, 1u}) {
    if (!reads_by(scene.materials[mesh.material], set)) continue;
    auto uvs = texture_coordinates(model, primitive, set, vertices);
    if (!uvs) return Failure(uvs.error());
    if (uvs->empty()) {
      scene.warnings.push_back("Mesh " + mesh.name + " lacks the texture coordinates " +
                               std::to_string(set) +
                               " that its material names: they are taken to be zero.");
    }
    (set == 0 ? mesh.uvs : mesh.second_uvs) = std::move(*uvs);
  }
  return {};
}

// Adds the vertex colours COLOR_0. Colours without alpha get an alpha of 1. If all colours are
// white, none are kept.
tl::expected<void, std::string> add_colors(const tinygltf::Model& model,
                                           const tinygltf::Primitive& primitive, Mesh& mesh) {
  const int accessor = attribute(primitive, "COLOR_0");
  if (accessor < 0) return {};
  const size_t vertices = mesh.positions.size();
  const bool has_alpha = static_cast<size_t>(accessor) < model.accessors.size() &&
                         model.accessors[static_cast<size_t>(accessor)].type == TINYGLTF_TYPE_VEC4;
  const int components = has_alpha ? 4 : 3;
  const auto values = read_floats(model, accessor, components, vertices);
  if (!values) return Failure(values.error());
  const auto width = static_cast<size_t>(components);
  if (values->size() != width * vertices) return Failure("has colours for some vertices only");
  mesh.colors.assign(vertices, glm::u8vec4(255));
  for (size_t v = 0; v < vertices; ++v) {
    for (size_t c = 0; c < width; ++c) {
      const float value = (*values)[v * width + c];
      const float clamped = std::isfinite(value) ? std::clamp(value, 0.0f, 1.0f) : 1.0f;
      mesh.colors[v][static_cast<int>(c)] = static_cast<uint8_t>(std::lround(255.0f * clamped));
    }
  }
  const auto is_white = [](const glm::u8vec4& color) { return color == glm::u8vec4(255); };
  if (std::ranges::all_of(mesh.colors, is_white)) mesh.colors = {};
  return {};
}

// Adds normals and tangents. `vertices` is the number of vertices in the file. Without normals,
// triangles have geometric normals and tangents are ignored (glTF 2.0 section 3.7.2.1).
tl::expected<void, std::string> add_normals(const tinygltf::Model& model,
                                            const tinygltf::Primitive& primitive,
                                            const Material& material,
                                            const VertexPlacement& placement, size_t vertices,
                                            Mesh& mesh) {
  const int normal = attribute(primitive, "NORMAL");
  if (normal < 0) {
    // The tangents of a normal map are computed at vertices that have a normal, so that the mesh
    // needs vertex normals.
    if (material.normal_texture.image >= 0) make_flat_normals(mesh);
    return {};
  }
  auto normals = world_normals(model, normal, placement, vertices);
  if (!normals) return Failure(normals.error());
  if (normals->size() != vertices) return Failure("has normals for some of its vertices only");
  mesh.normals = std::move(*normals);
  mend_normals(mesh);
  const int tangent = attribute(primitive, "TANGENT");
  if (tangent < 0) return {};
  if (static_cast<size_t>(tangent) < model.accessors.size() &&
      model.accessors[static_cast<size_t>(tangent)].count != vertices) {
    return Failure("has tangents for some of its vertices only");
  }
  if (material.normal_texture.image < 0) return {};
  auto tangents = world_tangents(model, tangent, placement, vertices);
  if (!tangents) return Failure(tangents.error());
  if (tangents->size() != vertices) return Failure("has tangents for some of its vertices only");
  mesh.tangents = std::move(*tangents);
  return {};
}

void charge(uint64_t& budget, uint64_t count) { budget -= std::min(budget, count); }

tl::expected<std::vector<uint32_t>, std::string> vertex_order(const tinygltf::Model& model,
                                                              const tinygltf::Primitive& primitive,
                                                              size_t vertices, uint64_t most) {
  if (primitive.indices >= 0) return read_indices(model, primitive.indices, vertices, most);
  std::vector<uint32_t> order(vertices);
  std::iota(order.begin(), order.end(), 0u);
  return order;
}

// Returns the transforms of the vertices of a primitive to the space of its mesh.
tl::expected<VertexPlacement, std::string> vertex_placement(const tinygltf::Model& model,
                                                            const tinygltf::Primitive& primitive,
                                                            const PrimitivePlacement& placement,
                                                            uint64_t most) {
  if (placement.joints == nullptr) return VertexPlacement(placement.world_from_mesh);
  const int position = attribute(primitive, "POSITION");
  const size_t vertices = static_cast<size_t>(position) < model.accessors.size()
                              ? model.accessors[static_cast<size_t>(position)].count
                              : 0;
  if (vertices > most) return Failure("has too many vertices: " + std::to_string(vertices));
  return VertexPlacement::skinned(model, primitive, vertices, *placement.joints, most);
}

bool is_invisible(const Material& material) {
  return material.alpha_mode == AlphaMode::kBlend && material.base_color.a == 0.0f;
}

// Gives the mesh its instances and takes its size from the budget.
tl::expected<void, std::string> charge_mesh(size_t vertices, const PrimitivePlacement& placement,
                                            MeshBudget& budget, Mesh& mesh) {
  if (mesh.indices.size() > budget.indices || mesh.indices.size() > budget.vertices) {
    return Failure("takes the scene past the number of triangles that is read here");
  }
  if (placement.instances != nullptr) {
    if (placement.instances->size() > budget.instances) {
      return Failure("takes the scene past the number of instances that is read here");
    }
    budget.instances -= placement.instances->size();
    mesh.instances = *placement.instances;
  }
  const uint64_t drawn = mesh.indices.size() / 3 * instance_count(mesh);
  if (drawn > budget.drawn_triangles) {
    return Failure(
        "takes the scene past the number of triangles that is drawn here, instances "
        "counted each");
  }
  // Triangles without an area count too, because they took time to read.
  charge(budget.vertices, vertices);
  charge(budget.indices, mesh.indices.size());
  charge(budget.drawn_triangles, drawn);
  return {};
}

}  // namespace

tl::expected<void, std::string> add_primitive(const tinygltf::Model& model,
                                              const tinygltf::Primitive& primitive,
                                              const std::string& name,
                                              const PrimitivePlacement& placement,
                                              MeshBudget& budget, Scene& scene) {
  const auto refuse = [&](const std::string& why) { return Failure("mesh " + name + " " + why); };
  if (budget.primitives == 0) {
    return refuse("takes the scene past the number of parts that is read here");
  }
  --budget.primitives;
  // tinygltf stores -1 if the file gives no mode. The default is triangles.
  const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
  if (mode < TINYGLTF_MODE_TRIANGLES || mode > TINYGLTF_MODE_TRIANGLE_FAN) {
    scene.warnings.push_back("Mesh " + name + " has points or lines, which are left out.");
    return {};
  }
  if (primitive.material >= static_cast<int>(model.materials.size())) {
    return refuse("has no material " + std::to_string(primitive.material));
  }
  const int position = attribute(primitive, "POSITION");
  if (position < 0) return {};

  Mesh mesh;
  mesh.name = name;
  mesh.material = static_cast<uint32_t>(
      primitive.material < 0 ? model.materials.size() : static_cast<size_t>(primitive.material));
  const Material& material = scene.materials[mesh.material];
  if (is_invisible(material)) {
    scene.warnings.push_back("Material \"" + material.name +
                             "\" blends with an alpha of 0: its triangles are not drawn.");
    return {};
  }
  auto placed = vertex_placement(model, primitive, placement, budget.vertices);
  if (!placed) return refuse(placed.error());
  auto positions = world_positions(model, position, *placed, budget.vertices);
  if (!positions) return refuse(positions.error());
  const size_t vertices = positions->size();
  auto order = vertex_order(model, primitive, vertices, budget.indices);
  if (!order) return refuse(order.error());
  mesh.positions = std::move(*positions);
  if (auto added = add_texture_coordinates(model, primitive, mesh, scene); !added) {
    return refuse(added.error());
  }
  if (auto added = add_colors(model, primitive, mesh); !added) return refuse(added.error());
  mesh.indices = as_list(std::move(*order), mode);
  if (auto charged = charge_mesh(vertices, placement, budget, mesh); !charged) {
    return refuse(charged.error());
  }
  turn_mirrored(*placed, mesh.indices);
  drop_flat_faces(mesh);
  if (mesh.indices.empty()) return {};

  if (auto added = add_normals(model, primitive, material, *placed, vertices, mesh); !added) {
    return refuse(added.error());
  }
  // Flat normals may have added vertices.
  charge(budget.vertices, mesh.positions.size() - std::min(vertices, mesh.positions.size()));
  scene.meshes.push_back(std::move(mesh));
  return {};
}

}  // namespace alcove::sample
