#include "scene/ray_scene.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace alcove::sample {
namespace {

constexpr uint32_t kPacket = 16;

// User data of Embree's filter functions.
struct FilteredMesh {
  const Scene* scene;
  const Mesh* mesh;
};

// The mesh and the instance of a geometry of the tree.
struct Attached {
  uint32_t mesh;
  uint32_t instance;
};

#if RTC_VERSION_MAJOR >= 4
using EmbreeContext = RTCRayQueryContext;
void initialise(EmbreeContext& context) { rtcInitRayQueryContext(&context); }
void intersect(RTCScene tree, EmbreeContext& context, RTCRayHit& query) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  rtcIntersect1(tree, &query, &arguments);
}
void occluded(const int* valid, RTCScene tree, EmbreeContext& context, RTCRay16& rays) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  rtcOccluded16(valid, tree, &rays, &arguments);
}
#else
using EmbreeContext = RTCIntersectContext;
void initialise(EmbreeContext& context) { rtcInitIntersectContext(&context); }
void intersect(RTCScene tree, EmbreeContext& context, RTCRayHit& query) {
  rtcIntersect1(tree, &context, &query);
}
void occluded(const int* valid, RTCScene tree, EmbreeContext& context, RTCRay16& rays) {
  rtcOccluded16(valid, tree, &context, &rays);
}
#endif

struct Context : EmbreeContext {
  explicit Context(bool hits_both_sides = false) : both_sides(hits_both_sides) {
    initialise(*this);
  }
  bool both_sides;
};

// Alpha of the base colour at a point of a triangle.
float alpha_at(const Scene& scene, const Mesh& mesh, uint32_t triangle, float u, float v) {
  const Material& material = scene.materials[mesh.material];
  const MeshUvs uvs = uvs_within(mesh, triangle, u, v);
  return material.base_color.a * color_within(mesh, triangle, u, v).a *
         sample_texture(scene, material.base_color_texture, uvs).a;
}

// Rejects hits that the rasteriser does not draw: back faces of single-sided materials, and points
// whose alpha is below the cutoff of a mask.
void reject_invisible(const RTCFilterFunctionNArguments* args) {
  const auto& [scene, mesh] = *static_cast<const FilteredMesh*>(args->geometryUserPtr);
  const Material& material = scene->materials[mesh->material];
  const bool culls =
      !material.double_sided && !static_cast<const Context*>(args->context)->both_sides;
  const unsigned count = args->N;
  for (unsigned i = 0; i < count; ++i) {
    if (args->valid[i] == 0) continue;
    // Ray and normal are in mesh space, where the sign of their product is that of world space.
    const float along = RTCRayN_dir_x(args->ray, count, i) * RTCHitN_Ng_x(args->hit, count, i) +
                        RTCRayN_dir_y(args->ray, count, i) * RTCHitN_Ng_y(args->hit, count, i) +
                        RTCRayN_dir_z(args->ray, count, i) * RTCHitN_Ng_z(args->hit, count, i);
    if (culls && along > 0.0f) {
      args->valid[i] = 0;
    } else if (material.alpha_mode == AlphaMode::mask) {
      const float alpha = alpha_at(*scene, *mesh, RTCHitN_primID(args->hit, count, i),
                                   RTCHitN_u(args->hit, count, i), RTCHitN_v(args->hit, count, i));
      if (alpha < material.least_alpha()) args->valid[i] = 0;
    }
  }
}

bool needs_filter(const Material& material) {
  return !material.double_sided || material.alpha_mode == AlphaMode::mask;
}

// Returns the triangles of a mesh as a committed Embree geometry, or null if memory runs out. The
// caller must release it. Embree reads 16 bytes at the last vertex of a buffer, so the vertices are
// copied rather than shared.
RTCGeometry triangles_of(RTCDevice device, const Material& material, FilteredMesh& filtered) {
  const Mesh& mesh = *filtered.mesh;
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                           sizeof(glm::vec3), mesh.positions.size());
  void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                          3 * sizeof(uint32_t), mesh.indices.size() / 3);
  if (!vertices || !indices) {
    rtcReleaseGeometry(geometry);
    return nullptr;
  }
  std::memcpy(vertices, mesh.positions.data(), mesh.positions.size() * sizeof(glm::vec3));
  std::memcpy(indices, mesh.indices.data(), mesh.indices.size() * sizeof(uint32_t));
  if (needs_filter(material)) {
    rtcSetGeometryUserData(geometry, &filtered);
    rtcSetGeometryIntersectFilterFunction(geometry, reject_invisible);
    rtcSetGeometryOccludedFilterFunction(geometry, reject_invisible);
  }
  rtcCommitGeometry(geometry);
  return geometry;
}

RTCScene new_tree(RTCDevice device) {
  RTCScene tree = rtcNewScene(device);
  rtcSetSceneFlags(tree, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(tree, RTC_BUILD_QUALITY_HIGH);
  return tree;
}

// One geometry of `tree` for each instance of the mesh, all with the same triangles.
void attach_instances(RTCDevice device, RTCScene tree, RTCGeometry triangles, uint32_t mesh_index,
                      const Mesh& mesh, std::vector<Attached>& attached) {
  RTCScene shared = new_tree(device);
  rtcAttachGeometryByID(shared, triangles, 0);
  rtcCommitScene(shared);
  for (uint32_t i = 0; i < mesh.instances.size(); ++i) {
    RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, shared);
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &mesh.instances[i]);
    rtcCommitGeometry(instance);
    rtcAttachGeometryByID(tree, instance, static_cast<unsigned>(attached.size()));
    rtcReleaseGeometry(instance);
    attached.push_back({mesh_index, i});
  }
  rtcReleaseScene(shared);
}

