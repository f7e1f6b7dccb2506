#include "scene/gltf_material.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "scene/gltf_accessor.h"
#include "scene/gltf_sampler.h"
#include "scene/gltf_texture_transform.h"
#include "support/decode_image.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

constexpr int32_t kUntried = -2;
constexpr int32_t kUnreadable = -1;

// What of a texture's use its kinds have in common.
struct TextureReference {
  const char* role;
  int index;  // below 0: none
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
  MaterialReader(const tinygltf::Model& model, uint64_t most_pixels, Scene& scene)
      : model_(model), scene_(scene), pixels_left_(most_pixels) {
    image_of_.assign(model.images.size(), kUntried);
  }

  tl::expected<void, std::string> add(const tinygltf::Material& material);

 private:
  tl::expected<void, std::string> add_textures(const tinygltf::Material& in, Material& out);
  tl::expected<TextureUse, std::string> texture(const TextureReference& reference);
  tl::expected<int32_t, std::string> image(size_t index);
  tl::expected<int32_t, std::string> decode(const std::string& name,
                                            std::span<const uint8_t> bytes);

  const tinygltf::Model& model_;
  Scene& scene_;
  uint64_t pixels_left_;
  std::vector<int32_t> image_of_;
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
    // Such as one that only an extension names.
    scene_.warnings.push_back("texture " + std::to_string(index) +
                              " has no image that is read here and is left out.");
    return use;
  }
  if (static_cast<size_t>(texture.source) >= model_.images.size()) {
    return Failure("has a texture without its image " + std::to_string(texture.source));
  }
  auto read = image(static_cast<size_t>(texture.source));
  if (!read) return Failure(read.error());
  use.image = *read;
  return use;
}

tl::expected<int32_t, std::string> MaterialReader::image(size_t index) {
  if (image_of_[index] != kUntried) return image_of_[index];
  const tinygltf::Image& in = model_.images[index];
  const std::string name =
      "image " + std::to_string(index) + (in.uri.empty() ? "" : " (" + in.uri + ")");
  std::span<const uint8_t> bytes = in.image;
  if (in.bufferView >= 0) {
    auto view = view_bytes(model_, in.bufferView);
    if (!view) return Failure("uses " + name + ", whose " + view.error());
    bytes = *view;
  }
  auto decoded = decode(name, bytes);
  if (decoded) image_of_[index] = *decoded;
  return decoded;
}

tl::expected<int32_t, std::string> MaterialReader::decode(const std::string& name,
                                                          std::span<const uint8_t> bytes) {
  const auto unreadable = [&](const std::string& why) {
    scene_.warnings.push_back(name + " " + why + " and is left out.");
    return kUnreadable;
  };
  if (bytes.empty()) return unreadable("is missing");
  const auto header = read_image_header(bytes);
  if (!header) return unreadable(header.error());
  if (header->width > kLargestImageSide || header->height > kLargestImageSide) {
    return Failure("uses " + name + ", which is " + std::to_string(header->width) + "x" +
                   std::to_string(header->height) + " pixels; make it at most " +
                   std::to_string(kLargestImageSide) + " a side");
  }
  const uint64_t pixels = uint64_t{header->width} * header->height;
  if (pixels > pixels_left_) return Failure("uses " + name + ", which is too large");
  pixels_left_ -= pixels;
  auto decoded = decode_image(bytes, *header);
  if (!decoded) return unreadable(decoded.error());
  TextureImage out;
  out.name = name;
  out.width = decoded->width;
  out.height = decoded->height;
  out.rgba = std::move(decoded->rgba);
  scene_.images.push_back(std::move(out));
  return static_cast<int32_t>(scene_.images.size() - 1);
}

}  // namespace

tl::expected<void, std::string> add_materials(const tinygltf::Model& model, uint64_t most_pixels,
                                              Scene& scene) {
  MaterialReader reader(model, most_pixels, scene);
  for (const tinygltf::Material& material : model.materials) {
    if (auto added = reader.add(material); !added) return added;
  }
  scene.materials.emplace_back();
  scene.materials.back().name = "default";
  return {};
}

}  // namespace alcove::sample
