#include "scene/gltf_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "scene/gltf_accessor.h"
#include "scene/gltf_skin.h"

namespace alcove::sample {
namespace {

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

// Returns the vertices that the indices name, in ascending order, and renumbers the indices by it.
std::vector<uint32_t> compacted(std::vector<uint32_t>& indices) {
  if (indices.empty()) return {};
  const auto [low, high] = std::ranges::minmax(indices);
  std::vector<uint32_t> vertices;
  if (high - low < 4 * indices.size()) {
    std::vector<uint32_t> numbers(size_t{high - low} + 1, 0);
    for (const uint32_t i : indices) numbers[i - low] = 1;
    for (uint32_t i = 0; i < numbers.size(); ++i) {
      if (numbers[i] == 0) continue;
      numbers[i] = static_cast<uint32_t>(vertices.size());
      vertices.push_back(low + i);
    }
    for (uint32_t& i : indices) i = numbers[i - low];
    return vertices;
  }
  vertices = indices;
  std::ranges::sort(vertices);
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  for (uint32_t& i : indices)
    i = static_cast<uint32_t>(std::ranges::lower_bound(vertices, i) - vertices.begin());
  return vertices;
}

// Reverses the winding of triangles that their transform mirrors.
void turn_mirrored(const VertexTransforms& transforms, std::vector<uint32_t>& indices) {
  for (size_t i = 0; i + 2 < indices.size(); i += 3)
    if (glm::determinant(glm::dmat3(transforms.at(indices[i]))) < 0.0)
      std::swap(indices[i + 1], indices[i + 2]);
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
  for (size_t i = 0; i < mesh.indices.size(); i += 3)
    mesh.normals.insert(mesh.normals.end(), 3, glm::vec3(glm::normalize(area_of(mesh, i))));
  const auto expand = [&](auto& values) {
    if (values.empty()) return;
    const auto by_vertex = std::exchange(values, {});
    for (const uint32_t v : mesh.indices) values.push_back(by_vertex[v]);
  };
  expand(mesh.positions);
  expand(mesh.uvs);
  expand(mesh.second_uvs);
  expand(mesh.colors);
  std::iota(mesh.indices.begin(), mesh.indices.end(), 0u);
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
  return std::ranges::any_of(material.textures(), [&](const TextureUse* use) {
    return use->image >= 0 && use->uv_set == uv_set;
  });
}

void charge(uint64_t& budget, uint64_t count) { budget -= std::min(budget, count); }

bool is_invisible(const Material& material) {
  return material.alpha_mode == AlphaMode::blend && material.base_color.a == 0.0f;
}

// Reads one primitive as a mesh. The steps are called in the order of their declaration.
class PrimitiveReader {
 public:
  PrimitiveReader(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                  const PrimitivePlacement& placement, GltfLimits& budget, Scene& scene, Mesh begun)
      : mesh(std::move(begun)),
        model_(model),
        primitive_(primitive),
        placement_(placement),
        budget_(budget),
        scene_(scene),
        material_(scene.materials[this->mesh.material]),
        transforms_(placement.world_from_mesh) {}

  // Reads the indices as a list of triangles, and takes its size from the budget.
  Result<void> read_triangles(int mode);
  Result<void> read_positions();
  // Reads the sets of texture coordinates that the textures of the material use.
  Result<void> read_uvs();
  // Reads COLOR_0. Colours without alpha get an alpha of 1. If all are white, none are kept.
  Result<void> read_colors();
  // Reads normals and tangents. Without normals, triangles have geometric normals and tangents are
  // ignored (glTF 2.0 section 3.7.2.1).
  Result<void> read_normals();

  Mesh mesh;

 private:
  Result<void> read_indices_of(const tinygltf::Accessor& positions);
  Result<void> charge_budget();
  // Returns the values of an attribute for all vertices, with the deltas of the morph targets,
  // which have three components. The attribute must exist.
  Result<std::vector<float>> values(const std::string& name, int components);

