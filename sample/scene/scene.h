#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/bounds.h"
#include "scene/camera.h"
#include "support/glm.h"

namespace alcove::sample {

// 8-bit RGBA, top row first. Base colour and emission are sRGB; roughness, metal and normals
// linear: the material says which by where it uses the image.
struct TextureImage {
  std::string name;
  uint32_t width = 0;
  uint32_t height = 0;
  std::vector<uint8_t> rgba;  // 4 * width * height
};

enum class Wrap : uint8_t { kRepeat, kClamp, kMirror };
enum class Filter : uint8_t { kLinear, kNearest };
enum class MipFilter : uint8_t { kLinear, kNearest, kNone };  // kNone: mip 0 alone is read

// How an image is read at its edges, and between texels and mips.
struct Sampler {
  Wrap wrap_u = Wrap::kRepeat;
  Wrap wrap_v = Wrap::kRepeat;
  Filter magnify = Filter::kLinear;
  Filter minify = Filter::kLinear;
  MipFilter mips = MipFilter::kLinear;

  bool operator==(const Sampler&) const = default;
};

// An image as a material uses it. `image` indexes Scene::images; -1 is none, and reads white.
struct TextureUse {
  int32_t image = -1;
  Sampler sampler;
  uint32_t uv_set = 0;  // 0: Mesh::uvs, 1: Mesh::second_uvs
  glm::mat3x2 texture_from_mesh_uv{1.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f};  // finite
};

// A g-buffer holds one surface a pixel, and an occluder either blocks or does not: alpha-blended
// materials are opaque, in the rasteriser and in the ray tracer alike.
enum class AlphaMode : uint8_t {
  kOpaque,
  kMask,   // cut out below alpha_cutoff
  kBlend,  // drawn and traced as opaque: a depth buffer has no half surfaces
};

// Metal and roughness, after glTF 2.0 section 3.9. Factors are linear and multiply the texture.
struct Material {
  std::string name;
  glm::vec4 base_color{1.0f};  // 0..1
  TextureUse base_color_texture;
  float metallic = 0.0f;               // 0..1
  float roughness = 1.0f;              // perceptual, 0..1
  TextureUse metal_roughness_texture;  // green: roughness, blue: metal
  glm::vec3 emissive{0.0f};            // >= 0
  TextureUse emissive_texture;
  // Tangent space: x along u, y against v (up in the image), z along the normal. Off without image.
  TextureUse normal_texture;
  float normal_scale = 1.0f;  // of x and y; -1e6..1e6
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  float alpha_cutoff = 0.5f;  // of kMask: kept where alpha >= cutoff
  // False: back faces are neither drawn nor hit by rays (glTF 2.0 section 3.9.6).
  bool double_sided = true;
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
  // Tangents that the file has, unit or zero. The bitangent is w * cross(normal, tangent). If
  // empty, corner_tangents() computes tangents from texture coordinates.
  std::vector<glm::vec4> tangents;
  // Factors of the base colour: linear RGB and alpha, 8-bit unsigned normalised. White if empty.
  std::vector<glm::u8vec4> colors;
  std::vector<uint32_t> indices;  // 3 per triangle
  // The affine transform from mesh to world space of each instance. If empty, the mesh has one
  // instance with the identity.
  std::vector<glm::mat4x3> instances;
  // The rasteriser transforms the mesh by GbufferView::world_from_moving. The ray tracer does not.
  bool moves = false;
};

// Everything that is drawn and traced. Materials hold at least one entry wherever there is a mesh.
struct Scene {
  std::string name;
  std::vector<Mesh> meshes;
  std::vector<Material> materials;
  std::vector<TextureImage> images;
  std::vector<Camera> cameras;  // the first is the default view; may be empty
  // Where the origin of world space is in the space of the file. Views that people type and read
  // are in that of the file.
  glm::dvec3 origin{0.0};
  Bounds bounds_ws;               // of all triangles
  Bounds core_bounds_ws;          // of what the scene is about, see scene_core(); empty: bounds_ws
  float suggested_radius = 0.0f;  // 0: a twentieth of the diagonal of the core's bounds
  std::vector<std::string> warnings;  // one sentence for each part that is not drawn as stored
};

// Triangles of all meshes, counted once for each instance.
[[nodiscard]] uint64_t triangle_count(const Scene& scene);

// The camera of that name, or for an empty name the first. Null when there is none.
[[nodiscard]] const Camera* find_camera(const Scene& scene, const std::string& name);

// The radius where none is given, in scene units.
[[nodiscard]] float default_radius(const Scene& scene);

// The transform of an instance; the identity where the mesh stands once. `instance` is below
// instance_count().
[[nodiscard]] glm::mat4x3 world_from_mesh(const Mesh& mesh, size_t instance);
[[nodiscard]] inline size_t instance_count(const Mesh& mesh) {
  return mesh.instances.empty() ? 1 : mesh.instances.size();
}

// A mesh's texture coordinates at a point of it, by TextureUse::uv_set.
using MeshUvs = std::array<glm::vec2, 2>;
[[nodiscard]] MeshUvs uvs_at(const Mesh& mesh, uint32_t vertex);
// The texture coordinates at the barycentric coordinates (1 - u - v, u, v) of a triangle.
[[nodiscard]] MeshUvs uvs_within(const Mesh& mesh, uint32_t triangle, float u, float v);
// The vertex colour at the same point, 0..1.
[[nodiscard]] glm::vec4 color_within(const Mesh& mesh, uint32_t triangle, float u, float v);

// Where a use looks for its texel, by the mesh's coordinates. Finite.
[[nodiscard]] glm::vec2 texture_uv(const TextureUse& use, const MeshUvs& mesh_uvs);

// An image's texel by the mesh's coordinates, 0..1 as stored (no sRGB decoding), as its sampler
// magnifies it: mip 0.
[[nodiscard]] glm::vec4 sample_texture(const Scene& scene, const TextureUse& use,
                                       const MeshUvs& mesh_uvs);

// sRGB to linear, per channel.
[[nodiscard]] float srgb_to_linear(float encoded);

}  // namespace alcove::sample
