#include "support/image_io.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <stb_image_write.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <random>
#include <span>
#include <system_error>

namespace alcove::sample {
namespace {

using Outcome = tl::expected<void, std::string>;

tl::unexpected<std::string> failure(const std::filesystem::path& file, const std::string& why) {
  return tl::unexpected<std::string>("cannot write " + file.string() + ": " + why);
}

constexpr const char* kPart = ".part";

// Beside the target, so that the rename stays on one file system; random, so that two processes
// that write the same file do not meet.
std::filesystem::path temporary_beside(const std::filesystem::path& file) {
  std::random_device random;
  std::filesystem::path temporary = file;
  temporary += kPart + std::to_string(random());
  return temporary;
}

// Temporary files of `file` whose writers were stopped: one is written within seconds.
void remove_abandoned(const std::filesystem::path& file) {
  namespace fs = std::filesystem;
  constexpr auto kAge = std::chrono::hours(1);
  const std::string start = file.filename().string() + kPart;
  std::error_code error;
  fs::directory_iterator entry(file.has_parent_path() ? file.parent_path() : fs::path("."), error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(start) || name.size() == start.size() ||
        name.find_first_not_of("0123456789", start.size()) != std::string::npos) {
      continue;
    }
    std::error_code ignored;
    const auto written = fs::last_write_time(entry->path(), ignored);
    if (!ignored && fs::file_time_type::clock::now() - written > kAge) {
      fs::remove(entry->path(), ignored);
    }
  }
}

// All of the bytes reach the disk's file or the caller hears of it: a full disk may show only when
// the buffer is flushed.
Outcome write_bytes(const std::filesystem::path& file, const void* bytes, size_t size) {
  std::FILE* stream = std::fopen(file.string().c_str(), "wb");
  if (!stream) return tl::unexpected<std::string>(std::strerror(errno));
  errno = 0;
  const bool written = std::fwrite(bytes, 1, size, stream) == size && std::fflush(stream) == 0;
  const int reason = errno;
  const bool closed = std::fclose(stream) == 0;
  if (written && closed) return {};
  return tl::unexpected<std::string>(std::strerror(written ? errno : reason));
}

Outcome check_writable_image(uint32_t width, uint32_t height, size_t pixels) {
  if (width == 0 || height == 0 || pixels != size_t{width} * height) {
    return tl::unexpected<std::string>("the image has no pixels");
  }
  return {};
}

// OpenEXR's file closes in a destructor that swallows errors, so a disk that fills up at the very
// end shows only in reading back.
Outcome check_complete_exr(const std::filesystem::path& file) {
  try {
    Imf::InputFile input(file.string().c_str());
    if (!input.isComplete()) return tl::unexpected<std::string>("the disk is full");
  } catch (const std::exception& error) {
    return tl::unexpected<std::string>(error.what());
  }
  return {};
}

// `channels`: their names in the order in which the floats of a pixel lie.
Outcome write_exr_channels(const std::filesystem::path& file, uint32_t width, uint32_t height,
                           const float* values, std::span<const char* const> channels) {
  return write_whole(file, [&](const std::filesystem::path& temporary) -> Outcome {
    try {
      Imf::Header header(static_cast<int>(width), static_cast<int>(height));
      header.compression() = Imf::ZIP_COMPRESSION;
      Imf::FrameBuffer frame;
      const size_t pixel = channels.size() * sizeof(float);
      for (size_t c = 0; c < channels.size(); ++c) {
        header.channels().insert(channels[c], Imf::Channel(Imf::FLOAT));
        auto* base = const_cast<char*>(reinterpret_cast<const char*>(values + c));
        frame.insert(channels[c], Imf::Slice(Imf::FLOAT, base, pixel, pixel * width));
      }
      Imf::OutputFile output(temporary.string().c_str(), header);
      output.setFrameBuffer(frame);
      output.writePixels(static_cast<int>(height));
    } catch (const std::exception& error) {
      return tl::unexpected<std::string>(error.what());
    }
    return check_complete_exr(temporary);
  });
}

// Reads `names`, one float each, interleaved.
tl::expected<std::vector<float>, std::string> read_exr_channels(const std::filesystem::path& file,
                                                                std::span<const std::string> names,
                                                                uint32_t& width, uint32_t& height) {
  const auto refuse = [&](const std::string& why) {
    return tl::unexpected<std::string>("cannot read " + file.string() + ": " + why);
  };
  try {
    Imf::InputFile input(file.string().c_str());
    const Imath::Box2i window = input.header().dataWindow();
    const int64_t columns = int64_t{window.max.x} - window.min.x + 1;
    const int64_t rows = int64_t{window.max.y} - window.min.y + 1;
    constexpr int64_t kLargestSide = 65536;
    if (columns < 1 || rows < 1 || columns > kLargestSide || rows > kLargestSide) {
      return refuse("its size is out of range");
    }
    std::error_code ignored;
    // ZIP reaches about 1000:1; a header that promises more than that is damaged.
    const auto promised = static_cast<uint64_t>(columns * rows);
    if (promised / 4096 > std::filesystem::file_size(file, ignored)) {
      return refuse("the file is too short for its size");
    }
    width = static_cast<uint32_t>(columns);
    height = static_cast<uint32_t>(rows);
    std::vector<float> values(promised * names.size());
    Imf::FrameBuffer frame;
    const size_t pixel = names.size() * sizeof(float);
    const ptrdiff_t first = window.min.x + ptrdiff_t{window.min.y} * static_cast<ptrdiff_t>(width);
    for (size_t c = 0; c < names.size(); ++c) {
      if (!input.header().channels().findChannel(names[c])) {
        return refuse("it has no channel " + names[c]);
      }
      char* base =
          reinterpret_cast<char*>(values.data() + c) - first * static_cast<ptrdiff_t>(pixel);
      frame.insert(names[c], Imf::Slice(Imf::FLOAT, base, pixel, pixel * width));
    }
    input.setFrameBuffer(frame);
    input.readPixels(window.min.y, window.max.y);
    return values;
  } catch (const std::exception& error) {
    return refuse(error.what());
  }
}

bool has_channel(const std::filesystem::path& file, const char* name) {
  try {
    return Imf::InputFile(file.string().c_str()).header().channels().findChannel(name) != nullptr;
  } catch (const std::exception&) {
    return false;
  }
}

uint8_t byte_of(float value) {
  if (!(value > 0.0f)) return 0;
  return static_cast<uint8_t>(std::lround(std::min(value, 1.0f) * 255.0f));
}

void append_bytes(void* context, void* data, int size) {
  auto* bytes = static_cast<std::vector<uint8_t>*>(context);
  const auto* first = static_cast<const uint8_t*>(data);
  bytes->insert(bytes->end(), first, first + size);
}

Outcome write_png_bytes(const std::filesystem::path& file, uint32_t width, uint32_t height,
                        int channels, const std::vector<uint8_t>& pixels) {
  return write_whole(file, [&](const std::filesystem::path& temporary) -> Outcome {
    std::vector<uint8_t> encoded;
    const int w = static_cast<int>(width);
    if (!stbi_write_png_to_func(append_bytes, &encoded, w, static_cast<int>(height), channels,
                                pixels.data(), w * channels)) {
      return tl::unexpected<std::string>("the image could not be encoded");
    }
    return write_bytes(temporary, encoded.data(), encoded.size());
  });
}

}  // namespace

