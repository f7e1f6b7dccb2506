#include <algorithm>
#include <array>
#include <iomanip>
#include <sstream>

#include "gpu_cost/cost_report.h"

namespace alcove::sample {
namespace {

constexpr double kWidth = 900;
constexpr double kLeft = 170;   // of the bars
constexpr double kRight = 130;  // for the totals
constexpr double kBar = 14;
constexpr double kRow = 18;
constexpr double kHeading = 44;  // of a part
constexpr double kLegend = 34;

// Told apart in print and by people who see no red or green (the palette of Okabe and Ito).
constexpr std::array<const char*, 7> kColours{"#0072b2", "#e69f00", "#009e73", "#cc79a7",
                                              "#56b4e9", "#d55e00", "#999999"};

void draw_text(std::ostream& out, double x, double y, const char* anchor, const std::string& text,
               const char* more = "") {
  out << "<text x=\"" << x << "\" y=\"" << y << "\" text-anchor=\"" << anchor << "\"" << more << ">"
      << text << "</text>\n";
}

void draw_box(std::ostream& out, double x, double y, double width, const char* colour,
              const std::string& title) {
  out << "<rect x=\"" << x << "\" y=\"" << y << "\" width=\"" << width << "\" height=\"" << kBar
      << "\" fill=\"" << colour << "\"><title>" << title << "</title></rect>\n";
}

std::string number(double value) {
  std::ostringstream out;
  out << std::setprecision(3) << value;
  return out.str();
}

// The passes in the order in which they appear, which is that of the colours.
std::vector<std::string> pass_names(std::span<const SettingsCost> costs) {
  std::vector<std::string> names;
  for (const SettingsCost& cost : costs) {
    for (const ModelledFrame& frame : cost.frames) {
      for (const ModelledPass& pass : frame.passes) {
        if (std::ranges::find(names, pass.pass) == names.end()) {
          names.push_back(pass.pass);
        }
      }
    }
  }
  return names;
}

const char* colour_of(const std::vector<std::string>& names, const std::string& pass) {
  const auto place = static_cast<std::size_t>(std::ranges::find(names, pass) - names.begin());
  return kColours[std::min(place, kColours.size() - 1)];
}

class Chart {
 public:
  explicit Chart(std::span<const SettingsCost> costs) : costs_(costs), names_(pass_names(costs)) {}

  std::string draw() {
    for (const GpuPart& part : kGpuParts) {
      draw_part(part);
    }
    draw_legend();
    std::ostringstream image;
    image << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << kWidth << "\" height=\"" << y_
          << "\" font-family=\"sans-serif\" font-size=\"12\">\n"
          << "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
          << body_.str() << "</svg>\n";
    return image.str();
  }

 private:
  void draw_part(const GpuPart& part);
  void draw_legend();

  std::span<const SettingsCost> costs_;
  std::vector<std::string> names_;
  std::ostringstream body_;
  double y_ = 0;
};

void Chart::draw_part(const GpuPart& part) {
  const PeerTime& peer = part.peers[2];
  double longest = peer.milliseconds;
  std::size_t rows = 0;
  for (const SettingsCost& cost : costs_) {
    for (const ModelledFrame& frame : cost.frames) {
      if (cost.family == part.family) {
        longest = std::max(longest, frame.milliseconds());
        ++rows;
      }
    }
  }
  if (rows == 0) {
    return;
  }
  const double scale = (kWidth - kLeft - kRight) / longest;
  draw_text(body_, 12, y_ + 20, "start", std::string(part.title) + ": modelled milliseconds",
            " font-weight=\"bold\"");
  const double top = y_ + kHeading;
  const double line = kLeft + peer.milliseconds * scale;
  draw_text(body_, line, top - 6, "middle",
            std::string(peer.name) + " " + number(peer.milliseconds));
  y_ = top;
  for (const SettingsCost& cost : costs_) {
    if (cost.family != part.family) {
      continue;
    }
    for (const ModelledFrame& frame : cost.frames) {
      draw_text(body_, kLeft - 8, y_ + kBar - 2, "end",
                cost.label + ", " + std::string(name_of(frame.state)));
      double x = kLeft;
      for (const ModelledPass& pass : frame.passes) {
        const double width = pass.milliseconds() * scale;
        draw_box(body_, x, y_, width, colour_of(names_, pass.pass),
                 pass.pass + ": " + number(pass.milliseconds()) + " ms, limited by " +
                     std::string(pass.limit()));
        x += width;
      }
      draw_text(body_, x + 6, y_ + kBar - 2, "start", number(frame.milliseconds()));
      y_ += kRow;
    }
    y_ += 6;
  }
  body_ << "<line x1=\"" << line << "\" y1=\"" << top - 2 << "\" x2=\"" << line << "\" y2=\"" << y_
        << "\" stroke=\"black\" stroke-dasharray=\"4 3\"/>\n";
}

void Chart::draw_legend() {
  double x = kLeft;
  for (const std::string& name : names_) {
    draw_box(body_, x, y_ + 10, kBar, colour_of(names_, name), name);
    draw_text(body_, x + kBar + 6, y_ + 10 + kBar - 2, "start", name);
    x += kBar + 26 + 7.0 * static_cast<double>(name.size());
  }
  y_ += kLegend;
}

}  // namespace

std::string chart_of(std::span<const SettingsCost> costs) { return Chart(costs).draw(); }

}  // namespace alcove::sample
