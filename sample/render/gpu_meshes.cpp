#include "render/gpu_meshes.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>

#include "maths/octahedral.h"
#include "scene/tangents.h"

namespace alcove::sample {
namespace {

// The sizes of the buffers (pages) that hold the meshes. Each new page is larger than the one
// before, up to kLargestPage, so that many small meshes share few device allocations.
constexpr VkDeviceSize kFirstPage = VkDeviceSize{1} << 20;
constexpr VkDeviceSize kLargestPage = VkDeviceSize{64} << 20;
constexpr VkDeviceSize kAlignment = 16;

std::int16_t snorm16(float value) {
  return static_cast<std::int16_t>(std::lround(std::clamp(value, -1.0f, 1.0f) * 32767.0f));
}

// A unit vector in the octahedral map of maths/octahedral.h, as signed normalised integers. The
// error is at most 5e-5 radians.
using PackedDirection = std::array<std::int16_t, 2>;

PackedDirection packed_direction(const glm::vec3& direction) {
  const glm::vec2 square = maths::octahedral_encode(direction);
  return {snorm16(square.x), snorm16(square.y)};
}

struct PackedNormals {
  PackedDirection vertex;  // normal of the vertex
  PackedDirection face;    // normal of the triangle whose first vertex this is
};

struct PackedTangent {
  PackedDirection direction;
  std::int16_t side;  // sign of the bitangent: 32767 or -32767; 0 without a tangent
  std::int16_t unused;
};

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
  PartBuilder(const Mesh& mesh, const Material& material) : mesh_(mesh), numbers_(mesh.indices) {
    if (material.normal_texture.image < 0 || mesh.normals.empty()) return;
    const std::vector<glm::vec4> tangents = corner_tangents(mesh, material.normal_texture);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i)
      corners_.push_back({mesh.indices[i], packed_tangent(tangents[i])});
    const std::size_t count = corners_.size();
    numbers_of_corners_.resize(count);
    const std::size_t distinct = meshopt_generateVertexRemap(
        numbers_of_corners_.data(), nullptr, count, corners_.data(), count, sizeof(Corner));
    meshopt_remapVertexBuffer(corners_.data(), corners_.data(), count, sizeof(Corner),
                              numbers_of_corners_.data());
    corners_.resize(distinct);
    numbers_ = numbers_of_corners_;
  }

  // Returns the next part, with at most `most_triangles` triangles. It has no indices if no
  // triangle is left. Triangles without an area are left out.
  Part next(std::size_t most_triangles) {
    part_ = {};
    copies_.assign(corners_.empty() ? mesh_.positions.size() : corners_.size(), kNone);
    is_first_.clear();
    const std::size_t left = (mesh_.indices.size() - at_) / 3;
    part_.indices.reserve(3 * std::min(most_triangles, left));
    for (; at_ + 2 < mesh_.indices.size() && part_.indices.size() < 3 * most_triangles; at_ += 3)
      add_triangle();
    part_.faces.resize(part_.sources.size());
    return std::move(part_);
  }

 private:
  // A vertex of the mesh with the tangent that it has in some of its triangles.
  struct Corner {
    std::uint32_t vertex;
    PackedTangent tangent;
  };
  static_assert(sizeof(Corner) == 12);  // without padding, because bytes are compared
  static constexpr std::uint32_t kNone = UINT32_MAX;

  std::uint32_t add_vertex(std::uint32_t number) {
    part_.sources.push_back(corners_.empty() ? number : corners_[number].vertex);
    if (!corners_.empty()) part_.tangents.push_back(corners_[number].tangent);
    is_first_.push_back(false);
    return static_cast<std::uint32_t>(part_.sources.size() - 1);
  }

  // Returns the vertex of the part for an index of the mesh.
  std::uint32_t vertex_at(std::size_t index) {
    std::uint32_t& known = copies_[numbers_[index]];
    if (known == kNone) known = add_vertex(numbers_[index]);
    return known;
  }

  void add_triangle() {
    const glm::dvec3 area = area_of(mesh_, at_);
    const double length = glm::length(area);
    if (!(length > 0.0)) return;
    std::array corners{vertex_at(at_), vertex_at(at_ + 1), vertex_at(at_ + 2)};
    const auto free = std::ranges::find_if(corners, [&](std::uint32_t v) { return !is_first_[v]; });
    if (free != corners.end())
      std::rotate(corners.begin(), free, corners.end());
    else
      corners[0] = add_vertex(numbers_[at_]);
    is_first_[corners[0]] = true;
    part_.faces.resize(part_.sources.size());
    part_.faces[corners[0]] = packed_direction(glm::vec3(area / length));
    part_.indices.insert(part_.indices.end(), corners.begin(), corners.end());
  }

