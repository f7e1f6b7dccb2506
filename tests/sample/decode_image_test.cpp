#include "support/decode_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "gltf_maker.h"
#include "image_maker.h"

namespace alcove::sample {
namespace {

using testing::HasSubstr;

tl::expected<DecodedImage, std::string> decoded(const std::vector<uint8_t>& bytes,
                                                uint32_t reduction = 1) {
  const auto header = read_image_header(bytes);
  if (!header) return tl::unexpected(header.error());
  return decode_image(bytes, *header, reduction);
}

std::vector<uint8_t> gradient(uint32_t width, uint32_t height, uint32_t components) {
  std::vector<uint8_t> out;
  for (uint32_t y = 0; y < height; ++y) {
    for (uint32_t x = 0; x < width; ++x)
      for (uint32_t c = 0; c < components; ++c)
        out.push_back(static_cast<uint8_t>(40 + 2 * x + y + 20 * c));
  }
  return out;
}

PngRecipe gradient_png(int colour_type, bool interlaced) {
  PngRecipe recipe{13, 11, colour_type, 8, interlaced};
  const auto samples = gradient(13, 11, static_cast<uint32_t>(recipe.channels()));
  recipe.samples.assign(samples.begin(), samples.end());
  return recipe;
}

TEST(DecodeImage, PngOfEachColourTypeAndDepthDecodesToRgbaOfEightBits) {
  const std::vector<png_color> palette = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}};
  struct Case {
    PngRecipe png;  // of three pixels in a row
    std::vector<uint8_t> rgb, alpha;
  };
  const std::vector<uint8_t> opaque(3, 255);
  const Case cases[] = {
      {{3, 1, PNG_COLOR_TYPE_GRAY, 1, false, {0, 1, 1}},
       {0, 0, 0, 255, 255, 255, 255, 255, 255},
       opaque},
      {{3, 1, PNG_COLOR_TYPE_GRAY, 2, false, {1, 2, 3}},
       {85, 85, 85, 170, 170, 170, 255, 255, 255},
       opaque},
      {{3, 1, PNG_COLOR_TYPE_GRAY, 4, true, {0, 1, 15}},
       {0, 0, 0, 17, 17, 17, 255, 255, 255},
       opaque},
      {{3, 1, PNG_COLOR_TYPE_GRAY, 16, true, {0, 0x01c0, 0xffff}},
       {0, 0, 0, 2, 2, 2, 255, 255, 255},
       opaque},
      {{3, 1, PNG_COLOR_TYPE_PALETTE, 2, false, {3, 1, 0}, palette, {90, 100}},
       {10, 11, 12, 4, 5, 6, 1, 2, 3},
       {255, 100, 90}},
      {{3, 1, PNG_COLOR_TYPE_GRAY_ALPHA, 8, false, {1, 2, 3, 4, 5, 6}},
       {1, 1, 1, 3, 3, 3, 5, 5, 5},
       {2, 4, 6}},
      {{3, 1, PNG_COLOR_TYPE_RGB, 16, false, {0, 257, 514, 771, 1028, 1285, 1542, 1799, 2056}},
       {0, 1, 2, 3, 4, 5, 6, 7, 8},
       opaque},
      {{3, 1, PNG_COLOR_TYPE_RGB_ALPHA, 8, false, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}},
       {1, 2, 3, 5, 6, 7, 9, 10, 11},
       {4, 8, 12}}};
  for (const Case& c : cases) {
    SCOPED_TRACE(testing::Message() << c.png.colour_type << " of " << c.png.bits << " bits");
    const auto image = decoded(make_png(c.png));
    ASSERT_TRUE(image) << image.error();
    for (size_t i = 0; i < 12; ++i)
      EXPECT_EQ(image->rgba.at(i), i % 4 == 3 ? c.alpha[i / 4] : c.rgb[i / 4 * 3 + i % 4]) << i;
  }
}

TEST(DecodeImage, InterlacedPngDecodesToTheSamePixels) {
  const auto plain = decoded(make_png(gradient_png(PNG_COLOR_TYPE_RGB, false)));
  const auto interlaced = decoded(make_png(gradient_png(PNG_COLOR_TYPE_RGB, true)));
  ASSERT_TRUE(plain && interlaced);
  EXPECT_EQ(interlaced->rgba, plain->rgba);
  EXPECT_EQ(plain->rgba[4 * 13 + 1], 40 + 1 + 20);
}

