#include "scene/gltf.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <new>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "scene/framing.h"
#include "scene/gltf_camera.h"
#include "scene/gltf_extensions.h"
#include "scene/gltf_material.h"
#include "scene/gltf_mesh.h"
#include "scene/gltf_nodes.h"
#include "support/printable.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;
namespace fs = std::filesystem;

constexpr uint64_t kMostFileBytes = INT32_MAX;  // tinygltf counts in int
constexpr size_t kMostOfASentence = 200;        // bytes
constexpr const char* kTooLittleMemory = "there is not enough memory for it";

// The only way in which tinygltf reaches the file system: files of the scene's own folder, up to a
// number of bytes in all.
struct FolderAccess {
  fs::path folder;  // canonical; empty: no files at all
  uint64_t bytes_left = kMostFileBytes;
  std::vector<std::string> outside;  // as the scene names them: there, and not to be read
};

bool lies_within(const fs::path& file, const fs::path& folder) {
  const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return end == folder.end() && rest != file.end();
}

bool file_exists(const std::string& name, void* user) {
  auto& access = *static_cast<FolderAccess*>(user);
  if (access.folder.empty() || name.find('\0') != std::string::npos) return false;
  std::error_code error;
  const fs::path file = fs::canonical(name, error);
  if (error || !fs::is_regular_file(file, error)) return false;
  if (lies_within(file, access.folder)) return true;
  // tinygltf also looks where the program was started, which is not what the scene means.
  const std::string within = (access.folder / "").string();
  if (name.starts_with(within)) access.outside.push_back(name.substr(within.size()));
  return false;
}

std::string same_path(const std::string& name, void*) { return name; }

bool read_file(const fs::path& file, uint64_t most, std::vector<unsigned char>& out,
               std::string& why) {
  std::error_code error;
  const uint64_t size = fs::file_size(file, error);
  if (error) return why = error.message(), false;
  if (size > most) return why = "the file is too large", false;
  std::ifstream stream(file, std::ios::binary);
  out.resize(size);
  stream.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(size));
  if (!stream) return why = "the file cannot be read", false;
  return true;
}

bool read_whole_file(std::vector<unsigned char>* out, std::string* error, const std::string& name,
                     void* user) {
  auto& access = *static_cast<FolderAccess*>(user);
  if (!read_file(name, access.bytes_left, *out, *error)) return false;
  access.bytes_left -= out->size();
  return true;
}

// Keeps the encoded bytes; materials decode what they use. The bytes of an image in a buffer view
// are not touched here: tinygltf has not checked that they lie within the buffer.
bool keep_encoded(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                  const unsigned char* bytes, int size, void*) {
  if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
  return true;
}

// How deep brackets nest outside strings. JSON libraries recurse by it.
size_t nesting(std::span<const uint8_t> json) {
  size_t depth = 0, deepest = 0;
  bool in_string = false;
  for (size_t i = 0; i < json.size(); ++i) {
    const uint8_t c = json[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      deepest = std::max(deepest, ++depth);
    } else if ((c == '}' || c == ']') && depth > 0) {
      --depth;
    }
  }
  return deepest;
}

bool is_binary(std::span<const uint8_t> bytes) {
  return bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
}

// The JSON of either kind of file; empty where a binary one is cut short.
std::span<const uint8_t> json_of(std::span<const uint8_t> bytes) {
  if (!is_binary(bytes)) return bytes;
  uint32_t length = 0;
  if (bytes.size() < 20) return {};
  std::memcpy(&length, bytes.data() + 12, sizeof(length));
  if (length > bytes.size() - 20) return {};
  return bytes.subspan(20, length);
}

// tinygltf reads every version as if it were the second.
tl::expected<void, std::string> check_version(const nlohmann::json& root) {
  const auto asset = root.find("asset");
  if (asset == root.end() || !asset->is_object()) return {};
  const auto version = asset->find("version");
  if (version == asset->end() || !version->is_string()) return {};
  const auto text = version->get<std::string>();
  if (text.substr(0, text.find('.')) == "2") return {};
  return Failure("it is glTF " + text + ", and version 2 is what is read here");
}

