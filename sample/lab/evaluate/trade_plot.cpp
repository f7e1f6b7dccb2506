#include "evaluate/trade_plot.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "support/svg.h"

namespace alcove::sample {
namespace {

constexpr double kWidth = 860;
constexpr double kHeight = 540;
constexpr double kLeft = 80;
constexpr double kRight = 30;
constexpr double kTop = 50;
constexpr double kBottom = 60;
constexpr double kPlotWidth = kWidth - kLeft - kRight;
constexpr double kPlotHeight = kHeight - kTop - kBottom;

// Maps times and errors to positions in the plot.
struct Axes {
  double first_ms;
  double last_ms;
  double least;
  double most;

  explicit Axes(const Trade& trade)
      : first_ms(trade.points.front().time_ms / 1.2), last_ms(trade.points.back().time_ms * 1.2) {
    const auto [low, high] = std::ranges::minmax(
        trade.points, {}, [](const Measurement& point) { return point.scene.rmse; });
    const double margin = std::max(0.08 * (high.scene.rmse - low.scene.rmse), 1e-4);
    least = std::max(low.scene.rmse - margin, 0.0);
    most = high.scene.rmse + margin;
  }
  double x(double ms) const {
    return kLeft + kPlotWidth * std::log(ms / first_ms) / std::log(last_ms / first_ms);
  }
  double y(double rmse) const { return kTop + kPlotHeight * (most - rmse) / (most - least); }
};

// A step of 1, 2 or 5 times a power of ten that divides a range into about `parts`.
double round_step(double range, double parts) {
  const double raw = range / parts;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double lead = raw / power;
  return power * (lead < 1.5 ? 1.0 : lead < 3.5 ? 2.0 : lead < 7.5 ? 5.0 : 10.0);
}

constexpr const char* kGridLine = "stroke=\"#ddd\"";

std::string number(double value) { return fmt::format("{:.3g}", value); }

void draw_axes(Svg& svg, const Axes& axes, const std::string& clock_title) {
  const double step = round_step(axes.most - axes.least, 6);
  const auto last = static_cast<int>(std::floor(axes.most / step));
  for (auto i = static_cast<int>(std::ceil(axes.least / step)); i <= last; ++i) {
    const double y = axes.y(i * step);
    svg.line({kLeft, y}, {kWidth - kRight, y}, kGridLine);
    svg.text({kLeft - 8, y + 4}, "end", number(i * step));
  }
  const auto first_power = static_cast<int>(std::floor(std::log10(axes.first_ms)));
  for (int power = first_power; std::pow(10.0, power) <= axes.last_ms; ++power) {
    for (const double lead : {1.0, 2.0, 5.0}) {
      const double ms = lead * std::pow(10.0, power);
      if (ms < axes.first_ms || ms > axes.last_ms) continue;
      svg.line({axes.x(ms), kTop}, {axes.x(ms), kHeight - kBottom}, kGridLine);
      svg.text({axes.x(ms), kHeight - kBottom + 18}, "middle", number(ms));
    }
  }
  svg.text({kLeft + 0.5 * kPlotWidth, kHeight - 14}, "middle", clock_title + ", ms");
  svg.text({kLeft, kTop - 10}, "middle", "RMSE");
}

void draw_pareto_front(Svg& svg, const Trade& trade, const Axes& axes) {
  std::vector<glm::vec2> points;
  for (std::size_t i = 0; i < trade.points.size(); ++i)
    if (trade.on_pareto_front[i])
      points.emplace_back(axes.x(trade.points[i].time_ms), axes.y(trade.points[i].scene.rmse));
  svg.polyline(points, "stroke=\"#1f6f8b\" stroke-width=\"2\"");
}

struct Box {
  double left, top, right, bottom;

  bool overlaps(const Box& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
};

// Places texts of 12 pixels so that none covers another or a point.
class Labels {
 public:
  explicit Labels(std::vector<Box> points) : taken_(std::move(points)) {}

  // Draws `text` beside the point, as near as there is room, with a line to it if it is not
  // adjacent.
  void draw(Svg& svg, double x, double y, const std::string& text) {
    constexpr double kStep = 16;
    constexpr int kRows = 14;
    for (int row = 0; row < kRows; ++row) {
      // Alternately above and below, at a growing distance; right of the point first, then left.
      const int rank = row / 2;
      const double distance = kStep * rank;
      const double base = row % 2 == 0 ? y - 7 - distance : y + 16 + distance;
      for (const bool right : {true, false}) {
        if (const Box box = box_of(x, base, right, text); is_free(box)) {
          taken_.push_back(box);
          if (row > 1) svg.line({x, y}, {x + (right ? 8 : -8), base - 4}, kGridLine);
          svg.text({x + (right ? 9 : -9), base}, right ? "start" : "end", text);
          return;
        }
      }
    }
  }

 private:
  static Box box_of(double x, double base, bool right, const std::string& text) {
    const double width = 6.6 * static_cast<double>(text.size());
    const double left = right ? x + 9 : x - 9 - width;
    return {left, base - 11, left + width, base + 4};
  }
  bool is_free(const Box& box) const {
    return box.left > kLeft && box.right < kWidth - 4 && box.top > kTop &&
           box.bottom < kHeight - kBottom &&
           std::ranges::none_of(taken_, [&](const Box& other) { return box.overlaps(other); });
  }

  std::vector<Box> taken_;
};

void draw_points(Svg& svg, const Trade& trade, const Axes& axes) {
  std::vector<Box> circles;
  for (const Measurement& point : trade.points) {
    const double x = axes.x(point.time_ms);
    const double y = axes.y(point.scene.rmse);
    circles.push_back({x - 5, y - 5, x + 5, y + 5});
  }
  Labels labels(circles);
  for (std::size_t i = 0; i < trade.points.size(); ++i) {
    const Measurement& point = trade.points[i];
    const double x = axes.x(point.time_ms);
    const double y = axes.y(point.scene.rmse);
    const char* colour = trade.on_pareto_front[i] ? "#1f6f8b" : "#bbb";
    if (point.spread_ms > 0 && point.spread_ms < point.time_ms) {
      svg.line({axes.x(point.time_ms - point.spread_ms), y},
               {axes.x(point.time_ms + point.spread_ms), y}, fmt::format("stroke=\"{}\"", colour));
    }
    svg.circle(
        {x, y}, 4, fmt::format("fill=\"{}\"", colour),
        fmt::format("{}, {:.3g}, {:.3g} ms", point.variant.name, point.scene.rmse, point.time_ms));
  }
  for (std::size_t i = 0; i < trade.points.size(); ++i) {
    if (trade.on_pareto_front[i]) {
      labels.draw(svg, axes.x(trade.points[i].time_ms), axes.y(trade.points[i].scene.rmse),
                  trade.points[i].variant.name);
    }
  }
}

}  // namespace

std::string draw_plot(const Trade& trade, const std::string& title,
                      const std::string& clock_title) {
  const Axes axes(trade);
  Svg svg;
  svg.text({0.5 * kWidth, 20}, "middle", title);
  draw_axes(svg, axes, clock_title);
  draw_pareto_front(svg, trade, axes);
  draw_points(svg, trade, axes);
  return svg.document({kWidth, kHeight}, 12);
}

}  // namespace alcove::sample
