#include "scene/gltf_images.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <new>
#include <queue>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scene/gltf_accessor.h"
#include "support/decode_image.h"
#include "support/parallel.h"
#include "support/printable.h"
#include "support/result.h"

namespace alcove::sample {
namespace {

// How large an image appears. Apparent areas are areas of surfaces, divided by the square of their
// distance from the centre of the subject, which counts as at least the size of the subject.
struct Appearance {
  double all = 0.0;     // apparent area of all its surfaces
  double repeat = 0.0;  // of one repetition of the image, on the mesh that shows it largest
};

// An image that is used.
struct Entry {
  size_t index;  // in the model
  std::string name;
  std::vector<uint8_t> file = {};       // empty if the bytes are in a buffer view
  std::span<const uint8_t> bytes = {};  // of the image file
  Appearance appearance = {};
  ImageHeader header = {};
  uint32_t reduction = 1;  // every block of so many pixels a side becomes one
  Result<DecodedImage> decoded = Failure("");

  uint64_t pixels() const {
    const auto reduced = [&](uint32_t side) {
      return (uint64_t{side} + reduction - 1) / reduction;
    };
    return reduced(header.width) * reduced(header.height);
  }
  double texels_in_view() const {
    return static_cast<double>(pixels()) / std::max(appearance.repeat, 1e-30);
  }
};

// Returns the images of the model that the materials of meshes use.
std::set<size_t> used_images(const Scene& scene) {
  std::set<size_t> out;
  for (const Mesh& mesh : scene.meshes) {
    for (const TextureUse* use : scene.materials[mesh.material].textures())
      if (use->image >= 0) out.insert(static_cast<size_t>(use->image));
  }
  return out;
}

// Returns the instance of each mesh that is nearest to a point.
std::vector<MeshInstance> nearest_instances(const std::vector<Mesh>& meshes, const glm::dvec3& to) {
  std::vector<MeshInstance> out;
  double least = 0.0;
  for (const MeshInstance& instance : instances_of(meshes)) {
    const glm::dvec3 low(instance.bounds_ws.low), high(instance.bounds_ws.high);
    const double distance = glm::distance(glm::clamp(to, low, high), to);
    const bool is_new = out.empty() || out.back().mesh != instance.mesh;
    if (!is_new && distance >= least) continue;
    if (is_new) out.emplace_back();
    out.back() = instance;
    least = distance;
  }
  return out;
}

// Returns how large each image of the model appears that a mesh uses. Of the instances of a mesh,
// the one nearest to the subject counts.
std::map<size_t, Appearance> appearances(const Scene& scene) {
  const glm::dvec3 low(scene.subject.bounds_ws.low), high(scene.subject.bounds_ws.high);
  const glm::dvec3 centre = 0.5 * (low + high);
  const double nearest = std::max(glm::distance(low, high), 1e-15);
  std::map<size_t, Appearance> out;
  for (const MeshInstance& instance : nearest_instances(scene.meshes, centre)) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const auto uses = scene.materials[mesh.material].textures();
    if (std::ranges::all_of(uses, [](const TextureUse* use) { return use->image < 0; })) continue;
    const glm::dmat4x3 world(world_from_mesh(mesh, instance.instance));
    double apparent = 0.0;
    std::array<double, 4> repeats{};  // by use: area in texture coordinates
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      std::array<glm::dvec3, 3> at;
      std::array<MeshUvs, 3> uvs;
      for (size_t c = 0; c < 3; ++c) {
        at[c] = world * glm::dvec4(mesh.positions[mesh.indices[i + c]], 1.0);
        uvs[c] = uvs_at(mesh, mesh.indices[i + c]);
      }
      const double distance =
          std::max(glm::distance((at[0] + at[1] + at[2]) / 3.0, centre), nearest);
      apparent += 0.5 * glm::length(glm::cross(at[1] - at[0], at[2] - at[0])) / distance / distance;
      for (size_t u = 0; u < uses.size(); ++u) {
        const glm::dvec2 origin = texture_uv(*uses[u], uvs[0]);
        const glm::dvec2 a = glm::dvec2(texture_uv(*uses[u], uvs[1])) - origin;
        const glm::dvec2 b = glm::dvec2(texture_uv(*uses[u], uvs[2])) - origin;
        repeats[u] += 0.5 * std::abs(a.x * b.y - a.y * b.x);
      }
    }
    for (size_t u = 0; u < uses.size(); ++u) {
      if (uses[u]->image < 0) continue;
      constexpr double kLeast = 1e-6;  // triangles of one colour each show a point of the image
      Appearance& image = out[static_cast<size_t>(uses[u]->image)];
      image.all += apparent;
      image.repeat = std::max(image.repeat, apparent / std::max(repeats[u], kLeast));
    }
  }
  return out;
}

