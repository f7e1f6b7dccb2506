#include "figures/drawing.h"

#include <fmt/format.h>

namespace alcove::sample {

glm::vec2 Drawing::px(glm::vec2 point) const {
  return {(point.x - low_.x) * scale_, (high_.y - point.y) * scale_};
}

std::vector<glm::vec2> Drawing::px(std::vector<glm::vec2> points) const {
  for (glm::vec2& point : points) point = px(point);
  return points;
}

void Drawing::line(glm::vec2 from, glm::vec2 to, std::string_view style) {
  svg_.line(px(from), px(to), style);
}

void Drawing::arrow(glm::vec2 from, glm::vec2 to, std::string_view colour) {
  line(from, to, fmt::format("stroke=\"{}\" stroke-width=\"2\"", colour));
  const glm::vec2 along = glm::normalize(to - from) * (9.0f / scale_);
  const glm::vec2 across = glm::vec2(-along.y, along.x) * 0.4f;
  polygon({to, to - along + across, to - along - across}, fmt::format("fill=\"{}\"", colour));
}

void Drawing::polyline(const std::vector<glm::vec2>& points, std::string_view style) {
  svg_.polyline(px(points), style);
}

void Drawing::polygon(const std::vector<glm::vec2>& points, std::string_view style) {
  svg_.polygon(px(points), style);
}

void Drawing::circle(glm::vec2 centre, float radius_px, std::string_view style) {
  svg_.circle(px(centre), radius_px, style);
}

void Drawing::text(glm::vec2 at, std::string_view text, std::string_view anchor) {
  svg_.text(px(at), anchor, text, "fill=\"#222\"");
}

std::string Drawing::svg() const { return svg_.document((high_ - low_) * scale_, 13); }

}  // namespace alcove::sample
