#include "shader_table.h"

#include <array>

#include "spirv/depth_pyramid.h"
#include "spirv/gtao.h"
#include "spirv/normals.h"
#include "spirv/spatial_filter.h"

namespace alcove::passes {

const ShaderSource& shader_source(Shader shader) {
  static const std::array<ShaderSource, static_cast<std::size_t>(Shader::count)> sources{{
      {kDepthPyramid, "sttttt"},
      {kNormals, "st"},
      {kGtao, "sstt"},
      {kSpatialFilter, "sssstt"},
  }};
  return sources[static_cast<std::size_t>(shader)];
}

}  // namespace alcove::passes
