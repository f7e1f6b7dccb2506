#include "scene/gltf.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <new>
#include <utility>
#include <vector>

#include "scene/gltf_camera.h"
#include "scene/gltf_files.h"
#include "scene/gltf_material.h"
#include "scene/gltf_mesh.h"
#include "scene/gltf_model.h"
#include "scene/gltf_scene.h"
#include "support/foreign_file.h"
#include "support/printable.h"

namespace alcove::sample {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMostOfASentence = 200;  // bytes
constexpr const char* kTooLittleMemory = "there is not enough memory for it";

// Shortens names, so that a message has room for its reason, and so that a long name that many
// nodes share does not exhaust memory.
void make_names_readable(tinygltf::Model& model) {
  constexpr size_t kMost = 100;
  const auto each = [](auto& things) {
    for (auto& thing : things) thing.name = shortened(thing.name, kMost);
  };
  each(model.nodes);
  each(model.meshes);
  each(model.materials);
  each(model.cameras);
}

// Keeps each warning only once, even if it applies to many parts of the file.
void tidy(std::vector<std::string>& warnings) {
  for (std::string& warning : warnings) warning = shortened(warning, kMostOfASentence);
  std::sort(warnings.begin(), warnings.end());
  warnings.erase(std::unique(warnings.begin(), warnings.end()), warnings.end());
}

Result<Scene> build_scene(GltfModel read, const GltfLimits& limits, const Progress& progress) {
  make_names_readable(read.model);
  const tinygltf::Model& model = read.model;
  Scene scene;
  scene.warnings = std::move(read.warnings);
  ALCOVE_TRY_VOID(add_materials(model, scene));
  GltfLimits budget = limits;
  std::vector<PlacedCamera> cameras;
  ALCOVE_TRY_VOID(add_nodes(model, budget, cameras, scene, progress));
  if (scene.meshes.empty()) {
    return Failure(
        "it has no triangles to draw; points, lines, triangles without an area and materials with "
        "an alpha of 0 are not drawn");
  }
  scene.has_animations = !model.animations.empty();
  if (scene.has_animations) {
    scene.warnings.push_back(
        "Animations are left out: nodes, joints and morph targets stand as the file places them.");
  }
  // The vertices have been copied, so that only images can be in the file's bytes.
  if (model.images.empty()) read.model.buffers.clear();
  scene.bounds_ws = bounds_of(scene.meshes);
  add_images(model, read.files, limits.images, scene);
  for (const PlacedCamera& camera : cameras) {
    scene.cameras.push_back(aimed(camera, scene.bounds_ws));
    scene.cameras.back().origin = scene.origin;
  }
  tidy(scene.warnings);
  return scene;
}

Result<Scene> parse(std::vector<uint8_t> bytes, const std::string& name, const fs::path& folder,
                    const GltfLimits& limits, const Progress& progress) {
  const auto refuse = [&](const std::string& why) {
    return Failure("cannot read " + name + ": " + shortened(why, kMostOfASentence));
  };
  try {
    auto model = read_gltf_model(std::move(bytes), folder);
    if (!model) return refuse(model.error());
    auto scene = build_scene(std::move(*model), limits, progress);
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

Result<Scene> parse_gltf(std::span<const uint8_t> bytes, const std::string& name,
                         const fs::path& folder, const GltfLimits& limits,
                         const Progress& progress) {
  return parse({bytes.begin(), bytes.end()}, name, folder, limits, progress);
}

Result<Scene> load_gltf(const fs::path& file, const Progress& progress) {
  const auto refuse = [&](const std::string& why) {
    return Failure("cannot read " + printable(file.string()) + ": " + why);
  };
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::status_known(status)) return refuse(error.message());
  if (!fs::is_regular_file(status)) return refuse(missing_file(file));
  if (has_other_format(file))
    return refuse("it is no glTF; convert it to glTF 2.0, for example with Blender");
  try {
    auto bytes = read_regular_file(file, kMostFileBytes);
    if (!bytes) return refuse("it " + bytes.error());
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    return parse(std::move(*bytes), printable(file.string()), folder, {}, progress);
  } catch (const std::bad_alloc&) {
    return refuse(kTooLittleMemory);
  } catch (const std::exception& exception) {
    return refuse(exception.what());
  }
}

}  // namespace alcove::sample
