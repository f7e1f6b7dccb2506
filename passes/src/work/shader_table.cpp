#include "work/shader_table.h"

#include <iterator>
#include <string>

#include "spirv/interfaces.h"
#include "tables/gtso.h"

namespace alcove::passes {

namespace {

// In the order of the enum.
constexpr ShaderSource kSources[] = {
    {"surface", kSurface, kSurfaceInterface},
    {"gtao", kGtao, kGtaoInterface},
    {"gtao_bent", kGtaoBent, kGtaoBentInterface},
    {"gtao_specular", kGtaoSpecular, kGtaoSpecularInterface},
    {"gtao_bent_specular", kGtaoBentSpecular, kGtaoBentSpecularInterface},
    {"reconstruct", kReconstruct, kReconstructInterface},
    {"reconstruct_bent", kReconstructBent, kReconstructBentInterface},
    {"reconstruct_specular", kReconstructSpecular, kReconstructSpecularInterface},
    {"reconstruct_bent_specular", kReconstructBentSpecular, kReconstructBentSpecularInterface},
    {"reconstruct_half", kReconstructHalf, kReconstructHalfInterface},
    {"reconstruct_half_bent", kReconstructHalfBent, kReconstructHalfBentInterface},
    {"reconstruct_half_specular", kReconstructHalfSpecular, kReconstructHalfSpecularInterface},
    {"reconstruct_half_bent_specular", kReconstructHalfBentSpecular,
     kReconstructHalfBentSpecularInterface},
    {"upsample", kUpsample, kUpsampleInterface},
    {"upsample_bent", kUpsampleBent, kUpsampleBentInterface},
    {"upsample_specular", kUpsampleSpecular, kUpsampleSpecularInterface},
    {"upsample_bent_specular", kUpsampleBentSpecular, kUpsampleBentSpecularInterface},
    {"resolve_depth", kResolveDepth, kResolveDepthInterface},
    {"halve_depth", kHalveDepth, kHalveDepthInterface},
    {"mask_depth", kMaskDepth, kMaskDepthInterface},
    {"mask_depth_integer", kMaskDepthInteger, kMaskDepthIntegerInterface},
    {"multi_bounce", kMultiBounce, kMultiBounceInterface},
    {"gtso", kGtso, kGtsoInterface, kGtsoTable},
    {"inspect", kInspect, kInspectInterface},
};
static_assert(std::size(kSources) == kShaderCount);

}  // namespace

ShaderSource shader_source(Shader shader) { return kSources[static_cast<std::size_t>(shader)]; }

Shader shader_of_name(std::string_view name) {
  return static_cast<Shader>(std::ranges::find(kSources, name, &ShaderSource::name) - kSources);
}

const ShaderInterface& shader_interface(Shader shader) {
  return kSources[static_cast<std::size_t>(shader)].interface;
}

tl::expected<std::uint32_t, Error> resolve_constants(Shader shader,
                                                     std::span<const NamedConstant> given,
                                                     std::span<AlcoveWorkConstant> values) {
  const std::span<const ShaderConstant> declared = shader_interface(shader).constants;
  for (std::size_t i = 0; i < declared.size(); ++i) {
    const NamedConstant* const found = find_named(given, declared[i].name, i);
    if (found == nullptr) {
      return tl::unexpected(
          Error{std::string("The shader '").append(shader_source(shader).name) +
                "' has a specialisation constant '" + std::string(declared[i].name) +
                "', for which its pass gives no value; name it in the pass's list of constants."});
    }
    values[i] = {declared[i].id, found->value};
  }
  return static_cast<std::uint32_t>(declared.size());
}

}  // namespace alcove::passes