tl::expected<void, std::string> check_binary_version(std::span<const uint8_t> bytes) {
  uint32_t version = 0;
  if (!is_binary(bytes) || bytes.size() < 8) return {};
  std::memcpy(&version, bytes.data() + 4, sizeof(version));
  if (version == 2) return {};
  return Failure("it is binary glTF of version " + std::to_string(version) +
                 ", and version 2 is what is read here");
}

// What tinygltf would answer with a crash, all memory or nonsense.
tl::expected<void, std::string> check_json(std::span<const uint8_t> json) {
  constexpr size_t kDeepest = 64;
  if (nesting(json) > kDeepest) return Failure("its JSON is nested too deeply");
  const auto root = nlohmann::json::parse(json.begin(), json.end(), nullptr, false);
  if (!root.is_object()) return Failure("it is not glTF: its JSON cannot be read");
  if (auto fine = check_version(root); !fine) return fine;
  const auto buffers = root.find("buffers");
  if (buffers != root.end() && buffers->is_array()) {
    const auto without_uri = [](const auto& b) { return !b.is_object() || !b.contains("uri"); };
    if (std::count_if(buffers->begin(), buffers->end(), without_uri) > 1) {
      return Failure("only one buffer may lie in the file itself");
    }
  }
  const auto required = root.find("extensionsRequired");
  if (required != root.end() && required->is_array()) {
    for (const auto& name : *required) {
      const std::string text = name.is_string() ? name.get<std::string>() : "?";
      if (!changes_no_shape(text) && !is_extension_read(text)) {
        return Failure("it requires the extension " + text +
                       ", which is not read here; export it without");
      }
    }
  }
  return {};
}

std::string first_line(const std::string& text) {
  const std::string line = text.substr(0, text.find('\n'));
  return line.empty() ? "it is not glTF" : line;
}

// One line that can be read, whatever the file has for names: they may be as long as the file, and
// a URI may be the data itself.
std::string readable(std::string text, size_t most) {
  text = printable(text);
  if (text.size() <= most) return text;
  const std::string data = "data:";
  const size_t uri = text.find(data);
  size_t end = uri < most ? uri + data.size() : most;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0u) == 0x80) --end;  // UTF-8
  return text.substr(0, end) + "...";
}

// Short enough that a sentence has its reason beside the name. And every part and node that bears a
// name has it again: a long one many times over is more than the memory.
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

// An image that cannot be read is left out with a note; of these it has to say why.
void name_images_outside(const FolderAccess& access, tinygltf::Model& model) {
  for (tinygltf::Image& image : model.images) {
    if (std::ranges::find(access.outside, image.uri) != access.outside.end()) {
      image.uri += ", outside the scene's folder";
    }
  }
}

tl::expected<tinygltf::Model, std::string> read_model(std::span<const uint8_t> bytes,
                                                      const fs::path& folder) {
  if (bytes.size() > kMostFileBytes) return Failure("the file is too large");
  if (auto fine = check_binary_version(bytes); !fine) return Failure(fine.error());
  if (auto fine = check_json(json_of(bytes)); !fine) return Failure(fine.error());
  FolderAccess access;
  std::error_code ignored;
  if (!folder.empty()) access.folder = fs::canonical(folder, ignored);
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks({file_exists, same_path, read_whole_file, nullptr, &access});
  loader.SetImageLoader(keep_encoded, nullptr);
  tinygltf::Model model;
  std::string error, warning;
  bool read = false;
  if (is_binary(bytes)) {
    // tinygltf lets the binary chunk reach eight bytes past the end.
    std::vector<unsigned char> padded(bytes.begin(), bytes.end());
    padded.resize(bytes.size() + 16, 0);
    read = loader.LoadBinaryFromMemory(&model, &error, &warning, padded.data(),
                                       static_cast<unsigned>(bytes.size()), access.folder.string());
  } else {
    read = loader.LoadASCIIFromString(&model, &error, &warning,
                                      reinterpret_cast<const char*>(bytes.data()),
                                      static_cast<unsigned>(bytes.size()), access.folder.string());
  }
  // Buffers come first, and the first that is not there ends it.
  if (!read && !access.outside.empty()) {
    return Failure(access.outside.back() + " lies outside the scene's folder");
  }
  if (!read) return Failure(first_line(error));
  name_images_outside(access, model);
  make_names_readable(model);
  return model;
}

