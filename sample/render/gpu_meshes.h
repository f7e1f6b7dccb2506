#pragma once

#include <vulkan/vulkan.h>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "gpu/gpu.h"
#include "scene/scene.h"
#include "support/result.h"

namespace alcove::sample {

// The vertex buffers of a draw; the values are their binding numbers. Every draw binds all of them.
// If a mesh does not have a stream, one constant element is bound with a stride of zero.
enum class VertexStream : std::uint8_t {
  position,   // 3 floats
  normals,    // PackedNormals of gpu_meshes.cpp
  uv,         // 2 floats; zero if the mesh has none
  second_uv,  // 2 floats; zero if the mesh has none
  tangent,    // PackedTangent of it; zero if the mesh has none
  color,      // 4 bytes, linear RGB and alpha; white if the mesh has none
  instance,   // the columns of world_from_mesh, 12 floats; the identity. One for each instance
};
inline constexpr std::size_t kVertexStreams = 7;

// One indexed draw, of a part of a mesh.
struct MeshDraw {
  std::uint32_t material = 0;
  std::uint32_t index_count = 0;
  std::uint32_t instance_count = 0;
  bool moves = false;
  bool faceted = false;   // the mesh has no vertex normals
  bool mirrored = false;  // its instances mirror the mesh, which reverses the winding
  VkBuffer index_buffer = VK_NULL_HANDLE;
  VkDeviceSize index_offset = 0;
  std::array<VkBuffer, kVertexStreams> buffers{};
  std::array<VkDeviceSize, kVertexStreams> offsets{};
  std::array<VkDeviceSize, kVertexStreams> strides{};
};

// The meshes of a scene in device memory. Triangles of a mesh share vertices, and instances share
// meshes. Large meshes are split, so that no buffer exceeds the device's limit for one allocation.
// A triangle takes 32 bytes if its vertices are shared as in a grid, and 8 more for texture
// coordinates; an instance takes 48 bytes.
class GpuMeshes {
 public:
  // Uploads the meshes. `most_bytes` is the largest size of a buffer, at least 4096; zero selects
  // the device's limit. If the device has not enough memory, the error is one sentence with the
  // sizes.
  [[nodiscard]] static Result<std::unique_ptr<GpuMeshes>> create(const VulkanDevice& device,
                                                                 const Scene& scene,
                                                                 VkDeviceSize most_bytes = 0);

  [[nodiscard]] const std::vector<MeshDraw>& draws() const { return draws_; }
  // Returns the size of all buffers in bytes.
  [[nodiscard]] VkDeviceSize bytes() const;
  [[nodiscard]] std::size_t buffers() const { return pages_.size(); }

 private:
  class Builder;
  GpuMeshes() = default;
  std::vector<std::unique_ptr<HostBuffer>> pages_;
  std::vector<MeshDraw> draws_;
};

}  // namespace alcove::sample
