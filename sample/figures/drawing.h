// A small SVG drawing, in units of its own that grow to the right and upwards.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "support/glm.h"

namespace alcove::sample {

class Drawing {
 public:
  // `low` and `high` are the corners of the visible area; `px_per_unit` scales it to the SVG's
  // size.
  Drawing(glm::vec2 low, glm::vec2 high, float px_per_unit);

  // `style` holds SVG presentation attributes, such as `stroke="black"`.
  void line(glm::vec2 from, glm::vec2 to, std::string_view style);
  void arrow(glm::vec2 from, glm::vec2 to, std::string_view colour);
  void polyline(const std::vector<glm::vec2>& points, std::string_view style);
  void polygon(const std::vector<glm::vec2>& points, std::string_view style);
  void circle(glm::vec2 centre, float radius_px, std::string_view style);
  // `anchor` is start, middle or end: where `at` lies along the text.
  void text(glm::vec2 at, std::string_view text, std::string_view anchor = "start",
            std::string_view colour = "#222");

  std::string svg() const;

 private:
  glm::vec2 px(glm::vec2 point) const;
  std::string list_of(const std::vector<glm::vec2>& points) const;

  glm::vec2 low_;
  glm::vec2 high_;
  float scale_;
  std::string body_;
};

}  // namespace alcove::sample
