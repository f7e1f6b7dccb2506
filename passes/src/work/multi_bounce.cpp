#include "multi_bounce_parameters.h"
#include "work/bindings.h"

namespace alcove::passes {

void describe_multi_bounce(const ViewInputs& view, ResourceHandle visibility) {
  const AlcoveArea& written = view.written;
  const NamedConstant constants[] = {{"kAreas", flag(view.in_part)}};
  const NamedImage images[] = {{"visibility_image", visibility},
                               {"albedo_image", view.image(ALCOVE_IMAGE_ALBEDO)},
                               {"result_image", view.image(ALCOVE_IMAGE_MULTI_BOUNCE)}};
  const maths::MultiBounceParameters parameters{
      maths::uvec4(view.read.x + written.x, view.read.y + written.y, view.info.output_x,
                   view.info.output_y),
      maths::vec2(written.width, written.height)};
  view.list.dispatch({.label = "multi-bounce",
                      .shader = Shader::multi_bounce,
                      .constants = constants,
                      .images = images,
                      .parameters = bytes_of(parameters),
                      .size = {written.width, written.height, 1}});
}

}  // namespace alcove::passes
