#include "scene/gltf_model.h"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "scene/gltf_container.h"
#include "scene/gltf_extensions.h"
#include "scene/gltf_files.h"
#include "scene/gltf_properties.h"
#include "support/printable.h"

namespace alcove::sample {
namespace {

using nlohmann::json;
using Failure = tl::unexpected<std::string>;
using Checked = tl::expected<void, std::string>;

tl::expected<json, std::string> parse(std::span<const uint8_t> text) {
  try {
    if (text.empty()) return Failure("it is empty");
    json root = json::parse(text.begin(), text.end());
    if (!root.is_object()) return Failure("it is not glTF: its JSON is not an object");
    return root;
  } catch (const json::parse_error& error) {
    return Failure("it is not glTF, or damaged: its JSON cannot be read at byte " +
                   std::to_string(error.byte) + "; export it again");
  } catch (const json::exception&) {
    return Failure("its JSON has a number that is too large; export it again");
  }
}

struct Version {
  unsigned major = 0;
  unsigned minor = 0;
};

std::optional<Version> version_of(const std::string& text) {
  Version version;
  const char* end = text.data() + text.size();
  const auto major = std::from_chars(text.data(), end, version.major);
  if (major.ec != std::errc() || major.ptr == end || *major.ptr != '.') return std::nullopt;
  const auto minor = std::from_chars(major.ptr + 1, end, version.minor);
  if (minor.ec != std::errc() || minor.ptr != end) return std::nullopt;
  return version;
}

// Checks the glTF version. Files of a later version 2.x are read, unless asset.minVersion says that
// readers of 2.0 cannot read them.
Checked check_version(const json& asset) {
  for (const char* name : {"version", "minVersion"}) {
    const auto found = asset.find(name);
    if (found == asset.end()) continue;
    const auto& text = found->get_ref<const std::string&>();
    const auto version = version_of(text);
    if (!version) {
      return Failure("asset." + std::string(name) + " is \"" + text +
                     "\"; it must be a version such as 2.0");
    }
    if (version->major != 2 || (*name == 'm' && version->minor > 0)) {
      return Failure("it is glTF " + text + " (asset." + name +
                     "), and version 2.0 is read here; export it as glTF 2.0");
    }
  }
  return {};
}

Checked check_required_extensions(const json& root) {
  const auto required = root.find("extensionsRequired");
  if (required == root.end()) return {};
  for (const json& name : *required) {
    const auto& text = name.get_ref<const std::string&>();
    if (is_extension_read(text) || changes_no_shape(text)) continue;
    return Failure("it requires the extension " + text +
                   ", which is not read here; export it without");
  }
  return {};
}

Failure reached_twice(size_t node) {
  return Failure("node " + std::to_string(node) +
                 " is reached twice: nodes form a cycle or have two parents");
}

// Checks that the nodes form a forest (glTF 2.0 section 3.5.2), including nodes that no scene
// shows.
Checked check_node_tree(const json& root) {
  const auto nodes = root.find("nodes");
  if (nodes == root.end()) return {};
  constexpr size_t kNone = SIZE_MAX;
  std::vector<size_t> parents(nodes->size(), kNone);
  for (size_t i = 0; i < nodes->size(); ++i) {
    const auto children = (*nodes)[i].find("children");
    if (children == (*nodes)[i].end()) continue;
    for (const json& child : *children) {
      const auto index = child.get<size_t>();
      if (index >= parents.size()) {
        return Failure("nodes[" + std::to_string(i) + "].children names node " +
                       std::to_string(index) + ", which does not exist");
      }
      if (std::exchange(parents[index], i) != kNone) return reached_twice(index);
    }
  }
  // Follows the parents of every node. If a walk has more steps than there are nodes, it is in a
  // cycle. `cleared` marks nodes that are known to lead to a root.
  std::vector<char> cleared(parents.size(), 0);
  for (size_t start = 0; start < parents.size(); ++start) {
    size_t steps = 0;
    for (size_t node = start; node != kNone && !cleared[node]; node = parents[node]) {
      if (++steps > parents.size()) return reached_twice(node);
    }
    for (size_t node = start; node != kNone && !cleared[node]; node = parents[node]) {
      cleared[node] = 1;
    }
  }
  return {};
}

// Parts of the JSON that are removed before tinygltf reads it. tinygltf would read external files
// by its own rules, and it refuses valid index accessors that have no buffer view.
struct Taken {
  json buffers;
  json images;
  size_t animations = 0;
  std::vector<std::vector<int>> indices;  // by mesh and primitive; -1: none
};

json take_member(json& root, const char* name) {
  const auto found = root.find(name);
  if (found == root.end()) return json::array();
  json out = std::move(*found);
  root.erase(found);
  return out;
}

Taken take(json& root) {
  Taken out{take_member(root, "buffers"),
            take_member(root, "images"),
            take_member(root, "animations").size(),
            {}};
  const auto meshes = root.find("meshes");
  if (meshes == root.end()) return out;
  for (json& mesh : *meshes) {
    auto& indices = out.indices.emplace_back();
    for (json& primitive : mesh.at("primitives")) {
      indices.push_back(primitive.value("indices", -1));
      primitive.erase("indices");
    }
  }
  return out;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

Checked read_by_tinygltf(const json& root, const Taken& taken, tinygltf::Model& model) {
  const std::string text = root.dump();
  tinygltf::TinyGLTF loader;
  std::string error, warning;
  if (!loader.LoadASCIIFromString(&model, &error, &warning, text.data(),
                                  static_cast<unsigned>(text.size()), "")) {
    return Failure(
        "it is not valid glTF; check it with Khronos' glTF validator and export it "
        "again (tinygltf says: " +
        first_line(error) + ")");
  }
  for (size_t m = 0; m < model.meshes.size(); ++m) {
    for (size_t p = 0; p < model.meshes[m].primitives.size(); ++p) {
      model.meshes[m].primitives[p].indices = taken.indices[m][p];
    }
  }
  model.animations.resize(taken.animations);
  return {};
}

// Fills the buffers of the model. The first buffer of a binary file may be its binary chunk. Other
// buffers without a URI have no data. The bytes are moved out of `file`, so that they are not in
// memory twice.
Checked fill_buffers(const json& buffers, std::vector<uint8_t> file, const GltfParts& parts,
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
      auto bytes = files.read(text);
      if (!bytes) return Failure(name + " " + bytes.error());
      out.data = std::move(*bytes);
    } else if (i == 0 && parts.has_binary) {
      out.data = std::move(chunk);
    } else {
      continue;
    }
    const auto length = buffers[i].at("byteLength").get<uint64_t>();
    if (length > out.data.size()) {
      return Failure(name + " has " + std::to_string(out.data.size()) +
                     " bytes, and its byteLength says " + std::to_string(length));
    }
    out.data.resize(length);
  }
  return {};
}

// Sets `all[index]` if that element exists.
void mark(std::vector<char>& all, int index) {
  if (index >= 0 && static_cast<size_t>(index) < all.size()) all[static_cast<size_t>(index)] = 1;
}

// Marks the images that are used by a material of a mesh of a node.
std::vector<char> used_images(const json& root, size_t image_count) {
  const json none = json::array();
  const auto array = [&](const char* name) -> const json& {
    const auto found = root.find(name);
    return found == root.end() ? none : *found;
  };
  const json &meshes = array("meshes"), &materials = array("materials"),
             &textures = array("textures");
  std::vector<char> mesh_used(meshes.size(), 0), material_used(materials.size(), 0),
      texture_used(textures.size(), 0), image_used(image_count, 0);
  for (const json& node : array("nodes")) mark(mesh_used, node.value("mesh", -1));
  for (size_t i = 0; i < meshes.size(); ++i) {
    if (!mesh_used[i]) continue;
    for (const json& primitive : meshes[i].at("primitives")) {
      mark(material_used, primitive.value("material", -1));
    }
  }
  // A material can refer to textures in several places. Each reference is an object with an index.
  std::vector<const json*> open;
  for (size_t i = 0; i < materials.size(); ++i) {
    if (material_used[i]) open.push_back(&materials[i]);
  }
  while (!open.empty()) {
    const json* object = open.back();
    open.pop_back();
    if (object->contains("index")) mark(texture_used, object->at("index").get<int>());
    for (const json& member : *object) {
      if (member.is_object()) open.push_back(&member);
    }
  }
  for (size_t i = 0; i < textures.size(); ++i) {
    if (texture_used[i]) mark(image_used, textures[i].value("source", -1));
  }
  return image_used;
}

void fill_images(const json& images, const std::vector<char>& used, GltfFiles& files,
                 GltfModel& out) {
  for (size_t i = 0; i < images.size(); ++i) {
    tinygltf::Image& image = out.model.images.emplace_back();
    image.bufferView = images[i].value("bufferView", -1);
    const auto leave_out = [&](const std::string& name, const std::string& why) {
      out.warnings.push_back(name + " " + why + " and is left out.");
    };
    const std::string name = "image " + std::to_string(i);
    const auto uri = images[i].find("uri");
    if (image.bufferView >= 0 || !used[i]) continue;
    if (uri == images[i].end()) {
      leave_out(name, "has neither a uri nor a bufferView");
      continue;
    }
    const auto& text = uri->get_ref<const std::string&>();
    const std::string shown = GltfFiles::shown(text);
    auto bytes = files.read(text);
    if (!shown.starts_with("data:")) image.uri = printable(shown);
    if (!bytes || bytes->empty()) {
      leave_out(name + " (" + shown + ")", bytes ? "is empty" : bytes.error());
      continue;
    }
    image.image = std::move(*bytes);
  }
}

}  // namespace

tl::expected<GltfModel, std::string> read_gltf_model(std::vector<uint8_t> file,
                                                     const std::filesystem::path& folder) {
  const auto parts = split_gltf(file);
  if (!parts) return Failure(parts.error());
  auto parsed = parse(parts->json);
  if (!parsed) return Failure(parsed.error());
  if (!parts->has_binary) file = {};
  auto root = checked_properties(std::move(*parsed));
  if (!root) return Failure(root.error());
  auto checked = check_version(root->at("asset"))
                     .and_then([&] { return check_required_extensions(*root); })
                     .and_then([&] { return check_node_tree(*root); });
  if (!checked) return Failure(checked.error());

  const Taken taken = take(*root);
  GltfModel out;
  if (auto read = read_by_tinygltf(*root, taken, out.model); !read) return Failure(read.error());
  GltfFiles files(folder);
  if (auto filled = fill_buffers(taken.buffers, std::move(file), *parts, files, out.model);
      !filled) {
    return Failure(filled.error());
  }
  fill_images(taken.images, used_images(*root, taken.images.size()), files, out);
  return out;
}

}  // namespace alcove::sample
