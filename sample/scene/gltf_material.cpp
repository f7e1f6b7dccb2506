#include "scene/gltf_material.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scene/gltf_texture.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

// A reference to a texture by any property of a material.
struct TextureReference {
  const char* role;
  int index;  // negative where there is none
  int set;
  const tinygltf::ExtensionMap* extensions;
};

template <class Info>
TextureReference reference(const char* role, const Info& info) {
  return {role, info.index, coordinate_set(info.texCoord, info.extensions), &info.extensions};
}

const tinygltf::Value* specular_glossiness(const tinygltf::Material& material) {
  const auto found = material.extensions.find("KHR_materials_pbrSpecularGlossiness");
  return found != material.extensions.end() && found->second.IsObject() ? &found->second : nullptr;
}

double number_or(const tinygltf::Value& object, const char* key, double otherwise) {
  if (!object.Has(key)) return otherwise;
  const tinygltf::Value& value = object.Get(key);
  return value.IsNumber() ? value.GetNumberAsDouble() : otherwise;
}

int int_or(const tinygltf::Value& object, const char* key, int otherwise) {
  const double value = number_or(object, key, otherwise);
  return value >= -1.0 && value < 2147483647.0 ? static_cast<int>(value) : otherwise;
}

// Returns a texture reference that is stored in an extension.
tinygltf::TextureInfo texture_info(const tinygltf::Value& extension, const char* key) {
  tinygltf::TextureInfo info;
  if (!extension.Has(key) || !extension.Get(key).IsObject()) return info;
  const tinygltf::Value& value = extension.Get(key);
  info.index = int_or(value, "index", -1);
  info.texCoord = int_or(value, "texCoord", 0);
  if (value.Has("extensions") && value.Get("extensions").IsObject()) {
    for (const auto& [name, extension_value] :
         value.Get("extensions").Get<tinygltf::Value::Object>()) {
      info.extensions[name] = extension_value;
    }
  }
  return info;
}

// Converts a specular-glossiness material to metallic-roughness: the diffuse colour and texture
// become the base colour of a dielectric, and 1 - glossiness becomes the roughness. The specular
// colour is left out.
tinygltf::Material as_metallic_roughness(const tinygltf::Material& material,
                                         const tinygltf::Value& extension) {
  tinygltf::Material out = material;
  auto& pbr = out.pbrMetallicRoughness;
  pbr = {};
  pbr.metallicFactor = 0.0;
  pbr.roughnessFactor = 1.0 - number_or(extension, "glossinessFactor", 1.0);
  pbr.baseColorTexture = texture_info(extension, "diffuseTexture");
  if (extension.Has("diffuseFactor")) {
    const tinygltf::Value& factor = extension.Get("diffuseFactor");
    for (int c = 0; factor.IsArray() && c < 4 && c < static_cast<int>(factor.ArrayLen()); ++c) {
      if (factor.Get(c).IsNumber()) {
        pbr.baseColorFactor[static_cast<size_t>(c)] = factor.Get(c).GetNumberAsDouble();
      }
    }
  }
  return out;
}

std::array<TextureReference, 4> references(const tinygltf::Material& material) {
  const auto& pbr = material.pbrMetallicRoughness;
  return {reference("base colour", pbr.baseColorTexture),
          reference("metal and roughness", pbr.metallicRoughnessTexture),
          reference("emission", material.emissiveTexture),
          reference("normal map", material.normalTexture)};
}

// Adds materials to a scene.
class MaterialReader {
 public:
  MaterialReader(const tinygltf::Model& model, Scene& scene) : model_(model), scene_(scene) {}

  tl::expected<void, std::string> add(const tinygltf::Material& material);

 private:
  tl::expected<void, std::string> add_textures(const tinygltf::Material& in, Material& out);
  tl::expected<TextureUse, std::string> texture(const TextureReference& reference);

  const tinygltf::Model& model_;
  Scene& scene_;
};

float clamped(double value, double low, double high, double otherwise) {
  return static_cast<float>(std::isfinite(value) ? std::clamp(value, low, high) : otherwise);
}