TEST(DecodeImage, OneBitPngOf4096PixelsPerSideIsDecoded) {
  PngRecipe recipe{4096, 4096, PNG_COLOR_TYPE_GRAY, 1};
  recipe.samples.assign(size_t{4096} * 4096, 1);
  const auto image = decoded(make_png(recipe), 64);
  ASSERT_TRUE(image) << image.error();
  EXPECT_EQ(image->width, 64u);
  EXPECT_THAT(image->rgba, testing::Each(255));
}

// glTF 2.0 section 3.8.3: colour space information is ignored.
TEST(DecodeImage, GammaOfAPngIsIgnored) {
  PngRecipe recipe{1, 1, PNG_COLOR_TYPE_GRAY, 8};
  recipe.samples = {100};
  recipe.gamma = 0.2;
  const auto image = decoded(make_png(recipe));
  ASSERT_TRUE(image) << image.error();
  EXPECT_THAT(image->rgba, testing::ElementsAre(100, 100, 100, 255));
}

TEST(DecodeImage, GreyRgbAndCmykJpegsDecodeToTheirPixels) {
  const uint32_t width = 37, height = 21;
  for (const bool progressive : {false, true}) {
    for (const auto& [space, components] :
         {std::pair{JCS_GRAYSCALE, 1u}, {JCS_RGB, 3u}, {JCS_CMYK, 4u}}) {
      const auto pixels = gradient(width, height, components);
      const auto image = decoded(make_jpeg(width, height, space, pixels, progressive));
      ASSERT_TRUE(image) << image.error();
      ASSERT_EQ(image->width, width);
      ASSERT_EQ(image->height, height);
      for (size_t i = 0; i < size_t{width} * height; ++i) {
        for (uint32_t c = 0; c < 3; ++c) {
          const uint8_t* in = &pixels[i * components];
          const int expected = components == 1   ? in[0]
                               : components == 3 ? in[c]
                                                 : in[c] * in[3] / 255;
          ASSERT_NEAR(image->rgba[4 * i + c], expected, 8) << i;
        }
        ASSERT_EQ(image->rgba[4 * i + 3], 255);
      }
    }
  }
}

TEST(DecodeImage, ReducedImageAveragesBlocksOfPixelsAlsoAtTheEdges) {
  PngRecipe recipe{5, 3, PNG_COLOR_TYPE_GRAY, 8};
  recipe.samples = {0, 10, 20, 30, 40, 20, 30, 40, 50, 60, 7, 9, 11, 13, 15};
  for (const bool interlaced : {false, true}) {
    recipe.interlaced = interlaced;
    const auto image = decoded(make_png(recipe), 2);
    ASSERT_TRUE(image) << image.error();
    EXPECT_EQ(image->width, 3u);
    EXPECT_EQ(image->height, 2u);
    std::vector<int> red;
    for (size_t i = 0; i < image->rgba.size(); i += 4) red.push_back(image->rgba[i]);
    EXPECT_THAT(red, testing::ElementsAre(15, 35, 50, 8, 12, 15));
  }
  const auto jpeg = decoded(make_jpeg(64, 32, JCS_GRAYSCALE, std::vector<uint8_t>(2048, 90)), 16);
  ASSERT_TRUE(jpeg) << jpeg.error();
  EXPECT_EQ(jpeg->width, 4u);
  EXPECT_EQ(jpeg->height, 2u);
  EXPECT_NEAR(jpeg->rgba[0], 90, 1);
}

TEST(DecodeImage, ImagesOtherThanPngAndJpegAreRefused) {
  for (const std::string& text :
       {std::string("P5 8000 8000 65535\n") + std::string(100, '\0'), std::string("GIF89a"),
        std::string("BM"), std::string("#?RADIANCE\n"), std::string("\0\0\2", 3), std::string()}) {
    const auto image = decoded(text_bytes(text));
    ASSERT_FALSE(image);
    EXPECT_THAT(image.error(), HasSubstr("not a PNG or JPEG"));
  }
}

