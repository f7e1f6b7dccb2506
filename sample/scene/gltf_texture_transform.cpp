#include "scene/gltf_texture_transform.h"

#include <cmath>

namespace alcove::sample {
namespace {

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
