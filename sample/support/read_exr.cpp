#include "support/read_exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfTileDescription.h>

#include <algorithm>
#include <exception>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace alcove::sample {
namespace {

// Lets OpenEXR read a file that is already open. OpenEXR expects errors as exceptions.
class FileStream : public Imf::IStream {
 public:
  explicit FileStream(std::FILE* file) : IStream("the file"), file_(file) {}

  bool read(char* out, int size) override {
    if (size < 0 ||
        std::fread(out, 1, static_cast<size_t>(size), file_) != static_cast<size_t>(size))
      throw std::runtime_error("it is cut short");
    return true;
  }
  uint64_t tellg() override { return static_cast<uint64_t>(std::ftell(file_)); }
  void seekg(uint64_t position) override {
    if (position > INT64_MAX || std::fseek(file_, static_cast<long>(position), SEEK_SET) != 0)
      throw std::runtime_error("it is cut short");
  }
  void clear() override { std::clearerr(file_); }

 private:
  std::FILE* file_;
};

// Little-endian, as all of OpenEXR.
bool read_word(std::FILE* file, uint32_t& out) {
  uint8_t bytes[4];
  if (std::fread(bytes, 1, 4, file) != 4) return false;
  out = uint32_t{bytes[0]} | uint32_t{bytes[1]} << 8 | uint32_t{bytes[2]} << 16 |
        uint32_t{bytes[3]} << 24;
  return true;
}

// Reads a name up to its terminating zero.
bool read_name(std::FILE* file, std::string& out) {
  constexpr size_t kLongest = 255;  // bytes
  out.clear();
  for (int c = std::getc(file); c != EOF && out.size() <= kLongest; c = std::getc(file)) {
    if (c == 0) return true;
    out.push_back(static_cast<char>(c));
  }
  return false;
}

// Returns the size in bytes of an attribute type that has only one size, or 0 for other types. For
// such a type, OpenEXR reads that many bytes, whatever size the file states.
uint32_t fixed_size(const std::string& type) {
  struct Entry {
    std::string_view type;
    uint32_t size;
  };
  constexpr Entry kSizes[] = {{"box2f", 16},         {"box2i", 16},    {"chromaticities", 32},
                              {"compression", 1},    {"double", 8},    {"envmap", 1},
                              {"deepImageState", 1}, {"float", 4},     {"int", 4},
                              {"keycode", 28},       {"lineOrder", 1}, {"m33d", 72},
                              {"m33f", 36},          {"m44d", 128},    {"m44f", 64},
                              {"rational", 8},       {"tiledesc", 9},  {"timecode", 8},
                              {"v2d", 16},           {"v2f", 8},       {"v2i", 8},
                              {"v3d", 24},           {"v3f", 12},      {"v3i", 12}};
  const auto found = std::ranges::find(kSizes, type, &Entry::type);
  return found == std::end(kSizes) ? 0 : found->size;
}

// Returns whether the attribute is a valid list of channels: names, each followed by 16 bytes, up
// to an empty name.
bool is_channel_list(std::FILE* file, uint32_t size) {
  constexpr uint32_t kChannel = 16;
  std::string name;
  for (uint32_t left = size; read_name(file, name) && left > name.size();) {
    left -= static_cast<uint32_t>(name.size()) + 1;
    if (name.empty()) return left == 0;
    if (left < kChannel || std::fseek(file, kChannel, SEEK_CUR) != 0) return false;
    left -= kChannel;
  }
  return false;
}

// Returns whether the attribute is a valid list of strings, each after its length.
bool is_string_vector(std::FILE* file, uint32_t size) {
  uint32_t length = 0;
  while (size > 0) {
    if (size < 4 || !read_word(file, length) || length > size - 4) return false;
    size -= 4 + length;
    if (std::fseek(file, static_cast<long>(length), SEEK_CUR) != 0) return false;
  }
  return true;
}

// Returns whether the attribute is a valid preview: a width, a height and that many pixels.
bool is_preview(std::FILE* file, uint32_t size) {
  uint32_t width = 0, height = 0;
  return size >= 8 && read_word(file, width) && read_word(file, height) &&
         width <= kLargestFloatSide && height <= kLargestFloatSide &&
         uint64_t{4} * width * height == size - 8;
}

// Returns whether OpenEXR reads exactly `size` bytes for an attribute, and allocates no more memory
// than that.
bool has_size(std::FILE* file, const std::string& type, uint32_t size) {
  if (const uint32_t fixed = fixed_size(type); fixed != 0) return size == fixed;
  if (type == "chlist") return is_channel_list(file, size);
  if (type == "stringvector") return is_string_vector(file, size);
  if (type == "preview") return is_preview(file, size);
  return type != "floatvector" || size % 4 == 0;
}

// Checks the attributes of all headers, and returns to the beginning of the file. OpenEXR allocates
// memory for an attribute by the size that the file states, before it reads it.
Result<void> check_attributes(std::FILE* file) {
  constexpr uint32_t kMagic = 20000630, kMultiPart = 0x1000;
  const long end = std::fseek(file, 0, SEEK_END) == 0 ? std::ftell(file) : -1;
  std::rewind(file);
  uint32_t magic = 0, version = 0;
  if (!read_word(file, magic) || !read_word(file, version) || magic != kMagic)
    return Failure("is no OpenEXR file");
  std::string name, type;
  // A header ends with an empty name. The list of headers of a multi-part file ends with another
  // empty name.
  for (bool new_header = true;;) {
    if (!read_name(file, name)) return Failure("is cut short in its header");
    if (name.empty()) {
      if (new_header || (version & kMultiPart) == 0) break;
      new_header = true;
      continue;
    }
    new_header = false;
    uint32_t size = 0;
    if (!read_name(file, type) || !read_word(file, size))
      return Failure("is cut short in its header");
    const long begin = std::ftell(file);
    if (begin < 0 || int64_t{size} > int64_t{end} - begin || !has_size(file, type, size) ||
        std::fseek(file, begin + static_cast<long>(size), SEEK_SET) != 0)
      return Failure("is damaged: its attribute " + name + " has a wrong size");
  }
  std::rewind(file);
  return {};
}

struct Size {
  uint32_t width = 0;
  uint32_t height = 0;
  int first_row = 0;
  int first_column = 0;
};

uint64_t bytes_per_pixel(const Imf::Header& header) {
  uint64_t bytes = 0;
  const Imf::ChannelList& channels = header.channels();
  for (auto channel = channels.begin(); channel != channels.end(); ++channel)
    bytes += channel.channel().type == Imf::HALF ? 2 : 4;
  return bytes;
}

// Checks the sizes for which OpenEXR allocates memory, before it allocates any.
Result<Size> check_header(const Imf::Header& header) {
  if (header.hasType() && Imf::isDeepData(header.type()))
    return Failure("is a deep image; flatten it first");
  const Imath::Box2i& window = header.dataWindow();
  const int64_t width = int64_t{window.max.x} - window.min.x + 1;
  const int64_t height = int64_t{window.max.y} - window.min.y + 1;
  if (width < 1 || height < 1 || width > kLargestFloatSide || height > kLargestFloatSide) {
    return Failure("is " + std::to_string(width) + "x" + std::to_string(height) +
                   " pixels, and a side may have from 1 to " + std::to_string(kLargestFloatSide));
  }
  // A compressed block has at most 256 rows (DWAB). OpenEXR keeps one compressed and one
  // decompressed block in memory.
  constexpr uint64_t kMostRowBytes = uint64_t{1} << 20;
  const uint64_t pixel = bytes_per_pixel(header);
  if (static_cast<uint64_t>(width) * pixel > kMostRowBytes)
    return Failure("has rows of over 1 MiB; remove the channels that are not needed");
  if (header.hasTileDescription()) {
    constexpr uint64_t kMostTileRowBytes = uint64_t{1} << 28;
    const Imf::TileDescription& tiles = header.tileDescription();
    const uint64_t columns = std::max<uint64_t>(static_cast<uint64_t>(width), tiles.xSize);
    if (tiles.xSize > 2 * kLargestFloatSide || tiles.ySize > 2 * kLargestFloatSide ||
        columns * tiles.ySize * pixel > kMostTileRowBytes)
      return Failure("has tiles that are too large to be read");
  }
  return Size{static_cast<uint32_t>(width), static_cast<uint32_t>(height), window.min.y,
              window.min.x};
}

Result<void> read_checked(FileStream& stream, const ChooseChannels& choose, const FloatRows& rows) {
  // Opening reads the headers and no pixels.
  Imf::MultiPartInputFile file(stream, 0);
  const Imf::Header& header = file.header(0);
  ALCOVE_TRY(const auto size, check_header(header));
  const auto exists = [&](const std::string& name) {
    return header.channels().findChannel(name) != nullptr;
  };
  const std::vector<std::string> names = choose(exists);
  const size_t pixel = names.size() * sizeof(float);
  std::vector<float> row(names.size() * size.width);
  Imf::FrameBuffer frame;
  for (size_t c = 0; c < names.size(); ++c) {
    if (!exists(names[c])) return Failure("has no channel " + names[c]);
    // The base of a slice is the address that column 0 would have, which may lie before the buffer.
    // All rows are read into the same memory.
    char* base = reinterpret_cast<char*>(row.data() + c) -
                 ptrdiff_t{size.first_column} * static_cast<ptrdiff_t>(pixel);
    frame.insert(names[c], Imf::Slice(Imf::FLOAT, base, pixel, 0));
  }
  Imf::InputPart part(file, 0);
  part.setFrameBuffer(frame);
  rows.begin(size.width, size.height);
  for (uint32_t y = 0; y < size.height; ++y) {
    const int line = size.first_row + static_cast<int>(y);
    part.readPixels(line, line);
    rows.row(row);
  }
  return {};
}

}  // namespace

Result<void> read_exr(std::FILE* file, const ChooseChannels& choose, const FloatRows& rows) {
  ALCOVE_TRY_VOID(check_attributes(file));
  try {
    FileStream stream(file);
    return read_checked(stream, choose, rows);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    return Failure(
        std::string("is no OpenEXR file that can be read; save it anew (OpenEXR says: ") +
        error.what() + ")");
  }
}

}  // namespace alcove::sample