  const tinygltf::Model& model_;
  const tinygltf::Primitive& primitive_;
  const PrimitivePlacement& placement_;
  GltfLimits& budget_;
  Scene& scene_;
  const Material& material_;
  VertexTransforms transforms_;
  std::vector<uint32_t> vertices_;  // the vertices of the file that the triangles use
};

Result<void> PrimitiveReader::read_triangles(int mode) {
  const auto position = static_cast<size_t>(attribute(primitive_.attributes, "POSITION"));
  if (position >= model_.accessors.size())
    return Failure("accessor " + std::to_string(position) + " does not exist");
  ALCOVE_TRY_VOID(read_indices_of(model_.accessors[position]));
  mesh.indices = as_list(std::move(mesh.indices), mode);
  vertices_ = compacted(mesh.indices);
  return charge_budget();
}

Result<void> PrimitiveReader::read_indices_of(const tinygltf::Accessor& positions) {
  const uint64_t vertices = positions.count;
  if (primitive_.indices >= 0) {
    ALCOVE_TRY(mesh.indices, read_indices(model_, primitive_.indices, vertices, budget_.indices));
    return {};
  }
  // A few bytes of a file can name any number of vertices without data.
  constexpr uint64_t kMostWithoutData = uint64_t{1} << 22;
  if (vertices > std::min(budget_.vertices, budget_.indices) ||
      (positions.bufferView < 0 && vertices > kMostWithoutData))
    return Failure("has too many vertices: " + std::to_string(vertices));
  mesh.indices.resize(vertices);
  std::iota(mesh.indices.begin(), mesh.indices.end(), 0u);
  return {};
}

Result<void> PrimitiveReader::charge_budget() {
  if (mesh.indices.size() > budget_.indices || vertices_.size() > budget_.vertices)
    return Failure("takes the scene past the number of triangles that is read here");
  if (placement_.instances != nullptr) {
    if (placement_.instances->size() > budget_.instances)
      return Failure("takes the scene past the number of instances that is read here");
    budget_.instances -= placement_.instances->size();
    mesh.instances = *placement_.instances;
  }
  const uint64_t drawn = mesh.indices.size() / 3 * instance_count(mesh);
  if (drawn > budget_.drawn_triangles) {
    return Failure(
        "takes the scene past the number of triangles that is drawn here, instances "
        "counted each");
  }
  // Triangles without an area count too, because they took time to read.
  charge(budget_.vertices, vertices_.size());
  charge(budget_.indices, mesh.indices.size());
  charge(budget_.drawn_triangles, drawn);
  return {};
}

Result<std::vector<float>> PrimitiveReader::values(const std::string& name, int components) {
  ALCOVE_TRY(auto sum, read_floats(model_, attribute(primitive_.attributes, name), components, 0,
                                   &vertices_));
  const bool morphs = name == "POSITION" || name == "NORMAL" || name == "TANGENT";
  if (!morphs || placement_.morph_weights == nullptr) return sum;
  const size_t targets = std::min(primitive_.targets.size(), placement_.morph_weights->size());
  for (size_t t = 0; t < targets; ++t) {
    const int delta = attribute(primitive_.targets[t], name);
    const auto weight = static_cast<float>((*placement_.morph_weights)[t]);
    if (delta < 0 || weight == 0.0f) continue;
    if (budget_.vertices < vertices_.size())
      return Failure("takes the scene past the number of vertices of morph targets");
    charge(budget_.vertices, vertices_.size());
    ALCOVE_TRY(const auto deltas, read_floats(model_, delta, 3, 0, &vertices_));
    for (size_t v = 0; v < vertices_.size(); ++v)
      for (size_t c = 0; c < 3; ++c)
        sum[v * static_cast<size_t>(components) + c] += weight * deltas[3 * v + c];
  }
  return sum;
}

Result<void> PrimitiveReader::read_positions() {
  // The squares of larger lengths overflow a float.
  constexpr float kFarthest = 1e15f;
  if (placement_.joints != nullptr) {
    ALCOVE_TRY(transforms_, VertexTransforms::skinned(model_, primitive_, vertices_,
                                                      *placement_.joints, budget_.vertices));
  }
  ALCOVE_TRY(const auto read, values("POSITION", 3));
  mesh.positions.resize(vertices_.size());
  for (size_t i = 0; i < vertices_.size(); ++i) {
    const float* in = &read[3 * i];
    glm::vec3& out = mesh.positions[i];
    out = glm::vec3(transforms_.at(i) * glm::dvec4(in[0], in[1], in[2], 1.0));
    if (!glm::all(glm::lessThanEqual(glm::abs(out), glm::vec3(kFarthest)))) {
      return Failure("has a vertex " + std::to_string(vertices_[i]) +
                     " that is not a finite position within 1e15 of the origin");
    }
  }
  turn_mirrored(transforms_, mesh.indices);
  drop_flat_faces(mesh);
  return {};
}

Result<void> PrimitiveReader::read_uvs() {
  for (const uint32_t set : {0u, 1u}) {
    if (!reads_by(material_, set)) continue;
    const std::string name = "TEXCOORD_" + std::to_string(set);
    if (attribute(primitive_.attributes, name) < 0) {
      scene_.warnings.push_back("Mesh " + mesh.name + " lacks the texture coordinates " +
                                std::to_string(set) +
                                " that its material names: they are taken to be zero.");
      continue;
    }
    ALCOVE_TRY(const auto read, values(name, 2));
    std::vector<glm::vec2>& uvs = set == 0 ? mesh.uvs : mesh.second_uvs;
    for (size_t i = 0; i < read.size(); i += 2) {
      const glm::vec2 uv(read[i], read[i + 1]);
      uvs.push_back(std::isfinite(uv.x) && std::isfinite(uv.y) ? uv : glm::vec2(0.0f));
    }
  }
  return {};
}

Result<void> PrimitiveReader::read_colors() {
  const auto accessor = static_cast<size_t>(attribute(primitive_.attributes, "COLOR_0"));
  if (accessor == SIZE_MAX) return {};
  const bool has_alpha =
      accessor < model_.accessors.size() && model_.accessors[accessor].type == TINYGLTF_TYPE_VEC4;
  const size_t width = has_alpha ? 4 : 3;
  ALCOVE_TRY(const auto read, values("COLOR_0", static_cast<int>(width)));
  mesh.colors.assign(vertices_.size(), glm::u8vec4(255));
  for (size_t i = 0; i < read.size(); ++i) {
    const float value = std::isfinite(read[i]) ? std::clamp(read[i], 0.0f, 1.0f) : 1.0f;
    mesh.colors[i / width][static_cast<int>(i % width)] =
        static_cast<uint8_t>(std::lround(255.0f * value));
  }
  const auto is_white = [](const glm::u8vec4& color) { return color == glm::u8vec4(255); };
  if (std::ranges::all_of(mesh.colors, is_white)) mesh.colors = {};
  return {};
}

Result<void> PrimitiveReader::read_normals() {
  const bool mapped = material_.normal_texture.image >= 0;
  if (attribute(primitive_.attributes, "NORMAL") < 0) {
    // The tangents of a normal map are computed at vertices that have a normal, so that the mesh
    // needs vertex normals.
    if (mapped) make_flat_normals(mesh);
    return {};
  }
  ALCOVE_TRY(const auto normals, values("NORMAL", 3));
  for (size_t i = 0; i < vertices_.size(); ++i) {
    // Normals that are zero or not finite become zero.
    const float* in = &normals[3 * i];
    mesh.normals.emplace_back(
        direction_of(cofactor(transforms_.at(i)) * glm::dvec3(in[0], in[1], in[2])));
  }
  mend_normals(mesh);
  if (!mapped || attribute(primitive_.attributes, "TANGENT") < 0) return {};
  ALCOVE_TRY(const auto tangents, values("TANGENT", 4));
  for (size_t i = 0; i < vertices_.size(); ++i) {
    const glm::dmat3 m(transforms_.at(i));
    const float side = glm::determinant(m) < 0.0 ? -1.0f : 1.0f;
    const float* in = &tangents[4 * i];
    mesh.tangents.emplace_back(glm::vec3(direction_of(m * glm::dvec3(in[0], in[1], in[2]))),
                               in[3] < 0.0f ? -side : side);
  }
  return {};
}

}  // namespace

Result<void> add_primitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                           const std::string& name, const PrimitivePlacement& placement,
                           GltfLimits& budget, Scene& scene) {
  if (budget.primitives == 0)
    return Failure("takes the scene past the number of parts that is read here");
  --budget.primitives;
  // tinygltf stores -1 if the file gives no mode. The default is triangles.
  const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
  if (mode < TINYGLTF_MODE_TRIANGLES || mode > TINYGLTF_MODE_TRIANGLE_FAN) {
    scene.warnings.push_back("Mesh " + name + " has points or lines, which are left out.");
    return {};
  }
  if (primitive.material >= static_cast<int>(model.materials.size()))
    return Failure("has no material " + std::to_string(primitive.material));
  if (attribute(primitive.attributes, "POSITION") < 0) return {};

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
  PrimitiveReader reader(model, primitive, placement, budget, scene, std::move(mesh));
  ALCOVE_TRY_VOID(reader.read_triangles(mode));
  ALCOVE_TRY_VOID(reader.read_positions());
  if (reader.mesh.indices.empty()) return {};
  ALCOVE_TRY_VOID(reader.read_uvs());
  ALCOVE_TRY_VOID(reader.read_colors());
  ALCOVE_TRY_VOID(reader.read_normals());
  scene.meshes.push_back(std::move(reader.mesh));
  return {};
}

}  // namespace alcove::sample