// Finds the bytes of an image and reads its header. The error is the end of a sentence that begins
// with the entry's name.
Result<void> read_header(const tinygltf::Model& model, GltfFiles& files, Entry& entry) {
  const tinygltf::Image& image = model.images[entry.index];
  if (image.bufferView >= 0) {
    ALCOVE_TRY(entry.bytes, view_bytes(model, image.bufferView)
                                .map_error(with_prefix("is in a view that cannot be read: ")));
  } else {
    if (image.uri.empty()) return Failure("has neither a uri nor a bufferView");
    ALCOVE_TRY(entry.file, files.read(image.uri));
    entry.bytes = entry.file;
  }
  if (entry.bytes.empty()) return Failure("is empty");
  ALCOVE_TRY(entry.header, read_image_header(entry.bytes));
  const auto& [format, width, height] = entry.header;
  if (std::max(width, height) > kLargestImageSide) {
    return Failure("is " + std::to_string(width) + "x" + std::to_string(height) +
                   " pixels, more than " + std::to_string(kLargestImageSide) + " a side,");
  }
  return {};
}

// Sets how large each image appears, and sorts the images by it, the largest first.
void sort_by_appearance(const Scene& scene, std::vector<Entry>& entries) {
  std::map<size_t, Appearance> known = appearances(scene);
  for (Entry& entry : entries) entry.appearance = known[entry.index];
  std::ranges::stable_sort(entries, std::greater<>(),
                           [](const Entry& entry) { return entry.appearance.all; });
}

// Halves the image with the most texels for its size in view, until all fit in memory. Returns the
// number of images that are reduced.
size_t reduce(std::vector<Entry>& entries, uint64_t most_pixels) {
  const auto coarser = [](const Entry* a, const Entry* b) {
    return a->texels_in_view() < b->texels_in_view();
  };
  std::priority_queue<Entry*, std::vector<Entry*>, decltype(coarser)> finest(coarser);
  uint64_t pixels = 0;
  for (Entry& entry : entries) {
    pixels += entry.pixels();
    finest.push(&entry);
  }
  while (pixels > most_pixels && !finest.empty()) {
    Entry& entry = *finest.top();
    finest.pop();
    pixels -= entry.pixels();
    entry.reduction *= 2;
    pixels += entry.pixels();
    if (entry.pixels() > 1) finest.push(&entry);
  }
  return static_cast<size_t>(
      std::ranges::count_if(entries, [](const Entry& entry) { return entry.reduction > 1; }));
}

}  // namespace

void add_images(const tinygltf::Model& model, GltfFiles& files, const ImageLimits& limits,
                Scene& scene) {
  const auto leave_out = [&](const std::string& name, const std::string& why) {
    scene.warnings.push_back(name + " " + why + " and is left out.");
  };
  std::vector<Entry> entries;
  uint64_t pixels = 0;
  for (const size_t index : used_images(scene)) {
    const std::string& uri = model.images[index].uri;
    const std::string name = "image " + std::to_string(index);
    Entry entry{.index = index,
                .name = uri.empty() ? name : name + " (" + printable(GltfFiles::shown(uri)) + ")"};
    if (auto read = read_header(model, files, entry); !read) {
      leave_out(entry.name, read.error());
      continue;
    }
    pixels += entry.pixels();
    entries.push_back(std::move(entry));
  }
  if (pixels > std::min(limits.kept, limits.decoded)) sort_by_appearance(scene, entries);
  pixels = 0;
  std::erase_if(entries, [&](const Entry& entry) {
    if (pixels + entry.pixels() <= limits.decoded) {
      pixels += entry.pixels();
      return false;
    }
    leave_out(entry.name, "takes the images of the scene past " +
                              std::to_string(limits.decoded >> 20) + " million pixels");
    return true;
  });
  if (const size_t reduced = reduce(entries, limits.kept); reduced > 0) {
    scene.warnings.push_back("The images are large together: " + std::to_string(reduced) + " of " +
                             std::to_string(entries.size()) +
                             " are reduced, those with the most texels for their size in view.");
  }
  parallel_rows(static_cast<uint32_t>(entries.size()), [&](uint32_t i) {
    Entry& entry = entries[i];
    try {
      entry.decoded = decode_image(entry.bytes, entry.header, entry.reduction);
    } catch (const std::bad_alloc&) {
      entry.decoded = Failure("needs more memory than there is");
    }
  });
  std::vector<int32_t> scene_image(model.images.size(), -1);
  std::ranges::sort(entries, {}, &Entry::index);
  for (Entry& entry : entries) {
    if (!entry.decoded) {
      leave_out(entry.name, entry.decoded.error());
      continue;
    }
    scene_image[entry.index] = static_cast<int32_t>(scene.images.size());
    scene.images.push_back(
        {entry.name, entry.decoded->width, entry.decoded->height, std::move(entry.decoded->rgba)});
  }
  for (Material& material : scene.materials) {
    for (TextureUse* use : material.textures())
      if (use->image >= 0) use->image = scene_image[static_cast<size_t>(use->image)];
  }
}

}  // namespace alcove::sample