tl::expected<void, std::string> MaterialReader::add(const tinygltf::Material& in) {
  Material out;
  out.name = in.name;
  const auto& pbr = in.pbrMetallicRoughness;
  for (size_t c = 0; c < 4 && c < pbr.baseColorFactor.size(); ++c) {
    out.base_color[static_cast<int>(c)] = clamped(pbr.baseColorFactor[c], 0.0, 1.0, 1.0);
  }
  out.metallic = clamped(pbr.metallicFactor, 0.0, 1.0, 1.0);
  out.roughness = clamped(pbr.roughnessFactor, 0.0, 1.0, 1.0);
  for (size_t c = 0; c < 3 && c < in.emissiveFactor.size(); ++c) {
    out.emissive[static_cast<int>(c)] = clamped(in.emissiveFactor[c], 0.0, 1e6, 0.0);
  }
  out.alpha_mode = in.alphaMode == "MASK"    ? AlphaMode::mask
                   : in.alphaMode == "BLEND" ? AlphaMode::blend
                                             : AlphaMode::opaque;
  out.double_sided = in.doubleSided;
  out.alpha_cutoff = clamped(in.alphaCutoff, 0.0, 1e6, 0.5);
  if (auto added = add_textures(in, out); !added) {
    return Failure("material \"" + in.name + "\" " + added.error());
  }
  scene_.materials.push_back(std::move(out));
  return {};
}

tl::expected<void, std::string> MaterialReader::add_textures(const tinygltf::Material& in,
                                                             Material& out) {
  const auto all = references(in);
  const auto uses = out.textures();
  for (size_t i = 0; i < all.size(); ++i) {
    if (all[i].index < 0) continue;
    if (all[i].set != 0 && all[i].set != 1) {
      scene_.warnings.push_back("Material \"" + in.name + "\" has its " + all[i].role +
                                " by texture coordinates " + std::to_string(all[i].set) +
                                ", neither 0 nor 1: it is left out.");
      continue;
    }
    auto read = texture(all[i]);
    if (!read) return Failure(read.error());
    *uses[i] = *read;
  }
  if (!std::isfinite(static_cast<float>(in.normalTexture.scale))) {
    return Failure("has a normal map whose scale is not finite");
  }
  out.normal_scale = clamped(in.normalTexture.scale, -1e6, 1e6, 1.0);
  return {};
}

tl::expected<TextureUse, std::string> MaterialReader::texture(const TextureReference& reference) {
  TextureUse use;
  use.uv_set = static_cast<uint32_t>(reference.set);
  const int index = reference.index;
  if (static_cast<size_t>(index) >= model_.textures.size()) {
    return Failure("has no texture " + std::to_string(index));
  }
  const tinygltf::Texture& texture = model_.textures[static_cast<size_t>(index)];
  if (texture.sampler >= 0) {
    if (static_cast<size_t>(texture.sampler) >= model_.samplers.size()) {
      return Failure("has a texture without its sampler " + std::to_string(texture.sampler));
    }
    const auto sampler = read_sampler(model_.samplers[static_cast<size_t>(texture.sampler)]);
    if (sampler) {
      use.sampler = *sampler;
    } else {
      scene_.warnings.push_back("sampler " + std::to_string(texture.sampler) + " " +
                                sampler.error() + " and is left out.");
    }
  }
  const auto transform = texture_transform(*reference.extensions);
  if (!transform) return Failure(transform.error());
  use.texture_from_mesh_uv = *transform;
  if (texture.source < 0) {
    // The texture may instead have its image in an extension that is not supported, such as
    // KHR_texture_basisu.
    scene_.warnings.push_back("texture " + std::to_string(index) +
                              " has no image that is read here and is left out.");
    return use;
  }
  if (static_cast<size_t>(texture.source) >= model_.images.size()) {
    return Failure("has a texture without its image " + std::to_string(texture.source));
  }
  use.image = texture.source;
  return use;
}

}  // namespace

tl::expected<void, std::string> add_materials(const tinygltf::Model& model, Scene& scene) {
  MaterialReader reader(model, scene);
  for (const tinygltf::Material& material : model.materials) {
    const tinygltf::Value* extension = specular_glossiness(material);
    auto added =
        reader.add(extension == nullptr ? material : as_metallic_roughness(material, *extension));
    if (!added) return added;
  }
  scene.materials.emplace_back();
  scene.materials.back().double_sided = false;
  scene.materials.back().name = "default";
  return {};
}

}  // namespace alcove::sample
