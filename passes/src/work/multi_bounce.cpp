#include "alcove/passes/work.h"
#include "multi_bounce_parameters.h"
#include "work/areas.h"
#include "work/bindings.h"
#include "work/check_inputs.h"
#include "work/output_format.h"
#include "work/view_parameters.h"

namespace alcove::passes {

using framegraph::Texture;

namespace {

tl::expected<void, Error> check(const WorkList& list, const WorkFrame& frame,
                                const MultiBounceInputs& inputs) {
  const Texture into = or_else(inputs.into, inputs.visibility);
  if (!has_areas(frame)) {
    return check_inputs(list, "multi-bounce",
                        {{"visibility", inputs.visibility},
                         {"albedo", inputs.albedo},
                         {"a texture for multi-bounce", into}});
  }
  const AlcoveArea written = written_area(frame, read_size(frame, {}));
  const VkExtent2D size{written.width, written.height};
  return check_areas(frame.areas, list.size(inputs.albedo))
      .and_then([&] { return check_output(frame, size, list.size(into), "multi-bounce"); })
      .and_then(
          [&] { return check_output(frame, size, list.size(inputs.visibility), "visibility"); });
}

}  // namespace

tl::expected<Texture, Error> describe_multi_bounce(WorkList& list, const WorkFrame& frame,
                                                   const MultiBounceInputs& inputs,
                                                   Precision precision) {
  if (auto good = check(list, frame, inputs); !good) return tl::unexpected(std::move(good.error()));
  const AlcoveArea written = written_area(frame, read_size(frame, list.size(inputs.visibility)));
  const VkExtent2D size{written.width, written.height};
  const Texture result = given_or_added(list, inputs.into, "multi-bounce", colour_format(precision),
                                        output_size(frame, size));
  const NamedConstant constants[] = {{"kAreas", flag(has_areas(frame))}};
  const NamedTexture images[] = {{"visibility_image", inputs.visibility},
                                 {"albedo_image", inputs.albedo},
                                 {"result_image", result}};
  const maths::MultiBounceParameters parameters{
      maths::uvec4(frame.areas.read.x + written.x, frame.areas.read.y + written.y,
                   frame.areas.output_x, frame.areas.output_y),
      maths::vec2(size.width, size.height)};
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
