#include "scene/gltf_draco.h"

#include <draco/compression/config/decoder_options.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <span>
#include <utility>

#include "scene/gltf_accessor.h"

namespace alcove::sample {
namespace {

using Bytes = std::span<const uint8_t>;

// The triangles and bytes that may still be decoded.
struct Budget {
  uint64_t faces = uint64_t{1} << 24;
  uint64_t bytes = uint64_t{1} << 30;
};

// A decoder of Draco that refuses counts beyond a budget before it allocates memory for them.
template <class Decoder>
class LimitedDecoder : public Decoder {
 public:
  // `counts_before_faces`: numbers in the bitstream before the number of faces.
  LimitedDecoder(const Budget& budget, int counts_before_faces)
      : budget_(budget), counts_before_faces_(counts_before_faces) {}

 protected:
  bool DecodeConnectivity() override {
    draco::DecoderBuffer ahead = *this->buffer();
    uint32_t faces = 0;
    for (int i = 0; i <= counts_before_faces_; ++i)
      if (!draco::DecodeVarint(&faces, &ahead)) return false;
    // The edgebreaker algorithm has connectivity of its own for each of these.
    uint8_t attribute_sets = 0;
    if (counts_before_faces_ > 0 && !ahead.Decode(&attribute_sets)) return false;
    constexpr uint64_t kMostFacesPerByte = 64;
    const auto bytes = static_cast<uint64_t>(ahead.remaining_size());
    const uint64_t most = std::min(budget_.faces, kMostFacesPerByte * bytes);
    // A mesh without triangles is refused too, because decoders are rarely tested with it.
    return faces > 0 && faces * (uint64_t{attribute_sets} + 1) <= most &&
           Decoder::DecodeConnectivity();
  }

  bool DecodeAllAttributes() override {
    constexpr uint64_t kOverhead = 8;  // bytes a value, for maps and quantised values
    const draco::PointCloud& points = *this->point_cloud();
    uint64_t size = 0;
    for (int i = 0; size <= budget_.bytes && i < points.num_attributes(); ++i) {
      const auto& attribute = *points.attribute(i);
      size += points.num_points() * (static_cast<uint64_t>(attribute.byte_stride()) +
                                     kOverhead * attribute.num_components());
    }
    return size > 0 && size <= budget_.bytes && Decoder::DecodeAllAttributes();
  }

 private:
  Budget budget_;
  int counts_before_faces_;
};

// Decodes a bitstream of version 2.2, the only one of the extension. Returns false if it is damaged
// or too large.
bool decode(Bytes bytes, const Budget& budget, draco::Mesh& out) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  draco::DecoderBuffer header_bytes = buffer;
  draco::DracoHeader header;
  if (!draco::PointCloudDecoder::DecodeHeader(&header_bytes, &header).ok() ||
      header.version_major != 2 || header.version_minor != 2)
    return false;
  const draco::DecoderOptions options;
  if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING) {
    LimitedDecoder<draco::MeshSequentialDecoder> decoder(budget, 0);
    return decoder.Decode(options, &buffer, &out).ok();
  }
  if (header.encoder_method != draco::MESH_EDGEBREAKER_ENCODING) return false;
  LimitedDecoder<draco::MeshEdgebreakerDecoder> decoder(budget, 1);
  return decoder.Decode(options, &buffer, &out).ok();
}

// Returns the component type of glTF, or 0 without one.
int component_type(draco::DataType type) {
  constexpr int kTypes[] = {0, 5120, 5121, 5122, 5123, 0, 5125, 0, 0, 5126};  // from DT_INVALID on
  return static_cast<size_t>(type) < std::size(kTypes) ? kTypes[type] : 0;
}

// Adds a buffer, a view of it and an accessor, and returns the accessor.
int add_accessor(tinygltf::Model& model, std::vector<uint8_t> data, tinygltf::Accessor accessor) {
  tinygltf::BufferView view;
  view.buffer = static_cast<int>(model.buffers.size());
  view.byteLength = data.size();
  model.buffers.emplace_back().data = std::move(data);
  accessor.bufferView = static_cast<int>(model.bufferViews.size());
  model.bufferViews.push_back(std::move(view));
  model.accessors.push_back(std::move(accessor));
  return static_cast<int>(model.accessors.size()) - 1;
}

