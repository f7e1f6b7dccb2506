#include "figures/drawing.h"

#include <cstdio>

namespace alcove::sample {
namespace {

std::string number(float value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", static_cast<double>(value));
  return text;
}

std::string attributes(std::string_view first, glm::vec2 at, std::string_view second) {
  return std::string(first) + "=\"" + number(at.x) + "\" " + std::string(second) + "=\"" +
         number(at.y) + "\" ";
}

}  // namespace

Drawing::Drawing(glm::vec2 low, glm::vec2 high, float px_per_unit)
    : low_(low), high_(high), scale_(px_per_unit) {}

glm::vec2 Drawing::px(glm::vec2 point) const {
  return {(point.x - low_.x) * scale_, (high_.y - point.y) * scale_};
}

std::string Drawing::list_of(const std::vector<glm::vec2>& points) const {
  std::string list;
  for (const glm::vec2 point : points) {
    const glm::vec2 at = px(point);
    list += number(at.x) + "," + number(at.y) + " ";
  }
  return list;
}

void Drawing::line(glm::vec2 from, glm::vec2 to, std::string_view style) {
  body_ += "<line " + attributes("x1", px(from), "y1") + attributes("x2", px(to), "y2") +
           std::string(style) + "/>\n";
}

void Drawing::arrow(glm::vec2 from, glm::vec2 to, std::string_view colour) {
  const std::string stroke = "stroke=\"" + std::string(colour) + "\" stroke-width=\"2\"";
  line(from, to, stroke);
  const glm::vec2 along = glm::normalize(to - from) * (9.0f / scale_);
  const glm::vec2 across = glm::vec2(-along.y, along.x) * 0.4f;
  polygon({to, to - along + across, to - along - across}, "fill=\"" + std::string(colour) + "\"");
}

void Drawing::polyline(const std::vector<glm::vec2>& points, std::string_view style) {
  body_ +=
      "<polyline points=\"" + list_of(points) + "\" fill=\"none\" " + std::string(style) + "/>\n";
}

void Drawing::polygon(const std::vector<glm::vec2>& points, std::string_view style) {
  body_ += "<polygon points=\"" + list_of(points) + "\" " + std::string(style) + "/>\n";
}

void Drawing::circle(glm::vec2 centre, float radius_px, std::string_view style) {
  body_ += "<circle " + attributes("cx", px(centre), "cy") + "r=\"" + number(radius_px) + "\" " +
           std::string(style) + "/>\n";
}

void Drawing::text(glm::vec2 at, std::string_view text, std::string_view anchor,
                   std::string_view colour) {
  body_ += "<text " + attributes("x", px(at), "y") + "text-anchor=\"" + std::string(anchor) +
           "\" fill=\"" + std::string(colour) + "\">" + std::string(text) + "</text>\n";
}

std::string Drawing::svg() const {
  const glm::vec2 size = (high_ - low_) * scale_;
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + number(size.x) + "\" height=\"" +
         number(size.y) + "\" font-family=\"sans-serif\" font-size=\"13\">\n" +
         "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n" + body_ + "</svg>\n";
}

}  // namespace alcove::sample
