#include "scene/gltf_texture.h"

#include <cmath>
#include <optional>

namespace alcove::sample {
namespace {

constexpr int kNotGiven = -1;

std::optional<Wrap> wrap_of(int mode) {
  switch (mode) {
    case TINYGLTF_TEXTURE_WRAP_REPEAT:
      return Wrap::repeat;
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return Wrap::clamp;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      return Wrap::mirror;
    default:
      return std::nullopt;
  }
}

// Returns the filter within a mip level. In glTF the same number also selects the filter between
// mip levels.
std::optional<Filter> filter_of(int filter) {
  switch (filter) {
    case kNotGiven:
    case TINYGLTF_TEXTURE_FILTER_LINEAR:
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR:
      return Filter::linear;
    case TINYGLTF_TEXTURE_FILTER_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR:
      return Filter::nearest;
    default:
      return std::nullopt;
  }
}

MipFilter mip_filter_of(int filter) {
  switch (filter) {
    case TINYGLTF_TEXTURE_FILTER_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_LINEAR:
      return MipFilter::none;
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST:
      return MipFilter::nearest;
    default:
      return MipFilter::linear;
  }
}

using tinygltf::Value;

constexpr const char* kExtension = "KHR_texture_transform";

// Returns a member of the extension KHR_texture_transform, or null.
const Value* member(const tinygltf::ExtensionMap& extensions, const std::string& name) {
  const auto found = extensions.find(kExtension);
  if (found == extensions.end() || !found->second.IsObject()) return nullptr;
  const auto& members = found->second.Get<Value::Object>();
  const auto value = members.find(name);
  return value == members.end() ? nullptr : &value->second;
}

double number(const Value* value, double otherwise) {
  return value && value->IsNumber() ? value->GetNumberAsDouble() : otherwise;
}

glm::dvec2 pair(const Value* value, double otherwise) {
  if (!value || !value->IsArray() || value->ArrayLen() != 2) return glm::dvec2(otherwise);
  return {number(&value->Get(0), otherwise), number(&value->Get(1), otherwise)};
}

}  // namespace

tl::expected<Sampler, std::string> read_sampler(const tinygltf::Sampler& in) {
  const auto wrap_u = wrap_of(in.wrapS), wrap_v = wrap_of(in.wrapT);
  if (!wrap_u || !wrap_v) return tl::unexpected<std::string>("has a wrap mode unknown to glTF");
  const auto magnify = filter_of(in.magFilter), minify = filter_of(in.minFilter);
  // Magnification only reads mip level 0, so that a filter between mip levels is not valid for it.
  const bool magnifies =
      in.magFilter == kNotGiven || mip_filter_of(in.magFilter) == MipFilter::none;
  if (!magnify || !minify || !magnifies) {
    return tl::unexpected<std::string>("has a filter unknown to glTF");
  }
  return Sampler{*wrap_u, *wrap_v, *magnify, *minify, mip_filter_of(in.minFilter)};
}

tl::expected<glm::mat3x2, std::string> texture_transform(const tinygltf::ExtensionMap& extensions) {
  const glm::dvec2 offset = pair(member(extensions, "offset"), 0.0);
  const glm::dvec2 scale = pair(member(extensions, "scale"), 1.0);
  const double rotation = number(member(extensions, "rotation"), 0.0);
  const double c = std::cos(rotation), s = std::sin(rotation);
  // The columns of the matrix are the transformed u axis, the transformed v axis and the
  // transformed origin.
  const glm::mat3x2 out(c * scale.x, -s * scale.x, s * scale.y, c * scale.y, offset.x, offset.y);
  for (int column = 0; column < 3; ++column) {
    if (!std::isfinite(out[column].x) || !std::isfinite(out[column].y)) {
      return tl::unexpected<std::string>("has a texture transform that is not of finite numbers");
    }
  }
  return out;
}

int coordinate_set(int set, const tinygltf::ExtensionMap& extensions) {
  const Value* other = member(extensions, "texCoord");
  return other && other->IsInt() ? other->GetNumberAsInt() : set;
}

}  // namespace alcove::sample
