#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "scene/gltf_images.h"
#include "scene/scene.h"
#include "support/progress.h"
#include "support/result.h"

namespace alcove::sample {

// Reads a glTF 2 file, .gltf or .glb (by its content, not its name), into a scene.
//
// It reads node transforms (matrix or TRS, any hierarchy; mirroring ones reverse the winding),
// morph targets at the file's weights, skins in the pose of the file's nodes, instances (a mesh of
// several nodes, EXT_mesh_gpu_instancing), triangle lists, strips and fans with and without
// indices, every accessor type (normalised, interleaved, sparse), embedded, binary and external
// buffers and images, metallic-roughness materials and KHR_materials_pbrSpecularGlossiness with
// normal maps and tangents, vertex colours, doubleSided, samplers, two sets of texture coordinates,
// KHR_texture_transform, alpha masks, cameras, EXT_meshopt_compression, KHR_draco_mesh_compression
// and KHR_node_visibility. Triangles without normals get their geometric normals. A mesh has the
// vertices that its indices use.
//
// It leaves out, with a warning in the scene, points and lines, animation, further sets of texture
// coordinates and other extensions. It refuses a file that requires an extension that is known to
// hold or place geometry, such as KHR_gaussian_splatting. It leaves out baked occlusion without a
// warning, because Alcove computes occlusion. Alpha-blended materials are opaque; with an alpha of
// 0 they are not drawn.
//
// A reader follows a file through gltf_container (splits a .glb), gltf_properties (checks the
// JSON), gltf_model (tinygltf's model, buffers), gltf_files (URIs), gltf_meshopt and gltf_draco
// (decompression), gltf_material, gltf_nodes (node tree, instances), gltf_scene (meshes of the
// nodes), gltf_mesh (one primitive, morph targets), gltf_skin (joints and weights), gltf_accessor
// (binary data), gltf_camera and gltf_images.
//
// The file may be hostile. Every index, offset, stride and count is checked before it is used,
// GltfLimits limits memory and time, and external files must be in the scene's folder. Errors are
// one sentence with the file's name. Thread-safe.
struct GltfLimits {
  // Limits on sums over all meshes. A mesh that several nodes share counts once, a skinned mesh
  // once for each node.
  uint64_t primitives = uint64_t{1} << 20;
  uint64_t vertices = uint64_t{1} << 26;
  uint64_t indices = uint64_t{3} << 25;
  uint64_t instances = uint64_t{1} << 23;        // counted once for each primitive of their mesh
  uint64_t joints = uint64_t{1} << 22;           // of all skins
  uint64_t drawn_triangles = uint64_t{1} << 28;  // counted once for each instance
  ImageLimits images;
};
[[nodiscard]] Result<Scene> load_gltf(const std::filesystem::path& file,
                                      const Progress& progress = {});

// Reads a file that is in memory. `name` is the name of the file in messages. External files must
// be in `folder`; if `folder` is empty, they are refused.
[[nodiscard]] Result<Scene> parse_gltf(std::span<const uint8_t> bytes, const std::string& name,
                                       const std::filesystem::path& folder,
                                       const GltfLimits& limits = {},
                                       const Progress& progress = {});

}  // namespace alcove::sample
