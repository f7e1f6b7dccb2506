#include "scene/gltf_material.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scene/gltf_images.h"
#include "scene/gltf_sampler.h"
#include "scene/gltf_texture_transform.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

// A reference of a material to a texture, whichever property of the material it is.
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

std::array<TextureReference, 4> references(const tinygltf::Material& material) {
  const auto& pbr = material.pbrMetallicRoughness;
  return {reference("base colour", pbr.baseColorTexture),
          reference("metal and roughness", pbr.metallicRoughnessTexture),
          reference("emission", material.emissiveTexture),
          reference("normal map", material.normalTexture)};
}

// Adds materials to a scene, and images as materials ask for them.
class MaterialReader {
 public:
  MaterialReader(const tinygltf::Model& model, const ImageLimits& limits, Scene& scene)
      : model_(model), scene_(scene), images_(model, limits, scene) {}

  tl::expected<void, std::string> add(const tinygltf::Material& material);

 private:
  tl::expected<void, std::string> add_textures(const tinygltf::Material& in, Material& out);
  tl::expected<TextureUse, std::string> texture(const TextureReference& reference);

  const tinygltf::Model& model_;
  Scene& scene_;
  GltfImages images_;
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
  out.alpha_mode = in.alphaMode == "MASK"    ? AlphaMode::kMask
                   : in.alphaMode == "BLEND" ? AlphaMode::kBlend
                                             : AlphaMode::kOpaque;
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
  const std::array<TextureUse*, 4> uses{&out.base_color_texture, &out.metal_roughness_texture,
                                        &out.emissive_texture, &out.normal_texture};
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
    // An extension may name the image instead, such as KHR_texture_basisu.
    scene_.warnings.push_back("texture " + std::to_string(index) +
                              " has no image that is read here and is left out.");
    return use;
  }
  if (static_cast<size_t>(texture.source) >= model_.images.size()) {
    return Failure("has a texture without its image " + std::to_string(texture.source));
  }
  auto read = images_.decode(static_cast<size_t>(texture.source));
  if (!read) return Failure(read.error());
  use.image = *read;
  return use;
}

}  // namespace

tl::expected<void, std::string> add_materials(const tinygltf::Model& model,
                                              const ImageLimits& limits, Scene& scene) {
  MaterialReader reader(model, limits, scene);
  for (const tinygltf::Material& material : model.materials) {
    if (auto added = reader.add(material); !added) return added;
  }
  scene.materials.emplace_back();
  scene.materials.back().name = "default";
  return {};
}

}  // namespace alcove::sample
