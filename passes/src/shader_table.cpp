#include "shader_table.h"

#include <array>

#include "spirv/apply.h"
#include "spirv/apply_specular.h"
#include "spirv/depth_pyramid.h"
#include "spirv/environment_half.h"
#include "spirv/environment_harmonics.h"
#include "spirv/environment_map.h"
#include "spirv/environment_prefilter.h"
#include "spirv/gtao.h"
#include "spirv/gtao_lobe.h"
#include "spirv/gtso.h"
#include "spirv/gtso_by_table.h"
#include "spirv/line_depth.h"
#include "spirv/multi_bounce.h"
#include "spirv/normals.h"
#include "spirv/reconstruct.h"
#include "spirv/reconstruct_history.h"
#include "spirv/reconstruct_lobe.h"
#include "spirv/reconstruct_lobe_history.h"
#include "tables/gtso.h"
#include "tables/reflectance.h"

namespace alcove::passes {

const ShaderSource& shader_source(Shader shader) {
  static const std::array<ShaderSource, static_cast<std::size_t>(Shader::count)> sources{{
      {kDepthPyramid, "sttttt"},
      {kNormals, "st"},
      {kLineDepth, "st"},
      {kGtao, "tstttt"},
      {kGtaoLobe,
       "tstttt"
       "s"},
      {kReconstruct, "tttstt"},
      {kReconstructHistory,
       "tttstt"
       "stttt"},
      {kReconstructLobe,
       "tttstt"
       "st"},
      {kReconstructLobeHistory,
       "tttstt"
       "stttt"
       "st"},
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
  }};
  return sources[static_cast<std::size_t>(shader)];
}

}  // namespace alcove::passes
