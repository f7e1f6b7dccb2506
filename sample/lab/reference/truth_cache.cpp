#include "reference/truth_cache.h"

#include <fmt/format.h>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <system_error>

#include "support/regular_file.h"
#include "support/result.h"
#include "support/whole_file.h"

namespace alcove::sample {
namespace {

// The header of an entry of the cache, which comes before its floats. If the header of a file
// differs from this one, the file is of another version or damaged.
struct Header {
  std::array<char, 8> magic{'a', 'l', 'c', 'o', 'v', 'e', 't', '2'};
  uint64_t count = 0;
  uint64_t checksum = 0;
};

// Returns a checksum that detects damaged files. It is not secure against forgery.
uint64_t checksum(std::span<const float> values) {
  return XXH3_64bits(values.data(), values.size_bytes());
}

template <class T>
void add_vector(CacheKey& key, const std::vector<T>& values) {
  key.add(static_cast<uint64_t>(values.size()));
  key.add(std::as_bytes(std::span(values)));
}

template <int size>
void add_components(CacheKey& key, const glm::vec<size, float>& vector) {
  for (int i = 0; i < size; ++i) key.add(vector[i]);
}

void add_use(CacheKey& key, const TextureUse& use) {
  key.add(use.image, static_cast<uint8_t>(use.sampler.wrap_u),
          static_cast<uint8_t>(use.sampler.wrap_v), static_cast<uint8_t>(use.sampler.magnify),
          use.uv_set);
  for (int column = 0; column < 3; ++column) add_components(key, use.texture_from_mesh_uv[column]);
}

void add_material(CacheKey& key, const Material& material) {
  add_components(key, material.base_color);
  add_use(key, material.base_color_texture);
  key.add(material.metallic, material.roughness);
  add_use(key, material.metal_roughness_texture);
  key.add(static_cast<uint8_t>(material.alpha_mode), material.alpha_cutoff,
          static_cast<uint8_t>(material.double_sided));
}

std::filesystem::path from_environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::filesystem::path() : std::filesystem::path(value);
}

}  // namespace

void CacheKey::add(std::span<const std::byte> bytes) {
  const std::array chain{hash_, XXH3_128bits(bytes.data(), bytes.size())};
  hash_ = XXH3_128bits(chain.data(), sizeof(chain));
}

void CacheKey::add(std::string_view text) { add(std::as_bytes(std::span(text))); }

void CacheKey::add(const Scene& scene) {
  for (const Mesh& mesh : scene.meshes) {
    add(mesh.material);
    add_vector(*this, mesh.positions);
    add_vector(*this, mesh.normals);
    add_vector(*this, mesh.uvs);
    add_vector(*this, mesh.second_uvs);
    add_vector(*this, mesh.colors);
    add_vector(*this, mesh.indices);
    add_vector(*this, mesh.instances);
  }
  for (const Material& material : scene.materials) add_material(*this, material);
  for (const TextureImage& image : scene.images) {
    add(image.width, image.height);
    add_vector(*this, image.rgba);
  }
}

void CacheKey::add(const Camera& camera) {
  add_components(*this, camera.eye_ws);
  add_components(*this, camera.target_ws);
  add_components(*this, camera.up_ws);
  add(static_cast<uint8_t>(camera.orthographic), camera.fov_y, camera.ortho_height,
      camera.near_plane, camera.far_plane, static_cast<uint8_t>(camera.reversed_z));
  add_components(*this, camera.offset_ndc);
  add_components(*this, camera.jitter_px);
}

std::string CacheKey::hex() const {
  return fmt::format("{:016x}{:016x}", hash_.high64, hash_.low64);
}

std::filesystem::path TruthCache::default_folder() {
  if (const auto cache = from_environment("XDG_CACHE_HOME"); cache.is_absolute())
    return cache / "alcove";
  const auto home = from_environment("HOME");
  return home.empty() ? home : home / ".cache" / "alcove";
}

TruthCache::TruthCache(std::filesystem::path folder) : folder_(std::move(folder)) {
  if (!folder_.empty()) remove_abandoned(folder_);
}

std::optional<std::vector<float>> TruthCache::read(const CacheKey& key, size_t count) const {
  if (folder_.empty()) return std::nullopt;
  // Only regular files are entries: reading a named pipe could wait for ever.
  const auto file = open_regular_file(folder_ / (key.hex() + ".truth"));
  Header header;
  const Header expected;
  if (!file || std::fread(&header, sizeof(header), 1, file->get()) != 1 ||
      header.magic != expected.magic || header.count != count)
    return std::nullopt;
  std::vector<float> values(count);
  const bool whole = std::fread(values.data(), sizeof(float), count, file->get()) == count &&
                     std::getc(file->get()) == EOF;
  if (!whole || checksum(values) != header.checksum) return std::nullopt;
  return values;
}

void TruthCache::write(const CacheKey& key, std::span<const float> values) const {
  if (folder_.empty()) return;
  std::error_code ignored;
  std::filesystem::create_directories(folder_, ignored);
  Header header;
  header.count = values.size();
  header.checksum = checksum(values);
  const auto fill = [&](const std::filesystem::path& path) -> Result<void> {
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(&header), sizeof(header));
    file.write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(values.size_bytes()));
    file.close();
    if (!file) return tl::unexpected(std::string("the truth could not be cached"));
    return {};
  };
  (void)write_whole(folder_ / (key.hex() + ".truth"), fill);
}

}  // namespace alcove::sample
