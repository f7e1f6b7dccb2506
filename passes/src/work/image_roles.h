// The purposes of a view's images, and the formats that suit them.
#pragma once

#include <cstdint>
#include <string>

#include "alcove/alcove_work.h"

namespace alcove::passes {

// Returns the name of a role, as resources of a list and sentences have it.
[[nodiscard]] const char* role_name(std::uint32_t role);

[[nodiscard]] constexpr bool is_output(std::uint32_t role) {
  return role >= ALCOVE_IMAGE_FIRST_OUTPUT;
}

// Returns what is wrong with an image of a view, as the end of a sentence that begins with "the
// image of" and its name. The text is empty if nothing is wrong.
[[nodiscard]] std::string image_problem(std::uint32_t role, const AlcoveWorkImage& image,
                                        const AlcoveViewInfo& info);

}  // namespace alcove::passes
