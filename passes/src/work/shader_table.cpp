#include "work/shader_table.h"

#include <array>
#include <iterator>
#include <string>
#include <vector>

#include "spirv/gtao.h"
#include "spirv/gtao_bent.h"
#include "spirv/gtao_bent_specular.h"
#include "spirv/gtao_specular.h"
#include "spirv/gtso.h"
#include "spirv/halve_depth.h"
#include "spirv/inspect.h"
#include "spirv/linear_depth.h"
#include "spirv/mask_depth.h"
#include "spirv/mask_depth_integer.h"
#include "spirv/multi_bounce.h"
#include "spirv/normals.h"
#include "spirv/reconstruct.h"
#include "spirv/reconstruct_bent.h"
#include "spirv/reconstruct_bent_specular.h"
#include "spirv/reconstruct_half.h"
#include "spirv/reconstruct_half_bent.h"
#include "spirv/reconstruct_half_bent_specular.h"
#include "spirv/reconstruct_half_specular.h"
#include "spirv/reconstruct_specular.h"
#include "spirv/resolve_depth.h"
#include "spirv/upsample.h"
#include "spirv/upsample_bent.h"
#include "spirv/upsample_bent_specular.h"
#include "spirv/upsample_specular.h"
#include "tables/gtso.h"

namespace alcove::passes {

namespace {

constexpr std::size_t kShaderCount = static_cast<std::size_t>(Shader::count);

// In the order of the enum.
constexpr ShaderSource kSources[] = {
    {"linear_depth", kLinearDepth},
    {"normals", kNormals},
    {"gtao", kGtao},
    {"gtao_bent", kGtaoBent},
    {"gtao_specular", kGtaoSpecular},
    {"gtao_bent_specular", kGtaoBentSpecular},
    {"reconstruct", kReconstruct},
    {"reconstruct_bent", kReconstructBent},
    {"reconstruct_specular", kReconstructSpecular},
    {"reconstruct_bent_specular", kReconstructBentSpecular},
    {"reconstruct_half", kReconstructHalf},
    {"reconstruct_half_bent", kReconstructHalfBent},
    {"reconstruct_half_specular", kReconstructHalfSpecular},
    {"reconstruct_half_bent_specular", kReconstructHalfBentSpecular},
    {"upsample", kUpsample},
    {"upsample_bent", kUpsampleBent},
    {"upsample_specular", kUpsampleSpecular},
    {"upsample_bent_specular", kUpsampleBentSpecular},
    {"resolve_depth", kResolveDepth},
    {"halve_depth", kHalveDepth},
    {"mask_depth", kMaskDepth},
    {"mask_depth_integer", kMaskDepthInteger},
    {"multi_bounce", kMultiBounce},
    {"gtso", kGtso, kGtsoTable},
    {"inspect", kInspect},
};
static_assert(std::size(kSources) == kShaderCount);

const std::array<ShaderInterface, kShaderCount>& interfaces() {
  static const std::array<ShaderInterface, kShaderCount> all = [] {
    std::array<ShaderInterface, kShaderCount> read;
    for (std::size_t i = 0; i < kShaderCount; ++i)
      read[i] = read_shader_interface(kSources[i].code);
    return read;
  }();
  return all;
}

}  // namespace

ShaderSource shader_source(Shader shader) { return kSources[static_cast<std::size_t>(shader)]; }

Shader shader_of_name(std::string_view name) {
  return static_cast<Shader>(std::ranges::find(kSources, name, &ShaderSource::name) - kSources);
}

const ShaderInterface& shader_interface(Shader shader) {
  return interfaces()[static_cast<std::size_t>(shader)];
}

tl::expected<std::uint32_t, Error> resolve_constants(Shader shader,
                                                     std::span<const NamedConstant> given,
                                                     std::span<AlcoveWorkConstant> values) {
  const std::vector<ShaderConstant>& declared = shader_interface(shader).constants;
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
