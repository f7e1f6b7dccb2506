#include "support/image_io.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "support/read_exr.h"
#include "support/regular_file.h"
#include "support/whole_file.h"

namespace alcove::sample {
namespace {

using Outcome = tl::expected<void, std::string>;

tl::unexpected<std::string> failure(const std::filesystem::path& file, const std::string& why) {
  return tl::unexpected<std::string>("cannot write " + file.string() + ": " + why);
}

// An image as its channels, interleaved.
struct Channels {
  uint32_t width;
  uint32_t height;
  size_t count;  // of channels
  std::span<const float> values;

  bool has_pixels() const {
    return !values.empty() && values.size() == count * size_t{width} * height;
  }
};

Channels channels(const Image<float>& image) {
  return {image.width, image.height, 1, image.pixels};
}
Channels channels(const Image<glm::vec3>& image) {
  const auto* first = reinterpret_cast<const float*>(image.pixels.data());
  return {image.width, image.height, 3, {first, 3 * image.pixels.size()}};
}

// Checks that a file is complete by reading it back. OpenEXR's destructor ignores errors when it
// closes the file, so a disk that becomes full at the end is not detected in any other way.
Outcome check_complete_exr(const std::filesystem::path& file) {
  try {
    Imf::InputFile input(file.string().c_str());
    if (!input.isComplete()) return tl::unexpected<std::string>("the disk is full");
  } catch (const std::exception& error) {
    return tl::unexpected<std::string>(error.what());
  }
  return {};
}

// `names`: of the channels.
Outcome write_exr_channels(const std::filesystem::path& file, const Channels& image,
                           const std::vector<const char*>& names) {
  if (!image.has_pixels()) return failure(file, "the image has no pixels");
  return write_whole(file, [&](const std::filesystem::path& temporary) -> Outcome {
    try {
      Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
      header.compression() = Imf::ZIP_COMPRESSION;
      Imf::FrameBuffer frame;
      const size_t pixel = image.count * sizeof(float);
      for (size_t c = 0; c < image.count; ++c) {
        header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
        auto* base = const_cast<char*>(reinterpret_cast<const char*>(image.values.data() + c));
        frame.insert(names[c], Imf::Slice(Imf::FLOAT, base, pixel, pixel * image.width));
      }
      Imf::OutputFile output(temporary.string().c_str(), header);
      output.setFrameBuffer(frame);
      output.writePixels(static_cast<int>(image.height));
    } catch (const std::exception& error) {
      return tl::unexpected<std::string>(error.what());
    }
    return check_complete_exr(temporary);
  });
}

// The selected channels of an EXR file, interleaved.
struct FloatImage {
  uint32_t width = 0;
  uint32_t height = 0;
  std::vector<float> values;
};

tl::expected<FloatImage, std::string> read_exr_channels(const std::filesystem::path& file,
                                                        const ChooseChannels& choose) {
  const auto refuse = [&](const std::string& why) {
    return tl::unexpected<std::string>("cannot read " + file.string() + ": it " + why);
  };
  const auto opened = open_regular_file(file);
  if (!opened) return refuse(opened.error());
  FloatImage image;
  const FloatRows rows{.begin =
                           [&](uint32_t width, uint32_t height) {
                             image.width = width;
                             image.height = height;
                           },
                       .row =
                           [&](std::span<const float> row) {
                             image.values.reserve(row.size() * image.height);
                             image.values.insert(image.values.end(), row.begin(), row.end());
                           }};
  if (auto read = read_exr(opened->get(), choose, rows); !read) return refuse(read.error());
  return image;
}

uint8_t byte_of(float value) {
  if (!(value > 0.0f)) return 0;
  return static_cast<uint8_t>(std::lround(std::min(value, 1.0f) * 255.0f));
}

Outcome write_png_channels(const std::filesystem::path& file, const Channels& in) {
  if (!in.has_pixels()) return failure(file, "the image has no pixels");
  std::vector<uint8_t> pixels(in.values.size());
  std::ranges::transform(in.values, pixels.begin(), byte_of);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = in.width;
  image.height = in.height;
  image.format = in.count == 1 ? PNG_FORMAT_GRAY : PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::vector<uint8_t> encoded(size);
  if (png_image_write_to_memory(&image, encoded.data(), &size, 0, pixels.data(), 0, nullptr) == 0)
    return failure(file, image.message);
  return write_bytes(file, encoded.data(), size);
}

}  // namespace

Outcome write_exr(const std::filesystem::path& file, const Image<float>& image) {
  return write_exr_channels(file, channels(image), {"Y"});
}
Outcome write_exr(const std::filesystem::path& file, const Image<glm::vec3>& image) {
  return write_exr_channels(file, channels(image), {"R", "G", "B"});
}

tl::expected<Image<float>, std::string> read_exr_grey(const std::filesystem::path& file) {
  auto read = read_exr_channels(file, [](const ChannelExists& exists) {
    return std::vector<std::string>{exists("Y") ? "Y" : "R"};
  });
  if (!read) return tl::unexpected(read.error());
  Image<float> image;
  image.width = read->width;
  image.height = read->height;
  image.pixels = std::move(read->values);
  return image;
}

tl::expected<Image<glm::vec3>, std::string> read_exr_rgb(const std::filesystem::path& file) {
  const auto read = read_exr_channels(file, [](const ChannelExists&) {
    return std::vector<std::string>{"R", "G", "B"};
  });
  if (!read) return tl::unexpected(read.error());
  Image<glm::vec3> image(read->width, read->height);
  std::memcpy(image.pixels.data(), read->values.data(), read->values.size() * sizeof(float));
  return image;
}

Outcome write_png(const std::filesystem::path& file, const Image<float>& image) {
  return write_png_channels(file, channels(image));
}
Outcome write_png(const std::filesystem::path& file, const Image<glm::vec3>& image) {
  return write_png_channels(file, channels(image));
}

}  // namespace alcove::sample
