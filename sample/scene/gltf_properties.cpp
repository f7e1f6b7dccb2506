#include "scene/gltf_properties.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace alcove::sample {
namespace {

using nlohmann::json;
using Failure = tl::unexpected<std::string>;
using Checked = tl::expected<void, std::string>;

enum class Type : uint8_t {
  object,  // its members have rows of their own
  whole,   // an integer from `low` to `high`
  number,  // a finite number from `low` to `high`
  boolean,
  string,  // one of `choices`, which `|` separates; any where that is empty
};

enum class Presence : uint8_t { optional, required };

constexpr size_t kSingle = 0;            // as `count`: one value and no array
constexpr size_t kAnyNumber = SIZE_MAX;  // an array of any length

// A row of the table. `path` has the names from the root, separated by /; * stands for every
// element of an array or member of an object. A parent has its row before its members. `count` is
// the length of an array of values.
struct Property {
  std::string_view path;
  Type type;
  size_t count = kSingle;
  double low = 0.0;
  double high = 0.0;
  std::string_view choices = {};
  Presence presence = Presence::optional;
};

constexpr auto kRequired = Presence::required;
constexpr double kLargestIndex = std::numeric_limits<int32_t>::max();
constexpr double kLargestExact = 9007199254740992.0;  // 2^53: integers above it are not exact
constexpr double kAny = std::numeric_limits<double>::max();
constexpr double kLargestColour = 1e6;  // 1 by the specification; exporters write brighter ones
constexpr double kLargestStride = 252.0;
constexpr double kLargestEnumerator = 65535.0;

constexpr Property object(std::string_view path, Presence presence = Presence::optional) {
  return {path, Type::object, kSingle, 0, 0, {}, presence};
}
constexpr Property objects(std::string_view path, Presence presence = Presence::optional) {
  return {path, Type::object, kAnyNumber, 0, 0, {}, presence};
}
constexpr Property whole(std::string_view path, double low, double high,
                         Presence presence = Presence::optional) {
  return {path, Type::whole, kSingle, low, high, {}, presence};
}
constexpr Property index(std::string_view path, Presence presence = Presence::optional) {
  return whole(path, 0, kLargestIndex, presence);
}
constexpr Property indices(std::string_view path, Presence presence = Presence::optional) {
  return {path, Type::whole, kAnyNumber, 0, kLargestIndex, {}, presence};
}
constexpr Property number(std::string_view path, double low, double high,
                          Presence presence = Presence::optional) {
  return {path, Type::number, kSingle, low, high, {}, presence};
}
constexpr Property numbers(std::string_view path, size_t count, double low, double high) {
  return {path, Type::number, count, low, high};
}
constexpr Property boolean(std::string_view path) { return {path, Type::boolean}; }
constexpr Property text(std::string_view path, std::string_view choices = {},
                        Presence presence = Presence::optional) {
  return {path, Type::string, kSingle, 0, 0, choices, presence};
}
constexpr Property texts(std::string_view path) { return {path, Type::string, kAnyNumber}; }

// The rows of a material's texture reference, including the extension KHR_texture_transform.
#define ALCOVE_TEXTURE_INFO(path)                                                   \
  object(path), index(path "/index", kRequired), index(path "/texCoord"),           \
      object(path "/extensions"), object(path "/extensions/KHR_texture_transform"), \
      numbers(path "/extensions/KHR_texture_transform/offset", 2, -kAny, kAny),     \
      numbers(path "/extensions/KHR_texture_transform/scale", 2, -kAny, kAny),      \
      number(path "/extensions/KHR_texture_transform/rotation", -kAny, kAny),       \
      index(path "/extensions/KHR_texture_transform/texCoord")

// The rows of a compressed buffer view. The format is the same by either name.
#define ALCOVE_MESHOPT(path)                                                                   \
  object(path), index(path "/buffer", kRequired), whole(path "/byteOffset", 0, kLargestExact), \
      whole(path "/byteLength", 0, kLargestExact, kRequired),                                  \
      whole(path "/byteStride", 1, 256, kRequired), index(path "/count", kRequired),           \
      text(path "/mode", "ATTRIBUTES|TRIANGLES|INDICES", kRequired),                           \
      text(path "/filter", "NONE|OCTAHEDRAL|QUATERNION|EXPONENTIAL")

constexpr Property kProperties[] = {
    object("asset", kRequired),
    text("asset/version", {}, kRequired),
    text("asset/minVersion"),
    texts("extensionsUsed"),
    texts("extensionsRequired"),

    index("scene"),
    objects("scenes"),
    indices("scenes/*/nodes"),

    objects("nodes"),
    text("nodes/*/name"),
    indices("nodes/*/children"),
    index("nodes/*/mesh"),
    index("nodes/*/camera"),
    index("nodes/*/skin"),
    numbers("nodes/*/weights", kAnyNumber, -kAny, kAny),
    numbers("nodes/*/matrix", 16, -kAny, kAny),
    numbers("nodes/*/translation", 3, -kAny, kAny),
    numbers("nodes/*/rotation", 4, -kAny, kAny),
    numbers("nodes/*/scale", 3, -kAny, kAny),
    object("nodes/*/extensions"),
    object("nodes/*/extensions/EXT_mesh_gpu_instancing"),
    object("nodes/*/extensions/EXT_mesh_gpu_instancing/attributes", kRequired),
    index("nodes/*/extensions/EXT_mesh_gpu_instancing/attributes/*"),
    object("nodes/*/extensions/KHR_node_visibility"),
    boolean("nodes/*/extensions/KHR_node_visibility/visible"),

    objects("meshes"),
    text("meshes/*/name"),
    objects("meshes/*/primitives", kRequired),
    object("meshes/*/primitives/*/attributes", kRequired),
    index("meshes/*/primitives/*/attributes/*"),
    index("meshes/*/primitives/*/indices"),
    index("meshes/*/primitives/*/material"),
    whole("meshes/*/primitives/*/mode", 0, 6),
    objects("meshes/*/primitives/*/targets"),
    index("meshes/*/primitives/*/targets/*/*"),
    object("meshes/*/primitives/*/extensions"),
    object("meshes/*/primitives/*/extensions/KHR_draco_mesh_compression"),
    index("meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/bufferView", kRequired),
    object("meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/attributes", kRequired),
    index("meshes/*/primitives/*/extensions/KHR_draco_mesh_compression/attributes/*"),
    numbers("meshes/*/weights", kAnyNumber, -kAny, kAny),

    objects("skins"),
    indices("skins/*/joints", kRequired),
    index("skins/*/inverseBindMatrices"),
    index("skins/*/skeleton"),

    objects("accessors"),
    index("accessors/*/bufferView"),
    whole("accessors/*/byteOffset", 0, kLargestExact),
    whole("accessors/*/componentType", 5120, 5126, kRequired),
    boolean("accessors/*/normalized"),
    whole("accessors/*/count", 0, kLargestExact, kRequired),
    text("accessors/*/type", "SCALAR|VEC2|VEC3|VEC4|MAT2|MAT3|MAT4", kRequired),
    object("accessors/*/sparse"),
    index("accessors/*/sparse/count", kRequired),
    object("accessors/*/sparse/indices", kRequired),
    index("accessors/*/sparse/indices/bufferView", kRequired),
    index("accessors/*/sparse/indices/byteOffset"),
    whole("accessors/*/sparse/indices/componentType", 5121, 5125, kRequired),
    object("accessors/*/sparse/values", kRequired),
    index("accessors/*/sparse/values/bufferView", kRequired),
    index("accessors/*/sparse/values/byteOffset"),

    objects("bufferViews"),
    index("bufferViews/*/buffer", kRequired),
    whole("bufferViews/*/byteOffset", 0, kLargestExact),
    whole("bufferViews/*/byteLength", 0, kLargestExact, kRequired),
    whole("bufferViews/*/byteStride", 0, kLargestStride),
    object("bufferViews/*/extensions"),
    ALCOVE_MESHOPT("bufferViews/*/extensions/EXT_meshopt_compression"),
    ALCOVE_MESHOPT("bufferViews/*/extensions/KHR_meshopt_compression"),

    objects("buffers"),
    text("buffers/*/uri"),
    whole("buffers/*/byteLength", 0, kLargestExact, kRequired),

    objects("images"),
    text("images/*/uri"),
    text("images/*/mimeType"),
    index("images/*/bufferView"),

    objects("textures"),
    index("textures/*/source"),
    index("textures/*/sampler"),

    objects("samplers"),
    whole("samplers/*/magFilter", 0, kLargestEnumerator),
    whole("samplers/*/minFilter", 0, kLargestEnumerator),
    whole("samplers/*/wrapS", 0, kLargestEnumerator),
    whole("samplers/*/wrapT", 0, kLargestEnumerator),

    objects("materials"),
    text("materials/*/name"),
    text("materials/*/alphaMode", "OPAQUE|MASK|BLEND"),
    number("materials/*/alphaCutoff", 0, kAny),
    boolean("materials/*/doubleSided"),
    numbers("materials/*/emissiveFactor", 3, 0, kAny),
    ALCOVE_TEXTURE_INFO("materials/*/normalTexture"),
    number("materials/*/normalTexture/scale", -kAny, kAny),
    ALCOVE_TEXTURE_INFO("materials/*/emissiveTexture"),
    object("materials/*/pbrMetallicRoughness"),
    numbers("materials/*/pbrMetallicRoughness/baseColorFactor", 4, 0, kLargestColour),
    number("materials/*/pbrMetallicRoughness/metallicFactor", 0, kLargestColour),
    number("materials/*/pbrMetallicRoughness/roughnessFactor", 0, kLargestColour),
    ALCOVE_TEXTURE_INFO("materials/*/pbrMetallicRoughness/baseColorTexture"),
    ALCOVE_TEXTURE_INFO("materials/*/pbrMetallicRoughness/metallicRoughnessTexture"),
    object("materials/*/extensions"),
    object("materials/*/extensions/KHR_materials_unlit"),
    object("materials/*/extensions/KHR_materials_emissive_strength"),
    number("materials/*/extensions/KHR_materials_emissive_strength/emissiveStrength", 0, kAny),
    object("materials/*/extensions/KHR_materials_pbrSpecularGlossiness"),
    numbers("materials/*/extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor", 4, 0,
            kLargestColour),
    numbers("materials/*/extensions/KHR_materials_pbrSpecularGlossiness/specularFactor", 3, 0,
            kLargestColour),
    number("materials/*/extensions/KHR_materials_pbrSpecularGlossiness/glossinessFactor", 0,
           kLargestColour),
    ALCOVE_TEXTURE_INFO(
        "materials/*/extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture"),
    ALCOVE_TEXTURE_INFO(
        "materials/*/extensions/KHR_materials_pbrSpecularGlossiness/specularGlossinessTexture"),

    objects("cameras"),
    text("cameras/*/name"),
    text("cameras/*/type", "perspective|orthographic", kRequired),
    object("cameras/*/perspective"),
    number("cameras/*/perspective/aspectRatio", 0, kAny),
    number("cameras/*/perspective/yfov", 0, kAny, kRequired),
    number("cameras/*/perspective/znear", 0, kAny, kRequired),
    number("cameras/*/perspective/zfar", 0, kAny),
    object("cameras/*/orthographic"),
    number("cameras/*/orthographic/xmag", -kAny, kAny, kRequired),
    number("cameras/*/orthographic/ymag", -kAny, kAny, kRequired),
    number("cameras/*/orthographic/znear", 0, kAny, kRequired),
    number("cameras/*/orthographic/zfar", 0, kAny, kRequired),

    objects("animations"),
};

#undef ALCOVE_TEXTURE_INFO
#undef ALCOVE_MESHOPT

// Returns the shortest text of a limit, such as 0, 5126 or 2^53.
std::string shown(double value) {
  if (value == kLargestExact) return "2^53";
  return json(static_cast<int64_t>(value)).dump();
}

// Returns the values that a property may have; `one`: of one element of its array.
std::string expectation(const Property& property, bool one) {
  const bool bounded_above = property.high<kAny, bounded_below = property.low> - kAny;
  std::string range;
  if (bounded_below && bounded_above)
    range = " from " + shown(property.low) + " to " + shown(property.high);
  else if (bounded_below)
    range = " of at least " + shown(property.low);
  if (property.count != kSingle && !one) {
    const std::string count =
        property.count == kAnyNumber ? "" : std::to_string(property.count) + " ";
    constexpr std::string_view kNames[] = {"objects", "whole numbers", "numbers", "", "strings"};
    const bool ranged = property.type == Type::whole || property.type == Type::number;
    return "an array of " + count + std::string(kNames[static_cast<size_t>(property.type)]) +
           (ranged ? range : "");
  }
  switch (property.type) {
    case Type::object:
      return "an object";
    case Type::whole:
      return "a whole number" + range;
    case Type::number:
      return "a number" + range;
    case Type::boolean:
      return "true or false";
    case Type::string:
      break;
  }
  if (property.choices.empty()) return "a string";
  std::string all(property.choices);
  for (size_t bar = all.find('|'); bar != std::string::npos; bar = all.find('|'))
    all.replace(bar, 1, ", ");
  return "one of " + all;
}

// Returns the beginning of a JSON value, short enough for a sentence.
std::string shown(const json& value) {
  constexpr size_t kLongest = 40;  // bytes
  if (value.is_object()) return "an object";
  if (value.is_array()) return "an array of " + std::to_string(value.size()) + " elements";
  if (value.is_string() && value.get_ref<const std::string&>().size() > kLongest)
    return "a string of " + std::to_string(value.get_ref<const std::string&>().size()) + " bytes";
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

// Copies the properties of the table from one JSON tree to another, and checks them.
class Copier {
 public:
  Checked copy(const Property& property, json& from, json& to) {
    property_ = &property;
    place_.clear();
    return descend(property.path, from, to);
  }

 private:
  // Copies and checks the property at `path`, relative to `from`. Afterwards place_ is the same as
  // before, unless there is an error.
  Checked descend(std::string_view path, json& from, json& to) {
    const size_t slash = path.find('/');
    const std::string_view name = path.substr(0, slash);
    const bool last = slash == std::string_view::npos;
    const std::string_view rest = last ? std::string_view() : path.substr(slash + 1);
    if (name == "*") return visit_each(last, rest, from, to);
    const std::string key(name);
    const auto found = from.find(key);
    place_.emplace_back(name);
    if (found != from.end()) {
      if (auto done = visit(last, rest, *found, last ? to[key] : to.at(key)); !done) return done;
    } else if (last && property_->presence == Presence::required) {
      return missing();
    }
    place_.pop_back();
    return {};
  }

  Checked visit_each(bool last, std::string_view rest, json& from, json& to) {
    if (from.is_array()) {
      for (size_t i = 0; i < from.size(); ++i) {
        place_.emplace_back(i);
        if (auto done = visit(last, rest, from[i], to[i]); !done) return done;
        place_.pop_back();
      }
      return {};
    }
    for (auto member = from.begin(); member != from.end(); ++member) {
      place_.emplace_back(std::string_view(member.key()));
      json& target = last ? to[member.key()] : to.at(member.key());
      if (auto done = visit(last, rest, member.value(), target); !done) return done;
      place_.pop_back();
    }
    return {};
  }

  Checked visit(bool last, std::string_view rest, json& from, json& to) {
    return last ? take(from, to) : descend(rest, from, to);
  }

  Checked take(json& from, json& to) {
    if (property_->count == kSingle) return take_value(from, to, false);
    if (!from.is_array() || (property_->count != kAnyNumber && from.size() != property_->count))
      return wrong(from, false);
    to = json::array();
    for (size_t i = 0; i < from.size(); ++i) {
      place_.emplace_back(i);
      json element;
      if (auto taken = take_value(from[i], element, true); !taken) return taken;
      place_.pop_back();
      to.push_back(std::move(element));
    }
    return {};
  }

  Checked take_value(json& from, json& to, bool of_array) {
    if (!fits(from)) return wrong(from, of_array);
    if (property_->type == Type::object)
      to = json::object();
    else if (property_->type == Type::whole && from.is_number_float())
      to = static_cast<uint64_t>(from.get<double>());
    else
      to = std::move(from);
    return {};
  }

  bool fits(const json& value) const {
    switch (property_->type) {
      case Type::object:
        return value.is_object();
      case Type::boolean:
        return value.is_boolean();
      case Type::string:
        return value.is_string() &&
               (property_->choices.empty() || is_choice(value.get_ref<const std::string&>()));
      case Type::whole:
      case Type::number:
        break;
    }
    if (!value.is_number()) return false;
    const auto number = value.get<double>();
    return number >= property_->low && number <= property_->high &&
           (property_->type == Type::number || number == std::floor(number));
  }

  bool is_choice(std::string_view value) const {
    std::string_view left = property_->choices;
    for (;;) {
      const size_t bar = left.find('|');
      if (left.substr(0, bar) == value) return true;
      if (bar == std::string_view::npos) return false;
      left.remove_prefix(bar + 1);
    }
  }

  // Returns the path of the property that is being checked, such as nodes[3].scale[1].
  std::string path() const {
    std::string out;
    for (const auto& step : place_) {
      if (const auto* i = std::get_if<size_t>(&step)) {
        out.append("[").append(std::to_string(*i)).append("]");
      } else {
        constexpr size_t kLongest = 40;  // bytes of a name: the file chooses some of them
        const auto name = std::get<std::string_view>(step);
        out.append(out.empty() ? "" : ".").append(name.substr(0, kLongest));
      }
    }
    return out;
  }

  Failure wrong(const json& value, bool of_array) const {
    return Failure(path() + " is " + shown(value) + "; it must be " +
                   expectation(*property_, of_array));
  }
  Failure missing() const {
    return Failure(path() + " is missing; it must be " + expectation(*property_, false));
  }

  const Property* property_ = nullptr;
  std::vector<std::variant<size_t, std::string_view>> place_;
};

}  // namespace

tl::expected<json, std::string> checked_properties(json root) {
  json out = json::object();
  Copier copier;
  for (const Property& property : kProperties)
    if (auto copied = copier.copy(property, root, out); !copied) return Failure(copied.error());
  return out;
}

}  // namespace alcove::sample
