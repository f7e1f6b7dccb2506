#include "reference/ray_scene.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "scene/area.h"

namespace alcove::sample {
namespace {

constexpr uint32_t kPacket = 16;

// Base colour's alpha where a triangle of a masked mesh is hit.
float alpha_at(const Scene& scene, const Mesh& mesh, uint32_t triangle, float u, float v) {
  const Material& material = scene.materials[mesh.material];
  const MeshUvs uvs = uvs_within(mesh, triangle, u, v);
  return material.base_color.a * sample_texture(scene, material.base_color_texture, uvs).a;
}

// Rays go through texels whose alpha is below the cutoff.
void pass_cut_out(const RTCFilterFunctionNArguments* args) {
  const auto& scene = *static_cast<const Scene*>(args->geometryUserPtr);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const unsigned geometry = RTCHitN_geomID(args->hit, args->N, i);
    const Mesh& mesh = scene.meshes[geometry];
    const float alpha =
        alpha_at(scene, mesh, RTCHitN_primID(args->hit, args->N, i),
                 RTCHitN_u(args->hit, args->N, i), RTCHitN_v(args->hit, args->N, i));
    if (alpha < scene.materials[mesh.material].alpha_cutoff) args->valid[i] = 0;
  }
}

// Embree reads 16 bytes at the last vertex of a buffer, so vertices are copied rather than shared.
bool attach(RTCDevice device, RTCScene tree, const Scene& scene, unsigned id) {
  const Mesh& mesh = scene.meshes[id];
  if (mesh.indices.empty()) return true;
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                           sizeof(glm::vec3), mesh.positions_ws.size());
  void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                          3 * sizeof(uint32_t), mesh.indices.size() / 3);
  const bool room = vertices && indices;
  if (room) {
    std::memcpy(vertices, mesh.positions_ws.data(), mesh.positions_ws.size() * sizeof(glm::vec3));
    std::memcpy(indices, mesh.indices.data(), mesh.indices.size() * sizeof(uint32_t));
    if (scene.materials[mesh.material].alpha_mode == AlphaMode::kMask) {
      rtcSetGeometryUserData(geometry, const_cast<Scene*>(&scene));
      rtcSetGeometryIntersectFilterFunction(geometry, pass_cut_out);
      rtcSetGeometryOccludedFilterFunction(geometry, pass_cut_out);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(tree, geometry, id);
  }
  rtcReleaseGeometry(geometry);
  return room;
}

// Beyond this, products of three lengths overflow in Embree, which then finds nothing.
constexpr float kFarthest = 1e12f;

bool is_too_large(const Bounds& bounds_ws) {
  const glm::vec3 reach = glm::max(glm::abs(bounds_ws.low), glm::abs(bounds_ws.high));
  return std::max({reach.x, reach.y, reach.z}) > kFarthest;
}

// Embree asserts that rays start within 2e18 and have a direction.
bool is_traceable(const glm::vec3& origin, const glm::vec3& direction) {
  constexpr float kFarthestStart = 1e18f;
  return std::abs(origin.x) < kFarthestStart && std::abs(origin.y) < kFarthestStart &&
         std::abs(origin.z) < kFarthestStart && std::isfinite(glm::dot(direction, direction));
}

glm::vec3 facing(const glm::vec3& n, const glm::vec3& direction) {
  return glm::dot(n, direction) > 0.0f ? -n : n;
}

}  // namespace

RayScene::RayScene() : impl_(std::make_unique<Impl>()) {}
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;
RayScene::~RayScene() = default;

RayScene::Impl::~Impl() {
  if (tree) rtcReleaseScene(tree);
  if (device) rtcReleaseDevice(device);
}

