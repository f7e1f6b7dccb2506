#include "support/image_io.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "support/whole_file.h"

namespace alcove::sample {
namespace {

Failure failure(const std::filesystem::path& file, const std::string& why) {
  return Failure("cannot write " + file.string() + ": " + why);
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
Result<void> check_complete_exr(const std::filesystem::path& file) {
  try {
    Imf::InputFile input(file.string().c_str());
    if (!input.isComplete()) return Failure("the disk is full");
  } catch (const std::exception& error) {
    return Failure(error.what());
  }
  return {};
}

// `names`: of the channels.
Result<void> write_exr_channels(const std::filesystem::path& file, const Channels& image,
                                const std::vector<const char*>& names) {
  if (!image.has_pixels()) return failure(file, "the image has no pixels");
  return write_whole(file, [&](const std::filesystem::path& temporary) -> Result<void> {
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
      return Failure(error.what());
    }
    return check_complete_exr(temporary);
  });
}

uint8_t to_byte(float value) {
  if (!(value > 0.0f)) return 0;
  return static_cast<uint8_t>(std::lround(std::min(value, 1.0f) * 255.0f));
}

Result<void> write_png_channels(const std::filesystem::path& file, const Channels& in) {
  if (!in.has_pixels()) return failure(file, "the image has no pixels");
  std::vector<uint8_t> pixels(in.values.size());
  std::ranges::transform(in.values, pixels.begin(), to_byte);
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

Result<void> write_exr(const std::filesystem::path& file, const Image<float>& image) {
  return write_exr_channels(file, channels(image), {"Y"});
}
Result<void> write_exr(const std::filesystem::path& file, const Image<glm::vec3>& image) {
  return write_exr_channels(file, channels(image), {"R", "G", "B"});
}

Result<void> write_png(const std::filesystem::path& file, const Image<float>& image) {
  return write_png_channels(file, channels(image));
}
Result<void> write_png(const std::filesystem::path& file, const Image<glm::vec3>& image) {
  return write_png_channels(file, channels(image));
}

}  // namespace alcove::sample
