#include "shader_table.h"

#include <array>

#include "spirv/depth_pyramid.h"
#include "spirv/gtao.h"
#include "spirv/gtso.h"
#include "spirv/multi_bounce.h"
#include "spirv/normals.h"
#include "spirv/reconstruct.h"
#include "spirv/reconstruct_history.h"

namespace alcove::passes {

const ShaderSource& shader_source(Shader shader) {
  static const std::array<ShaderSource, static_cast<std::size_t>(Shader::count)> sources{{
      {kDepthPyramid, "sttttt"},
      {kNormals, "st"},
      {kGtao, "sstt"},
      {kReconstruct, "sssstt"},
      {kReconstructHistory,
       "sssstt"
       "ssstt"},
      {kMultiBounce, "sst"},
      {kGtso, "ssssst"},
  }};
  return sources[static_cast<std::size_t>(shader)];
}

}  // namespace alcove::passes
