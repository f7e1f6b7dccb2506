#include "scene/gltf_material.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

namespace alcove::sample {
namespace {

using tinygltf::Value;

// The members of the extension KHR_texture_transform, which gltf_properties.h has checked, or null.
const Value* transform_extension(const tinygltf::ExtensionMap& extensions) {
  const auto found = extensions.find("KHR_texture_transform");
  return found == extensions.end() ? nullptr : &found->second;
}

// A reference to a texture by any property of a material.
struct TextureReference {
  const char* role;
  int index;               // negative if there is none
  int set;                 // of texture coordinates
  const Value* transform;  // null if there is none
};

// The extension may replace the set of texture coordinates.
template <class Info>
TextureReference reference(const char* role, const Info& info) {
  const Value* transform = transform_extension(info.extensions);
  const bool replaces = transform != nullptr && transform->Has("texCoord");
  const int set = replaces ? transform->Get("texCoord").GetNumberAsInt() : info.texCoord;
  return {role, info.index, set, transform};
}

std::array<TextureReference, 4> references(const tinygltf::Material& material) {
  const auto& pbr = material.pbrMetallicRoughness;
  return {reference("base colour", pbr.baseColorTexture),
          reference("metal and roughness", pbr.metallicRoughnessTexture),
          reference("emission", material.emissiveTexture),
          reference("normal map", material.normalTexture)};
}

// Sets `out` to the value for an enumerator of glTF. Returns false if there is none.
template <class Value, size_t N>
bool set(Value& out, int enumerator, const std::pair<int, Value> (&values)[N]) {
  const auto found = std::ranges::find(values, enumerator, &std::pair<int, Value>::first);
  if (found != std::end(values)) out = found->second;
  return found != std::end(values);
}

// Converts a glTF sampler (glTF 2.0 section 5.26). Filters that the file does not give (-1) are
// linear, also between mip levels. A value that glTF does not define is an error.
Result<Sampler> read_sampler(const tinygltf::Sampler& in) {
  constexpr auto kLinear = Filter::linear, kNearest = Filter::nearest;
  constexpr std::pair<int, Wrap> kWraps[] = {{TINYGLTF_TEXTURE_WRAP_REPEAT, Wrap::repeat},
                                             {TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE, Wrap::clamp},
                                             {TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT, Wrap::mirror}};
  constexpr std::pair<int, Filter> kFilters[] = {{-1, kLinear},
                                                 {TINYGLTF_TEXTURE_FILTER_LINEAR, kLinear},
                                                 {TINYGLTF_TEXTURE_FILTER_NEAREST, kNearest}};
  // One number gives the filter within a mip level and the filter between mip levels.
  using Filters = std::pair<Filter, MipFilter>;
  constexpr std::pair<int, Filters> kMinFilters[] = {
      {-1, {kLinear, MipFilter::linear}},
      {TINYGLTF_TEXTURE_FILTER_LINEAR, {kLinear, MipFilter::none}},
      {TINYGLTF_TEXTURE_FILTER_NEAREST, {kNearest, MipFilter::none}},
      {TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR, {kLinear, MipFilter::linear}},
      {TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST, {kLinear, MipFilter::nearest}},
      {TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR, {kNearest, MipFilter::linear}},
      {TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST, {kNearest, MipFilter::nearest}}};
  Sampler out;
  Filters minify;
  if (!set(out.wrap_u, in.wrapS, kWraps) || !set(out.wrap_v, in.wrapT, kWraps))
    return Failure("has a wrap mode unknown to glTF");
  if (!set(out.magnify, in.magFilter, kFilters) || !set(minify, in.minFilter, kMinFilters))
    return Failure("has a filter unknown to glTF");
  std::tie(out.minify, out.mips) = minify;
  return out;
}

// Returns the matrix of KHR_texture_transform from the mesh's texture coordinates to those of the
// image: scale, then rotation, then offset. A positive rotation is counter-clockwise in the image,
// whose v points down. Numbers outside the range of a float are an error.
Result<glm::mat3x2> texture_transform(const Value& transform) {
  const auto pair = [&](const char* name, double otherwise) {
    if (!transform.Has(name)) return glm::dvec2(otherwise);
    const Value& values = transform.Get(name);
    return glm::dvec2(values.Get(0).GetNumberAsDouble(), values.Get(1).GetNumberAsDouble());
  };
  const glm::dvec2 offset = pair("offset", 0.0), scale = pair("scale", 1.0);
  const double rotation =
      transform.Has("rotation") ? transform.Get("rotation").GetNumberAsDouble() : 0.0;
  const double c = std::cos(rotation), s = std::sin(rotation);
  // The columns are the transformed u axis, v axis and origin.
  const glm::mat3x2 out(c * scale.x, -s * scale.x, s * scale.y, c * scale.y, offset.x, offset.y);
  for (int column = 0; column < 3; ++column)
    if (!std::isfinite(out[column].x) || !std::isfinite(out[column].y))
      return Failure("has a texture transform that is not of finite numbers");
  return out;
}

// Reads the texture of a reference. Samplers and images that cannot be used are left out with a
// warning in the scene.
Result<TextureUse> read_texture(const tinygltf::Model& model, const TextureReference& reference,
                                Scene& scene) {
  TextureUse use;
  use.uv_set = static_cast<uint32_t>(reference.set);
  const std::string name = std::to_string(reference.index);
  if (static_cast<size_t>(reference.index) >= model.textures.size())
    return Failure("has no texture " + name);
  const tinygltf::Texture& texture = model.textures[static_cast<size_t>(reference.index)];
  if (texture.sampler >= 0) {
    const std::string sampler_name = std::to_string(texture.sampler);
    if (static_cast<size_t>(texture.sampler) >= model.samplers.size())
      return Failure("has a texture without its sampler " + sampler_name);
    const auto sampler = read_sampler(model.samplers[static_cast<size_t>(texture.sampler)]);
    if (!sampler) {
      scene.warnings.push_back("sampler " + sampler_name + " " + sampler.error() +
                               " and is left out.");
    }
    use.sampler = sampler.value_or(Sampler());
  }
  if (reference.transform != nullptr) {
    ALCOVE_TRY(use.texture_from_mesh_uv, texture_transform(*reference.transform));
  }
  if (texture.source < 0) {
    // The texture may instead have its image in an extension that is not supported, such as
    // KHR_texture_basisu.
    scene.warnings.push_back("texture " + name +
                             " has no image that is read here and is left out.");
  } else if (static_cast<size_t>(texture.source) >= model.images.size()) {
    return Failure("has a texture without its image " + std::to_string(texture.source));
  }
  use.image = texture.source;
  return use;
}

float clamped(double value, double low, double high) {
  return static_cast<float>(std::clamp(value, low, high));
}

// The error text is the end of a sentence that begins with the material's name.
Result<Material> read_material(const tinygltf::Model& model, const tinygltf::Material& in,
                               Scene& scene) {
  Material out;
  out.name = in.name;
  const auto& pbr = in.pbrMetallicRoughness;
  for (size_t c = 0; c < 4; ++c)
    out.base_color[static_cast<int>(c)] = clamped(pbr.baseColorFactor[c], 0.0, 1.0);
  out.metallic = clamped(pbr.metallicFactor, 0.0, 1.0);
  out.roughness = clamped(pbr.roughnessFactor, 0.0, 1.0);
  for (size_t c = 0; c < 3 && !in.emissiveFactor.empty(); ++c)
    out.emissive[static_cast<int>(c)] = clamped(in.emissiveFactor[c], 0.0, 1e6);
  out.alpha_mode = in.alphaMode == "MASK"    ? AlphaMode::mask
                   : in.alphaMode == "BLEND" ? AlphaMode::blend
                                             : AlphaMode::opaque;
  out.double_sided = in.doubleSided;
  out.alpha_cutoff = clamped(in.alphaCutoff, 0.0, 1e6);
  const auto all = references(in);
  const auto uses = out.textures();
  for (size_t i = 0; i < all.size(); ++i) {
    if (all[i].index < 0) continue;
    if (all[i].set > 1) {
      scene.warnings.push_back("Material \"" + in.name + "\" has its " + all[i].role +
                               " by texture coordinates " + std::to_string(all[i].set) +
                               ", neither 0 nor 1: it is left out.");
      continue;
    }
    ALCOVE_TRY(*uses[i], read_texture(model, all[i], scene));
  }
  if (!std::isfinite(static_cast<float>(in.normalTexture.scale)))
    return Failure("has a normal map whose scale is not finite");
  out.normal_scale = clamped(in.normalTexture.scale, -1e6, 1e6);
  return out;
}

}  // namespace

Result<void> add_materials(const tinygltf::Model& model, Scene& scene) {
  for (const tinygltf::Material& in : model.materials) {
    ALCOVE_TRY(
        scene.materials.emplace_back(),
        read_material(model, in, scene).map_error(with_prefix("material \"" + in.name + "\" ")));
  }
  scene.materials.emplace_back();
  scene.materials.back().double_sided = false;
  scene.materials.back().name = "default";
  return {};
}

}  // namespace alcove::sample