// A warning once, however many parts it holds for.
void tidy(std::vector<std::string>& warnings) {
  for (std::string& warning : warnings) warning = readable(std::move(warning), kMostOfASentence);
  std::sort(warnings.begin(), warnings.end());
  warnings.erase(std::unique(warnings.begin(), warnings.end()), warnings.end());
}

void add_core(Scene& scene) {
  const SceneCore core = scene_core(scene.meshes);
  scene.core_bounds_ws = core.bounds_ws;
  if (core.triangles_outside == 0) return;
  scene.warnings.push_back(std::to_string(core.triangles_outside) + " of " +
                           std::to_string(triangle_count(scene)) +
                           " triangles surround the others or lie far from them: the default view, "
                           "radius and near plane are chosen without them.");
}

tl::expected<Scene, std::string> build_scene(const tinygltf::Model& model, const GltfLimits& limits,
                                             const Progress& progress) {
  Scene scene;
  if (auto added = add_materials(model, limits.pixels, scene); !added) {
    return Failure(added.error());
  }
  MeshBudget budget{limits.primitives, limits.vertices, limits.indices, limits.instances,
                    limits.drawn_triangles};
  std::vector<PlacedCamera> cameras;
  if (auto added = add_nodes(model, budget, cameras, scene, progress); !added)
    return Failure(added.error());
  if (scene.meshes.empty()) return Failure("it has no triangles");
  if (!model.animations.empty()) {
    scene.warnings.push_back(
        "Animations are left out: nodes and joints stand as the file places them.");
  }
  for (const auto* extensions : {&model.extensionsUsed, &model.extensionsRequired}) {
    for (const std::string& extension : *extensions) {
      if (!is_extension_read(extension)) {
        scene.warnings.push_back("The extension " + extension + " is left out.");
      }
    }
  }
  scene.bounds_ws = bounds_of(scene.meshes);
  add_core(scene);
  for (const PlacedCamera& camera : cameras) {
    scene.cameras.push_back(aimed(camera, scene.core_bounds_ws));
    scene.cameras.back().origin = scene.origin;
  }
  tidy(scene.warnings);
  return scene;
}

}  // namespace

tl::expected<Scene, std::string> parse_gltf(std::span<const uint8_t> bytes, const std::string& name,
                                            const fs::path& folder, const GltfLimits& limits,
                                            const Progress& progress) {
  const auto refuse = [&](const std::string& why) {
    return Failure("cannot read " + name + ": " + readable(why, kMostOfASentence));
  };
  try {
    const auto model = read_model(bytes, folder);
    if (!model) return refuse(model.error());
    auto scene = build_scene(*model, limits, progress);
    if (!scene) return refuse(scene.error());
    scene->name = printable(fs::path(name).stem().string());
    return scene;
  } catch (const std::bad_alloc&) {
    return refuse(kTooLittleMemory);
  } catch (const std::exception& error) {
    return refuse(error.what());
  }
}

tl::expected<Scene, std::string> load_gltf(const fs::path& file, const Progress& progress) {
  const auto refuse = [&](const std::string& why) {
    return Failure("cannot read " + file.string() + ": " + why);
  };
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) return refuse("there is no such file");
  if (!fs::status_known(status)) return refuse(error.message());
  if (fs::is_directory(status)) return refuse("it is a folder; name the .gltf or .glb in it");
  std::vector<unsigned char> bytes;
  std::string why;
  try {
    if (!read_file(file, kMostFileBytes, bytes, why)) return refuse(why);
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    return parse_gltf(bytes, file.string(), folder, {}, progress);
  } catch (const std::bad_alloc&) {
    return refuse(kTooLittleMemory);
  } catch (const std::exception& exception) {
    return refuse(exception.what());
  }
}

}  // namespace alcove::sample
