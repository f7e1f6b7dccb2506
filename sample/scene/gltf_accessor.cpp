#include "scene/gltf_accessor.h"

#include <algorithm>
#include <cstring>

namespace alcove::sample {
namespace {

// Elements of one type in memory, `stride` bytes apart, all of them within their buffer view.
struct Elements {
  const uint8_t* first = nullptr;  // null if there is no buffer view: all elements are zero
  uint64_t stride = 0;
  uint64_t count = 0;
  int component_type = 0;
  int components = 0;
  bool normalized = false;
};

uint64_t component_size(int type) {
  const int size = tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(type));
  return size > 0 ? static_cast<uint64_t>(size) : 0;
}

// Matrices of 2 or 3 columns are not read, because no property that is read has them.
int component_count(int type) {
  if (type == TINYGLTF_TYPE_MAT2 || type == TINYGLTF_TYPE_MAT3) return 0;
  return std::max(tinygltf::GetNumComponentsInType(static_cast<uint32_t>(type)), 0);
}

template <class T>
T load(const uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return value;
}

template <class T>
float scaled(const uint8_t* at, bool normalized, float most) {
  const auto value = static_cast<float>(load<T>(at));
  return normalized ? std::max(value / most, -1.0f) : value;
}

float float_component(const uint8_t* at, int type, bool normalized) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return scaled<int8_t>(at, normalized, 127.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return scaled<uint8_t>(at, normalized, 255.0f);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return scaled<int16_t>(at, normalized, 32767.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return scaled<uint16_t>(at, normalized, 65535.0f);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return scaled<uint32_t>(at, normalized, 4294967295.0f);
    default:
      return load<float>(at);
  }
}

uint32_t unsigned_component(const uint8_t* at, int type) {
  if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return *at;
  if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) return load<uint16_t>(at);
  return load<uint32_t>(at);
}

bool is_unsigned(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

// Returns the address of `count` elements of `size` bytes, `stride` bytes apart, which begin at
// `offset` in a buffer view.
Result<const uint8_t*> find_elements(const tinygltf::Model& model, int64_t view, uint64_t offset,
                                     uint64_t count, uint64_t size, uint64_t stride) {
  ALCOVE_TRY(const auto bytes, view_bytes(model, view));
  const uint64_t length = bytes.size();
  // The last element must end within the view. The comparisons are written so that no term can
  // overflow.
  if (count > 0 && (offset > length || size > length - offset ||
                    (count - 1) > (length - offset - size) / stride))
    return Failure("reads past the end of buffer view " + std::to_string(view));
  return bytes.data() + std::min(offset, length);
}

Result<Elements> resolve(const tinygltf::Model& model, const tinygltf::Accessor& accessor) {
  Elements out;
  out.count = accessor.count;
  out.component_type = accessor.componentType;
  out.components = component_count(accessor.type);
  out.normalized = accessor.normalized;
  const uint64_t component = component_size(accessor.componentType);
  const bool padded =
      out.components == 16 && accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT;
  if (component == 0 || out.components == 0 || padded)
    return Failure("has a type that is not read here");
  const uint64_t size = component * static_cast<uint64_t>(out.components);
  out.stride = size;
  if (accessor.bufferView < 0) return out;
  if (static_cast<size_t>(accessor.bufferView) >= model.bufferViews.size())
    return Failure("has no buffer view " + std::to_string(accessor.bufferView));
  const size_t stride = model.bufferViews[static_cast<size_t>(accessor.bufferView)].byteStride;
  if (stride != 0) out.stride = stride;
  if (out.stride < size) return Failure("has a stride that is less than its element");
  ALCOVE_TRY(out.first, find_elements(model, accessor.bufferView, accessor.byteOffset, out.count,
                                      size, out.stride));
  return out;
}

// Reads elements of an accessor: all if `only` is null, otherwise those of its ascending indices.
// `convert` returns the value of a component at an address. Sparse values replace those of the
// buffer view.
template <class Convert>
auto read_elements(const tinygltf::Model& model, const tinygltf::Accessor& accessor,
                   const Elements& elements, const std::vector<uint32_t>* only,
                   const Convert& convert)
    -> Result<std::vector<decltype(convert(elements.first))>> {
  const auto width = static_cast<size_t>(elements.components);
  const uint64_t step = component_size(elements.component_type);
  std::vector<decltype(convert(elements.first))> values(width *
                                                        (only ? only->size() : elements.count));
  const auto put = [&](uint64_t i, const uint8_t* at) {
    for (size_t c = 0; c < width; ++c) values[i * width + c] = convert(at + c * step);
  };
  for (uint64_t i = 0; elements.first && i < values.size() / width; ++i)
    put(i, elements.first + (only ? (*only)[i] : i) * elements.stride);
  const auto& sparse = accessor.sparse;
  if (!sparse.isSparse) return values;
  const auto count = static_cast<uint64_t>(sparse.count);
  if (count > elements.count) return Failure("has more sparse values than elements");
  if (!is_unsigned(sparse.indices.componentType))
    return Failure("has sparse indices that are not unsigned integers");
  const uint64_t index_size = component_size(sparse.indices.componentType);
  ALCOVE_TRY(const uint8_t* indices, find_elements(model, sparse.indices.bufferView,
                                                   static_cast<uint64_t>(sparse.indices.byteOffset),
                                                   count, index_size, index_size));
  ALCOVE_TRY(const uint8_t* replacements,
             find_elements(model, sparse.values.bufferView,
                           static_cast<uint64_t>(sparse.values.byteOffset), count, width * step,
                           width * step));
  for (uint64_t i = 0; i < count; ++i) {
    uint64_t target = unsigned_component(indices + i * index_size, sparse.indices.componentType);
    if (target >= elements.count) return Failure("has a sparse index out of range");
    if (only) {
      const auto found = std::ranges::lower_bound(*only, target);
      if (found == only->end() || *found != target) continue;
      target = static_cast<uint64_t>(found - only->begin());
    }
    put(target, replacements + i * width * step);
  }
  return values;
}

// Calls `read(accessor)`, and puts the accessor's name before an error.
template <class Read>
auto with_accessor(const tinygltf::Model& model, int64_t index, const Read& read)
    -> decltype(read(model.accessors[0])) {
  const std::string name = "accessor " + std::to_string(index) + " ";
  if (index < 0 || static_cast<uint64_t>(index) >= model.accessors.size())
    return Failure(name + "does not exist");
  return read(model.accessors[static_cast<size_t>(index)]).map_error(with_prefix(name));
}

}  // namespace