tl::expected<void, std::string> create_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    return tl::unexpected("The folder " + folder.string() +
                          " could not be created: " + error.message() + ".");
  }
  const std::filesystem::path variant = temporary_beside(folder / "variant");
  if (auto written = write_bytes(variant, "", 0); !written) {
    return tl::unexpected("Nothing can be written to the folder " + folder.string() + ": " +
                          written.error() + ".");
  }
  std::filesystem::remove(variant, error);
  return {};
}

Outcome write_whole(const std::filesystem::path& file,
                    const std::function<Outcome(const std::filesystem::path&)>& write) {
  remove_abandoned(file);
  const std::filesystem::path temporary = temporary_beside(file);
  std::error_code reason;
  Outcome outcome = write(temporary);
  if (outcome) {
    std::filesystem::rename(temporary, file, reason);
    if (!reason) return {};
    outcome = tl::unexpected<std::string>(reason.message());
  }
  std::filesystem::remove(temporary, reason);
  return failure(file, outcome.error());
}

Outcome write_text(const std::filesystem::path& file, const std::string& text) {
  return write_whole(file, [&](const std::filesystem::path& temporary) {
    return write_bytes(temporary, text.data(), text.size());
  });
}

Outcome write_exr(const std::filesystem::path& file, const Image<float>& image) {
  constexpr std::array<const char*, 1> kNames = {"Y"};
  if (auto fine = check_writable_image(image.width, image.height, image.pixels.size()); !fine) {
    return failure(file, fine.error());
  }
  return write_exr_channels(file, image.width, image.height, image.pixels.data(), kNames);
}

Outcome write_exr(const std::filesystem::path& file, const Image<glm::vec3>& image) {
  constexpr std::array<const char*, 3> kNames = {"R", "G", "B"};
  if (auto fine = check_writable_image(image.width, image.height, image.pixels.size()); !fine) {
    return failure(file, fine.error());
  }
  return write_exr_channels(file, image.width, image.height, &image.pixels[0].x, kNames);
}

tl::expected<Image<float>, std::string> read_exr_grey(const std::filesystem::path& file) {
  const std::array<std::string, 1> names = {has_channel(file, "Y") ? "Y" : "R"};
  Image<float> image;
  auto values = read_exr_channels(file, names, image.width, image.height);
  if (!values) return tl::unexpected(values.error());
  image.pixels = std::move(*values);
  return image;
}

tl::expected<Image<glm::vec3>, std::string> read_exr_rgb(const std::filesystem::path& file) {
  const std::array<std::string, 3> names = {"R", "G", "B"};
  uint32_t width = 0, height = 0;
  auto values = read_exr_channels(file, names, width, height);
  if (!values) return tl::unexpected(values.error());
  Image<glm::vec3> image(width, height);
  std::memcpy(image.pixels.data(), values->data(), values->size() * sizeof(float));
  return image;
}

Outcome write_png(const std::filesystem::path& file, const Image<float>& image) {
  if (auto fine = check_writable_image(image.width, image.height, image.pixels.size()); !fine) {
    return failure(file, fine.error());
  }
  std::vector<uint8_t> pixels;
  pixels.reserve(image.pixels.size());
  for (const float value : image.pixels) pixels.push_back(byte_of(value));
  return write_png_bytes(file, image.width, image.height, 1, pixels);
}

Outcome write_png(const std::filesystem::path& file, const Image<glm::vec3>& image) {
  if (auto fine = check_writable_image(image.width, image.height, image.pixels.size()); !fine) {
    return failure(file, fine.error());
  }
  std::vector<uint8_t> pixels;
  pixels.reserve(image.pixels.size() * 3);
  for (const glm::vec3& value : image.pixels) {
    for (int c = 0; c < 3; ++c) pixels.push_back(byte_of(value[c]));
  }
  return write_png_bytes(file, image.width, image.height, 3, pixels);
}

}  // namespace alcove::sample
