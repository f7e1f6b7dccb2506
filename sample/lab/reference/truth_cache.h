#pragma once

#include <xxhash.h>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "scene/camera.h"
#include "scene/scene.h"
#include "support/image.h"

namespace alcove::sample {

// A 128-bit hash of everything that a reference image depends on. Add these parts in a fixed order.
// Keys are equal if all parts are equal.
class CacheKey {
 public:
  void add(std::span<const std::byte> bytes);
  void add(std::string_view text);
  void add(const Scene& scene);
  void add(const Camera& camera);
  template <class T>
  requires std::is_arithmetic_v<T>
  void add(T value) { add(std::as_bytes(std::span(&value, 1))); }
  template <class T>
  void add(const Image<T>& image) {
    add(image.width);
    add(image.height);
    add(std::as_bytes(std::span(image.pixels)));
  }
  template <class First, class Second, class... Rest>
  void add(const First& first, const Second& second, const Rest&... rest) {
    add(first);
    add(second);
    (add(rest), ...);
  }
  std::string hex() const;  // 32 digits

 private:
  XXH128_hash_t hash_{};
};

// A cache of arrays of floats on disk, which are found by key. read() finds no entry if the file is
// damaged, cut short or of another version; the caller then computes the array again. Several
// processes may share a folder. Failures to write are ignored, because callers never rely on an
// entry.
class TruthCache {
 public:
  // Returns `$XDG_CACHE_HOME/alcove`, or else `~/.cache/alcove`. If neither is known, returns an
  // empty path, with which nothing is cached.
  [[nodiscard]] static std::filesystem::path default_folder();
  explicit TruthCache(std::filesystem::path folder);

  // Reads an entry of exactly `count` floats.
  [[nodiscard]] std::optional<std::vector<float>> read(const CacheKey& key, size_t count) const;
  void write(const CacheKey& key, std::span<const float> values) const;

  // Reads or writes images, of which all but the first have keys derived from `key`.
  template <class... T>
  [[nodiscard]] bool read(const CacheKey& key, Image<T>&... images) const {
    std::uint32_t part = 0;
    const auto read_one = [&](auto& image) {
      const auto values = read(part_key(key, part++), as_floats(image).size());
      if (values) std::memcpy(image.pixels.data(), values->data(), values->size() * sizeof(float));
      return values.has_value();
    };
    return (read_one(images) && ...);
  }
  template <class... T>
  void write(const CacheKey& key, const Image<T>&... images) const {
    std::uint32_t part = 0;
    (write(part_key(key, part++), as_floats(images)), ...);
  }

 private:
  static CacheKey part_key(CacheKey key, std::uint32_t part) {
    if (part > 0) key.add(part);
    return key;
  }
  template <class T>
  static std::span<const float> as_floats(const Image<T>& image) {
    const auto bytes = std::as_bytes(std::span(image.pixels));
    static_assert(sizeof(T) % sizeof(float) == 0);
    return {reinterpret_cast<const float*>(bytes.data()), bytes.size() / sizeof(float)};
  }

  std::filesystem::path folder_;
};

}  // namespace alcove::sample
