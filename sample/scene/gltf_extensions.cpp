#include "scene/gltf_extensions.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace alcove::sample {

bool is_extension_read(const std::string& name) {
  constexpr std::array<std::string_view, 5> kRead{
      "EXT_mesh_gpu_instancing", "KHR_materials_pbrSpecularGlossiness", "KHR_mesh_quantization",
      "KHR_node_visibility", "KHR_texture_transform"};
  return std::ranges::find(kRead, name) != kRead.end();
}

bool changes_no_shape(const std::string& name) {
  // Extensions that change no shape: prefixes of families, then whole names. Extensions that hold
  // or place triangles are not listed, for example mesh compression (KHR_draco_mesh_compression,
  // EXT_meshopt_compression). KHR_texture_basisu and similar extensions are not listed either,
  // because a texture may have no other source. Unknown extensions are assumed to change shapes.
  constexpr std::array<std::string_view, 4> kFamilies{"KHR_materials_", "ADOBE_materials_",
                                                      "EXT_lights_", "KHR_lights_"};
  constexpr std::array<std::string_view, 8> kNames{
      "AGI_stk_metadata",        "CESIUM_primitive_outline",
      "EXT_structural_metadata", "KHR_animation_pointer",
      "KHR_audio_emitter",       "KHR_xmp",
      "KHR_xmp_json_ld",         "MSFT_packing_occlusionRoughnessMetallic"};
  return std::ranges::any_of(kFamilies, [&](auto family) { return name.starts_with(family); }) ||
         std::ranges::find(kNames, name) != kNames.end();
}

}  // namespace alcove::sample
