#include "render/frame_read_back.h"

#include "render/read_back.h"

namespace alcove::sample {

namespace {

// Appends the textures with the lit surfaces of a frame.
void append_lit(const DeclaredFrame& declared, VkExtent2D size, std::vector<Wanted>& wanted) {
  const auto colours = [&](Texture texture, Image<glm::vec3> LitImages::*image) {
    if (texture) {
      wanted.push_back({texture, [=](const HostBuffer& buffer, FrameImages& images) {
                          images.lit.*image = to_image<glm::vec3, Half4>(buffer, size, from_half);
                        }});
    }
  };
  colours(declared.lit.lit, &LitImages::all);
  colours(declared.lit.diffuse, &LitImages::diffuse);
  colours(declared.lit.specular, &LitImages::specular);
  colours(declared.unoccluded, &LitImages::unoccluded);
  colours(declared.unbent, &LitImages::unbent);
  colours(declared.occluded, &LitImages::occluded);
  colours(declared.bounced, &LitImages::bounced);
}

void append_surfaces(const DeclaredFrame& declared, VkExtent2D size, std::vector<Wanted>& wanted) {
  wanted.push_back({declared.depth, [size](const HostBuffer& buffer, FrameImages& images) {
                      images.depth_ndc =
                          to_image<float, float>(buffer, size, [](float x) { return x; });
                    }});
  wanted.push_back(
      {declared.outputs.normals, [size](const HostBuffer& buffer, FrameImages& images) {
         images.normal_ws = to_image<glm::vec3, Half4>(buffer, size, from_half);
       }});
  wanted.push_back({declared.albedo, [size](const HostBuffer& buffer, FrameImages& images) {
                      images.albedo = to_image<glm::vec3, Byte4>(buffer, size, from_bytes);
                      images.roughness = to_image<float, Byte4>(
                          buffer, size, [](const Byte4& t) { return float(t[3]) / 255.0f; });
                    }});
  wanted.push_back({declared.emissive, [size](const HostBuffer& buffer, FrameImages& images) {
                      images.metallic = to_image<float, Half4>(
                          buffer, size, [](const Half4& t) { return half_to_float(t[3]); });
                    }});
}

}  // namespace

std::vector<Wanted> wanted_of(const DeclaredFrame& declared, VkExtent2D size,
                              passes::Precision precision) {
  std::vector<Wanted> wanted;
  append_surfaces(declared, size, wanted);
  wanted.push_back(
      {declared.outputs.visibility, [=](const HostBuffer& buffer, FrameImages& images) {
         images.visibility = read_visibility(buffer, size, precision);
       }});
  if (declared.outputs.bent_normal) {
    wanted.push_back(
        {declared.outputs.bent_normal, [=](const HostBuffer& buffer, FrameImages& images) {
           images.bent_normal_ws = read_vectors(buffer, size, precision);
         }});
  }
  if (declared.multi_bounce) {
    wanted.push_back({declared.multi_bounce, [=](const HostBuffer& buffer, FrameImages& images) {
                        images.multi_bounce = read_colours(buffer, size, precision);
                      }});
  }
  for (const Texture texture : declared.specular_occlusion) {
    wanted.push_back({texture, [=](const HostBuffer& buffer, FrameImages& images) {
                        images.specular_occlusion.push_back(
                            read_visibility(buffer, size, precision));
                      }});
  }
  append_lit(declared, size, wanted);
  return wanted;
}

}  // namespace alcove::sample
