#include "alcove/passes/inverse_depth.h"

#include <array>

#include "bindings.h"
#include "check_inputs.h"
#include "inverse_depth_parameters.h"
#include "view_parameters.h"

namespace alcove::passes {

using framegraph::RecordContext;
using framegraph::Texture;

tl::expected<Texture, Error> add_inverse_depth(const Frame& frame, Texture depth_ndc,
                                               std::string_view name) {
  const std::array<NamedInput, 1> needed{{{"depth", depth_ndc}}};
  if (auto good = check_inputs(frame.graph, name, needed); !good) {
    return tl::unexpected(good.error());
  }
  const auto projection = projection_of(frame, frame.view, depth_ndc);
  if (!projection) {
    return tl::unexpected(projection.error());
  }
  const std::array constants{flag(is_perspective(*projection)), flag(is_reversed(*projection))};
  const auto kernel = frame.kernels.get(Shader::inverse_depth, constants);
  if (!kernel) {
    return tl::unexpected(kernel.error());
  }
  const VkExtent3D extent = frame.graph.extent(depth_ndc);
  Texture line = frame.graph.create_texture(
      name, {VK_FORMAT_R32_SFLOAT, framegraph::Extent::absolute(extent.width, extent.height)});
  auto pass = frame.graph.add_pass(name);
  pass.read(depth_ndc, framegraph::access::sampled_compute);
  line = pass.write(line, framegraph::access::storage_write_compute, {},
                    framegraph::Contents::discard);
  const maths::InverseDepthParameters parameters{inverse_depth_from_ndc(*projection)};
  pass.record([&kernels = frame.kernels, kernel = *kernel, depth_ndc, line, extent,
               parameters](RecordContext& context) {
    const std::array views{context.view(depth_ndc), context.view(line)};
    kernels.dispatch(context, kernel, views, bytes_of(parameters), extent);
  });
  return line;
}

}  // namespace alcove::passes
