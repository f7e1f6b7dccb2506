#include "scene/gltf_properties.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>
#include <utility>
#include <vector>

namespace alcove::sample {
namespace {

using nlohmann::json;

// The types of properties by name. A rule is a type; an object with a rule for each member, where !
// follows the name of a required member and * stands for members of any names; or an array with the
// rule of its elements and their number, if it is fixed. The numbers of a range come after `whole`
// or `number`, and the choices of a string after `text`.
constexpr const char* kTypes = R"({
  "index": "whole 0 2147483647",
  "size": "whole 0 9007199254740992",
  "filter or wrap mode": "whole 0 65535",
  "colour": "number 0 1000000",
  "indices by name": {"*": "index"},
  "texture": {"index!": "index", "texCoord": "index", "extensions": "texture extensions"},
  "texture extensions": {
    "KHR_texture_transform": {
      "offset": ["number", 2], "scale": ["number", 2], "rotation": "number", "texCoord": "index"}},
  "compressed view": {
    "buffer!": "index", "byteOffset": "size", "byteLength!": "size", "byteStride!": "whole 1 256",
    "count!": "index", "mode!": "text ATTRIBUTES|TRIANGLES|INDICES",
    "filter": "text NONE|OCTAHEDRAL|QUATERNION|EXPONENTIAL|COLOR"}
})";

// The rule of a glTF file: all properties that the loader reads. A colour may exceed the 1 of the
// specification, because exporters write brighter ones.
constexpr const char* kFile = R"({
  "asset!": {"version!": "text", "minVersion": "text"},
  "extensionsUsed": ["text"],
  "extensionsRequired": ["text"],
  "scene": "index",
  "scenes": [{"nodes": ["index"]}],
  "nodes": [{
    "name": "text", "children": ["index"], "mesh": "index", "camera": "index", "skin": "index",
    "weights": ["number"], "matrix": ["number", 16], "translation": ["number", 3],
    "rotation": ["number", 4], "scale": ["number", 3],
    "extensions": {
      "EXT_mesh_gpu_instancing": {"attributes!": "indices by name"},
      "KHR_node_visibility": {"visible": "boolean"}}}],
  "meshes": [{
    "name": "text",
    "primitives!": [{
      "attributes!": "indices by name", "indices": "index", "material": "index",
      "mode": "whole 0 6", "targets": ["indices by name"],
      "extensions": {
        "KHR_draco_mesh_compression": {
          "bufferView!": "index", "attributes!": "indices by name"}}}],
    "weights": ["number"]}],
  "skins": [{"joints!": ["index"], "inverseBindMatrices": "index", "skeleton": "index"}],
  "accessors": [{
    "bufferView": "index", "byteOffset": "size", "componentType!": "whole 5120 5126",
    "normalized": "boolean", "count!": "size",
    "type!": "text SCALAR|VEC2|VEC3|VEC4|MAT2|MAT3|MAT4",
    "sparse": {
      "count!": "index",
      "indices!": {
        "bufferView!": "index", "byteOffset": "index", "componentType!": "whole 5121 5125"},
      "values!": {"bufferView!": "index", "byteOffset": "index"}}}],
  "bufferViews": [{
    "buffer!": "index", "byteOffset": "size", "byteLength!": "size", "byteStride": "whole 0 252",
    "extensions": {
      "EXT_meshopt_compression": "compressed view",
      "KHR_meshopt_compression": "compressed view"}}],
  "buffers": [{"uri": "text", "byteLength!": "size"}],
  "images": [{"uri": "text", "mimeType": "text", "bufferView": "index"}],
  "textures": [{"source": "index", "sampler": "index"}],
  "samplers": [{
    "magFilter": "filter or wrap mode", "minFilter": "filter or wrap mode",
    "wrapS": "filter or wrap mode", "wrapT": "filter or wrap mode"}],
  "materials": [{
    "name": "text", "alphaMode": "text OPAQUE|MASK|BLEND", "alphaCutoff": "number 0",
    "doubleSided": "boolean", "emissiveFactor": ["number 0", 3], "emissiveTexture": "texture",
    "normalTexture": {
      "index!": "index", "texCoord": "index", "scale": "number",
      "extensions": "texture extensions"},
    "pbrMetallicRoughness": {
      "baseColorFactor": ["colour", 4], "metallicFactor": "colour", "roughnessFactor": "colour",
      "baseColorTexture": "texture", "metallicRoughnessTexture": "texture"},
    "extensions": {
      "KHR_materials_unlit": {},
      "KHR_materials_emissive_strength": {"emissiveStrength": "number 0"},
      "KHR_materials_pbrSpecularGlossiness": {
        "diffuseFactor": ["colour", 4], "specularFactor": ["colour", 3],
        "glossinessFactor": "colour", "diffuseTexture": "texture",
        "specularGlossinessTexture": "texture"}}}],
  "cameras": [{
    "name": "text", "type!": "text perspective|orthographic",
    "perspective": {
      "aspectRatio": "number 0", "yfov!": "number 0", "znear!": "number 0", "zfar": "number 0"},
    "orthographic": {
      "xmag!": "number", "ymag!": "number", "znear!": "number 0", "zfar!": "number 0"}}],
  "animations": [{}]
})";