// The decoder must not invent pixels for the missing part of a file.
TEST(DecodeImage, TruncatedImageIsRefusedUnlessAllItsPixelsArePresent) {
  for (const auto& whole : {make_png(gradient_png(PNG_COLOR_TYPE_RGB, false)),
                            make_png(gradient_png(PNG_COLOR_TYPE_GRAY_ALPHA, true)),
                            make_jpeg(37, 21, JCS_RGB, gradient(37, 21, 3)),
                            make_jpeg(37, 21, JCS_RGB, gradient(37, 21, 3), true)}) {
    const auto expected = decoded(whole);
    ASSERT_TRUE(expected);
    for (size_t size = 0; size < whole.size(); ++size) {
      const auto image = decoded({whole.begin(), whole.begin() + static_cast<ptrdiff_t>(size)});
      if (image) {
        EXPECT_EQ(image->rgba, expected->rgba) << size << " of " << whole.size();
      }
    }
  }
}

TEST(DecodeImage, DamagedBytesDoNotCrashTheDecoder) {
  for (auto bytes : {make_png(gradient_png(PNG_COLOR_TYPE_RGB, true)),
                     make_jpeg(37, 21, JCS_RGB, gradient(37, 21, 3)),
                     make_jpeg(37, 21, JCS_CMYK, gradient(37, 21, 4), true)}) {
    for (uint8_t& byte : bytes) {
      const uint8_t good = byte;
      for (const int bit : {0, 3, 7}) {
        byte = static_cast<uint8_t>(good ^ 1u << bit);
        const auto header = read_image_header(bytes);
        if (header && uint64_t{header->width} * header->height < 1'000'000)
          (void)decode_image(bytes, *header, 2);
      }
      byte = good;
    }
  }
}

TEST(DecodeImage, ImageThatClaimsMorePixelsThanItsBytesCanHoldIsRefusedFromItsHeader) {
  EXPECT_FALSE(read_image_header(make_png_promise(8192, 8192, 10'000)));
  EXPECT_TRUE(read_image_header(make_png_promise(8192, 8192, 300'000)));
}

// Where a marker of a JPEG begins, from `start` on.
size_t marker(const std::vector<uint8_t>& jpeg, uint8_t kind, size_t start = 2) {
  const std::array<uint8_t, 2> wanted{0xff, kind};
  return static_cast<size_t>(std::search(jpeg.begin() + static_cast<ptrdiff_t>(start), jpeg.end(),
                                         wanted.begin(), wanted.end()) -
                             jpeg.begin());
}

TEST(DecodeImage, JpegWithHundredsOfScansIsRefused) {
  auto jpeg = make_jpeg(64, 64, JCS_GRAYSCALE, gradient(64, 64, 1), true);
  // Refine the last scan over and over: 0xda begins a scan, 0xd9 ends the image.
  const size_t end = jpeg.size() - 2;
  size_t last = 0;
  for (size_t at = marker(jpeg, 0xda); at < end; at = marker(jpeg, 0xda, at + 1)) last = at;
  const std::vector<uint8_t> scan(jpeg.begin() + static_cast<ptrdiff_t>(last),
                                  jpeg.begin() + static_cast<ptrdiff_t>(end));
  jpeg.resize(end);
  for (int i = 0; i < 200; ++i) jpeg.insert(jpeg.end(), scan.begin(), scan.end());
  jpeg.insert(jpeg.end(), {0xff, 0xd9});
  EXPECT_FALSE(decoded(jpeg));
}

TEST(DecodeImage, LargeProgressiveJpegIsRefusedBeforeItsMemoryIsAllocated) {
  auto jpeg = make_jpeg(64, 64, JCS_RGB, gradient(64, 64, 3), true);
  const size_t frame = marker(jpeg, 0xc2);  // then length, precision, height, width
  jpeg[frame + 5] = jpeg[frame + 7] = 0x40;
  jpeg[frame + 6] = jpeg[frame + 8] = 0;
  jpeg.resize(jpeg.size() + 200'000);
  const auto header = read_image_header(jpeg);
  ASSERT_TRUE(header) << header.error();
  ASSERT_EQ(header->width, 0x4000u);
  const auto image = decode_image(jpeg, *header, 8);
  ASSERT_FALSE(image);
  EXPECT_THAT(image.error(), HasSubstr("512 MiB"));
}

}  // namespace
}  // namespace alcove::sample
