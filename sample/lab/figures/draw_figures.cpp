// alcove_figures FOLDER: draws the figures of passes/ALGORITHM.md with the functions that the
// shaders use, so that a figure cannot disagree with the code.
#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "figures/drawing.h"
#include "maths/gtao.h"
#include "maths/sampling.h"
#include "maths/slice.h"
#include "maths/visibility_bitmask.h"
#include "support/result.h"
#include "support/whole_file.h"
#include "work/interleave_offset.h"

namespace alcove::sample {
namespace {

using glm::vec2;
using glm::vec3;

constexpr const char* kSurface = "stroke=\"#333\" stroke-width=\"2.5\"";
constexpr const char* kThin = "stroke=\"#888\" stroke-width=\"1\"";
constexpr const char* kDashed = "stroke=\"#888\" stroke-width=\"1\" stroke-dasharray=\"5 4\"";
constexpr const char* kOpen = "fill=\"#bfe3f2\" fill-opacity=\"0.8\"";
constexpr const char* kOccluded = "fill=\"#f0b8a8\" fill-opacity=\"0.9\"";
constexpr const char* kHidden = "fill=\"#f6e3b0\" fill-opacity=\"0.9\"";

// A surface in the plane of a slice: x along the slice's direction, y along the view direction.
struct Profile {
  std::vector<vec2> surface;  // from left to right
  vec2 shaded;                // the shaded point
  vec2 normal;                // unit
  maths::Slice slice() const {
    return maths::make_slice(vec3(normal.x, 0, normal.y), vec3(1, 0, 0), vec3(0, 0, 1));
  }
};

// Returns a floor that is tilted to the left, with a block on either side. `slope` is the tangent
// of the angle between the floor's normal and the view direction.
Profile blocks() {
  const float slope = 0.25f;
  const auto floor = [&](float x) { return slope * x; };
  Profile p;
  p.surface = {{-4.0f, floor(-4.0f)}, {-2.6f, floor(-2.6f)}, {-2.6f, 0.9f}, {-1.9f, 1.2f},
               {-1.6f, floor(-1.6f)}, {1.7f, floor(1.7f)},   {1.9f, 2.1f},  {2.7f, 2.4f},
               {2.9f, floor(2.9f)},   {4.0f, floor(4.0f)}};
  p.shaded = {0, 0};
  p.normal = glm::normalize(vec2(-slope, 1.0f));
  return p;
}

// Returns the cosine of the angle between the view direction and the highest surface point on one
// side.
float horizon_of(const Profile& p, float side) {
  float horizon = -1.0f;
  for (const vec2 point : p.surface) {
    const vec2 offset = point - p.shaded;
    if (offset.x * side > 0.0f) horizon = std::max(horizon, glm::normalize(offset).y);
  }
  return horizon;
}

// Returns a circular sector between two directions, which are given as signed angles from the view
// direction in radians.
std::vector<vec2> circular_sector(vec2 centre, float radius, float from, float to) {
  std::vector<vec2> points{centre};
  for (int i = 0; i <= 32; ++i) {
    const float angle = from + (to - from) * static_cast<float>(i) / 32.0f;
    points.push_back(centre + radius * vec2(std::sin(angle), std::cos(angle)));
  }
  return points;
}

void draw_profile(Drawing& d, const Profile& p) {
  d.polyline(p.surface, kSurface);
  d.arrow(p.shaded, p.shaded + vec2(0, 2.2f), "#1f6f8b");
  d.text(p.shaded + vec2(0.08f, 2.1f), "v (view direction)");
  d.arrow(p.shaded, p.shaded + 1.5f * p.normal, "#b0502c");
  d.text(p.shaded + 1.55f * p.normal - vec2(0.05f, 0), "n (normal)", "end");
  d.circle(p.shaded, 4, "fill=\"#222\"");
}

Drawing slice_and_horizons() {
  const Profile p = blocks();
  const maths::Slice slice = p.slice();
  Drawing d({-4.2f, -1.4f}, {4.2f, 3.1f}, 80);
  std::array<float, 2> cosines{};
  std::array<float, 2> angles{};
  for (int i = 0; i < 2; ++i) {
    const float side = i == 0 ? 1.0f : -1.0f;
    cosines[i] = horizon_of(p, side);
    angles[i] = side * std::acos(std::max(cosines[i], maths::tangent_horizon(slice, side)));
  }
  d.polygon(circular_sector(p.shaded, 1.9f, angles[1], angles[0]), kOpen);
  draw_profile(d, p);
  for (const float angle : angles)
    d.line(p.shaded, p.shaded + 3.0f * vec2(std::sin(angle), std::cos(angle)), kDashed);
  d.text({2.05f, 2.75f}, "horizon h1");
  d.text({-2.75f, 1.45f}, "horizon h2", "end");
  const vec2 along(p.normal.y, -p.normal.x);
  d.line(p.shaded - 3.4f * along, p.shaded + 3.4f * along, kDashed);
  d.text(p.shaded - 3.3f * along + vec2(0, -0.28f), "tangent plane");
  const float visibility = maths::slice_visibility(slice, cosines[0], cosines[1]);
  d.text({0.0f, -1.15f},
         fmt::format("visible part of this slice: {:.3f}", visibility / maths::open_slice(slice)),
         "middle");
  return d;
}

// An occluder of a half-slice: front and back in the slice's plane, seen from the shaded point.
struct Box {
  vec2 front;
  vec2 back;
};

void draw_sectors(Drawing& d, const Profile& p, std::uint32_t occluded, float radius) {
  const maths::Slice slice = p.slice();
  const float per = maths::sectors_per_diamond_angle(slice, 1.0f);
  for (std::uint32_t i = 0; i < maths::kSectorCount; ++i) {
    const vec2 from = maths::diamond_angle_light(static_cast<float>(i) / per);
    const vec2 to = maths::diamond_angle_light(static_cast<float>(i + 1) / per);
    const bool hit = ((occluded >> i) & 1u) != 0;
    d.polygon({p.shaded, p.shaded + radius * from, p.shaded + radius * to},
              fmt::format("{} stroke=\"white\" stroke-width=\"1\"", hit ? kOccluded : kOpen));
  }
}

std::uint32_t sectors_of(const Profile& p, vec2 a, vec2 b) {
  const float per = maths::sectors_per_diamond_angle(p.slice(), 1.0f);
  return maths::sectors_between(maths::sector_position(per, a - p.shaded),
                                maths::sector_position(per, b - p.shaded));
}

Profile open_floor() {
  Profile p = blocks();
  p.surface = {{-1.0f, -0.25f}, {6.0f, 1.5f}};
  return p;
}

Drawing half_slice_sectors() {
  const Profile p = open_floor();
  Drawing d({-1.9f, -0.7f}, {6.2f, 3.9f}, 85);
  const Box post{{2.6f, 2.0f}, {2.6f, 1.5f}};
  draw_sectors(d, p, sectors_of(p, post.front, post.back), 3.6f);
  draw_profile(d, p);
  d.polygon({post.front, post.front + vec2(0.45f, 0), post.back + vec2(0.45f, 0), post.back},
            "fill=\"#777\" stroke=\"#333\"");
  d.text(post.front + vec2(0.1f, 0.15f), "depth sample");
  d.text(post.back + vec2(0.55f, 0.1f), "its back, one thickness behind");
  d.text({0.2f, -0.5f}, "32 sectors from the view direction to the tangent plane; red: occluded");
  return d;
}

Drawing connected_segment() {
  const Profile p = open_floor();
  Drawing d({-1.9f, -0.9f}, {6.7f, 3.9f}, 85);
  const std::array<vec2, 4> wall{{{2.2f, 0.9f}, {2.4f, 1.6f}, {2.7f, 2.4f}, {3.1f, 3.1f}}};
  std::uint32_t occluded = 0;
  for (std::size_t i = 0; i < wall.size(); ++i) {
    const vec2 previous = wall[i == 0 ? 0 : i - 1];
    occluded |= sectors_of(p, wall[i], previous);
    occluded |= sectors_of(p, wall[i], wall[i] - vec2(0, 0.3f));
  }
  draw_sectors(d, p, occluded, 3.6f);
  draw_profile(d, p);
  d.polyline({wall.begin(), wall.end()}, "stroke=\"#333\" stroke-width=\"2.5\"");
  for (const vec2 sample : wall) {
    d.circle(sample, 4, "fill=\"white\" stroke=\"#222\" stroke-width=\"2\"");
    d.line(sample, sample - vec2(0, 0.3f), "stroke=\"#b0502c\" stroke-width=\"2\"");
  }
  d.text(wall[3] + vec2(0.15f, 0.0f), "samples of one surface are connected:");
  d.text(wall[3] + vec2(0.15f, -0.22f), "the sectors between them are occluded");
  d.text(vec2(3.7f, 2.0f), "red: thickness behind each sample,");
  d.text(vec2(3.7f, 1.78f), "at most the width seen of its surface");
  d.text({-1.0f, -0.7f}, "Without the connection, light would leak between the samples of a wall.");
  return d;
}

Drawing hidden_volume() {
  const Profile p = open_floor();
  Drawing d({-1.9f, -0.9f}, {6.7f, 3.9f}, 85);
  const Box slat{{2.0f, 2.4f}, {2.0f, 2.0f}};
  const maths::Slice slice = p.slice();
  const vec2 tangent = maths::tangent_light(slice, 1.0f);
  draw_sectors(d, p, sectors_of(p, slat.front, slat.back), 3.6f);
  d.polygon({p.shaded, p.shaded + 3.6f * glm::normalize(slat.back), p.shaded + 3.6f * tangent},
            kHidden);
  draw_profile(d, p);
  d.polygon({slat.front, slat.front + vec2(0.9f, 0), slat.back + vec2(0.9f, 0), slat.back},
            "fill=\"#777\" stroke=\"#333\"");
  for (const float x : {2.0f, 2.9f}) d.line({x, 3.8f}, {x, 0.25f * x}, kDashed);
  d.text({3.0f, 3.4f}, "the eye sees the front of the occluder");
  d.text({3.7f, 2.1f}, "yellow: directions that pass behind it.");
  d.text({3.7f, 1.88f}, "A fraction of them counts as occluded,");
  d.text({3.7f, 1.66f}, "more the wider the occluder is.");
  d.text({-1.0f, -0.7f}, "The depth buffer does not show what stands between the dashed lines.");
  return d;
}

Drawing tile_interleave() {
  const int size = 8;
  Drawing d({-0.3f, -1.3f}, {19.4f, 8.5f}, 42);
  const auto row = [&](int y) { return static_cast<float>(size - 1 - y); };
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const vec2 low(static_cast<float>(x), row(y));
      std::uint32_t traced = 0;
      for (std::uint32_t frame = 0; frame < 4; ++frame) {
        const auto offset = passes::interleave_offset_of(2, frame);
        if (offset.x == static_cast<std::uint32_t>(x % 2) &&
            offset.y == static_cast<std::uint32_t>(y % 2))
          traced = frame;
      }
      d.polygon(
          {low, low + vec2(1, 0), low + vec2(1, 1), low + vec2(0, 1)},
          traced == 0 ? "fill=\"#bfe3f2\" stroke=\"#aaa\"" : "fill=\"white\" stroke=\"#aaa\"");
      d.text(low + vec2(0.5f, 0.35f), fmt::to_string(traced), "middle");
    }
  }
  for (int i = 0; i <= size; i += 2) {
    const auto at = static_cast<float>(i);
    d.line({at, 0}, {at, 8}, "stroke=\"#333\" stroke-width=\"2\"");
    d.line({0, at}, {8, at}, "stroke=\"#333\" stroke-width=\"2\"");
  }
  d.text({0, -0.5f}, "Tiles of 2x2 pixels. The number is the frame, modulo 4, in which");
  d.text({0, -1.0f}, "a pixel is traced; blue pixels are traced in frame 0.");
  // The slice directions of the tiles in frame 0.
  for (std::uint32_t y = 0; y < 4; ++y) {
    for (std::uint32_t x = 0; x < 4; ++x) {
      const maths::SliceNoise noise = maths::golden_pattern(glm::uvec2(x, y), 0, true);
      const float phi = maths::slice_angle(0, 1, noise.direction);
      const vec2 centre(11.4f + 2.0f * static_cast<float>(x), 7.0f - 2.0f * static_cast<float>(y));
      const vec2 half = 0.85f * vec2(std::cos(phi), std::sin(phi));
      d.polygon({centre - 1.0f, centre + vec2(1, -1), centre + 1.0f, centre + vec2(-1, 1)},
                "fill=\"none\" stroke=\"#333\"");
      d.line(centre - half, centre + half, "stroke=\"#b0502c\" stroke-width=\"2.5\"");
    }
  }
  d.text({10.4f, -0.5f}, "Slice directions of 4x4 tiles in frame 0. Every");
  d.text({10.4f, -1.0f}, "tile has another; they rotate from frame to frame.");
  return d;
}