  const Mesh& mesh_;
  std::vector<Corner> corners_;  // distinct ones; empty without a normal map
  std::vector<std::uint32_t> numbers_of_corners_;
  // For each index of the mesh, its corner, or without a normal map its vertex.
  std::span<const std::uint32_t> numbers_;
  Part part_;                          // the current part
  std::vector<std::uint32_t> copies_;  // for each of these numbers, its copy in the current part
  // For each vertex of the part, whether it is already the first vertex of a triangle.
  std::vector<bool> is_first_;
  std::size_t at_ = 0;  // position of the next triangle's indices
};

}  // namespace

// Copies the meshes into pages, and creates a new page when the last one is full.
class GpuMeshes::Builder {
 public:
  Builder(const VulkanDevice& device, VkDeviceSize most_bytes, GpuMeshes& meshes)
      : device_(device), most_bytes_(most_bytes), meshes_(meshes) {}

  Result<void> add_constants() {
    struct Constants {
      std::array<float, 4> zero{};
      std::array<std::uint8_t, 16> white{};
      glm::mat4x3 identity{1.0f};
    } constants;
    constants.white.fill(255);
    return store(1, [&](std::size_t) { return constants; }).map([&](const Place& place) {
      constants_.buffers.fill(place.buffer);
      constants_.offsets.fill(place.offset);
      constants_.offsets[index_of(VertexStream::color)] += offsetof(Constants, white);
      constants_.offsets[index_of(VertexStream::instance)] += offsetof(Constants, identity);
    });
  }

  Result<void> add(const Mesh& mesh, const Material& material) {
    // With this limit on the number of triangles, the largest stream of a part fits into a page
    // even if no two triangles share a vertex.
    const std::size_t most_triangles =
        std::min(most_bytes_, kLargestPage) / (3 * sizeof(glm::vec3));
    PartBuilder builder(mesh, material);
    std::vector<MeshDraw> parts;
    for (Part part = builder.next(most_triangles); !part.indices.empty();
         part = builder.next(most_triangles))
      ALCOVE_TRY_VOID(add_part(mesh, part, parts));
    return add_instances(mesh, parts);
  }

 private:
  static constexpr std::size_t index_of(VertexStream stream) {
    return static_cast<std::size_t>(stream);
  }

  Result<Place> reserve(VkDeviceSize bytes, std::byte*& data) {
    auto& pages = meshes_.pages_;
    VkDeviceSize at = (used_ + kAlignment - 1) / kAlignment * kAlignment;
    if (pages.empty() || at > pages.back()->bytes().size() ||
        bytes > pages.back()->bytes().size() - at) {
      const VkDeviceSize size = std::max(std::min(next_page_, most_bytes_), bytes);
      constexpr auto kUsage = VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT;
      ALCOVE_TRY(
          auto page,
          HostBuffer::create(device_, size, kUsage)
              .map_error(with_prefix("the device has no memory for the scene's triangles after " +
                                     std::to_string(meshes_.bytes()) + " bytes: ")));
      pages.push_back(std::move(page));
      next_page_ = std::min(2 * next_page_, kLargestPage);
      at = 0;
    }
    used_ = at + bytes;
    data = pages.back()->bytes().data() + at;
    return Place{pages.back()->buffer(), at};
  }

  // Copies element(i) for each i below `count` into a page.
  template <class Element>
  Result<Place> store(std::size_t count, const Element& element) {
    using Value = decltype(element(std::size_t{}));
    std::byte* data = nullptr;
    ALCOVE_TRY(const Place place, reserve(count * sizeof(Value), data));
    for (std::size_t i = 0; i < count; ++i) {
      const Value value = element(i);
      std::memcpy(data + i * sizeof(Value), &value, sizeof(Value));
    }
    return place;
  }

  template <class Element>
  Result<void> stream(MeshDraw& draw, VertexStream which, std::size_t count,
                      const Element& element) {
    return store(count, element).map([&](const Place& place) {
      draw.buffers[index_of(which)] = place.buffer;
      draw.offsets[index_of(which)] = place.offset;
      draw.strides[index_of(which)] = sizeof(element(std::size_t{}));
    });
  }