Result<std::span<const uint8_t>> view_bytes(const tinygltf::Model& model,
                                            const tinygltf::BufferView& v) {
  if (v.buffer < 0 || static_cast<size_t>(v.buffer) >= model.buffers.size())
    return Failure("has no buffer " + std::to_string(v.buffer));
  const auto& data = model.buffers[static_cast<size_t>(v.buffer)].data;
  if (data.empty() && v.byteLength > 0)
    return Failure("lies in buffer " + std::to_string(v.buffer) + ", which has no data");
  if (v.byteOffset > data.size() || v.byteLength > data.size() - v.byteOffset)
    return Failure("reaches past the end of its buffer");
  return std::span<const uint8_t>(data.data() + v.byteOffset, v.byteLength);
}

Result<std::span<const uint8_t>> view_bytes(const tinygltf::Model& model, int64_t view) {
  const std::string name = "buffer view " + std::to_string(view) + " ";
  if (view < 0 || static_cast<uint64_t>(view) >= model.bufferViews.size())
    return Failure(name + "does not exist");
  return view_bytes(model, model.bufferViews[static_cast<size_t>(view)])
      .map_error([&](const std::string& why) { return name + why; });
}

int attribute(const std::map<std::string, int>& attributes, const std::string& name) {
  const auto found = attributes.find(name);
  return found == attributes.end() ? -1 : found->second;
}

Result<std::vector<float>> read_floats(const tinygltf::Model& model, int64_t index, int components,
                                       uint64_t most, const std::vector<uint32_t>* only) {
  using Floats = Result<std::vector<float>>;
  return with_accessor(model, index, [&](const tinygltf::Accessor& accessor) -> Floats {
    ALCOVE_TRY(const Elements elements, resolve(model, accessor));
    if (elements.components != components) {
      return Failure("has " + std::to_string(elements.components) + " components where " +
                     std::to_string(components) + " belong");
    }
    if (!only && elements.count > most)
      return Failure("has too many elements: " + std::to_string(elements.count));
    if (only && !only->empty() && only->back() >= elements.count) {
      return Failure("has " + std::to_string(elements.count) + " elements, and element " +
                     std::to_string(only->back()) + " is used");
    }
    return read_elements(model, accessor, elements, only, [&](const uint8_t* at) {
      return float_component(at, elements.component_type, elements.normalized);
    });
  });
}

Result<std::vector<uint32_t>> read_indices(const tinygltf::Model& model, int64_t index,
                                           uint64_t bound, uint64_t most) {
  using Indices = Result<std::vector<uint32_t>>;
  return with_accessor(model, index, [&](const tinygltf::Accessor& accessor) -> Indices {
    ALCOVE_TRY(const Elements elements, resolve(model, accessor));
    if (elements.count > most)
      return Failure("has too many elements: " + std::to_string(elements.count));
    if (elements.components != 1 || !is_unsigned(elements.component_type))
      return Failure("is used for indices and does not hold unsigned integers");
    auto values = read_elements(model, accessor, elements, nullptr, [&](const uint8_t* at) {
      return unsigned_component(at, elements.component_type);
    });
    if (!values) return values;
    const auto past = std::ranges::find_if(*values, [&](uint32_t v) { return v >= bound; });
    if (past == values->end()) return values;
    return Failure("has the index " + std::to_string(*past) + ", past the last vertex");
  });
}

}  // namespace alcove::sample
