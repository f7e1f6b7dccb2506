#include "render/gpu_meshes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <unordered_map>
#include <utility>

#include "maths/octahedral.h"
#include "scene/area.h"
#include "scene/tangents.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

// The sizes of the buffers (pages) that hold the meshes. Each new page is larger than the one
// before, up to kLargestPage, so that many small meshes share few device allocations.
constexpr VkDeviceSize kFirstPage = VkDeviceSize{1} << 20;
constexpr VkDeviceSize kLargestPage = VkDeviceSize{64} << 20;
constexpr VkDeviceSize kAlignment = 16;

std::int16_t snorm16(float value) {
  return static_cast<std::int16_t>(std::lround(std::clamp(value, -1.0f, 1.0f) * 32767.0f));
}

// A range of a page: the buffer, and the offset of the first byte.
struct Place {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceSize offset = 0;
};

// Part of a mesh with its own copies of the vertices. Each copy is the first vertex of at most one
// triangle, because it also stores the geometric normal of that triangle.
struct Part {
  // For each vertex, the index of the mesh's vertex that it copies.
  std::vector<std::uint32_t> sources;
  std::vector<PackedTangent> tangents;  // one for each vertex; empty without a normal map
  // One for each vertex: normal of the triangle whose first vertex it is.
  std::vector<PackedDirection> faces;
  std::vector<std::uint32_t> indices;
};

PackedTangent packed_tangent(const glm::vec4& tangent) {
  if (glm::vec3(tangent) == glm::vec3(0.0f)) return {{0, 0}, 0, 0};
  return {packed_direction(glm::vec3(tangent)),
          static_cast<std::int16_t>(tangent.w < 0.0f ? -32767 : 32767), 0};
}

// Divides the triangles of a mesh into parts.
class PartBuilder {
 public:
  PartBuilder(const Mesh& mesh, const Material& material) : mesh_(mesh) {
    if (material.normal_texture.image >= 0 && !mesh.normals.empty()) {
      tangents_ = corner_tangents(mesh, material.normal_texture);
    }
  }

  // Returns the next part, with at most `most_triangles` triangles. It has no indices if no
  // triangle is left. Triangles without an area are left out.
  Part next(std::size_t most_triangles);

 private:
  struct Corner {
    std::uint32_t vertex;
    std::uint64_t tangent;
    bool operator==(const Corner&) const = default;
  };
  struct CornerHash {
    std::size_t operator()(const Corner& corner) const {
      return std::hash<std::uint64_t>()((corner.tangent + corner.vertex) * 0x9e3779b97f4a7c15u);
    }
  };

  std::uint32_t vertex_of(std::size_t index, Part& part);
  std::uint32_t copy_of(std::uint32_t vertex, Part& part) const;

  static constexpr std::uint32_t kNone = UINT32_MAX;
  const Mesh& mesh_;
  std::vector<glm::vec4> tangents_;  // one for each index; empty without a normal map
  // For each vertex of the mesh, its copy in the current part.
  std::vector<std::uint32_t> of_vertex_;
  // The copies of corners that differ in their tangents.
  std::unordered_map<Corner, std::uint32_t, CornerHash> of_corner_;
  // For each vertex of the part, whether it is already the first vertex of a triangle.
  std::vector<bool> is_first_;
  std::size_t at_ = 0;  // position of the next triangle's indices
};

std::uint32_t PartBuilder::vertex_of(std::size_t index, Part& part) {
  const std::uint32_t source = mesh_.indices[index];
  const auto add = [&] {
    part.sources.push_back(source);
    is_first_.push_back(false);
    return static_cast<std::uint32_t>(part.sources.size() - 1);
  };
  if (tangents_.empty()) {
    std::uint32_t& known = of_vertex_[source];
    if (known == kNone) known = add();
    return known;
  }
  const PackedTangent tangent = packed_tangent(tangents_[index]);
  Corner corner{source, 0};
  std::memcpy(&corner.tangent, &tangent, sizeof(tangent));
  const auto [known, is_new] = of_corner_.try_emplace(corner, 0);
  if (is_new) {
    known->second = add();
    part.tangents.push_back(tangent);
  }
  return known->second;
}

