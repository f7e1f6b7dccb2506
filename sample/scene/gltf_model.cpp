#include "scene/gltf_model.h"

// tinygltf is compiled here from its header, because its conversions of JSON objects have no other
// interface. Its readers and writers of images are left out.
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#include <tiny_gltf.h>
#undef TINYGLTF_IMPLEMENTATION

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>

#include "scene/gltf_container.h"
#include "scene/gltf_draco.h"
#include "scene/gltf_meshopt.h"
#include "scene/gltf_properties.h"
#include "support/foreign_file.h"

namespace alcove::sample {
namespace {

using nlohmann::json;

Result<json> parse(std::span<const uint8_t> text) {
  try {
    if (text.empty()) return Failure("it is empty");
    json root = json::parse(text.begin(), text.end());
    if (!root.is_object()) return Failure("it is not glTF: its JSON is not an object");
    return root;
  } catch (const json::parse_error& error) {
    const std::string kind = foreign_kind(text, "name a .gltf or .glb file");
    if (!kind.empty()) return Failure("it " + kind);
    if (error.byte <= 1)
      return Failure("it is not glTF, which begins with { or glTF; name a .gltf or .glb file");
    return Failure("it is not glTF, or damaged: its JSON cannot be read at byte " +
                   std::to_string(error.byte) + "; export it as glTF 2.0 again");
  } catch (const json::exception&) {
    return Failure("its JSON has a number that is too large; export it again");
  }
}

// Checks the glTF version, before other properties, because those of glTF 1.0 are different. Files
// of a later version 2.x are read, unless asset.minVersion says that readers of 2.0 cannot.
Result<void> check_version(const json& root) {
  const auto asset = root.find("asset");
  if (asset == root.end() || !asset->is_object()) return {};
  for (const char* name : {"version", "minVersion"}) {
    const auto found = asset->find(name);
    if (found == asset->end() || !(found->is_string() || found->is_number())) continue;
    const std::string text = found->is_string() ? found->get<std::string>() : found->dump();
    unsigned major = 0, minor = 0;
    if (std::sscanf(text.c_str(), "%4u.%4u", &major, &minor) != 2) {
      return Failure("asset." + std::string(name) + " is \"" + text +
                     "\"; it must be a version such as 2.0");
    }
    if (major != 2 || (*name == 'm' && minor > 0)) {
      return Failure("it is glTF " + text + " (asset." + name +
                     "), and version 2.0 is read here; export it as glTF 2.0");
    }
  }
  return {};
}

bool is_one_of(std::span<const std::string_view> names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

// Notes the extensions that are not read, and refuses those that hold or place triangles. Other
// extensions, also unknown ones, change appearance, light, behaviour or metadata.
Result<std::vector<std::string>> check_extensions(const json& root) {
  static constexpr std::string_view kRead[] = {
      "EXT_mesh_gpu_instancing",    "EXT_meshopt_compression",
      "KHR_draco_mesh_compression", "KHR_materials_pbrSpecularGlossiness",
      "KHR_mesh_quantization",      "KHR_meshopt_compression",
      "KHR_node_visibility",        "KHR_texture_transform"};
  static constexpr std::string_view kGeometry[] = {
      "ALI_amc_mesh_compression",      "EXT_implicit_cylinder_region",
      "EXT_implicit_ellipsoid_region", "EXT_mesh_primitive_restart",
      "EXT_primitive_voxels",          "FB_ngon_encoding",
      "KHR_accessor_float64",          "KHR_binary_glTF",
      "KHR_gaussian_splatting",        "KHR_implicit_shapes",
      "KHR_mesh_primitive_restart",    "MPEG_accessor_timed",
      "MPEG_buffer_circular",          "WEB3D_quantized_attributes"};
  std::vector<std::string> notes;
  for (const char* list : {"extensionsRequired", "extensionsUsed"}) {
    const bool required = std::string_view(list) == "extensionsRequired";
    for (const json& name : root.value(list, json::array())) {
      const auto& text = name.get_ref<const std::string&>();
      if (is_one_of(kRead, text)) continue;
      if (required && is_one_of(kGeometry, text)) {
        return Failure("it requires the extension " + text +
                       ", which is not read here; export it without");
      }
      notes.push_back("The extension " + text + " is left out.");
    }
  }
  return notes;
}

// Converts specular-glossiness materials to metallic-roughness: the diffuse colour and texture
// become the base colour of a dielectric, and 1 - glossiness becomes the roughness. The specular
// colour is left out.
void convert_specular_glossiness(json& root) {
  const json::json_pointer extension("/extensions/KHR_materials_pbrSpecularGlossiness");
  for (size_t i = 0; root.contains("materials") && i < root["materials"].size(); ++i) {
    json& material = root["materials"][i];
    if (!material.contains(extension)) continue;
    const json& from = material[extension];
    json to = {{"metallicFactor", 0.0},
               {"roughnessFactor", 1.0 - from.value("glossinessFactor", 1.0)}};
    if (from.contains("diffuseFactor")) to["baseColorFactor"] = from["diffuseFactor"];
    if (from.contains("diffuseTexture")) to["baseColorTexture"] = from["diffuseTexture"];
    material["pbrMetallicRoughness"] = std::move(to);
  }
}

// Converts the elements of an array of the JSON by a function of tinygltf.
template <class Element, class Convert>
void convert(const json& root, const char* name, std::vector<Element>& out,
             const Convert& convert_one) {
  const auto found = root.find(name);
  if (found == root.end()) return;
  out.reserve(found->size());
  for (const json& element : *found)
    if (!convert_one(&out.emplace_back(), element)) return;
}

// Converts the JSON to tinygltf's model by tinygltf's own functions, so that it is parsed once.
Result<void> fill_model(const json& root, tinygltf::Model& model) {
  std::string error;
  // From tinygltf 2.9 on some functions also return warnings and take a strictness, of which {} is
  // the least.
  const auto by = [&](auto parse, auto... more) {
    return [&error, parse, more...](auto* out, const json& from) {
      if (!error.empty()) return false;
      if constexpr (std::is_invocable_v<decltype(parse), decltype(out), decltype(more)...,
                                        std::string*, const json&, bool>) {
        return parse(out, more..., &error, from, false);
      } else {
        std::string warning;
        return parse(out, more..., &error, &warning, from, false, {});
      }
    };
  };
  convert(root, "accessors", model.accessors, by(tinygltf::ParseAccessor));
  convert(root, "bufferViews", model.bufferViews, by(tinygltf::ParseBufferView));
  convert(root, "nodes", model.nodes, by(tinygltf::ParseNode));
  convert(root, "materials", model.materials, by(tinygltf::ParseMaterial));
  convert(root, "samplers", model.samplers, by(tinygltf::ParseSampler));
  convert(root, "cameras", model.cameras, by(tinygltf::ParseCamera));
  convert(root, "meshes", model.meshes, by(tinygltf::ParseMesh, &model));
  convert(root, "textures", model.textures, [&](tinygltf::Texture* out, const json& from) {
    return tinygltf::ParseTexture(out, &error, from, false, "");
  });
  convert(root, "images", model.images, [&](tinygltf::Image* out, const json& from) {
    out->uri = from.value("uri", "");
    out->bufferView = from.value("bufferView", -1);
    return true;
  });
  convert(root, "scenes", model.scenes, [&](tinygltf::Scene* out, const json& from) {
    out->nodes = from.value("nodes", std::vector<int>());
    return true;
  });
  std::string missing_matrices;  // tinygltf calls them required; the specification does not
  convert(root, "skins", model.skins, [&](tinygltf::Skin* out, const json& from) {
    return tinygltf::ParseSkin(out, &missing_matrices, from, false);
  });
  model.defaultScene = root.value("scene", -1);
  model.animations.resize(root.value("animations", json::array()).size());
  if (error.empty()) return {};
  return Failure(
      "it is not valid glTF; check it with Khronos' glTF validator and export it again (tinygltf "
      "says: " +
      error.substr(0, error.find('\n')) + ")");
}

// Fills the buffers of the model. The first buffer of a binary file may be its binary chunk. Other
// buffers without a URI have no data. The bytes are moved out of `file`, so that they are not in
// memory twice.
Result<void> fill_buffers(const json& buffers, std::vector<uint8_t> file, const GltfParts& parts,
                          GltfFiles& files, tinygltf::Model& model) {
  std::vector<uint8_t> chunk;
  if (parts.has_binary) {
    const auto begin = file.begin() + (parts.binary.data() - file.data());
    const auto size = static_cast<ptrdiff_t>(parts.binary.size());
    file.erase(begin + size, file.end());
    file.erase(file.begin(), begin);
    chunk = std::move(file);
  }
  for (size_t i = 0; i < buffers.size(); ++i) {
    tinygltf::Buffer& out = model.buffers.emplace_back();
    const auto uri = buffers[i].find("uri");
    std::string name = "buffers[" + std::to_string(i) + "]";
    if (uri != buffers[i].end()) {
      const auto& text = uri->get_ref<const std::string&>();
      name += " (" + GltfFiles::shown(text) + ")";
      ALCOVE_TRY(out.data, files.read(text).map_error(with_prefix(name + " ")));
    } else if (i == 0 && parts.has_binary) {
      out.data = std::move(chunk);
    } else {
      continue;
    }
    const auto length = buffers[i].at("byteLength").get<uint64_t>();
    if (length > out.data.size()) {
      const std::string kind = foreign_kind(out.data, "export the scene again");
      if (!kind.empty()) return Failure(name + " " + kind);
      return Failure(name + " has " + std::to_string(out.data.size()) +
                     " bytes, and its byteLength says " + std::to_string(length));
    }
    out.data.resize(length);
  }
  return {};
}

}  // namespace

Result<GltfModel> read_gltf_model(std::vector<uint8_t> file, const std::filesystem::path& folder) {
  ALCOVE_TRY(const auto parts, split_gltf(file));
  ALCOVE_TRY(auto parsed, parse(parts.json));
  if (!parts.has_binary) file = {};
  ALCOVE_TRY_VOID(check_version(parsed));
  ALCOVE_TRY(auto root, checked_properties(std::move(parsed)));
  convert_specular_glossiness(root);
  GltfModel out{{}, GltfFiles(folder), {}};
  ALCOVE_TRY(out.warnings, check_extensions(root));
  ALCOVE_TRY_VOID(fill_model(root, out.model));
  ALCOVE_TRY_VOID(fill_buffers(root.value("buffers", json::array()), std::move(file), parts,
                               out.files, out.model));
  ALCOVE_TRY_VOID(decompress_views(out.model, out.warnings));
  ALCOVE_TRY_VOID(decompress_primitives(out.model, out.warnings));
  return out;
}

}  // namespace alcove::sample