enum class Type : uint8_t { object, whole, number, boolean, text };

constexpr size_t kSingle = 0;            // as `count`: one value and no array
constexpr size_t kAnyNumber = SIZE_MAX;  // an array of any length
constexpr double kAny = std::numeric_limits<double>::max();

// A property and the values that it may have.
struct Property {
  std::string name = {};
  bool is_required = false;
  Type type = Type::object;
  size_t count = kSingle;  // the length of an array of values
  double low = -kAny;
  double high = kAny;
  std::vector<std::string> choices = {};  // of a text; empty: any
  std::vector<Property> members = {};     // of an object
};

using Rule = nlohmann::ordered_json;

Property read_rule(const Rule& rule, const Rule& types) {
  Property out;
  if (rule.is_array()) {
    out = read_rule(rule[0], types);
    out.count = rule.size() > 1 ? rule[1].get<size_t>() : kAnyNumber;
    return out;
  }
  if (rule.is_object()) {
    for (const auto& [name, member] : rule.items()) {
      Property property = read_rule(member, types);
      property.is_required = name.ends_with('!');
      property.name = name.substr(0, name.size() - (property.is_required ? 1 : 0));
      out.members.push_back(std::move(property));
    }
    return out;
  }
  const auto& text = rule.get_ref<const std::string&>();
  if (types.contains(text)) return read_rule(types[text], types);
  std::istringstream words(text);
  std::string type, choice;
  words >> type >> std::ws;
  out.type = type == "whole"     ? Type::whole
             : type == "number"  ? Type::number
             : type == "boolean" ? Type::boolean
                                 : Type::text;
  if (out.type == Type::text)
    while (std::getline(words, choice, '|')) out.choices.push_back(choice);
  else if (double bound = 0.0; words >> bound) {
    out.low = bound;
    if (words >> bound) out.high = bound;
  }
  return out;
}

// Returns the shortest text of a limit, such as 0, 5126 or 2^53.
std::string shown(double value) {
  constexpr double kLargestExact = 9007199254740992.0;  // integers above it are not exact
  return value == kLargestExact ? "2^53" : std::to_string(static_cast<int64_t>(value));
}

