#include "scene/gltf_images.h"

#include <algorithm>
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

// An image that is used.
struct Entry {
  size_t index;  // in the model
  std::string name;
  std::vector<uint8_t> file = {};       // empty if the bytes are in a buffer view
  std::span<const uint8_t> bytes = {};  // of the image file
  ImageHeader header = {};
  uint32_t reduction = 1;  // every block of so many pixels a side becomes one
  Result<DecodedImage> decoded = Failure("");

  uint64_t pixels() const {
    const auto reduced = [&](uint32_t side) {
      return (uint64_t{side} + reduction - 1) / reduction;
    };
    return reduced(header.width) * reduced(header.height);
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

// Halves the largest image until all fit in memory. Returns the number of images that are reduced.
size_t reduce(std::vector<Entry>& entries, uint64_t most_pixels) {
  const auto smaller = [](const Entry* a, const Entry* b) { return a->pixels() < b->pixels(); };
  std::priority_queue<Entry*, std::vector<Entry*>, decltype(smaller)> largest(smaller);
  uint64_t pixels = 0;
  for (Entry& entry : entries) {
    pixels += entry.pixels();
    largest.push(&entry);
  }
  while (pixels > most_pixels && !largest.empty()) {
    Entry& entry = *largest.top();
    largest.pop();
    pixels -= entry.pixels();
    entry.reduction *= 2;
    pixels += entry.pixels();
    if (entry.pixels() > 1) largest.push(&entry);
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
    if (pixels + entry.pixels() > limits.decoded) {
      leave_out(entry.name, "takes the images of the scene past " +
                                std::to_string(limits.decoded >> 20) + " million pixels");
      continue;
    }
    pixels += entry.pixels();
    entries.push_back(std::move(entry));
  }
  if (const size_t reduced = reduce(entries, limits.kept); reduced > 0) {
    scene.warnings.push_back("The images are large together: " + std::to_string(reduced) + " of " +
                             std::to_string(entries.size()) + " are reduced, the largest first.");
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
