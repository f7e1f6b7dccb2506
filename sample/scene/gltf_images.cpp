#include "scene/gltf_images.h"

#include <algorithm>
#include <new>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <utility>

#include "scene/gltf_accessor.h"
#include "support/decode_image.h"
#include "support/parallel.h"
#include "support/printable.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

uint64_t pixels_of(const ImageHeader& header, uint32_t reduction) {
  const auto reduced = [&](uint32_t side) { return uint64_t{(side + reduction - 1) / reduction}; };
  return reduced(header.width) * reduced(header.height);
}

// An image that is used and whose header is valid.
struct Entry {
  size_t index;  // in the model
  std::string name;
  std::vector<uint8_t> file;       // empty if the bytes are in a buffer view
  std::span<const uint8_t> bytes;  // of the image file
  ImageHeader header;
  tl::expected<DecodedImage, std::string> decoded = Failure("");

  // Returns the factor that reduces the longer side to at most `side`.
  uint32_t reduction(uint32_t side) const {
    uint32_t factor = 1;
    while (std::max(header.width, header.height) > uint64_t{side} * factor) factor *= 2;
    return factor;
  }
};

// Finds the bytes of an image and reads its header. The error is the end of a sentence that begins
// with the entry's name.
tl::expected<void, std::string> read_header(const tinygltf::Model& model, GltfFiles& files,
                                            Entry& entry) {
  const tinygltf::Image& image = model.images[entry.index];
  if (image.bufferView >= 0) {
    const auto view = view_bytes(model, image.bufferView);
    if (!view) return Failure("is in a view that cannot be read: " + view.error());
    entry.bytes = *view;
  } else {
    if (image.uri.empty()) return Failure("has neither a uri nor a bufferView");
    auto bytes = files.read(image.uri);
    if (!bytes) return Failure(bytes.error());
    entry.file = std::move(*bytes);
    entry.bytes = entry.file;
  }
  if (entry.bytes.empty()) return Failure("is empty");
  const auto header = read_image_header(entry.bytes);
  if (!header) return Failure(header.error());
  entry.header = *header;
  if (std::max(header->width, header->height) > kLargestImageSide) {
    return Failure("is " + std::to_string(header->width) + "x" + std::to_string(header->height) +
                   " pixels, more than " + std::to_string(kLargestImageSide) + " a side,");
  }
  return {};
}

// Returns the largest side that lets all images fit in memory.
uint32_t largest_side(const std::vector<Entry>& entries, uint64_t most_pixels) {
  uint32_t side = kLargestImageSide;
  const auto pixels = [&] {
    uint64_t sum = 0;
    for (const Entry& entry : entries) sum += pixels_of(entry.header, entry.reduction(side));
    return sum;
  };
  while (side > 1 && pixels() > most_pixels) side /= 2;
  return side;
}

}  // namespace

std::vector<int32_t> decode_images(const tinygltf::Model& model, const std::vector<char>& used,
                                   GltfFiles& files, const ImageLimits& limits, Scene& scene) {
  const auto leave_out = [&](const std::string& name, const std::string& why) {
    scene.warnings.push_back(name + " " + why + " and is left out.");
  };
  std::vector<Entry> entries;
  uint64_t pixels = 0;
  for (size_t i = 0; i < model.images.size(); ++i) {
    if (!used[i]) continue;
    const std::string& uri = model.images[i].uri;
    const std::string name = "image " + std::to_string(i);
    Entry entry{
        i, uri.empty() ? name : name + " (" + printable(GltfFiles::shown(uri)) + ")", {}, {}, {}};
    if (auto read = read_header(model, files, entry); !read) {
      leave_out(entry.name, read.error());
      continue;
    }
    if (pixels + pixels_of(entry.header, 1) > limits.decoded) {
      leave_out(entry.name, "takes the images of the scene past " +
                                std::to_string(limits.decoded >> 20) + " million pixels");
      continue;
    }
    pixels += pixels_of(entry.header, 1);
    entries.push_back(std::move(entry));
  }
  const uint32_t side = largest_side(entries, limits.kept);
  if (side < kLargestImageSide) {
    scene.warnings.push_back("The images are large together: those of over " +
                             std::to_string(side) + " pixels a side are reduced to that.");
  }
  parallel_rows(static_cast<uint32_t>(entries.size()), [&](uint32_t i) {
    try {
      Entry& entry = entries[i];
      entry.decoded = decode_image(entry.bytes, entry.header, entry.reduction(side));
    } catch (const std::bad_alloc&) {
      entries[i].decoded = Failure("needs more memory than there is");
    }
  });
  std::vector<int32_t> out(model.images.size(), -1);
  for (Entry& entry : entries) {
    if (!entry.decoded) {
      leave_out(entry.name, entry.decoded.error());
      continue;
    }
    out[entry.index] = static_cast<int32_t>(scene.images.size());
    scene.images.push_back(
        {entry.name, entry.decoded->width, entry.decoded->height, std::move(entry.decoded->rgba)});
  }
  return out;
}

}  // namespace alcove::sample
