#include "work/areas.h"

#include <string>

#include "work/number_text.h"

namespace alcove::passes {
namespace {

std::string area_text(const AlcoveArea& area) {
  return size_text({area.width, area.height}) + " pixels at (" + std::to_string(area.x) + ", " +
         std::to_string(area.y) + ")";
}

bool is_empty(const AlcoveArea& area) {
  return area.x == 0 && area.y == 0 && area.width == 0 && area.height == 0;
}

// Whether `size` pixels from `begin` on end within `end`.
bool fits(std::uint32_t begin, std::uint32_t size, std::uint64_t end) {
  return std::uint64_t{begin} + size <= end;
}

}  // namespace

AlcoveArea written_area(const WorkFrame& frame, VkExtent2D read) {
  const auto& [area, written, x, y] = frame.areas;
  return has_areas(frame) && !is_empty(written)
             ? AlcoveArea{written.x - area.x, written.y - area.y, written.width, written.height}
             : AlcoveArea{0, 0, read.width, read.height};
}

VkExtent2D output_size(const WorkFrame& frame, VkExtent2D written) {
  return {frame.areas.output_x + written.width, frame.areas.output_y + written.height};
}

tl::expected<void, Error> check_areas(const ImageAreas& areas, VkExtent2D whole) {
  const auto& [read, written, x, y] = areas;
  const auto refuse = [](const char* name, const AlcoveArea& area, const std::string& wanted) {
    return tl::unexpected(Error{"The area that is " + std::string(name) + " has " +
                                area_text(area) + "; " + wanted + "."});
  };
  if (is_empty(read)) {
    return is_empty(written) && x == 0 && y == 0
               ? tl::expected<void, Error>()
               : refuse("read", read, "it must be given with the area that is written");
  }
  for (const auto& [name, area] : {std::pair{"read", read}, {"written", written}})
    if (!is_empty(area) && (area.width == 0 || area.height == 0))
      return refuse(name, area, "each side must be at least 1");
  if (!fits(read.x, read.width, whole.width) || !fits(read.y, read.height, whole.height))
    return refuse("read", read, "it must lie within depth's " + size_text(whole));
  const bool inside = written.x >= read.x && written.y >= read.y &&
                      fits(written.x, written.width, std::uint64_t{read.x} + read.width) &&
                      fits(written.y, written.height, std::uint64_t{read.y} + read.height);
  return is_empty(written) || inside
             ? tl::expected<void, Error>()
             : refuse("written", written,
                      "it must lie within the area that is read, " + area_text(read));
}

std::string output_problem(const WorkFrame& frame, VkExtent2D written, VkExtent2D texture) {
  const auto& [read, area, x, y] = frame.areas;
  const bool room =
      fits(x, written.width, texture.width) && fits(y, written.height, texture.height);
  const bool same = texture.width == written.width && texture.height == written.height;
  if (has_areas(frame) ? room : same) return {};
  return "is " + size_text(texture) + " pixels; it needs " +
         (has_areas(frame) ? "room for " + area_text({x, y, written.width, written.height})
                           : size_text(written)) +
         ".";
}

tl::expected<void, Error> check_output(const WorkFrame& frame, VkExtent2D written,
                                       VkExtent2D texture, std::string_view name) {
  const std::string problem = output_problem(frame, written, texture);
  return problem.empty()
             ? tl::expected<void, Error>()
             : tl::unexpected(Error{"The texture for " + std::string(name) + " " + problem});
}

}  // namespace alcove::passes
