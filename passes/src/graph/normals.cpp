#include "alcove/passes/normals.h"

#include <array>

#include "graph/check_inputs.h"
#include "normals_parameters.h"
#include "work/view_parameters.h"

namespace alcove::passes {

using framegraph::RecordContext;
using framegraph::Texture;

tl::expected<Texture, Error> add_normals(const Frame& frame, Texture depth) {
  const std::array<NamedInput, 1> needed{{{"linear depth", depth}}};
  if (auto good = check_inputs(frame.graph, "normals", needed); !good) {
    return tl::unexpected(good.error());
  }
  const auto projection = projection_of(frame, frame.view, depth);
  if (!projection) {
    return tl::unexpected(projection.error());
  }
  const auto kernel = frame.kernels.get(Shader::normals);
  if (!kernel) {
    return tl::unexpected(kernel.error());
  }
  Texture normals = frame.graph.create_texture(
      "normals from depth", {VK_FORMAT_R16G16B16A16_SFLOAT, framegraph::Extent::relative(depth)});
  auto pass = frame.graph.add_pass("normals");
  pass.read(depth, framegraph::access::sampled_compute);
  normals = pass.write(normals, framegraph::access::storage_write_compute, {},
                       framegraph::Contents::discard);
  const maths::NormalsParameters parameters{*projection};
  pass.record([&kernels = frame.kernels, kernel = *kernel, depth, normals,
               parameters](RecordContext& context) {
    const auto views = std::to_array<NamedView>(
        {{"depth_image", context.view(depth)}, {"normal_image", context.view(normals)}});
    kernels.dispatch(context, kernel, views, bytes_of(parameters), context.extent(normals));
  });
  return normals;
}

}  // namespace alcove::passes
