#include "work/shader_table.h"

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

}  // namespace alcove::passes
