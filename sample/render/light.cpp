#include "render/light.h"

#include <array>
#include <glm/gtc/packing.hpp>

#include "render/shaders/light.h"
#include "spirv/light.h"

namespace alcove::sample {
namespace {

constexpr VkFormat kFormat = VK_FORMAT_R16G16B16A16_SFLOAT;

// Returns the matrix from (ndc x, ndc y, 1) to the direction of the pixel's view ray.
glm::mat3 world_from_ndc(const GbufferView& view) {
  const glm::mat3 world_from_view = glm::transpose(glm::mat3(view.view_from_world));
  const glm::mat4& p = view.clip_from_view;
  if (p[2][3] == 0.0f) return {glm::vec3(0.0f), glm::vec3(0.0f), -world_from_view[2]};
  return world_from_view * glm::mat3(1.0f / p[0][0], 0.0f, 0.0f,  //
                                     0.0f, 1.0f / p[1][1], 0.0f,  //
                                     p[2][0] / p[0][0], p[2][1] / p[1][1], -1.0f);
}

}  // namespace

Result<std::unique_ptr<Light>> Light::create(Gpu& gpu, const EnvironmentImage& environment) {
  std::unique_ptr<Light> made(new Light);
  std::vector<std::uint64_t> halves;
  for (const glm::vec3& radiance : environment.pixels)
    halves.push_back(glm::packHalf4x16(glm::vec4(radiance, 1.0f)));
  ALCOVE_TRY(made->environment_, upload_image(gpu, kFormat, {environment.width, environment.height},
                                              std::as_bytes(std::span(halves))));
  ALCOVE_TRY(made->pass_, FullScreenPass::create(gpu, {"light",
                                                       kLight,
                                                       maths::kLightImages,
                                                       sizeof(maths::LightParameters),
                                                       {kFormat, kFormat, kFormat}}));
  return made;
}

Lit Light::add(Graph& graph, Texture environment, const GbufferView& view, const Surfaces& surfaces,
               Texture normals, const LightOcclusion& occlusion) const {
  const Gbuffer& gbuffer = surfaces.gbuffer;
  const Texture images[maths::kLightImages] = {
      environment,           gbuffer.depth,     normals,
      gbuffer.albedo,        gbuffer.emissive,  occlusion.visibility,
      occlusion.bent_normal, occlusion.specular};
  std::array<Texture, 3> lit;
  for (Texture& target : lit)
    target = graph.create_texture("light", {kFormat, extent_of(graph, gbuffer.depth)});
  const glm::mat3 world_from_normal = surfaces.normals == NormalSource::depth
                                          ? glm::transpose(glm::mat3(view.view_from_world))
                                          : glm::mat3(1.0f);
  pass_->add(
      graph, images, lit,
      maths::LightParameters{glm::mat3x4(world_from_ndc(view)), glm::mat3x4(world_from_normal),
                             view.reversed_z ? 0.0f : 1.0f, surfaces.roughness.value_or(-1.0f),
                             (occlusion.visibility ? maths::kUsesVisibility : 0) |
                                 (occlusion.bent_normal ? maths::kUsesBentNormal : 0) |
                                 (occlusion.specular ? maths::kUsesSpecular : 0) |
                                 (occlusion.multi_bounce ? maths::kUsesMultiBounce : 0)});
  return {lit[0], lit[1], lit[2]};
}

}  // namespace alcove::sample
