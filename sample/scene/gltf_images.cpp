#include "scene/gltf_images.h"

#include <algorithm>
#include <utility>

#include "scene/gltf_accessor.h"

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

std::string shown(const ImageHeader& header) {
  return std::to_string(header.width) + "x" + std::to_string(header.height) + " pixels";
}

uint64_t pixels_of(const ImageHeader& header, uint32_t reduction) {
  const auto reduced = [&](uint32_t side) { return uint64_t{(side + reduction - 1) / reduction}; };
  return reduced(header.width) * reduced(header.height);
}

}  // namespace

GltfImages::GltfImages(const tinygltf::Model& model, const ImageLimits& limits, Scene& scene)
    : model_(model), scene_(scene), entries_(model.images.size()) {
  for (size_t i = 0; i < entries_.size(); ++i) read_header(i);
  limit_sides(limits);
}

std::string GltfImages::name(size_t index) const {
  const std::string& uri = model_.images[index].uri;
  return "image " + std::to_string(index) + (uri.empty() ? "" : " (" + uri + ")");
}

void GltfImages::read_header(size_t index) {
  Entry& entry = entries_[index];
  const tinygltf::Image& image = model_.images[index];
  if (image.bufferView < 0) {
    entry.bytes = image.image;
  } else if (const auto view = view_bytes(model_, image.bufferView); view) {
    entry.bytes = *view;
  } else {
    entry.refusal = "uses " + name(index) + ", whose " + view.error();
    return;
  }
  // A warning was already added for an image without bytes.
  if (image.bufferView < 0 && entry.bytes.empty()) return;
  entry.header = read_image_header(entry.bytes);
  if (!entry.header) return;
  if (std::max(entry.header->width, entry.header->height) > kLargestImageSide) {
    entry.refusal = "uses " + name(index) + ", which is " + shown(*entry.header) +
                    "; make it at most " + std::to_string(kLargestImageSide) + " a side";
  }
}

void GltfImages::limit_sides(const ImageLimits& limits) {
  uint64_t decoded = 0;
  for (size_t i = 0; i < entries_.size(); ++i) {
    Entry& entry = entries_[i];
    if (!entry.header || !entry.refusal.empty()) continue;
    decoded += pixels_of(*entry.header, 1);
    if (decoded > limits.decoded) {
      entry.refusal = "uses " + name(i) + ", which takes the images of the scene past " +
                      std::to_string(limits.decoded >> 20) + " million pixels; make them smaller";
    }
  }
  const auto kept = [&] {
    uint64_t sum = 0;
    for (const Entry& entry : entries_) {
      if (entry.header && entry.refusal.empty()) {
        sum += pixels_of(*entry.header, reduction(*entry.header));
      }
    }
    return sum;
  };
  while (largest_side_ > 1 && kept() > limits.kept) largest_side_ /= 2;
  if (largest_side_ < kLargestImageSide) {
    scene_.warnings.push_back("The images are large together: those of over " +
                              std::to_string(largest_side_) +
                              " pixels a side are reduced to that.");
  }
}

uint32_t GltfImages::reduction(const ImageHeader& header) const {
  uint32_t factor = 1;
  while (std::max(header.width, header.height) > uint64_t{largest_side_} * factor) factor *= 2;
  return factor;
}

tl::expected<int32_t, std::string> GltfImages::decode(size_t index) {
  Entry& entry = entries_[index];
  if (!entry.refusal.empty()) return Failure(entry.refusal);
  if (std::exchange(entry.tried, true)) return entry.image;
  const auto leave_out = [&](const std::string& why) {
    if (!why.empty()) scene_.warnings.push_back(name(index) + " " + why + " and is left out.");
    return -1;
  };
  if (!entry.header) return leave_out(entry.header.error());
  auto decoded = decode_image(entry.bytes, *entry.header, reduction(*entry.header));
  if (!decoded) return leave_out(decoded.error());
  entry.image = static_cast<int32_t>(scene_.images.size());
  scene_.images.push_back({name(index), decoded->width, decoded->height, std::move(decoded->rgba)});
  return entry.image;
}

}  // namespace alcove::sample