tl::expected<RayScene, std::string> RayScene::create(const Scene& scene) {
  if (is_too_large(scene.bounds_ws)) {
    return tl::unexpected("the scene " + scene.name +
                          " reaches further than 1e12 from its origin, too far for rays to be "
                          "traced: scale it down");
  }
  RayScene out;
  Impl& impl = *out.impl_;
  impl.scene = &scene;
  impl.device = rtcNewDevice(nullptr);
  if (!impl.device) return tl::unexpected<std::string>("Embree, the ray tracer, cannot start");
  impl.tree = rtcNewScene(impl.device);
  rtcSetSceneFlags(impl.tree, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(impl.tree, RTC_BUILD_QUALITY_HIGH);
  bool room = true;
  for (unsigned id = 0; room && id < scene.meshes.size(); ++id) {
    room = attach(impl.device, impl.tree, scene, id);
  }
  if (room) rtcCommitScene(impl.tree);
  if (!room || rtcGetDeviceError(impl.device) != RTC_ERROR_NONE) {
    return tl::unexpected<std::string>("Embree, the ray tracer, has no memory for the scene " +
                                       scene.name);
  }
  return out;
}

std::optional<Hit> RayScene::Impl::nearest(const glm::vec3& origin, const glm::vec3& direction,
                                           float far) const {
  if (!is_traceable(origin, direction)) return std::nullopt;
  RTCRayHit query{};
  query.ray = {origin.x,    origin.y, origin.z, 0.0f,        direction.x, direction.y,
               direction.z, 0.0f,     far,      0xffffffffu, 0,           0};
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(tree, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const Mesh& mesh = scene->meshes[query.hit.geomID];
  const uint32_t* i = &mesh.indices[size_t{3} * query.hit.primID];
  const float u = query.hit.u, v = query.hit.v, w = 1.0f - u - v;
  Hit hit;
  hit.distance = query.ray.tfar;
  hit.material = mesh.material;
  const glm::dvec3 area = area_of(mesh, size_t{3} * query.hit.primID);
  const double twice_the_area = glm::length(area);
  if (!(twice_the_area > 0.0) || !std::isfinite(hit.distance)) return std::nullopt;
  const glm::vec3 normal(area / twice_the_area);
  hit.geometric_normal_ws = facing(normal, direction);
  const glm::vec3 smooth =
      w * mesh.normals_ws[i[0]] + u * mesh.normals_ws[i[1]] + v * mesh.normals_ws[i[2]];
  const float length = glm::length(smooth);
  // A back face turns its vertices' normals with it, whatever side of the ray they are on.
  const float side = glm::dot(normal, direction) > 0.0f ? -1.0f : 1.0f;
  hit.shading_normal_ws = length > 1e-6f ? side * smooth / length : hit.geometric_normal_ws;
  hit.uvs = uvs_within(mesh, query.hit.primID, u, v);
  return hit;
}

uint32_t RayScene::Impl::blocked(const glm::vec3& origin, std::span<const glm::vec3> directions,
                                 float far) const {
  alignas(64) RTCRay16 rays;
  alignas(64) int valid[kPacket];
  for (uint32_t i = 0; i < kPacket; ++i) {
    const glm::vec3& d = directions[std::min<size_t>(i, directions.size() - 1)];
    valid[i] = i < directions.size() && is_traceable(origin, d) ? -1 : 0;
    rays.org_x[i] = origin.x;
    rays.org_y[i] = origin.y;
    rays.org_z[i] = origin.z;
    rays.dir_x[i] = d.x;
    rays.dir_y[i] = d.y;
    rays.dir_z[i] = d.z;
    rays.tnear[i] = 0.0f;
    rays.tfar[i] = far;
    rays.time[i] = 0.0f;
    rays.mask[i] = 0xffffffffu;
    rays.id[i] = i;
    rays.flags[i] = 0;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded16(valid, tree, &context, &rays);
  uint32_t bits = 0;
  for (uint32_t i = 0; i < directions.size(); ++i) {
    if (rays.tfar[i] < 0.0f) bits |= 1u << i;
  }
  return bits;
}

glm::vec3 RayScene::Impl::off_surface(const glm::vec3& position_ws,
                                      const glm::vec3& normal_ws) const {
  const Bounds& bounds = scene->bounds_ws;
  const glm::vec3 reach =
      glm::max(glm::max(glm::abs(bounds.low), glm::abs(bounds.high)), glm::abs(position_ws));
  return position_ws + normal_ws * (std::max({reach.x, reach.y, reach.z}) * 0x1p-20f);
}

glm::vec3 albedo_at(const Scene& scene, const Hit& hit) {
  const Material& material = scene.materials[hit.material];
  glm::vec3 out(material.base_color);
  if (material.base_color_texture.image < 0) return out;
  const glm::vec4 texel = sample_texture(scene, material.base_color_texture, hit.uvs);
  for (int c = 0; c < 3; ++c) out[c] *= srgb_to_linear(texel[c]);
  return out;
}

}  // namespace alcove::sample
