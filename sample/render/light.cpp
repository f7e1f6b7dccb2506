#include "render/light.h"

#include <algorithm>
#include <array>
#include <bit>
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
  const std::uint32_t width = environment.width, height = environment.height;
  ALCOVE_TRY(made->environment_,
             GpuImage::create(gpu.device(),
                              {kFormat, framegraph::Extent::absolute(width, height),
                               static_cast<std::uint32_t>(std::bit_width(std::max(width, height)))},
                              VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                  VK_IMAGE_USAGE_TRANSFER_DST_BIT));
  ALCOVE_TRY(const auto texels, HostBuffer::create(gpu.device(), environment.pixels.size() * 8,
                                                   VK_BUFFER_USAGE_TRANSFER_SRC_BIT));
  auto* const halves = reinterpret_cast<std::uint64_t*>(texels->bytes().data());
  std::ranges::transform(environment.pixels, halves, [](const glm::vec3& radiance) {
    return glm::packHalf4x16(glm::vec4(radiance, 1.0f));
  });
  ALCOVE_TRY_VOID(gpu.run([&](Graph& graph) -> Result<void> {
    const GpuImage& image = *made->environment_;
    const Texture target = graph.import_texture("environment", image.import_to_fill(kSampledState));
    (void)add_mips(graph, add_copy(graph, *texels, target), image.mips());
    return {};
  }));
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
  const VkExtent3D size = graph.extent(gbuffer.depth);
  for (Texture& target : lit)
    target = graph.create_texture("light", {kFormat, {size.width, size.height}});
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
