#include "support/read_hdr.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

namespace alcove::sample {
namespace {

using Rgbe = std::array<uint8_t, 4>;

struct Size {
  uint32_t width;
  uint32_t height;
};

// Reads the next line, without its end. Returns nothing at the end of the file, or if the line is
// longer than any line of a header.
std::optional<std::string> read_line(std::FILE* file) {
  constexpr size_t kLongest = 4096;  // bytes
  std::string line;
  for (int c = std::getc(file); c != EOF && line.size() < kLongest; c = std::getc(file)) {
    if (c == '\n') return line;
    line.push_back(static_cast<char>(c));
  }
  return std::nullopt;
}

// Reads a side after the name of its axis, such as 512 in "-Y 512". Returns 0 if there is none.
uint32_t read_side(std::string_view& text, std::string_view axis) {
  uint32_t value = 0;
  if (!text.starts_with(axis)) return 0;
  text.remove_prefix(axis.size());
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) return 0;
  text.remove_prefix(static_cast<size_t>(end - text.data()));
  return value;
}

Result<Size> read_size(const std::string& line) {
  std::string_view text = line;
  const uint32_t height = read_side(text, "-Y ");
  const uint32_t width = read_side(text, " +X ");
  if (height == 0 || width == 0)
    return Failure("has no size of the form \"-Y HEIGHT +X WIDTH\"; save it anew, unrotated");
  if (width > kLargestFloatSide || height > kLargestFloatSide) {
    return Failure("is " + std::to_string(width) + "x" + std::to_string(height) +
                   " pixels, and a side may have at most " + std::to_string(kLargestFloatSide));
  }
  return Size{width, height};
}

Result<Size> read_header(std::FILE* file) {
  constexpr int kMostLines = 1000;
  const auto first = read_line(file);
  if (!first || !(first->starts_with("#?RADIANCE") || first->starts_with("#?RGBE")))
    return Failure("is no Radiance file");
  for (int i = 0; i < kMostLines; ++i) {
    const auto line = read_line(file);
    if (!line) break;
    if (line->starts_with("FORMAT=") && !line->starts_with("FORMAT=32-bit_rle_rgbe"))
      return Failure("has pixels of another kind than 32-bit_rle_rgbe; save it anew");
    if (!line->empty()) continue;
    const auto size = read_line(file);
    return size ? read_size(*size) : Failure("is cut short");
  }
  return Failure("has a header without an end");
}

bool read_pixel(std::FILE* file, Rgbe& out) { return std::fread(out.data(), 1, 4, file) == 4; }

// Reads one channel of a row. A byte above 128 begins a run of one value; any other byte is the
// number of values that follow.
bool read_channel(std::FILE* file, std::vector<Rgbe>& row, size_t channel) {
  constexpr int kRun = 128;
  for (size_t x = 0; x < row.size();) {
    const int code = std::getc(file);
    if (code <= 0) return false;
    const bool run = code > kRun;
    const auto count = static_cast<size_t>(run ? code - kRun : code);
    if (count > row.size() - x) return false;
    int value = run ? std::getc(file) : 0;
    for (size_t i = 0; i < count; ++i) {
      if (!run) value = std::getc(file);
      if (value == EOF) return false;
      row[x++][channel] = static_cast<uint8_t>(value);
    }
  }
  return true;
}

// Reads a row in the old encoding, whose first pixel was already read. The pixel (1, 1, 1, n)
// repeats the previous pixel n times; several of them in succession are the digits of one larger n.
bool read_old_row(std::FILE* file, std::vector<Rgbe>& row, Rgbe pixel) {
  unsigned shift = 0;
  for (size_t x = 0; x < row.size();) {
    const bool repeats = pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1;
    if (repeats) {
      const uint64_t count = shift < 32 ? uint64_t{pixel[3]} << shift : UINT64_MAX;
      if (x == 0 || count > row.size() - x) return false;
      std::fill_n(row.begin() + static_cast<ptrdiff_t>(x), count, row[x - 1]);
      x += count;
      shift += 8;
    } else {
      row[x++] = pixel;
      shift = 0;
    }
    if (x < row.size() && !read_pixel(file, pixel)) return false;
  }
  return true;
}

bool read_row(std::FILE* file, std::vector<Rgbe>& row) {
  constexpr size_t kNarrowest = 8, kWidest = 32767;  // of the newer coding, by channels
  Rgbe first;
  if (!read_pixel(file, first)) return false;
  const size_t width = size_t{first[2]} << 8 | first[3];
  const bool by_channels = row.size() >= kNarrowest && row.size() <= kWidest && first[0] == 2 &&
                           first[1] == 2 && first[2] < 128;
  if (!by_channels) return read_old_row(file, row, first);
  if (width != row.size()) return false;
  for (size_t channel = 0; channel < 4; ++channel)
    if (!read_channel(file, row, channel)) return false;
  return true;
}

// Decodes pixels: mantissas in units of 1/256, and a common exponent with a bias of 128.
void decode(const std::vector<Rgbe>& row, std::vector<float>& out) {
  for (size_t x = 0; x < row.size(); ++x) {
    const float unit = row[x][3] == 0 ? 0.0f : std::ldexp(1.0f, row[x][3] - (128 + 8));
    for (size_t c = 0; c < 3; ++c) out[3 * x + c] = static_cast<float>(row[x][c]) * unit;
  }
}

}  // namespace

Result<void> read_hdr(std::FILE* file, const FloatRows& rows) {
  ALCOVE_TRY(const auto size, read_header(file));
  std::vector<Rgbe> row(size.width);
  std::vector<float> values(3 * size_t{size.width});
  rows.begin(size.width, size.height);
  for (uint32_t y = 0; y < size.height; ++y) {
    if (!read_row(file, row)) {
      return Failure("is damaged or cut short in row " + std::to_string(y) + " of " +
                     std::to_string(size.height));
    }
    decode(row, values);
    rows.row(values);
  }
  return {};
}

}  // namespace alcove::sample
