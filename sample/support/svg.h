#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "support/glm.h"

namespace alcove::sample {

// An SVG image that is built shape by shape. Positions and lengths are in pixels; y grows
// downwards. A `style` is a text of presentation attributes, such as `stroke="black"`. A `title` is
// shown as a tooltip.
class Svg {
 public:
  void line(glm::vec2 from, glm::vec2 to, std::string_view style);
  void polyline(const std::vector<glm::vec2>& points, std::string_view style);
  void polygon(const std::vector<glm::vec2>& points, std::string_view style);
  void circle(glm::vec2 centre, float radius, std::string_view style, std::string_view title = "");
  // `corner` is the upper left one.
  void rectangle(glm::vec2 corner, glm::vec2 size, std::string_view style,
                 std::string_view title = "");
  // `anchor` is `start`, `middle` or `end`: the part of the text that is at the position `at`.
  void text(glm::vec2 at, std::string_view anchor, std::string_view text,
            std::string_view style = "");

  // Returns the text of the SVG file: the shapes on a white background.
  std::string document(glm::vec2 size, int font_size) const;

 private:
  std::string body_;
};

}  // namespace alcove::sample
