#include "scene/gltf_meshopt.h"

#include <meshoptimizer.h>

#include <cstdint>
#include <vector>

#include "scene/gltf_accessor.h"

namespace alcove::sample {
namespace {

const tinygltf::Value* compression(const tinygltf::BufferView& view) {
  for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    const auto found = view.extensions.find(name);
    if (found != view.extensions.end()) return &found->second;
  }
  return nullptr;
}

// Returns a number that the table of properties requires, or 0 if an optional one is missing.
uint64_t number(const tinygltf::Value& extension, const char* name) {
  return extension.Has(name) ? static_cast<uint64_t>(extension.Get(name).GetNumberAsDouble()) : 0;
}

std::string text(const tinygltf::Value& extension, const char* name) {
  return extension.Has(name) ? extension.Get(name).Get<std::string>() : "";
}

// Reverses the filter after decoding. `stride` was checked for the filter.
void unfilter(const std::string& filter, std::vector<uint8_t>& data, size_t count, size_t stride) {
  if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(data.data(), count, stride);
  if (filter == "QUATERNION") meshopt_decodeFilterQuat(data.data(), count, stride);
  if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(data.data(), count, stride);
}

// Returns the name of what KHR_meshopt_compression added to EXT_meshopt_compression, if data uses
// it.
std::string newer_codec(std::span<const uint8_t> bytes, const std::string& filter) {
  constexpr uint8_t kVertices = 0xa0;  // the first byte of the data is the codec and its version
  constexpr uint8_t kVersion = 0x0f;
  const uint8_t header = bytes.empty() ? 0 : bytes[0];
  if ((header & ~kVersion) == kVertices && (header & kVersion) > 0)
    return "vertex codec " + std::to_string(header & kVersion) + " of meshoptimizer";
  return filter == "COLOR" ? "the filter COLOR" : "";
}

Result<std::vector<uint8_t>> decompressed(const tinygltf::Model& model,
                                          const tinygltf::Value& extension, uint64_t most_bytes) {
  const uint64_t count = number(extension, "count"), stride = number(extension, "byteStride");
  const std::string mode = text(extension, "mode"), filter = text(extension, "filter");
  const bool attributes = mode == "ATTRIBUTES";
  const bool fits_filter = filter == "OCTAHEDRAL"   ? stride == 4 || stride == 8
                           : filter == "QUATERNION" ? stride == 8
                                                    : true;
  if (attributes ? stride % 4 != 0 || !fits_filter
                 : (stride != 2 && stride != 4) || (mode == "TRIANGLES" && count % 3 != 0))
    return Failure("has a stride or count that does not suit its mode");
  if (count * stride > most_bytes) return Failure("is too large when it is decompressed");
  tinygltf::BufferView view;
  view.buffer = static_cast<int>(number(extension, "buffer"));
  view.byteOffset = number(extension, "byteOffset");
  view.byteLength = number(extension, "byteLength");
  ALCOVE_TRY(const auto bytes, view_bytes(model, view));
  if (const auto newer = newer_codec(bytes, filter); !newer.empty())
    return Failure(
        "uses " + newer +
        ", which is not read here; pack it by gltfpack -ce ext, or add a fallback by -cf");
  std::vector<uint8_t> out(count * stride);
  const int failed =
      attributes ? meshopt_decodeVertexBuffer(out.data(), count, stride, bytes.data(), bytes.size())
      : mode == "TRIANGLES"
          ? meshopt_decodeIndexBuffer(out.data(), count, stride, bytes.data(), bytes.size())
          : meshopt_decodeIndexSequence(out.data(), count, stride, bytes.data(), bytes.size());
  if (failed != 0) return Failure("is damaged");
  if (attributes) unfilter(filter, out, count, stride);
  return out;
}

}  // namespace

Result<void> decompress_views(tinygltf::Model& model, std::vector<std::string>& notes) {
  uint64_t bytes_left = uint64_t{1} << 30;
  for (size_t i = 0; i < model.bufferViews.size(); ++i) {
    tinygltf::BufferView& view = model.bufferViews[i];
    const tinygltf::Value* extension = compression(view);
    if (extension == nullptr) continue;
    auto data = decompressed(model, *extension, bytes_left);
    if (!data && view_bytes(model, view)) {
      notes.push_back("Compressed meshes that cannot be read are replaced by their fallback.");
      continue;
    }
    if (!data) return Failure("compressed buffer view " + std::to_string(i) + " " + data.error());
    bytes_left -= data->size();
    view.buffer = static_cast<int>(model.buffers.size());
    view.byteOffset = 0;
    view.byteLength = data->size();
    model.buffers.emplace_back().data = std::move(*data);
  }
  return {};
}

}  // namespace alcove::sample
