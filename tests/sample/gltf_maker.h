#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "glb_file.h"
#include "scene/gltf.h"

namespace alcove::sample {

// Builds small glTF files in memory: a JSON to edit and a buffer to fill.
class GltfMaker {
 public:
  nlohmann::json json = {{"asset", {{"version", "2.0"}}},
                         {"scene", 0},
                         {"scenes", {{{"nodes", {0}}}}},
                         {"nodes", {{{"mesh", 0}}}}};
  std::vector<uint8_t> bytes;

  // Appends values to the buffer, at a multiple of 4, and gives their buffer view.
  template <class T>
  int view(const std::vector<T>& values, int stride = 0) {
    while (bytes.size() % 4) bytes.push_back(0);
    nlohmann::json view = {
        {"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * sizeof(T)}};
    if (stride) view["byteStride"] = stride;
    const auto* first = reinterpret_cast<const uint8_t*>(values.data());
    bytes.insert(bytes.end(), first, first + values.size() * sizeof(T));
    json["bufferViews"].push_back(view);
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }

  int accessor(int buffer_view, int component, const std::string& type, size_t count,
               bool normalized = false) {
    json["accessors"].push_back({{"bufferView", buffer_view},
                                 {"componentType", component},
                                 {"type", type},
                                 {"count", count},
                                 {"normalized", normalized}});
    return static_cast<int>(json["accessors"].size()) - 1;
  }

  // Appends values with an accessor of their own, and gives it.
  template <class T>
  int add(const std::string& type, const std::vector<T>& values, bool normalized = false) {
    static const std::map<std::string, size_t> kWidths = {
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
    const int component = std::is_same_v<T, float>     ? 5126
                          : sizeof(T) == 4             ? 5125
                          : std::is_same_v<T, int8_t>  ? 5120
                          : std::is_same_v<T, uint8_t> ? 5121
                          : std::is_same_v<T, int16_t> ? 5122
                                                       : 5123;
    return accessor(view(values), component, type, values.size() / kWidths.at(type), normalized);
  }

  // An image of one white pixel, in a texture of its own; gives the texture.
  int white_texture() {
    const int png = view<uint8_t>(
        {0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48,
         0x44, 0x52, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x00, 0x00, 0x00,
         0x00, 0x3a, 0x7e, 0x9b, 0x55, 0x00, 0x00, 0x00, 0x0a, 0x49, 0x44, 0x41, 0x54, 0x78,
         0xda, 0x63, 0xf8, 0x0f, 0x00, 0x01, 0x01, 0x01, 0x00, 0x1c, 0xb0, 0x8c, 0x99, 0x00,
         0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82});
    json["images"].push_back({{"bufferView", png}, {"mimeType", "image/png"}});
    json["textures"].push_back({{"source", json["images"].size() - 1}});
    return static_cast<int>(json["textures"].size()) - 1;
  }

  // One triangle in the XY plane that faces +Z.
  static GltfMaker triangle() {
    GltfMaker maker;
    const int accessor = maker.add<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
    maker.json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", accessor}}}}}}}};
    return maker;
  }

  nlohmann::json& primitive() { return json["meshes"][0]["primitives"][0]; }

  // A .gltf whose buffer is embedded.
  std::vector<uint8_t> gltf() const {
    nlohmann::json out = json;
    out["buffers"] = {{{"byteLength", bytes.size()},
                       {"uri", "data:application/octet-stream;base64," + base64(bytes)}}};
    return text_bytes(out.dump());
  }

  std::vector<uint8_t> glb() const {
    nlohmann::json out = json;
    out["buffers"] = {{{"byteLength", bytes.size()}}};
    return glb_file(out.dump(), bytes);
  }

  static std::string base64(const std::vector<uint8_t>& in) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (size_t i = 0; i < in.size(); i += 3) {
      uint32_t group = 0;
      for (size_t k = 0; k < 3; ++k) group = group << 8 | (i + k < in.size() ? in[i + k] : 0u);
      for (size_t k = 0; k < 4; ++k)
        out += i + k <= in.size() ? kDigits[group >> (18 - 6 * k) & 63u] : '=';
    }
    return out;
  }
};

// A triangle whose one material uses texture 0, which has no image, in these ways.
inline GltfMaker textured(const nlohmann::json& base_colour, const nlohmann::json& normal_map) {
  GltfMaker maker = GltfMaker::triangle();
  maker.json["textures"] = {nlohmann::json::object()};
  maker.json["materials"] = {{{"name", "tiles"},
                              {"pbrMetallicRoughness", {{"baseColorTexture", base_colour}}},
                              {"normalTexture", normal_map}}};
  maker.primitive()["material"] = 0;
  return maker;
}

inline nlohmann::json transformed(const nlohmann::json& transform) {
  return {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}};
}

// The same with an image, and with both sets of coordinates in the mesh.
inline GltfMaker painted(const nlohmann::json& base_colour, const nlohmann::json& normal_map) {
  GltfMaker maker = textured(base_colour, normal_map);
  maker.json.erase("textures");
  maker.white_texture();
  auto& attributes = maker.primitive()["attributes"];
  attributes["TEXCOORD_0"] = maker.add<float>("VEC2", {0, 0, 3, 0, 0, 3});
  attributes["TEXCOORD_1"] = maker.add<float>("VEC2", {0, 0, 7, 0, 0, 7});
  return maker;
}

inline Scene parsed(const std::vector<uint8_t>& bytes, const GltfLimits& limits = {}) {
  auto scene = parse_gltf(bytes, "test.gltf", "", limits);
  EXPECT_TRUE(scene) << (scene ? "" : scene.error());
  return scene ? std::move(*scene) : Scene{};
}

// The sentence by which a file is refused.
inline std::string refusal(const std::vector<uint8_t>& bytes, const GltfLimits& limits = {}) {
  const auto scene = parse_gltf(bytes, "test.gltf", "", limits);
  EXPECT_FALSE(scene);
  if (scene) return "";
  EXPECT_THAT(scene.error(), testing::HasSubstr("test.gltf"));
  EXPECT_EQ(scene.error().find('\n'), std::string::npos);
  return scene.error();
}

// Corners in the order of the indices.
inline std::vector<glm::vec3> corners(const Scene& scene) {
  std::vector<glm::vec3> out;
  for (const Mesh& mesh : scene.meshes)
    for (const uint32_t i : mesh.indices) out.push_back(mesh.positions[i]);
  return out;
}

}  // namespace alcove::sample
