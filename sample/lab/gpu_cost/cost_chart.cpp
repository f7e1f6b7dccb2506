#include <fmt/format.h>
#include <algorithm>
#include <array>

#include "gpu_cost/cost_report.h"
#include "gpu_cost/xegtao.h"
#include "support/svg.h"

namespace alcove::sample {
namespace {

constexpr double kWidth = 900;
constexpr double kLeft = 170;   // left edge of the bars
constexpr double kRight = 130;  // for the totals
constexpr double kBar = 14;
constexpr double kRow = 18;
constexpr double kGap = 6;       // between labels
constexpr double kHeading = 44;  // height of a GPU's heading
constexpr double kLegend = 34;

// The palette of Okabe and Ito, which is distinct in print and to people with colour blindness.
constexpr std::array<const char*, 7> kColours{"#0072b2", "#e69f00", "#009e73", "#cc79a7",
                                              "#56b4e9", "#d55e00", "#999999"};

// A white outline that keeps text readable on lines.
constexpr const char* kOverLines =
    "stroke=\"white\" stroke-width=\"4\" paint-order=\"stroke\" stroke-linejoin=\"round\"";

// The passes in order of appearance, which determines their colours.
std::vector<std::string> pass_names(std::span<const SettingsCost> costs) {
  std::vector<std::string> names;
  for (const SettingsCost& cost : costs) {
    for (const ModelledFrame& frame : cost.frames) {
      for (const ModelledPass& pass : frame.passes)
        if (std::ranges::find(names, pass.pass) == names.end()) names.push_back(pass.pass);
    }
  }
  return names;
}

class Chart {
 public:
  explicit Chart(std::span<const SettingsCost> costs) : costs_(costs), names_(pass_names(costs)) {}

  std::string draw() {
    for (const GpuPart& part : kGpuParts) draw_part(part);
    draw_legend();
    return svg_.document({kWidth, y_}, 12);
  }

 private:
  void draw_part(const GpuPart& part);
  void draw_box(double x, double y, double width, const std::string& pass,
                const std::string& title);
  void draw_legend();

  std::span<const SettingsCost> costs_;
  std::vector<std::string> names_;
  Svg svg_;
  double y_ = 0;
};

void Chart::draw_part(const GpuPart& part) {
  const auto own = std::ranges::find(costs_, &part, &SettingsCost::part);
  if (own == costs_.end()) return;
  const CostInputs& size = own->settings.inputs;
  const double peer_ms = xegtao_ms(part, kXeGtaoHigh, size.width, size.height);
  double longest = peer_ms;
  std::size_t rows = 0;
  std::size_t labels = 0;
  for (const SettingsCost& cost : costs_) {
    labels += cost.part == &part ? 1 : 0;
    for (const ModelledFrame& frame : cost.frames) {
      if (cost.part == &part) {
        longest = std::max(longest, frame.milliseconds());
        ++rows;
      }
    }
  }
  const double scale = (kWidth - kLeft - kRight) / longest;
  svg_.text({12, y_ + 20}, "start", fmt::format("{}: modelled milliseconds", part.title),
            "font-weight=\"bold\"");
  const double top = y_ + kHeading;
  const double line = kLeft + peer_ms * scale;
  svg_.text({line, top - 6}, "middle", fmt::format("{} {:.3g}", kXeGtaoHigh.name, peer_ms));
  y_ = top;
  // The line of the reference time is drawn first, so that bars and texts cover it.
  const double height = kRow * static_cast<double>(rows) + kGap * static_cast<double>(labels);
  svg_.line({line, top - 2}, {line, top + height}, "stroke=\"black\" stroke-dasharray=\"4 3\"");
  for (const SettingsCost& cost : costs_) {
    if (cost.part != &part) continue;
    for (const ModelledFrame& frame : cost.frames) {
      svg_.text({kLeft - 8, y_ + kBar - 2}, "end",
                fmt::format("{}, {}", cost.settings.label, name_of(frame.state)));
      double x = kLeft;
      for (const ModelledPass& pass : frame.passes) {
        const double width = pass.milliseconds() * scale;
        draw_box(x, y_, width, pass.pass,
                 fmt::format("{}: {:.3g} ms, limited by {}", pass.pass, pass.milliseconds(),
                             pass.limit()));
        x += width;
      }
      svg_.text({x + 6, y_ + kBar - 2}, "start", fmt::format("{:.3g}", frame.milliseconds()),
                kOverLines);
      y_ += kRow;
    }
    y_ += kGap;
  }
}

void Chart::draw_box(double x, double y, double width, const std::string& pass,
                     const std::string& title) {
  const auto place = static_cast<std::size_t>(std::ranges::find(names_, pass) - names_.begin());
  svg_.rectangle({x, y}, {width, kBar},
                 fmt::format("fill=\"{}\"", kColours[std::min(place, kColours.size() - 1)]), title);
}

void Chart::draw_legend() {
  double x = kLeft;
  for (const std::string& name : names_) {
    draw_box(x, y_ + 10, kBar, name, name);
    svg_.text({x + kBar + 6, y_ + 10 + kBar - 2}, "start", name);
    x += kBar + 26 + 7.0 * static_cast<double>(name.size());
  }
  y_ += kLegend;
}

}  // namespace

std::string draw_chart(std::span<const SettingsCost> costs) { return Chart(costs).draw(); }

}  // namespace alcove::sample