  Result<void> add_part(const Mesh& mesh, const Part& part, std::vector<MeshDraw>& draws) {
    MeshDraw draw = constants_;
    draw.material = mesh.material;
    draw.index_count = static_cast<std::uint32_t>(part.indices.size());
    draw.instance_count = 1;
    draw.moves = mesh.moves;
    draw.faceted = mesh.normals.empty();
    const std::size_t count = part.sources.size();
    // Stores one value for each vertex of the mesh, unless the mesh has none.
    const auto add_values = [&](VertexStream which, const auto& values) {
      return values.empty() ? Result<void>() : stream(draw, which, count, [&](std::size_t i) {
        return values[part.sources[i]];
      });
    };
    const auto normals = [&](std::size_t i) {
      return PackedNormals{
          draw.faceted ? PackedDirection{} : packed_direction(mesh.normals[part.sources[i]]),
          part.faces[i]};
    };
    const auto tangents = [&](std::size_t i) { return part.tangents[i]; };
    ALCOVE_TRY_VOID(add_values(VertexStream::position, mesh.positions));
    ALCOVE_TRY_VOID(stream(draw, VertexStream::normals, count, normals));
    ALCOVE_TRY_VOID(add_values(VertexStream::uv, mesh.uvs));
    ALCOVE_TRY_VOID(add_values(VertexStream::second_uv, mesh.second_uvs));
    if (!part.tangents.empty())
      ALCOVE_TRY_VOID(stream(draw, VertexStream::tangent, count, tangents));
    ALCOVE_TRY_VOID(add_values(VertexStream::color, mesh.colors));
    ALCOVE_TRY(const Place indices,
               store(part.indices.size(), [&](std::size_t i) { return part.indices[i]; }));
    draw.index_buffer = indices.buffer;
    draw.index_offset = indices.offset;
    draws.push_back(draw);
    return {};
  }

  Result<void> add_instances(const Mesh& mesh, const std::vector<MeshDraw>& parts) {
    if (mesh.instances.empty()) {
      meshes_.draws_.insert(meshes_.draws_.end(), parts.begin(), parts.end());
      return {};
    }
    const std::size_t most = most_bytes_ / sizeof(glm::mat4x3);
    for (const bool mirrored : {false, true}) {
      std::vector<std::uint32_t> chosen;
      for (std::uint32_t i = 0; i < mesh.instances.size(); ++i)
        if ((glm::determinant(glm::mat3(mesh.instances[i])) < 0.0f) == mirrored)
          chosen.push_back(i);
      for (std::size_t first = 0; first < chosen.size(); first += most) {
        const std::size_t count = std::min(most, chosen.size() - first);
        MeshDraw instanced;
        ALCOVE_TRY_VOID(stream(instanced, VertexStream::instance, count,
                               [&](std::size_t i) { return mesh.instances[chosen[first + i]]; }));
        constexpr std::size_t kAt = index_of(VertexStream::instance);
        for (MeshDraw draw : parts) {
          draw.mirrored = mirrored;
          draw.instance_count = static_cast<std::uint32_t>(count);
          draw.buffers[kAt] = instanced.buffers[kAt];
          draw.offsets[kAt] = instanced.offsets[kAt];
          draw.strides[kAt] = instanced.strides[kAt];
          meshes_.draws_.push_back(draw);
        }
      }
    }
    return {};
  }

  const VulkanDevice& device_;
  VkDeviceSize most_bytes_;
  GpuMeshes& meshes_;
  VkDeviceSize used_ = 0;  // bytes of the last page that are in use
  VkDeviceSize next_page_ = kFirstPage;
  MeshDraw constants_;  // with every stream bound to its constant
};

Result<std::unique_ptr<GpuMeshes>> GpuMeshes::create(const VulkanDevice& device, const Scene& scene,
                                                     VkDeviceSize most_bytes) {
  std::unique_ptr<GpuMeshes> made(new GpuMeshes);
  const VkDeviceSize limit = device.max_allocation();
  Builder builder(device, most_bytes == 0 ? limit : std::min(most_bytes, limit), *made);
  ALCOVE_TRY_VOID(builder.add_constants());
  for (const Mesh& mesh : scene.meshes)
    ALCOVE_TRY_VOID(builder.add(mesh, scene.materials[mesh.material]));
  return made;
}

VkDeviceSize GpuMeshes::bytes() const {
  VkDeviceSize sum = 0;
  for (const auto& page : pages_) sum += page->bytes().size();
  return sum;
}

}  // namespace alcove::sample
