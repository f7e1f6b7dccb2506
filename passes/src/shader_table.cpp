#include "shader_table.h"

#include <array>

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

const ShaderSource& shader_source(Shader shader) {
  static const std::array<ShaderSource, static_cast<std::size_t>(Shader::count)> sources{{
      {kLinearDepth, "sttttt"},
      {kNormals, "st"},
      {kGtao, "ssttss"},
      {kGtaoSpecular,
       "ssttss"
       "s"},
      {kReconstruct, "ttsstt"},
      {kReconstructHistory,
       "ttsstt"
       "gtsgt"},
      {kReconstructSpecular,
       "ttsstt"
       "st"},
      {kReconstructSpecularHistory,
       "ttsstt"
       "gtsgt"
       "stgt"},
      {kReconstructHalf,
       "ttgstt"
       "t"},
      {kReconstructHalfHistory,
       "ttgstt"
       "ggsgt"},
      {kReconstructHalfSpecular,
       "ttgstt"
       "t"
       "st"},
      {kReconstructHalfSpecularHistory,
       "ttgstt"
       "ggsgt"
       "sgt"},
      {kUpsample, "gggsgtt"},
      {kUpsampleSpecular,
       "gggsgtt"
       "gt"},
      {kMultiBounce, "sst"},
      {kGtso, "ssssst"},
      {kGtsoByTable, "ssssstb", kGtsoTable},
      {kApply, "ssssssstt"},
      {kApplySpecular,
       "ssssssstt"
       "tssssb",
       kReflectanceTable},
      {kEnvironmentMap, "st"},
      {kEnvironmentHalf, "st"},
      {kEnvironmentPrefilter, "st"},
      {kEnvironmentHarmonics, "st"},
      {kInspect, "sst"},
  }};
  return sources[static_cast<std::size_t>(shader)];
}

}  // namespace alcove::passes