// Products of three larger lengths overflow in Embree, which then finds no hits.
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

}  // namespace

struct RayScene::Impl {
  const Scene* scene = nullptr;
  RTCDevice device = nullptr;
  RTCScene tree = nullptr;
  std::vector<Attached> attached;  // by geometry index
  std::vector<FilteredMesh> filtered;

  ~Impl() {
    if (tree) rtcReleaseScene(tree);
    if (device) rtcReleaseDevice(device);
  }
};

RayScene::RayScene() : impl_(std::make_unique<Impl>()) {}
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;
RayScene::~RayScene() = default;

const Scene& RayScene::scene() const { return *impl_->scene; }

Result<RayScene> RayScene::create(const Scene& scene) {
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
  impl.tree = new_tree(impl.device);
  impl.filtered.reserve(scene.meshes.size());  // Embree keeps their addresses
  bool room = true;
  for (uint32_t m = 0; room && m < scene.meshes.size(); ++m) {
    const Mesh& mesh = scene.meshes[m];
    if (mesh.indices.empty()) continue;
    impl.filtered.push_back({&scene, &mesh});
    RTCGeometry triangles =
        triangles_of(impl.device, scene.materials[mesh.material], impl.filtered.back());
    room = triangles != nullptr;
    if (!room) break;
    if (mesh.instances.empty()) {
      rtcAttachGeometryByID(impl.tree, triangles, static_cast<unsigned>(impl.attached.size()));
      impl.attached.push_back({m, 0});
    } else {
      attach_instances(impl.device, impl.tree, triangles, m, mesh, impl.attached);
    }
    rtcReleaseGeometry(triangles);
  }
  if (room) rtcCommitScene(impl.tree);
  if (!room || rtcGetDeviceError(impl.device) != RTC_ERROR_NONE) {
    return tl::unexpected<std::string>("Embree, the ray tracer, has no memory for the scene " +
                                       scene.name);
  }
  return out;
}

std::optional<Hit> RayScene::nearest(const glm::vec3& origin, const glm::vec3& direction, float far,
                                     bool both_sides) const {
  if (!is_traceable(origin, direction)) return std::nullopt;
  RTCRayHit query{};
  query.ray = {origin.x,    origin.y, origin.z, 0.0f,        direction.x, direction.y,
               direction.z, 0.0f,     far,      0xffffffffu, 0,           0};
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  Context context(both_sides);
  intersect(impl_->tree, context, query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const bool instanced = query.hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
  const Attached& hit_geometry =
      impl_->attached[instanced ? query.hit.instID[0] : query.hit.geomID];
  const Mesh& mesh = scene().meshes[hit_geometry.mesh];
  const uint32_t* i = &mesh.indices[size_t{3} * query.hit.primID];
  const float u = query.hit.u, v = query.hit.v, w = 1.0f - u - v;
  Hit hit;
  hit.distance = query.ray.tfar;
  hit.mesh = hit_geometry.mesh;
  hit.material = mesh.material;
  hit.color = color_within(mesh, query.hit.primID, u, v);
  const glm::dmat3 placed = cofactor(glm::mat3(world_from_mesh(mesh, hit_geometry.instance)));
  const glm::dvec3 area = placed * area_of(mesh, size_t{3} * query.hit.primID);
  const double length_of_area = glm::length(area);
  if (!(length_of_area > 0.0) || !std::isfinite(hit.distance)) return std::nullopt;
  const glm::vec3 normal(area / length_of_area);
  hit.front = !(glm::dot(normal, direction) > 0.0f);
  hit.geometric_normal_ws = hit.front ? normal : -normal;
  hit.shading_normal_ws = hit.geometric_normal_ws;
  if (!mesh.normals.empty()) {
    const glm::vec3 smooth =
        w * mesh.normals[i[0]] + u * mesh.normals[i[1]] + v * mesh.normals[i[2]];
    const glm::vec3 smooth_ws(direction_of(placed * glm::dvec3(smooth)));
    // The vertex normal is flipped on a back face, as the triangle's normal is, even if the vertex
    // normal faces the ray already.
    if (glm::length(smooth) > 1e-6f && smooth_ws != glm::vec3(0.0f))
      hit.shading_normal_ws = hit.front ? smooth_ws : -smooth_ws;
  }
  hit.uvs = uvs_within(mesh, query.hit.primID, u, v);
  return hit;
}

uint32_t RayScene::blocked(const glm::vec3& origin, std::span<const glm::vec3> directions,
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
  Context context;
  occluded(valid, impl_->tree, context, rays);
  uint32_t bits = 0;
  for (uint32_t i = 0; i < directions.size(); ++i)
    if (rays.tfar[i] < 0.0f) bits |= 1u << i;
  return bits;
}

glm::vec3 RayScene::off_surface(const glm::vec3& position_ws, const glm::vec3& normal_ws) const {
  const Bounds& bounds = scene().bounds_ws;
  const glm::vec3 reach =
      glm::max(glm::max(glm::abs(bounds.low), glm::abs(bounds.high)), glm::abs(position_ws));
  return position_ws + normal_ws * (std::max({reach.x, reach.y, reach.z}) * 0x1p-20f);
}

glm::vec3 albedo_at(const Scene& scene, const Hit& hit) {
  const Material& material = scene.materials[hit.material];
  glm::vec3 out(material.base_color * hit.color);
  if (material.base_color_texture.image < 0) return out;
  const glm::vec4 texel = sample_texture(scene, material.base_color_texture, hit.uvs);
  for (int c = 0; c < 3; ++c) out[c] *= srgb_to_linear(texel[c]);
  return out;
}

}  // namespace alcove::sample
