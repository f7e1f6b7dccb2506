#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "support/svg.h"

namespace alcove::sample {

// An SVG image in drawing units, with x to the right and y upwards. `style` has the same meaning as
// in Svg.
class Drawing {
 public:
  // Creates an empty image. `low` and `high` are the corners of the visible area in drawing units;
  // `px_per_unit` scales it to the SVG's size in pixels.
  Drawing(glm::vec2 low, glm::vec2 high, float px_per_unit)
      : low_(low), high_(high), scale_(px_per_unit) {}

  void line(glm::vec2 from, glm::vec2 to, std::string_view style);
  void arrow(glm::vec2 from, glm::vec2 to, std::string_view colour);
  void polyline(const std::vector<glm::vec2>& points, std::string_view style);
  void polygon(const std::vector<glm::vec2>& points, std::string_view style);
  void circle(glm::vec2 centre, float radius_px, std::string_view style);
  void text(glm::vec2 at, std::string_view text, std::string_view anchor = "start");

  std::string svg() const;

 private:
  glm::vec2 px(glm::vec2 point) const;
  std::vector<glm::vec2> px(std::vector<glm::vec2> points) const;

  glm::vec2 low_;
  glm::vec2 high_;
  float scale_;
  Svg svg_;
};

}  // namespace alcove::sample
