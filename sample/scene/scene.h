#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/bounds.h"
#include "scene/camera.h"
#include "support/glm.h"

namespace alcove::sample {

// An 8-bit RGBA image, top row first. Base colour and emission are encoded as sRGB; roughness,
// metal and normals are linear. The material's use of the image determines which encoding applies.
struct TextureImage {
  std::string name;
  uint32_t width = 0;
  uint32_t height = 0;
  std::vector<uint8_t> rgba;  // 4 * width * height
};

enum class Wrap : uint8_t { repeat, clamp, mirror };
enum class Filter : uint8_t { linear, nearest };
enum class MipFilter : uint8_t { linear, nearest, none };  // none: mip 0 alone is read

// How an image is read outside of 0..1, and between texels and mips.
struct Sampler {
  Wrap wrap_u = Wrap::repeat;
  Wrap wrap_v = Wrap::repeat;
  Filter magnify = Filter::linear;
  Filter minify = Filter::linear;
  MipFilter mips = MipFilter::linear;

  bool operator==(const Sampler&) const = default;
};

// How a material uses an image. `image` is an index into Scene::images; -1 means that there is no
// image, and lookups return white.
struct TextureUse {
  int32_t image = -1;
  Sampler sampler;
  uint32_t uv_set = 0;  // 0: Mesh::uvs, 1: Mesh::second_uvs
  glm::mat3x2 texture_from_mesh_uv{1.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f};  // finite
};

// How the alpha of a material is used. Alpha-blended materials are opaque in the rasteriser and in
// the ray tracer, because a g-buffer holds one surface per pixel.
enum class AlphaMode : uint8_t {
  opaque,
  mask,   // cut out below alpha_cutoff
  blend,  // drawn and traced as opaque
};

// A metallic-roughness material after glTF 2.0 section 3.9. Factors are linear and multiply the
// texture.
struct Material {
  std::string name;
  glm::vec4 base_color{1.0f};  // 0..1
  TextureUse base_color_texture;
  float metallic = 0.0f;               // 0..1
  float roughness = 1.0f;              // perceptual, 0..1
  TextureUse metal_roughness_texture;  // green: roughness, blue: metal
  glm::vec3 emissive{0.0f};            // >= 0
  TextureUse emissive_texture;
  // A normal map in tangent space: x along u, y against v (up in the image), z along the normal.
  // Without an image the mesh's normal is used.
  TextureUse normal_texture;
  float normal_scale = 1.0f;  // of x and y; -1e6..1e6
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5f;  // for AlphaMode::mask: points with alpha >= cutoff are drawn
  // If false, back faces are neither drawn nor hit by rays (glTF 2.0 section 3.9.6).
  bool double_sided = true;

  // Returns the least alpha at which a point of a mask is drawn. It is a little below the cutoff,
  // because alpha that is interpolated between equal vertices is only nearly theirs.
  [[nodiscard]] float least_alpha() const { return alpha_cutoff - 0x1p-14f; }
  // Returns base colour, metal and roughness, emission and normal map.
  [[nodiscard]] std::array<TextureUse*, 4> textures() {
    return {&base_color_texture, &metal_roughness_texture, &emissive_texture, &normal_texture};
  }
  [[nodiscard]] std::array<const TextureUse*, 4> textures() const {
    return {&base_color_texture, &metal_roughness_texture, &emissive_texture, &normal_texture};
  }
};

// Triangles of one material, counter-clockwise seen from the front. The arrays are in mesh space,
// which is world space for a mesh without `instances`. Every vertex array is as long as `positions`
// or empty; every index is below that length.
struct Mesh {
  std::string name;
  uint32_t material = 0;  // indexes Scene::materials
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;     // unit; if empty, each triangle has its geometric normal
  std::vector<glm::vec2> uvs;         // zero if empty
  std::vector<glm::vec2> second_uvs;  // zero if empty
  // Tangents from the file, unit or zero. The bitangent is w * cross(normal, tangent). If empty,
  // corner_tangents() computes tangents from texture coordinates.
  std::vector<glm::vec4> tangents;
  // Vertex colours, by which the base colour is multiplied: linear RGB and alpha, 8-bit unsigned
  // normalised. If empty, all are white.
  std::vector<glm::u8vec4> colors;
  std::vector<uint32_t> indices;  // 3 per triangle
  // The affine transform from mesh to world space of each instance. If empty, the mesh has one
  // instance with the identity.
  std::vector<glm::mat4x3> instances;
  // Whether the rasteriser also transforms the mesh by GbufferView::world_from_moving. The ray
  // tracer does not.
  bool moves = false;
};

// A scene for the rasteriser and the ray tracer. A scene with meshes has at least one material.
struct Scene {
  std::string name;
  std::vector<Mesh> meshes;
  std::vector<Material> materials;
  std::vector<TextureImage> images;
  std::vector<Camera> cameras;  // the first is the default view; may be empty
  // The origin of world space in the coordinates of the file. Views that the user types or reads
  // are in the coordinates of the file.
  glm::dvec3 origin{0.0};
  Bounds bounds_ws;                   // of all triangles
  float suggested_radius = 0.0f;      // scene units; 0: the view decides (ViewFinder::radius())
  bool has_animations = false;        // in the file; they are not played
  std::vector<std::string> warnings;  // one sentence for each part that is not drawn as stored
};

// Returns the number of triangles of all meshes, counted once for each instance.
[[nodiscard]] uint64_t triangle_count(const Scene& scene);

// Returns the camera of a name, or the first for an empty name. Null if there is no such camera.
[[nodiscard]] const Camera* find_camera(const Scene& scene, const std::string& name);

// Returns the transform of an instance, whose index is below instance_count(). It is the identity
// for a mesh whose `instances` is empty.
[[nodiscard]] glm::mat4x3 world_from_mesh(const Mesh& mesh, size_t instance);
[[nodiscard]] inline size_t instance_count(const Mesh& mesh) {
  return mesh.instances.empty() ? 1 : mesh.instances.size();
}

// Returns the normal of the triangle whose indices begin at `first`, multiplied by twice its area.
// It is computed in double, because the cross product of the edges of a narrow triangle cancels,
// and because the squares of very small or large lengths are outside the range of floats.
[[nodiscard]] glm::dvec3 area_of(const Mesh& mesh, size_t first);

// The texture coordinates at a point of a mesh, indexed by TextureUse::uv_set.
using MeshUvs = std::array<glm::vec2, 2>;
[[nodiscard]] MeshUvs uvs_at(const Mesh& mesh, uint32_t vertex);
// Returns the texture coordinates at the barycentric coordinates (1 - u - v, u, v) of a triangle.
[[nodiscard]] MeshUvs uvs_within(const Mesh& mesh, uint32_t triangle, float u, float v);
// Returns the vertex colour at the barycentric coordinates (1 - u - v, u, v) of a triangle, 0..1.
[[nodiscard]] glm::vec4 color_within(const Mesh& mesh, uint32_t triangle, float u, float v);

// Returns the coordinates in the image for the texture coordinates of the mesh. They are finite.
[[nodiscard]] glm::vec2 texture_uv(const TextureUse& use, const MeshUvs& mesh_uvs);

// Returns the colour that the sampler reads from mip 0 for the texture coordinates of the mesh:
// 0..1 as stored, without sRGB decoding.
[[nodiscard]] glm::vec4 sample_texture(const Scene& scene, const TextureUse& use,
                                       const MeshUvs& mesh_uvs);

// Decodes an sRGB value from 0 to 1 to a linear one.
[[nodiscard]] float srgb_to_linear(float encoded);

}  // namespace alcove::sample