Drawing history_reprojection() {
  Drawing d({-0.4f, -1.2f}, {17.0f, 7.2f}, 46);
  const auto grid = [&](float left, const char* title) {
    for (int i = 0; i <= 6; ++i) {
      const auto at = static_cast<float>(i);
      d.line({left + at, 0}, {left + at, 6}, kThin);
      d.line({left, at}, {left + 6, at}, kThin);
    }
    d.text({left + 3, 6.4f}, title, "middle");
  };
  // The four texels around a position in the previous frame. The second texel shows another
  // surface.
  const vec2 at(2.8f, 3.3f);
  const vec2 first(std::floor(at.x - 0.5f), std::floor(at.y - 0.5f));
  const vec2 part = at - 0.5f - first;
  for (int i = 0; i < 4; ++i) {
    const vec2 offset(static_cast<float>(i % 2), static_cast<float>(i / 2));
    const vec2 low = first + offset;
    const bool other = i == 1;
    d.polygon({low, low + vec2(1, 0), low + vec2(1, 1), low + vec2(0, 1)},
              other ? kOccluded : kOpen);
    const vec2 share = glm::mix(1.0f - part, part, offset);
    d.text(low + vec2(0.5f, offset.y > 0 ? 0.78f : 0.15f),
           other ? "0" : fmt::format("{:.2f}", share.x * share.y), "middle");
  }
  grid(0, "previous frame");
  grid(10, "this frame");
  const vec2 pixel(13.5f, 2.5f);
  d.polygon({pixel - 0.5f, pixel + vec2(0.5f, -0.5f), pixel + 0.5f, pixel + vec2(-0.5f, 0.5f)},
            "fill=\"#cfe8cf\"");
  d.arrow(pixel, at, "#b0502c");
  d.circle(at, 4, "fill=\"#b0502c\"");
  d.text(
      {0, -0.5f},
      "A pixel reads the four texels around its position in the previous frame. Texels of another");
  d.text({0, -1.0f},
         "depth (red) get no weight, the others their bilinear weight; the rest is divided out.");
  return d;
}

struct Figure {
  const char* name;
  Drawing (*draw)();
};

constexpr std::array<Figure, 6> kFigures{{{"slice_and_horizons", slice_and_horizons},
                                          {"half_slice_sectors", half_slice_sectors},
                                          {"connected_segment", connected_segment},
                                          {"hidden_volume", hidden_volume},
                                          {"tile_interleave", tile_interleave},
                                          {"history_reprojection", history_reprojection}}};

Result<void> draw_all(const std::filesystem::path& folder) {
  for (const Figure& figure : kFigures) {
    const auto written =
        write_text(folder / fmt::format("{}.svg", figure.name), figure.draw().svg());
    if (!written) return written;
  }
  return {};
}

}  // namespace
}  // namespace alcove::sample

int main(int count, char** arguments) {
  if (count != 2) {
    std::cerr << "alcove_figures FOLDER: draws the figures of passes/ALGORITHM.md as SVG files\n";
    return 2;
  }
  const auto drawn = alcove::sample::draw_all(arguments[1]);
  if (!drawn) {
    std::cerr << "alcove_figures: " << drawn.error() << "\n";
    return 1;
  }
}
