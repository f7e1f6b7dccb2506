#include "report/report_page.h"

#include <cstdint>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "report/page_html.h"
#include "support/image_io.h"

namespace alcove::sample {
namespace {

// Where Debian and npm install Chart.js.
constexpr const char* kChartFiles[] = {"/usr/share/nodejs/chart.js/dist/chart.min.js",
                                       "/usr/share/javascript/chart.js/chart.min.js",
                                       "/usr/share/javascript/chart.js/Chart.min.js",
                                       "/usr/lib/node_modules/chart.js/dist/chart.umd.js"};

std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string base64(const std::string& bytes) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t j = 0; j < 3; ++j)
      three = three << 8u | (i + j < bytes.size() ? static_cast<unsigned char>(bytes[i + j]) : 0u);
    for (std::size_t j = 0; j < 4; ++j)
      text += i + j > bytes.size() ? '=' : kDigits[three >> (18u - 6u * j) & 63u];
  }
  return text;
}

template <typename Pixel>
Result<std::string> encoded(const Image<Pixel>& image, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "picture.png";
  ALCOVE_TRY_VOID(write_png(file, image));
  const std::string bytes = read_file(file);
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  return "data:image/png;base64," + base64(bytes);
}

void replace(std::string& text, const std::string& what, const std::string& by) {
  if (const std::size_t at = text.find(what); at != std::string::npos)
    text.replace(at, what.size(), by);
}

// A script element ends at the first "</script", also within a string.
std::string within_script(std::string text) {
  for (std::size_t at = text.find("</"); at != std::string::npos; at = text.find("</", at + 3))
    text.replace(at, 2, "<\\/");
  return text;
}

}  // namespace

Result<std::string> data_uri(const Image<float>& image, const std::filesystem::path& folder) {
  return encoded(image, folder);
}

Result<std::string> data_uri(const Image<glm::vec3>& image, const std::filesystem::path& folder) {
  return encoded(image, folder);
}

Result<std::string> report_page(const nlohmann::ordered_json& data) {
  std::string chart;
  for (const char* file : kChartFiles) chart = chart.empty() ? read_file(file) : chart;
  if (chart.empty()) {
    return Failure(
        "The page needs Chart.js, which is not installed; on Debian, install the package "
        "libjs-chart.js.");
  }
  std::string page = kPageHtml;
  replace(page, "/*CHART*/", within_script(chart));
  replace(
      page, "/*DATA*/",
      within_script(data.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)));
  return page;
}

}  // namespace alcove::sample
