#include "scene/gltf.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <new>
#include <utility>
#include <vector>

#include "scene/gltf_camera.h"
#include "scene/gltf_extensions.h"
#include "scene/gltf_files.h"
#include "scene/gltf_material.h"
#include "scene/gltf_mesh.h"
#include "scene/gltf_model.h"
#include "support/printable.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;
namespace fs = std::filesystem;

constexpr size_t kMostOfASentence = 200;  // bytes
constexpr const char* kTooLittleMemory = "there is not enough memory for it";

// One line of at most `most` bytes: names may be as long as the file.
std::string readable(std::string text, size_t most) {
  text = printable(text);
  if (text.size() <= most) return text;
  size_t end = most;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0u) == 0x80) --end;  // UTF-8
  return text.substr(0, end) + "...";
}

// Shortens names, so that a sentence has room for its reason, and so that a long name that many
// nodes share does not take more memory than there is.
void make_names_readable(tinygltf::Model& model) {
  constexpr size_t kMost = 100;
  const auto each = [](auto& things) {
    for (auto& thing : things) thing.name = readable(std::move(thing.name), kMost);
  };
  each(model.nodes);
  each(model.meshes);
  each(model.materials);
  each(model.cameras);
}

glm::dmat4 local_transform(const tinygltf::Node& node) {
  glm::dmat4 m(1.0);
  if (node.matrix.size() == 16) {
    for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = node.matrix[static_cast<size_t>(i)];
    return m;
  }
  if (node.rotation.size() == 4) {
    const glm::dquat q(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    const double length = glm::length(q);
    if (length > 0.0) m = glm::mat4_cast(q / length);
  }
  if (node.scale.size() == 3) {
    for (int c = 0; c < 3; ++c) m[c] *= node.scale[static_cast<size_t>(c)];
  }
  if (node.translation.size() == 3) {
    for (int c = 0; c < 3; ++c) m[3][c] = node.translation[static_cast<size_t>(c)];
  }
  return m;
}

// The nodes to start from: those of the default scene, or every node that is nobody's child.
tl::expected<std::vector<int>, std::string> root_nodes(const tinygltf::Model& model) {
  if (!model.scenes.empty()) {
    const int index = std::max(model.defaultScene, 0);
    if (static_cast<size_t>(index) >= model.scenes.size()) {
      return Failure("it has no scene " + std::to_string(index));
    }
    return model.scenes[static_cast<size_t>(index)].nodes;
  }
  std::vector<char> is_child(model.nodes.size(), 0);
  for (const tinygltf::Node& node : model.nodes) {
    for (const int child : node.children) {
      if (child >= 0 && static_cast<size_t>(child) < is_child.size()) {
        is_child[static_cast<size_t>(child)] = 1;
      }
    }
  }
  std::vector<int> roots;
  for (size_t i = 0; i < is_child.size(); ++i) {
    if (!is_child[i]) roots.push_back(static_cast<int>(i));
  }
  return roots;
}

tl::expected<void, std::string> add_mesh(const tinygltf::Model& model, const tinygltf::Node& node,
                                         const glm::dmat4& world_from_node, MeshBudget& budget,
                                         Scene& scene) {
  if (node.mesh < 0) return {};
  if (static_cast<size_t>(node.mesh) >= model.meshes.size()) {
    return Failure("node \"" + node.name + "\" has no mesh " + std::to_string(node.mesh));
  }
  const tinygltf::Mesh& mesh = model.meshes[static_cast<size_t>(node.mesh)];
  const std::string name = !mesh.name.empty() ? "\"" + mesh.name + "\"" : std::to_string(node.mesh);
  for (const tinygltf::Primitive& primitive : mesh.primitives) {
    if (!primitive.targets.empty()) {
      scene.warnings.push_back("Mesh " + name + " has morph targets, which are left out.");
    }
    auto added = add_primitive(model, primitive, name, world_from_node, budget, scene);
    if (!added) return added;
  }
  if (node.skin >= 0) {
    scene.warnings.push_back("Mesh " + name + " is skinned and stands in its rest pose.");
  }
  return {};
}

// Every node once, from the roots; a second visit means a cycle or two parents.
tl::expected<void, std::string> add_nodes(const tinygltf::Model& model, MeshBudget& budget,
                                          std::vector<PlacedCamera>& cameras, Scene& scene) {
  auto roots = root_nodes(model);
  if (!roots) return Failure(roots.error());
  std::vector<std::pair<int, glm::dmat4>> open;
  for (auto root = roots->rbegin(); root != roots->rend(); ++root) {
    open.emplace_back(*root, glm::dmat4(1.0));
  }
  std::vector<char> visited(model.nodes.size(), 0);
  while (!open.empty()) {
    const auto [index, world_from_parent] = open.back();
    open.pop_back();
    if (index < 0 || static_cast<size_t>(index) >= model.nodes.size()) {
      return Failure("it has no node " + std::to_string(index));
    }
    if (std::exchange(visited[static_cast<size_t>(index)], 1)) {
      return Failure("node " + std::to_string(index) +
                     " is reached twice: nodes form a cycle or have two parents");
    }
    const tinygltf::Node& node = model.nodes[static_cast<size_t>(index)];
    const glm::dmat4 world_from_node = world_from_parent * local_transform(node);
    if (auto added = add_mesh(model, node, world_from_node, budget, scene); !added) return added;
    add_camera(model, node, world_from_node, cameras, scene);
    for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
      open.emplace_back(*child, world_from_node);
    }
  }
  return {};
}

