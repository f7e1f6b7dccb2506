#pragma once

#include <png.h>
#include <zlib.h>

#include <cstdio>  // jpeglib.h needs it first

#include <jpeglib.h>

#include <cstdint>
#include <cstdlib>
#include <vector>

namespace alcove::sample {

// A PNG as the encoder gets it: `samples` has width * height * channels numbers of `bits` bits.
struct PngRecipe {
  uint32_t width = 1;
  uint32_t height = 1;
  int colour_type = PNG_COLOR_TYPE_GRAY;
  int bits = 8;
  bool interlaced = false;
  std::vector<uint16_t> samples;
  std::vector<png_color> palette;  // for PNG_COLOR_TYPE_PALETTE
  std::vector<uint8_t> alphas;     // of palette entries; may be empty
  double gamma = 0.0;              // value of a gAMA chunk; 0: no chunk

  int channels() const {
    switch (colour_type) {
      case PNG_COLOR_TYPE_GRAY_ALPHA:
        return 2;
      case PNG_COLOR_TYPE_RGB:
        return 3;
      case PNG_COLOR_TYPE_RGB_ALPHA:
        return 4;
      default:
        return 1;
    }
  }
};

inline std::vector<uint8_t> make_png(const PngRecipe& recipe) {
  std::vector<uint8_t> out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &out,
      [](png_structp writer, png_bytep bytes, size_t size) {
        auto& target = *static_cast<std::vector<uint8_t>*>(png_get_io_ptr(writer));
        target.insert(target.end(), bytes, bytes + size);
      },
      nullptr);
  png_set_IHDR(png, info, recipe.width, recipe.height, recipe.bits, recipe.colour_type,
               recipe.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
  if (!recipe.palette.empty())
    png_set_PLTE(png, info, recipe.palette.data(), static_cast<int>(recipe.palette.size()));
  if (!recipe.alphas.empty())
    png_set_tRNS(png, info, recipe.alphas.data(), static_cast<int>(recipe.alphas.size()), nullptr);
  if (recipe.gamma > 0.0) png_set_gAMA(png, info, recipe.gamma);
  png_write_info(png, info);
  // Samples are packed as PNG requires: the highest bits first, 16 bits as two bytes.
  const size_t per_row = size_t{recipe.width} * static_cast<size_t>(recipe.channels());
  const size_t row_bytes = (per_row * static_cast<size_t>(recipe.bits) + 7) / 8;
  std::vector<uint8_t> packed(row_bytes * recipe.height);
  for (size_t i = 0; i < recipe.samples.size(); ++i) {
    for (int bit = 0; bit < recipe.bits; ++bit) {
      const size_t at = i % per_row * static_cast<size_t>(recipe.bits) + static_cast<size_t>(bit);
      const unsigned value = recipe.samples[i] >> (recipe.bits - 1 - bit) & 1u;
      packed[i / per_row * row_bytes + at / 8] |= static_cast<uint8_t>(value << (7 - at % 8));
    }
  }
  std::vector<png_bytep> rows;
  for (uint32_t y = 0; y < recipe.height; ++y) rows.push_back(packed.data() + y * row_bytes);
  png_write_image(png, rows.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return out;
}

// An 8-bit RGB PNG of one colour.
inline std::vector<uint8_t> make_plain_png(uint32_t width, uint32_t height, uint8_t value) {
  PngRecipe recipe{.width = width, .height = height, .colour_type = PNG_COLOR_TYPE_RGB};
  recipe.samples.assign(size_t{width} * height * 3, value);
  return make_png(recipe);
}

// Returns a PNG whose header has this size and whose data are `padding` bytes of zeros.
inline std::vector<uint8_t> make_png_promise(uint32_t width, uint32_t height, size_t padding) {
  std::vector<uint8_t> out{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  const auto add_word = [&](size_t value) {
    for (int shift = 24; shift >= 0; shift -= 8)
      out.push_back(static_cast<uint8_t>(value >> shift));
  };
  add_word(13);
  out.insert(out.end(), {'I', 'H', 'D', 'R'});
  add_word(width);
  add_word(height);
  out.insert(out.end(), {8, 0, 0, 0, 0});
  add_word(crc32(0, &out[12], 17));
  add_word(padding);
  out.insert(out.end(), {'I', 'D', 'A', 'T'});
  out.resize(out.size() + padding + 4);
  return out;
}

// A JPEG of quality 95. `pixels` has width * height * components bytes; the colour space is one of
// JCS_GRAYSCALE, JCS_RGB (stored as YCbCr) and JCS_CMYK (stored inverted, as Adobe does).
inline std::vector<uint8_t> make_jpeg(uint32_t width, uint32_t height, J_COLOR_SPACE space,
                                      const std::vector<uint8_t>& pixels,
                                      bool progressive = false) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &bytes, &size);
  jpeg.image_width = width;
  jpeg.image_height = height;
  jpeg.input_components = space == JCS_GRAYSCALE ? 1 : space == JCS_RGB ? 3 : 4;
  jpeg.in_color_space = space;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 95, TRUE);
  if (progressive) jpeg_simple_progression(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  const size_t row_bytes = size_t{width} * static_cast<size_t>(jpeg.input_components);
  while (jpeg.next_scanline < height) {
    auto* row = const_cast<uint8_t*>(pixels.data() + jpeg.next_scanline * row_bytes);
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  std::vector<uint8_t> out(bytes, bytes + size);
  jpeg_destroy_compress(&jpeg);
  std::free(bytes);
  return out;
}

}  // namespace alcove::sample
