#include "cli/option_value.h"

#include <cstdlib>

namespace alcove::sample {

Result<glm::dvec3> read_vector(std::string_view text) {
  constexpr double kHuge = std::numeric_limits<float>::max();
  const std::string wanted = "three numbers, such as 0,1.5,-2";
  ALCOVE_TRY(const auto v, list(number(-kHuge, kHuge, wanted))(text));
  if (v.size() != 3) return Failure(wanted);
  return glm::dvec3(v[0], v[1], v[2]);
}

Result<std::pair<std::uint32_t, std::uint32_t>> read_size(std::string_view text) {
  const auto side =
      number(1u, 16384u, "WIDTHxHEIGHT in pixels, each from 1 to 16384, such as 960x540");
  const std::size_t x = std::min(text.find('x'), text.size());
  ALCOVE_TRY(const std::uint32_t width, side(text.substr(0, x)));
  ALCOVE_TRY(const std::uint32_t height, side(text.substr(std::min(x + 1, text.size()))));
  return std::pair(width, height);
}

std::string coordinate_text(float value, double origin) {
  if (origin == 0.0) return number_text(value);
  std::string text;
  for (int digits = 6; digits <= 17; ++digits) {
    text = fmt::format("{:.{}g}", origin + static_cast<double>(value), digits);
    if (static_cast<float>(std::strtod(text.c_str(), nullptr) - origin) == value) break;
  }
  return text;
}

}  // namespace alcove::sample