std::uint32_t PartBuilder::copy_of(std::uint32_t vertex, Part& part) const {
  part.sources.push_back(part.sources[vertex]);
  if (!tangents_.empty()) part.tangents.push_back(part.tangents[vertex]);
  return static_cast<std::uint32_t>(part.sources.size() - 1);
}

Part PartBuilder::next(std::size_t most_triangles) {
  Part part;
  if (tangents_.empty()) {
    of_vertex_.assign(mesh_.positions.size(), kNone);
  }
  of_corner_.clear();
  is_first_.clear();
  const std::size_t left = (mesh_.indices.size() - at_) / 3;
  part.indices.reserve(3 * std::min(most_triangles, left));
  for (; at_ + 2 < mesh_.indices.size() && part.indices.size() < 3 * most_triangles; at_ += 3) {
    const glm::dvec3 area = area_of(mesh_, at_);
    const double length = glm::length(area);
    if (!(length > 0.0)) continue;
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) corners[k] = vertex_of(at_ + k, part);
    const auto free = std::ranges::find_if(corners, [&](std::uint32_t v) { return !is_first_[v]; });
    if (free != corners.end()) {
      std::rotate(corners.begin(), free, corners.end());
    } else {
      corners[0] = copy_of(corners[0], part);
      is_first_.push_back(false);
    }
    is_first_[corners[0]] = true;
    part.faces.resize(part.sources.size());
    part.faces[corners[0]] = packed_direction(glm::vec3(area / length));
    part.indices.insert(part.indices.end(), corners.begin(), corners.end());
  }
  part.faces.resize(part.sources.size());
  return part;
}

}  // namespace

PackedDirection packed_direction(const glm::vec3& direction) {
  const glm::vec2 square = maths::octahedral_encode(direction);
  return {snorm16(square.x), snorm16(square.y)};
}

// Copies the meshes into pages, and creates a new page when the last one is full.
class GpuMeshes::Builder {
 public:
  Builder(const VulkanDevice& device, VkDeviceSize most_bytes, GpuMeshes& meshes)
      : device_(device), most_bytes_(most_bytes), meshes_(meshes) {}

  tl::expected<void, std::string> add_constants();
  tl::expected<void, std::string> add(const Mesh& mesh, const Material& material);

 private:
  tl::expected<Place, std::string> reserve(VkDeviceSize bytes, std::byte*& data);
  // Copies element(i) for each i below `count` into a page.
  template <class Element>
  tl::expected<Place, std::string> store(std::size_t count, const Element& element);
  template <class Element>
  void stream(MeshDraw& draw, VertexStream which, std::size_t count, const Element& element);
  tl::expected<void, std::string> add_part(const Mesh& mesh, const Part& part,
                                           std::vector<MeshDraw>& draws);
  tl::expected<void, std::string> add_instances(const Mesh& mesh,
                                                const std::vector<MeshDraw>& parts);
  void bind_constant(MeshDraw& draw, VertexStream which, const Place& place) {
    draw.buffers[static_cast<std::size_t>(which)] = place.buffer;
    draw.offsets[static_cast<std::size_t>(which)] = place.offset;
  }

  const VulkanDevice& device_;
  VkDeviceSize most_bytes_;
  GpuMeshes& meshes_;
  VkDeviceSize used_ = 0;  // bytes of the last page that are in use
  VkDeviceSize next_page_ = kFirstPage;
  MeshDraw constants_;   // with every stream bound to its constant
  std::string failure_;  // the first error while storing the streams of a draw
};

