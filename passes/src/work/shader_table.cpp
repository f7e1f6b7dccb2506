#include "work/shader_table.h"

#include <array>
#include <string>
#include <vector>

#include "spirv/apply.h"
#include "spirv/apply_specular.h"
#include "spirv/environment_half.h"
#include "spirv/environment_harmonics.h"
#include "spirv/environment_map.h"
#include "spirv/environment_prefilter.h"
#include "spirv/gtao.h"
#include "spirv/gtao_specular.h"
#include "spirv/gtso.h"
#include "spirv/gtso_by_table.h"
#include "spirv/half_output.h"
#include "spirv/half_output_specular.h"
#include "spirv/inspect.h"
#include "spirv/linear_depth.h"
#include "spirv/multi_bounce.h"
#include "spirv/normals.h"
#include "spirv/reconstruct.h"
#include "spirv/reconstruct_half.h"
#include "spirv/reconstruct_half_history.h"
#include "spirv/reconstruct_half_specular.h"
#include "spirv/reconstruct_half_specular_history.h"
#include "spirv/reconstruct_history.h"
#include "spirv/reconstruct_specular.h"
#include "spirv/reconstruct_specular_history.h"
#include "spirv/upsample.h"
#include "spirv/upsample_specular.h"
#include "tables/gtso.h"
#include "tables/reflectance.h"

namespace alcove::passes {

ShaderSource shader_source(Shader shader) {
  switch (shader) {
    case Shader::linear_depth:
      return {"linear_depth", kLinearDepth};
    case Shader::normals:
      return {"normals", kNormals};
    case Shader::gtao:
      return {"gtao", kGtao};
    case Shader::gtao_specular:
      return {"gtao_specular", kGtaoSpecular};
    case Shader::reconstruct:
      return {"reconstruct", kReconstruct};
    case Shader::reconstruct_history:
      return {"reconstruct_history", kReconstructHistory};
    case Shader::reconstruct_specular:
      return {"reconstruct_specular", kReconstructSpecular};
    case Shader::reconstruct_specular_history:
      return {"reconstruct_specular_history", kReconstructSpecularHistory};
    case Shader::reconstruct_half:
      return {"reconstruct_half", kReconstructHalf};
    case Shader::reconstruct_half_history:
      return {"reconstruct_half_history", kReconstructHalfHistory};
    case Shader::reconstruct_half_specular:
      return {"reconstruct_half_specular", kReconstructHalfSpecular};
    case Shader::reconstruct_half_specular_history:
      return {"reconstruct_half_specular_history", kReconstructHalfSpecularHistory};
    case Shader::upsample:
      return {"upsample", kUpsample};
    case Shader::upsample_specular:
      return {"upsample_specular", kUpsampleSpecular};
    case Shader::half_output:
      return {"half_output", kHalfOutput};
    case Shader::half_output_specular:
      return {"half_output_specular", kHalfOutputSpecular};
    case Shader::multi_bounce:
      return {"multi_bounce", kMultiBounce};
    case Shader::gtso:
      return {"gtso", kGtso};
    case Shader::gtso_by_table:
      return {"gtso_by_table", kGtsoByTable, kGtsoTable};
    case Shader::apply:
      return {"apply", kApply};
    case Shader::apply_specular:
      return {"apply_specular", kApplySpecular, kReflectanceTable};
    case Shader::environment_map:
      return {"environment_map", kEnvironmentMap};
    case Shader::environment_half:
      return {"environment_half", kEnvironmentHalf};
    case Shader::environment_prefilter:
      return {"environment_prefilter", kEnvironmentPrefilter};
    case Shader::environment_harmonics:
      return {"environment_harmonics", kEnvironmentHarmonics};
    case Shader::inspect:
      return {"inspect", kInspect};
    case Shader::count:
      break;
  }
  return {};
}

namespace {

constexpr std::size_t kShaderCount = static_cast<std::size_t>(Shader::count);

struct Interfaces {
  std::array<ShaderInterface, kShaderCount> shaders;
  std::vector<std::string_view> constant_names;
  std::vector<std::string_view> image_names;
};

const Interfaces& interfaces() {
  static const Interfaces all = [] {
    Interfaces read;
    for (std::size_t i = 0; i < kShaderCount; ++i) {
      read.shaders[i] = read_shader_interface(shader_source(static_cast<Shader>(i)).code);
      for (const ShaderConstant& constant : read.shaders[i].constants) {
        read.constant_names.push_back(constant.name);
      }
      for (const ShaderBinding& binding : read.shaders[i].bindings) {
        if (binding.is_image()) {
          read.image_names.push_back(binding.name);
        }
      }
    }
    std::ranges::sort(read.constant_names);
    std::ranges::sort(read.image_names);
    return read;
  }();
  return all;
}

}  // namespace

Shader shader_of_name(std::string_view name) {
  std::size_t i = 0;
  while (i < kShaderCount && shader_source(static_cast<Shader>(i)).name != name) {
    ++i;
  }
  return static_cast<Shader>(i);
}

const ShaderInterface& shader_interface(Shader shader) {
  return interfaces().shaders[static_cast<std::size_t>(shader)];
}

std::span<const std::string_view> known_constants() { return interfaces().constant_names; }

std::span<const std::string_view> known_images() { return interfaces().image_names; }

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
  if (given.size() > declared.size()) {
    if (const NamedConstant* const unknown = find_unknown(given, known_constants())) {
      return tl::unexpected(
          Error{"The pass of the shader '" + std::string(shader_source(shader).name) +
                "' gives a value for a specialisation constant '" + std::string(unknown->name) +
                "', which no shader declares; correct the name or remove it."});
    }
  }
  return static_cast<std::uint32_t>(declared.size());
}

}  // namespace alcove::passes