// A warning once, however many parts it holds for.
void tidy(std::vector<std::string>& warnings) {
  for (std::string& warning : warnings) warning = readable(std::move(warning), kMostOfASentence);
  std::sort(warnings.begin(), warnings.end());
  warnings.erase(std::unique(warnings.begin(), warnings.end()), warnings.end());
}

tl::expected<Scene, std::string> build_scene(GltfModel read, const GltfLimits& limits) {
  make_names_readable(read.model);
  const tinygltf::Model& model = read.model;
  Scene scene;
  scene.warnings = std::move(read.warnings);
  if (auto added = add_materials(model, limits.images, scene); !added) {
    return Failure(added.error());
  }
  MeshBudget budget{limits.primitives, limits.vertices, limits.indices};
  std::vector<PlacedCamera> cameras;
  if (auto added = add_nodes(model, budget, cameras, scene); !added) return Failure(added.error());
  if (scene.meshes.empty()) return Failure("it has no triangles");
  if (!model.animations.empty()) {
    scene.warnings.push_back("Animations are left out: nodes stand as the file places them.");
  }
  for (const auto* extensions : {&model.extensionsUsed, &model.extensionsRequired}) {
    for (const std::string& extension : *extensions) {
      if (!is_extension_read(extension)) {
        scene.warnings.push_back("The extension " + extension + " is left out.");
      }
    }
  }
  tidy(scene.warnings);
  scene.bounds_ws = bounds_of(scene.meshes);
  for (const PlacedCamera& camera : cameras) {
    scene.cameras.push_back(aimed(camera, scene.bounds_ws));
  }
  return scene;
}

tl::expected<Scene, std::string> parse(std::vector<uint8_t> bytes, const std::string& name,
                                       const fs::path& folder, const GltfLimits& limits) {
  const auto refuse = [&](const std::string& why) {
    return Failure("cannot read " + name + ": " + readable(why, kMostOfASentence));
  };
  try {
    auto model = read_gltf_model(std::move(bytes), folder);
    if (!model) return refuse(model.error());
    auto scene = build_scene(std::move(*model), limits);
    if (!scene) return refuse(scene.error());
    scene->name = printable(fs::path(name).stem().string());
    return scene;
  } catch (const std::bad_alloc&) {
    return refuse(kTooLittleMemory);
  } catch (const std::exception& error) {
    return refuse(error.what());
  }
}

}  // namespace

tl::expected<Scene, std::string> parse_gltf(std::span<const uint8_t> bytes, const std::string& name,
                                            const fs::path& folder, const GltfLimits& limits) {
  return parse({bytes.begin(), bytes.end()}, name, folder, limits);
}

tl::expected<Scene, std::string> load_gltf(const fs::path& file) {
  const auto refuse = [&](const std::string& why) {
    return Failure("cannot read " + printable(file.string()) + ": " + why);
  };
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) return refuse("there is no such file");
  if (!fs::status_known(status)) return refuse(error.message());
  if (fs::is_directory(status)) return refuse("it is a folder; name the .gltf or .glb in it");
  try {
    auto bytes = read_regular_file(file, kMostFileBytes);
    if (!bytes) return refuse("it " + bytes.error());
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    return parse(std::move(*bytes), printable(file.string()), folder, {});
  } catch (const std::bad_alloc&) {
    return refuse(kTooLittleMemory);
  } catch (const std::exception& exception) {
    return refuse(exception.what());
  }
}

}  // namespace alcove::sample
