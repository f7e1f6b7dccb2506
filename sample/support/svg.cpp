#include "support/svg.h"

#include <fmt/format.h>

namespace alcove::sample {
namespace {

std::string point_list(const std::vector<glm::vec2>& points) {
  std::string list;
  for (const glm::vec2 point : points) list += fmt::format("{:.2f},{:.2f} ", point.x, point.y);
  return list;
}

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : std::string(1, c);
  return result;
}

// Returns the end of a shape's element, with its title if it has one.
std::string element_end(const char* shape, std::string_view title) {
  return title.empty() ? "/>\n" : fmt::format("><title>{}</title></{}>\n", escaped(title), shape);
}

}  // namespace

void Svg::line(glm::vec2 from, glm::vec2 to, std::string_view style) {
  body_ += fmt::format("<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" {}/>\n",
                       from.x, from.y, to.x, to.y, style);
}

void Svg::polyline(const std::vector<glm::vec2>& points, std::string_view style) {
  body_ += fmt::format("<polyline points=\"{}\" fill=\"none\" {}/>\n", point_list(points), style);
}

void Svg::polygon(const std::vector<glm::vec2>& points, std::string_view style) {
  body_ += fmt::format("<polygon points=\"{}\" {}/>\n", point_list(points), style);
}

void Svg::circle(glm::vec2 centre, float radius, std::string_view style, std::string_view title) {
  body_ += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.2f}\" {}", centre.x, centre.y,
                       radius, style) +
           element_end("circle", title);
}

void Svg::rectangle(glm::vec2 corner, glm::vec2 size, std::string_view style,
                    std::string_view title) {
  body_ += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" {}",
                       corner.x, corner.y, size.x, size.y, style) +
           element_end("rect", title);
}

void Svg::text(glm::vec2 at, std::string_view anchor, std::string_view text,
               std::string_view style) {
  body_ += fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\" text-anchor=\"{}\"{}{}>{}</text>\n", at.x,
                       at.y, anchor, style.empty() ? "" : " ", style, escaped(text));
}

std::string Svg::document(glm::vec2 size, int font_size) const {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.2f}\" height=\"{:.2f}\" "
      "font-family=\"sans-serif\" font-size=\"{}\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n{}</svg>\n",
      size.x, size.y, font_size, body_);
}

}  // namespace alcove::sample
