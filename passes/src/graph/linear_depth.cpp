#include "alcove/passes/linear_depth.h"

#include <array>

#include "graph/check_inputs.h"
#include "work/view_parameters.h"

namespace alcove::passes {

using framegraph::RecordContext;
using framegraph::Texture;

tl::expected<Texture, Error> add_linear_depth(const Frame& frame, Texture depth_ndc) {
  const std::array<NamedInput, 1> needed{{{"depth", depth_ndc}}};
  if (auto good = check_inputs(frame.graph, "linear depth", needed); !good) {
    return tl::unexpected(good.error());
  }
  const auto projection = projection_of(frame, frame.view, depth_ndc);
  if (!projection) {
    return tl::unexpected(projection.error());
  }
  const auto kernel = frame.kernels.get(Shader::linear_depth);
  if (!kernel) {
    return tl::unexpected(kernel.error());
  }
  const VkExtent3D extent = frame.graph.extent(depth_ndc);
  Texture depth = frame.graph.create_texture(
      "linear depth",
      {VK_FORMAT_R32_SFLOAT, framegraph::Extent::absolute(extent.width, extent.height)});
  auto pass = frame.graph.add_pass("linear depth");
  pass.read(depth_ndc, framegraph::access::sampled_compute);
  depth = pass.write(depth, framegraph::access::storage_write_compute, {},
                     framegraph::Contents::discard);
  pass.record([&kernels = frame.kernels, kernel = *kernel, depth_ndc, depth, extent,
               parameters = *projection](RecordContext& context) {
    const auto views = std::to_array<NamedView>({{"depth_ndc_image", context.view(depth_ndc)},
                                                 {"linear_depth_image", context.view(depth)}});
    kernels.dispatch(context, kernel, views, bytes_of(parameters), extent);
  });
  return depth;
}

}  // namespace alcove::passes
