#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <tl/expected.hpp>

#include "scene/gltf_images.h"
#include "scene/scene.h"
#include "support/progress.h"

namespace alcove::sample {

// Reads a glTF 2 file, .gltf or .glb (by its content, not its name), into a scene.
//
// Read: node transforms (matrix or TRS, any hierarchy; mirrored ones turn the winding), skins in
// the pose of the file's nodes, instances (a mesh of several nodes, EXT_mesh_gpu_instancing),
// triangle lists, strips and fans with and without indices, every accessor type (normalised,
// interleaved, sparse), embedded, binary and external buffers and images, metallic-roughness
// materials and KHR_materials_pbrSpecularGlossiness with normal maps and tangents, vertex colours,
// doubleSided, samplers, two sets of texture coordinates, KHR_texture_transform, alpha masks,
// cameras, KHR_node_visibility. Triangles without normals have their geometric ones.
//
// Left out, with a warning in the scene: points and lines, morph targets, animation, further sets
// of texture coordinates, other extensions. A file that requires an extension that changes shapes
// is refused. Baked occlusion is left out without a warning, because occlusion is what is computed
// here. Alpha-blended materials are opaque; with an alpha of 0 they are not drawn.
//
// The file may be hostile: every index, offset, stride and count is checked before it is used, what
// a file may grow to is bounded by GltfLimits, and external files must lie in the scene's folder.
// Errors are one sentence with the file's name. Thread-safe.
struct GltfLimits {
  // Sums over all meshes; those that several nodes share count once, skinned ones for each node.
  uint64_t primitives = uint64_t{1} << 20;
  uint64_t vertices = uint64_t{1} << 26;
  uint64_t indices = uint64_t{3} << 25;
  uint64_t instances = uint64_t{1} << 23;        // counted once for each primitive of their mesh
  uint64_t joints = uint64_t{1} << 22;           // of all skins
  uint64_t drawn_triangles = uint64_t{1} << 28;  // counted once for each instance
  ImageLimits images;
};
[[nodiscard]] tl::expected<Scene, std::string> load_gltf(const std::filesystem::path& file,
                                                         const Progress& progress = {});

// The same from memory. `name` stands in messages; external files are looked for in `folder`, or
// refused when it is empty.
[[nodiscard]] tl::expected<Scene, std::string> parse_gltf(std::span<const uint8_t> bytes,
                                                          const std::string& name,
                                                          const std::filesystem::path& folder,
                                                          const GltfLimits& limits = {},
                                                          const Progress& progress = {});

}  // namespace alcove::sample