tl::expected<Place, std::string> GpuMeshes::Builder::reserve(VkDeviceSize bytes, std::byte*& data) {
  auto& pages = meshes_.pages_;
  const VkDeviceSize at = (used_ + kAlignment - 1) / kAlignment * kAlignment;
  if (pages.empty() || at > pages.back()->bytes().size() ||
      bytes > pages.back()->bytes().size() - at) {
    const VkDeviceSize size = std::max(std::min(next_page_, most_bytes_), bytes);
    auto page = HostBuffer::create(
        device_, size, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    if (!page) {
      return Failure("the device has no memory for the scene's triangles after " +
                     std::to_string(meshes_.bytes()) + " bytes: " + page.error());
    }
    pages.push_back(std::move(*page));
    next_page_ = std::min(2 * next_page_, kLargestPage);
    used_ = bytes;
    data = pages.back()->bytes().data();
    return Place{pages.back()->buffer(), 0};
  }
  used_ = at + bytes;
  data = pages.back()->bytes().data() + at;
  return Place{pages.back()->buffer(), at};
}

template <class Element>
tl::expected<Place, std::string> GpuMeshes::Builder::store(std::size_t count,
                                                           const Element& element) {
  using Value = decltype(element(std::size_t{}));
  std::byte* data = nullptr;
  auto place = reserve(count * sizeof(Value), data);
  for (std::size_t i = 0; place && i < count; ++i) {
    const Value value = element(i);
    std::memcpy(data + i * sizeof(Value), &value, sizeof(Value));
  }
  return place;
}

template <class Element>
void GpuMeshes::Builder::stream(MeshDraw& draw, VertexStream which, std::size_t count,
                                const Element& element) {
  if (!failure_.empty()) return;
  const auto place = store(count, element);
  if (!place) {
    failure_ = place.error();
    return;
  }
  bind_constant(draw, which, *place);
  draw.strides[static_cast<std::size_t>(which)] = sizeof(element(std::size_t{}));
}

tl::expected<void, std::string> GpuMeshes::Builder::add_constants() {
  struct Constants {
    std::array<float, 4> zero{};
    std::array<std::uint8_t, 16> white{};
    glm::mat4x3 identity{1.0f};
  } constants;
  constants.white.fill(255);
  const auto place = store(1, [&](std::size_t) { return constants; });
  if (!place) return Failure(place.error());
  for (const VertexStream which : {VertexStream::position, VertexStream::normals, VertexStream::uv,
                                   VertexStream::second_uv, VertexStream::tangent}) {
    bind_constant(constants_, which, *place);
  }
  bind_constant(constants_, VertexStream::color,
                {place->buffer, place->offset + offsetof(Constants, white)});
  bind_constant(constants_, VertexStream::instance,
                {place->buffer, place->offset + offsetof(Constants, identity)});
  return {};
}

tl::expected<void, std::string> GpuMeshes::Builder::add_part(const Mesh& mesh, const Part& part,
                                                             std::vector<MeshDraw>& draws) {
  MeshDraw draw = constants_;
  draw.material = mesh.material;
  draw.index_count = static_cast<std::uint32_t>(part.indices.size());
  draw.instance_count = 1;
  draw.moves = mesh.moves;
  draw.faceted = mesh.normals.empty();
  const std::size_t count = part.sources.size();
  stream(draw, VertexStream::position, count,
         [&](std::size_t i) { return mesh.positions[part.sources[i]]; });
  stream(draw, VertexStream::normals, count, [&](std::size_t i) {
    return PackedNormals{
        draw.faceted ? PackedDirection{} : packed_direction(mesh.normals[part.sources[i]]),
        part.faces[i]};
  });
  if (!mesh.uvs.empty()) {
    stream(draw, VertexStream::uv, count, [&](std::size_t i) { return mesh.uvs[part.sources[i]]; });
  }
  if (!mesh.second_uvs.empty()) {
    stream(draw, VertexStream::second_uv, count,
           [&](std::size_t i) { return mesh.second_uvs[part.sources[i]]; });
  }
  if (!part.tangents.empty()) {
    stream(draw, VertexStream::tangent, count, [&](std::size_t i) { return part.tangents[i]; });
  }
  if (!mesh.colors.empty()) {
    stream(draw, VertexStream::color, count,
           [&](std::size_t i) { return mesh.colors[part.sources[i]]; });
  }
  if (!failure_.empty()) return Failure(failure_);
  const auto indices = store(part.indices.size(), [&](std::size_t i) { return part.indices[i]; });
  if (!indices) return Failure(indices.error());
  draw.index_buffer = indices->buffer;
  draw.index_offset = indices->offset;
  draws.push_back(draw);
  return {};
}

tl::expected<void, std::string> GpuMeshes::Builder::add_instances(
    const Mesh& mesh, const std::vector<MeshDraw>& parts) {
  if (mesh.instances.empty()) {
    meshes_.draws_.insert(meshes_.draws_.end(), parts.begin(), parts.end());
    return {};
  }
  const std::size_t most = most_bytes_ / sizeof(glm::mat4x3);
  for (const bool mirrored : {false, true}) {
    std::vector<std::uint32_t> chosen;
    const auto flush = [&]() -> tl::expected<void, std::string> {
      MeshDraw instanced;
      stream(instanced, VertexStream::instance, chosen.size(),
             [&](std::size_t i) { return mesh.instances[chosen[i]]; });
      if (!failure_.empty()) return Failure(failure_);
      constexpr auto kAt = static_cast<std::size_t>(VertexStream::instance);
      for (MeshDraw draw : parts) {
        draw.mirrored = mirrored;
        draw.instance_count = static_cast<std::uint32_t>(chosen.size());
        draw.buffers[kAt] = instanced.buffers[kAt];
        draw.offsets[kAt] = instanced.offsets[kAt];
        draw.strides[kAt] = instanced.strides[kAt];
        meshes_.draws_.push_back(draw);
      }
      chosen.clear();
      return {};
    };
    for (std::uint32_t i = 0; i < mesh.instances.size(); ++i) {
      if ((glm::determinant(glm::mat3(mesh.instances[i])) < 0.0f) != mirrored) continue;
      chosen.push_back(i);
      if (chosen.size() == most) {
        if (auto done = flush(); !done) return done;
      }
    }
    if (!chosen.empty()) {
      if (auto done = flush(); !done) return done;
    }
  }
  return {};
}

tl::expected<void, std::string> GpuMeshes::Builder::add(const Mesh& mesh,
                                                        const Material& material) {
  // With this limit on the number of triangles, the largest stream of a part fits into a page even
  // if no two triangles share a vertex.
  const std::size_t most_triangles = std::min(most_bytes_, kLargestPage) / (3 * sizeof(glm::vec3));
  PartBuilder builder(mesh, material);
  std::vector<MeshDraw> parts;
  for (Part part = builder.next(most_triangles); !part.indices.empty();
       part = builder.next(most_triangles)) {
    if (auto done = add_part(mesh, part, parts); !done) return done;
  }
  return add_instances(mesh, parts);
}

tl::expected<std::unique_ptr<GpuMeshes>, std::string> GpuMeshes::create(const VulkanDevice& device,
                                                                        const Scene& scene,
                                                                        VkDeviceSize most_bytes) {
  std::unique_ptr<GpuMeshes> made(new GpuMeshes);
  const VkDeviceSize limit = device.max_allocation();
  Builder builder(device, most_bytes == 0 ? limit : std::min(most_bytes, limit), *made);
  auto done = builder.add_constants();
  for (std::size_t i = 0; done && i < scene.meshes.size(); ++i) {
    done = builder.add(scene.meshes[i], scene.materials[scene.meshes[i].material]);
  }
  if (!done) return Failure(done.error());
  return made;
}

VkDeviceSize GpuMeshes::bytes() const {
  VkDeviceSize sum = 0;
  for (const auto& page : pages_) sum += page->bytes().size();
  return sum;
}

}  // namespace alcove::sample