int add_indices(tinygltf::Model& model, const draco::Mesh& mesh) {
  tinygltf::Accessor accessor;
  accessor.componentType = TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  accessor.type = TINYGLTF_TYPE_SCALAR;
  accessor.count = 3 * size_t{mesh.num_faces()};
  std::vector<uint8_t> data(4 * accessor.count);
  for (uint32_t f = 0; f < mesh.num_faces(); ++f) {
    for (uint32_t c = 0; c < 3; ++c) {
      const uint32_t point = mesh.face(draco::FaceIndex(f))[c].value();
      std::memcpy(&data[4 * (3 * size_t{f} + c)], &point, 4);
    }
  }
  return add_accessor(model, std::move(data), std::move(accessor));
}

// `stated` is the attribute's accessor in the file.
Result<int> add_attribute(tinygltf::Model& model, const draco::Mesh& mesh, int id, size_t stated) {
  const auto* attribute = mesh.GetAttributeByUniqueId(static_cast<uint32_t>(id));
  if (attribute == nullptr) return Failure("is missing");
  const int components = attribute->num_components(), type = component_type(attribute->data_type());
  if (type == 0 || components > 4) return Failure("has a type that is not read here");
  tinygltf::Accessor accessor;
  accessor.componentType = type;
  accessor.type = components == 1 ? TINYGLTF_TYPE_SCALAR : components;  // TINYGLTF_TYPE_VEC2 is 2
  accessor.count = mesh.num_points();
  accessor.normalized = stated < model.accessors.size() && model.accessors[stated].normalized;
  const auto stride = static_cast<size_t>(attribute->byte_stride());
  std::vector<uint8_t> data(stride * accessor.count);
  for (uint32_t point = 0; point < accessor.count; ++point) {
    const auto value = attribute->mapped_index(draco::PointIndex(point));
    if (value.value() >= attribute->size()) return Failure("has a point without a value");
    attribute->GetValue(value, &data[stride * point]);
  }
  return add_accessor(model, std::move(data), std::move(accessor));
}

Result<void> decompress(tinygltf::Model& model, const tinygltf::Value& extension, Budget& budget,
                        tinygltf::Primitive& primitive) {
  const int view = extension.Get("bufferView").GetNumberAsInt();
  ALCOVE_TRY(const auto bytes, view_bytes(model, view));
  draco::Mesh mesh;
  if (!decode(bytes, budget, mesh)) {
    return Failure("buffer view " + std::to_string(view) +
                   " is no Draco mesh of version 2.2, or is damaged or too large");
  }
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.indices = add_indices(model, mesh);
  uint64_t size = model.buffers.back().data.size();
  const tinygltf::Value& attributes = extension.Get("attributes");
  for (const std::string& name : attributes.Keys()) {
    const auto stated = static_cast<size_t>(attribute(primitive.attributes, name));
    ALCOVE_TRY(primitive.attributes[name],
               add_attribute(model, mesh, attributes.Get(name).GetNumberAsInt(), stated)
                   .map_error(with_prefix("buffer view " + std::to_string(view) +
                                          " is a Draco mesh whose " + name + " ")));
    size += model.buffers.back().data.size();
  }
  budget.faces -= mesh.num_faces();
  budget.bytes -= std::min(budget.bytes, size);
  return {};
}

bool has_data(const tinygltf::Model& model, int accessor) {
  const auto index = static_cast<size_t>(accessor);
  return index < model.accessors.size() && model.accessors[index].bufferView >= 0;
}

}  // namespace

Result<void> decompress_primitives(tinygltf::Model& model, std::vector<std::string>& notes) {
  Budget budget;
  for (tinygltf::Mesh& mesh : model.meshes) {
    for (tinygltf::Primitive& primitive : mesh.primitives) {
      const auto found = primitive.extensions.find("KHR_draco_mesh_compression");
      if (found == primitive.extensions.end()) continue;
      tinygltf::Primitive decompressed = primitive;
      if (auto done = decompress(model, found->second, budget, decompressed); done) {
        primitive = std::move(decompressed);
      } else if (has_data(model, attribute(primitive.attributes, "POSITION")) &&
                 (primitive.indices < 0 || has_data(model, primitive.indices))) {
        notes.push_back("Compressed meshes that cannot be read are replaced by their fallback.");
      } else {
        return done;
      }
    }
  }
  return {};
}

}  // namespace alcove::sample