// Returns the values that a property may have, or an element of its array.
std::string expectation(const Property& property, bool is_array) {
  constexpr std::pair<const char*, const char*> kNames[] = {{"an object", "objects"},
                                                            {"a whole number", "whole numbers"},
                                                            {"a number", "numbers"},
                                                            {"true or false", ""},
                                                            {"a string", "strings"}};
  const auto& [one, many] = kNames[static_cast<size_t>(property.type)];
  std::string range;
  if (property.high < kAny)
    range = " from " + shown(property.low) + " to " + shown(property.high);
  else if (property.low > -kAny)
    range = " of at least " + shown(property.low);
  if (is_array) {
    const bool is_fixed = property.count != kAnyNumber;
    return "an array of " + (is_fixed ? std::to_string(property.count) + " " : "") + many + range;
  }
  if (property.choices.empty()) return one + range;
  std::string all;
  for (const std::string& choice : property.choices)
    all.append(all.empty() ? "one of " : ", ").append(choice);
  return all;
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

bool fits(const Property& property, const json& value) {
  const std::vector<std::string>& choices = property.choices;
  switch (property.type) {
    case Type::object:
      return value.is_object();
    case Type::boolean:
      return value.is_boolean();
    case Type::text:
      return value.is_string() &&
             (choices.empty() ||
              std::ranges::find(choices, value.get_ref<const std::string&>()) != choices.end());
    case Type::whole:
    case Type::number:
      break;
  }
  if (!value.is_number()) return false;
  const auto number = value.get<double>();
  return number >= property.low && number <= property.high &&
         (property.type == Type::number || number == std::floor(number));
}

// The error is a sentence that begins with the path of a property that is wrong or missing, such as
// .nodes[3].scale[1].
using Checked = Result<void>;

Checked wrong(const json& value, const Property& property, bool is_array) {
  return Failure(" is " + shown(value) + "; it must be " + expectation(property, is_array));
}

// Returns the result for a property as that of its parent, from which `step` leads to it.
Checked at(const std::string& step, Checked checked) {
  if (!checked) checked.error().insert(0, step);
  return checked;
}

// Copies a property from one JSON tree to another, and checks it.
Checked copy(const Property& property, json& from, json& to);

Checked copy_members(const std::vector<Property>& members, json& from, json& to) {
  constexpr size_t kLongest = 40;  // bytes of a name: the file chooses some of them
  to = json::object();
  Checked done;
  const auto copy_member = [&](const Property& property, const std::string& name, json& value) {
    if (done)
      done = at(std::string(".").append(name, 0, kLongest), copy(property, value, to[name]));
  };
  for (const Property& property : members) {
    if (property.name == "*") {
      for (auto member = from.begin(); member != from.end(); ++member)
        copy_member(property, member.key(), member.value());
    } else if (const auto found = from.find(property.name); found != from.end()) {
      copy_member(property, property.name, *found);
    } else if (done && property.is_required) {
      const std::string expected = expectation(property, property.count != kSingle);
      return at(std::string(".").append(property.name),
                Failure(" is missing; it must be " + expected));
    }
  }
  return done;
}

Checked copy_value(const Property& property, json& from, json& to) {
  if (!fits(property, from)) return wrong(from, property, false);
  if (property.type == Type::object) return copy_members(property.members, from, to);
  if (property.type == Type::whole && from.is_number_float())
    to = static_cast<uint64_t>(from.get<double>());
  else
    to = std::move(from);
  return {};
}

Checked copy(const Property& property, json& from, json& to) {
  if (property.count == kSingle) return copy_value(property, from, to);
  if (!from.is_array() || (property.count != kAnyNumber && from.size() != property.count))
    return wrong(from, property, true);
  to = json::array();
  Checked done;
  for (size_t i = 0; done && i < from.size(); ++i)
    done = at(std::string("[").append(std::to_string(i)).append("]"),
              copy_value(property, from[i], to.emplace_back()));
  return done;
}

}  // namespace

Result<json> checked_properties(json root) {
  static const Property file = read_rule(Rule::parse(kFile), Rule::parse(kTypes));
  json out;
  if (auto copied = copy(file, root, out); !copied) return Failure(copied.error().substr(1));
  return out;
}

}  // namespace alcove::sample
