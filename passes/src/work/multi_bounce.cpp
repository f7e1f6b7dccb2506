#include "alcove/passes/work.h"
#include "multi_bounce_parameters.h"
#include "work/bindings.h"
#include "work/check_inputs.h"
#include "work/output_format.h"
#include "work/view_parameters.h"

namespace alcove::passes {

using framegraph::Texture;

tl::expected<Texture, Error> describe_multi_bounce(WorkList& list, const MultiBounceInputs& inputs,
                                                   Precision precision) {
  if (auto good =
          check_inputs(list, "multi-bounce",
                       {{"visibility", inputs.visibility},
                        {"albedo", inputs.albedo},
                        {"a texture for multi-bounce", or_else(inputs.into, inputs.visibility)}});
      !good) {
    return tl::unexpected(std::move(good.error()));
  }
  const VkExtent2D size = list.size(inputs.visibility);
  const Texture result =
      given_or_added(list, inputs.into, "multi-bounce", colour_format(precision), size);
  const NamedConstant constants[] = {
      {"kVisibilityChannel", channel_index(inputs.visibility_channel)}};
  const NamedTexture images[] = {{"visibility_image", inputs.visibility},
                                 {"albedo_image", inputs.albedo},
                                 {"result_image", result}};
  const maths::MultiBounceParameters parameters{maths::vec2(size.width, size.height)};
  return list
      .dispatch({.label = "multi-bounce",
                 .shader = Shader::multi_bounce,
                 .constants = constants,
                 .images = images,
                 .parameters = bytes_of(parameters),
                 .size = {size.width, size.height, 1}})
      .map([&] { return result; });
}

}  // namespace alcove::passes
