#include "alcove/passes/multi_bounce.h"

#include <array>

#include "graph/check_inputs.h"
#include "graph/write_result.h"
#include "multi_bounce_parameters.h"
#include "work/output_format.h"
#include "work/view_parameters.h"

namespace alcove::passes {

using framegraph::RecordContext;
using framegraph::Texture;

tl::expected<Texture, Error> add_multi_bounce(const Frame& frame, const MultiBounceInputs& inputs,
                                              Precision precision) {
  const std::array<NamedInput, 3> named{
      {{"visibility", inputs.visibility},
       {"albedo", inputs.albedo},
       {"a texture for multi-bounce", inputs.into ? inputs.into : inputs.visibility}}};
  if (auto good = check_inputs(frame.graph, "multi-bounce", named); !good) {
    return tl::unexpected(std::move(good.error()));
  }
  const auto constants = std::to_array<NamedConstant>(
      {{"kVisibilityChannel", channel_index(inputs.visibility_channel)}});
  const auto kernel = frame.kernels.get(Shader::multi_bounce, constants);
  if (!kernel) {
    return tl::unexpected(kernel.error());
  }
  Texture result =
      given_or_created(frame.graph, inputs.into, "multi-bounce",
                       {colour_format(precision), framegraph::Extent::relative(inputs.visibility)});
  auto pass = frame.graph.add_pass("multi-bounce");
  pass.read(inputs.visibility, framegraph::access::sampled_compute);
  pass.read(inputs.albedo, framegraph::access::sampled_compute);
  result = write_result(frame.graph, pass, result);
  const VkExtent3D size = frame.graph.extent(inputs.visibility);
  const maths::MultiBounceParameters parameters{
      maths::vec2(static_cast<float>(size.width), static_cast<float>(size.height))};
  pass.record([&kernels = frame.kernels, kernel = *kernel, inputs, result,
               parameters](RecordContext& context) {
    const auto views =
        std::to_array<NamedView>({{"visibility_image", context.view(inputs.visibility)},
                                  {"albedo_image", context.view(inputs.albedo)},
                                  {"result_image", context.view(result)}});
    kernels.dispatch(context, kernel, views, bytes_of(parameters), context.extent(result));
  });
  return result;
}

}  // namespace alcove::passes
