#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <tl/expected.hpp>

#include "scene/gltf_images.h"
#include "scene/scene.h"

namespace alcove::sample {

// Reads a glTF 2 file, .gltf or .glb (by its content, not its name), into world-space triangles.
//
// Read: node transforms (matrix or TRS, any hierarchy; mirrored ones turn the winding), triangle
// lists, strips and fans with and without indices, every accessor type (normalised, interleaved,
// sparse), embedded, binary and external buffers and images, metal-roughness materials with normal
// maps and tangents, samplers, two sets of texture coordinates, KHR_texture_transform, alpha mask,
// cameras. Missing normals are made from the faces. Left out, with a warning in the scene: points
// and lines, vertex colours, morph targets, skins, animation, further sets of texture coordinates,
// extensions; an extension that a file requires and that changes shapes is an error. Left out
// without: baked occlusion, which is what is found here. Alpha blend counts as opaque.
//
// The file may be hostile: every index, offset, stride and count is checked before it is used, what
// a file may grow to is bounded by GltfLimits, and external files must lie in the scene's folder.
// Errors are one sentence with the file's name. Thread-safe.
struct GltfLimits {
  uint64_t primitives = uint64_t{1} << 20;  // as vertices
  uint64_t vertices = uint64_t{1} << 25;    // of all meshes together, instances counted each
  uint64_t indices = uint64_t{3} << 25;
  ImageLimits images;
};
[[nodiscard]] tl::expected<Scene, std::string> load_gltf(const std::filesystem::path& file);

// The same from memory. `name` stands in messages; external files are looked for in `folder`, or
// refused when it is empty.
[[nodiscard]] tl::expected<Scene, std::string> parse_gltf(std::span<const uint8_t> bytes,
                                                          const std::string& name,
                                                          const std::filesystem::path& folder,
                                                          const GltfLimits& limits = {});

}  // namespace alcove::sample
