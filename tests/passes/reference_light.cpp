#include "reference_light.h"

#include <cstring>
#include <vector>

#include "environment_lookup.h"
#include "maths/gtso.h"
#include "maths/make_projection.h"
#include "maths/multi_bounce.h"
#include "maths/packing.h"
#include "maths/split_sum.h"
#include "random_input.h"
#include "tables.h"

namespace alcove::passes {
namespace {

using glm::vec2;
using glm::vec3;

void append(HostImage& image, vec3 v, float w) {
  image.texels.insert(image.texels.end(), {v.x, v.y, v.z, w});
}

maths::mat4 to_mat4(const Matrix& matrix) {
  maths::mat4 result;
  std::memcpy(&result[0][0], matrix.data(), sizeof(result));
  return result;
}

vec3 irradiance(const HostImage& harmonics, vec3 direction) {
  vec3 sum(0);
  for (std::uint32_t i = 0; i < maths::kHarmonics; ++i)
    sum += rgb(harmonics, i, 0) * (maths::harmonic(i, direction) * maths::harmonic_irradiance(i));
  return max(sum, vec3(0));
}

vec2 reflectance(float n_dot_v, float roughness) {
  static const std::vector<std::uint32_t> table = reflectance_table();
  const vec2 at = maths::reflectance_coordinates(n_dot_v, roughness);
  const glm::uvec2 low = min(glm::uvec2(at), glm::uvec2(maths::kReflectanceTable - 2));
  const vec2 t = at - vec2(low);
  const auto entry = [&](unsigned x, unsigned y) {
    const std::uint32_t word = table[(low.y + y) * maths::kReflectanceTable + low.x + x];
    return vec2(maths::unpack_unorm(word, 16), maths::unpack_unorm(word >> 16, 16));
  };
  return mix(mix(entry(0, 0), entry(1, 0), t.x), mix(entry(0, 1), entry(1, 1), t.x), t.y);
}

}  // namespace

LitSurfaces random_surfaces() {
  maths_test::RandomInput random;
  const auto colour = [&](float most) {
    return vec3(random.uniform(0, most), random.uniform(0, most), random.uniform(0, most));
  };
  LitSurfaces surfaces;
  for (std::uint32_t i = 0; i < LitSurfaces::kWidth * LitSurfaces::kHeight; ++i) {
    const vec3 normal = random.facing(vec3(0, 0, 1));
    append(surfaces.normals, normal, 0.0f);
    append(surfaces.bent, random.facing(normal), 0.0f);
    append(surfaces.albedo, colour(1.0f), random.uniform(0.0f, 1.0f));
    append(surfaces.light, colour(9.0f), random.uniform(0.0f, 1.0f));
    surfaces.visibility.texels.push_back(random.uniform(0.0f, 1.0f));
    surfaces.specular_occlusion.texels.push_back(random.uniform(0.0f, 1.0f));
    surfaces.depth.texels.push_back(i % 7 == 6 ? LitSurfaces::kSky : random.uniform(1.0f, 9.0f));
  }
  for (std::uint32_t i = 0; i < maths::kHarmonics; ++i)
    append(surfaces.harmonics, i == 0 ? vec3(9, 8, 7) : colour(1.0f), 0.0f);
  for (std::uint32_t i = 0; i < LitSurfaces::kMapSize * LitSurfaces::kMapSize; ++i)
    append(surfaces.map, colour(4.0f), 0.0f);
  return surfaces;
}

void make_white(LitSurfaces& surfaces) {
  surfaces.harmonics.texels.assign(surfaces.harmonics.texels.size(), 0.0f);
  for (int c = 0; c < 3; ++c)
    surfaces.harmonics.texels[c] = 1.0f / maths::harmonic(0, vec3(0, 1, 0));
  surfaces.map.texels.assign(surfaces.map.texels.size(), 1.0f);
}

Light reference_light(const LitSurfaces& surfaces, const View& view, std::uint32_t x,
                      std::uint32_t y) {
  const float depth = surfaces.depth.at(x, y);
  if (depth == LitSurfaces::kSky) return {};
  const auto projection = maths::make_projection(to_mat4(view.clip_from_view), LitSurfaces::kWidth,
                                                 LitSurfaces::kHeight)
                              .value();
  const maths::mat3 world_from_view = transpose(maths::mat3(to_mat4(view.view_from_world)));
  const vec2 uv = maths::pixel_centre_uv(projection, {x, y});
  const vec3 towards = world_from_view *
                       maths::view_direction(projection, maths::position_vs(projection, uv, depth));
  const vec3 normal = normalize(world_from_view * rgb(surfaces.normals, x, y));
  const vec3 bent =
      maths::raised_bent_normal(normalize(world_from_view * rgb(surfaces.bent, x, y)), normal,
                                maths::converged_visibility(surfaces.visibility.at(x, y)));
  const vec3 base = rgb(surfaces.albedo, x, y);
  const float roughness = surfaces.albedo.at(x, y, 3);
  const float metallic = surfaces.light.at(x, y, 3);
  const vec3 reflected = maths::specular_reflectance(maths::normal_reflectance(base, metallic),
                                                     reflectance(dot(normal, towards), roughness));
  const vec3 visible = maths::multi_bounce(surfaces.visibility.at(x, y), base);
  const vec3 mirrored = look_up(
      surfaces.map,
      maths::dominant_direction(normal, maths::mirror_direction(normal, towards), roughness));
  const vec3 spread = visible * irradiance(surfaces.harmonics, bent);
  const float open = surfaces.specular_occlusion.at(x, y);
  return {maths::diffuse_albedo(base, metallic) * (1.0f - reflected) * spread,
          reflected * (mirrored * open + spread * base * (1.0f - open))};
}

}  // namespace alcove::passes
