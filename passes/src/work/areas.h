// The areas of a view, with their defaults.
#pragma once

#include "alcove/passes/work.h"
#include "maths/language.h"

namespace alcove::passes {

// Whether images are read or written in part.
[[nodiscard]] inline bool has_areas(const WorkFrame& frame) {
  return frame.areas.read.width > 0 || frame.areas.read.height > 0;
}

// Returns the size of the area that is read of images of the size `whole`.
[[nodiscard]] inline VkExtent2D read_size(const WorkFrame& frame, VkExtent2D whole) {
  return has_areas(frame) ? VkExtent2D{frame.areas.read.width, frame.areas.read.height} : whole;
}

// Returns the area that is written, relative to the area of the size `read` that is read.
[[nodiscard]] AlcoveArea written_area(const WorkFrame& frame, VkExtent2D read);

// Returns the size of textures for results of which `written` pixels are written.
[[nodiscard]] VkExtent2D output_size(const WorkFrame& frame, VkExtent2D written);

// Checks that the area that is read lies in images of the size `whole`, and the area that is
// written in the area that is read.
[[nodiscard]] tl::expected<void, Error> check_areas(const ImageAreas& areas, VkExtent2D whole);

// Returns what is wrong with the size of a texture for results: it must have room for `written`
// pixels, and without areas exactly this size. The text is empty if nothing is wrong.
[[nodiscard]] std::string output_problem(const WorkFrame& frame, VkExtent2D written,
                                         VkExtent2D texture);
// Returns the problem as an error that calls the texture `name`.
[[nodiscard]] tl::expected<void, Error> check_output(const WorkFrame& frame, VkExtent2D written,
                                                     VkExtent2D texture, std::string_view name);

// Sets the members `area` and `written` of a shader's parameters.
template <typename Parameters>
void set_areas(Parameters& parameters, const WorkFrame& frame, VkExtent2D read) {
  const AlcoveArea written = written_area(frame, read);
  parameters.area = maths::uvec4(frame.areas.read.x, frame.areas.read.y, read.width, read.height);
  parameters.written = maths::uvec4(written.x, written.y, written.x + written.width - 1,
                                    written.y + written.height - 1);
}

}  // namespace alcove::passes
