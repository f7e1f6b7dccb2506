// Tests mips, wrap modes, filters and sets of texture coordinates in the rasteriser and the ray
// tracer.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include "gpu/gpu_image.h"
#include "quad_test.h"
#include "reference/truth.h"

namespace alcove::sample {
namespace {

constexpr std::uint32_t kSize = 24;
constexpr float kByte = 1.0f / 255.0f;

const glm::u8vec4 kRed(255, 0, 0, 255);
const glm::u8vec4 kGreen(0, 255, 0, 255);
const glm::u8vec4 kBlack(0, 0, 0, 255);
const glm::u8vec4 kWhite(255);
const glm::u8vec4 kHole(255, 255, 255, 0);

TextureImage image_of(std::uint32_t width, std::uint32_t height,
                      const std::function<glm::u8vec4(std::uint32_t, std::uint32_t)>& texel) {
  TextureImage image{"made", width, height, {}};
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const glm::u8vec4 t = texel(x, y);
      image.rgba.insert(image.rgba.end(), {t.r, t.g, t.b, t.a});
    }
  }
  return image;
}

TextureImage checkerboard(std::uint32_t size) {
  return image_of(size, size, [](auto x, auto y) { return (x + y) % 2 == 0 ? kWhite : kBlack; });
}

Scene quad_of(const TextureImage& image, const Sampler& sampler = {}) {
  Scene scene = plain_quad();
  scene.images.push_back(image);
  scene.materials[0].base_color_texture.image = 0;
  scene.materials[0].base_color_texture.sampler = sampler;
  return scene;
}

GBuffer traced(const Scene& scene) {
  const auto rays = RayScene::create(scene);
  EXPECT_TRUE(rays);
  return cast_gbuffer(*rays, camera_at(3.0f), kSize, kSize);
}

class TextureTest : public QuadTest {
 protected:
  FrameImages drawn(const Scene& scene) { return QuadTest::draw(scene, kSize); }

  // Returns the only texel of the last mip.
  glm::u8vec4 last_mip(const TextureImage& image, VkFormat format) {
    const auto made = upload_image(gpu(), format, {image.width, image.height},
                                   std::as_bytes(std::span(image.rgba)));
    auto target = HostBuffer::create(gpu().device(), 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    EXPECT_TRUE(made && target);
    if (!made || !target) return {};
    const auto ran = gpu().run([&](Graph& graph) -> tl::expected<void, std::string> {
      add_read_back(graph, graph.import_texture("made", (*made)->import_to_read(kSampledState)),
                    **target, (*made)->mips() - 1);
      return {};
    });
    EXPECT_TRUE(ran) << ran.error();
    glm::u8vec4 texel;
    for (int c = 0; c < 4; ++c)
      texel[c] = static_cast<std::uint8_t>((*target)->bytes()[static_cast<std::size_t>(c)]);
    return texel;
  }
};

TEST_F(TextureTest, LastMipOfACheckerboardIsItsMeanInLinearLight) {
  const TextureImage image = checkerboard(16);
  // The sRGB value of 0.5 is 187.5. Each of the four mips adds a rounding error.
  EXPECT_NEAR(last_mip(image, VK_FORMAT_R8G8B8A8_SRGB).r, 188, 2);
  EXPECT_NEAR(last_mip(image, VK_FORMAT_R8G8B8A8_UNORM).r, 127.5, 2);
}

TEST_F(TextureTest, MipsOfAOneRowTextureHalveOnlyItsWidth) {
  const TextureImage image = image_of(8, 1, [](auto x, auto) { return x < 4 ? kRed : kGreen; });
  const glm::u8vec4 texel = last_mip(image, VK_FORMAT_R8G8B8A8_UNORM);
  EXPECT_NEAR(texel.r, 127.5, 1);
  EXPECT_NEAR(texel.g, 127.5, 1);
  EXPECT_EQ(texel.b, 0);
  EXPECT_EQ(texel.a, 255);
}

TEST_F(TextureTest, CheckerboardWithMipsFinerThanPixelsIsDrawnGrey) {
  for (const glm::vec3& albedo : drawn(quad_of(checkerboard(8 * kSize))).albedo.pixels)
    ASSERT_NEAR(albedo.g, 0.5f, 0.02f);
}

TEST_F(TextureTest, CheckerboardWithoutMipsFinerThanPixelsIsDrawnBlackOrWhite) {
  // A pixel covers eight and a third texels, so each pixel contains both colours.
  const Sampler sampler{.minify = Filter::nearest, .mips = MipFilter::none};
  const FrameImages images = drawn(quad_of(checkerboard(200), sampler));
  std::size_t white = 0;
  for (const glm::vec3& albedo : images.albedo.pixels) {
    ASSERT_TRUE(albedo.g < kByte || albedo.g > 1.0f - kByte) << albedo.g;
    white += albedo.g > 0.5f;
  }
  EXPECT_GT(white, images.albedo.pixels.size() / 4);
  EXPECT_LT(white, images.albedo.pixels.size() * 3 / 4);
}

TEST_F(TextureTest, RasteriserAndRayTracerUseTheMagnificationFilterOfTheSampler) {
  const TextureImage image = image_of(2, 1, [](auto x, auto) { return x == 0 ? kRed : kGreen; });
  for (const Filter filter : {Filter::nearest, Filter::linear}) {
    const Scene scene = quad_of(image, {.wrap_u = Wrap::clamp, .magnify = filter});
    const Image<glm::vec3> raster = drawn(scene).albedo, rays = traced(scene).albedo;
    for (std::uint32_t x = 0; x < kSize; ++x) {
      if (filter == Filter::nearest) {
        EXPECT_NEAR(raster.at(x, 3).r, x < kSize / 2 ? 1.0f : 0.0f, kByte) << x;
        EXPECT_NEAR(rays.at(x, 3).r, x < kSize / 2 ? 1.0f : 0.0f, kByte) << x;
      } else if (x == kSize / 2) {
        EXPECT_TRUE(raster.at(x, 3).r > 0.1f && raster.at(x, 3).r < 0.9f);
        EXPECT_TRUE(rays.at(x, 3).r > 0.1f && rays.at(x, 3).r < 0.9f);
      }
    }
  }
}

TEST_F(TextureTest, TextureWrapModesAgreeBetweenRasteriserAndRayTracer) {
  const TextureImage image = image_of(2, 2, [](auto x, auto y) {
    return x + y == 0 ? kBlack : x == 0 ? kGreen : y == 0 ? kRed : kWhite;
  });
  // The texture has two texels. These are the indices of the texels that are read at coordinates
  // from -1 to 2.
  const std::array<std::pair<Wrap, std::array<int, 6>>, 3> wraps{
      {{Wrap::repeat, {0, 1, 0, 1, 0, 1}},
       {Wrap::mirror, {1, 0, 0, 1, 1, 0}},
       {Wrap::clamp, {0, 0, 0, 1, 1, 1}}}};
  for (const auto& [wrap_u, across] : wraps) {
    for (const auto& [wrap_v, down] : wraps) {
      Scene scene = quad_of(image, {wrap_u, wrap_v, Filter::nearest});
      for (glm::vec2& uv : scene.meshes[0].uvs) uv = 3.0f * uv - 1.0f;
      const Image<glm::vec3> raster = drawn(scene).albedo, rays = traced(scene).albedo;
      for (std::uint32_t y = 0; y < kSize; ++y) {
        for (std::uint32_t x = 0; x < kSize; ++x) {
          const glm::vec2 expected(across[x / (kSize / 6)], down[y / (kSize / 6)]);
          ASSERT_LT(glm::distance(glm::vec2(raster.at(x, y)), expected), kByte) << x << ' ' << y;
          ASSERT_LT(glm::distance(glm::vec2(rays.at(x, y)), expected), kByte) << x << ' ' << y;
        }
      }
    }
  }
}

TEST_F(TextureTest, EachTextureIsReadWithItsOwnUvSet) {
  Scene scene = quad_of(image_of(2, 1, [](auto x, auto) { return x == 0 ? kRed : kGreen; }),
                        {.magnify = Filter::nearest});
  Material& material = scene.materials[0];
  material.metallic = 1.0f;
  material.metal_roughness_texture = material.base_color_texture;
  material.base_color_texture.uv_set = 1;
  Mesh& mesh = scene.meshes[0];
  mesh.second_uvs = mesh.uvs;
  for (glm::vec2& uv : mesh.second_uvs) uv.x = 1.0f - uv.x;
  const FrameImages raster = drawn(scene);
  const GBuffer rays = traced(scene);
  for (std::uint32_t x = 0; x < kSize; ++x) {
    const float right = x < kSize / 2 ? 0.0f : 1.0f;
    EXPECT_NEAR(raster.albedo.at(x, 5).r, right, kByte) << x;
    EXPECT_NEAR(raster.roughness.at(x, 5), right, kByte) << x;
    EXPECT_NEAR(rays.albedo.at(x, 5).r, right, kByte) << x;
    EXPECT_NEAR(rays.roughness.at(x, 5), right, kByte) << x;
  }
}

TEST_F(TextureTest, MissingUvSetReadsAsZero) {
  Scene scene = quad_of(image_of(2, 1, [](auto x, auto) { return x == 0 ? kRed : kGreen; }),
                        {.magnify = Filter::nearest});
  scene.materials[0].base_color_texture.uv_set = 1;
  const FrameImages raster = drawn(scene);
  const GBuffer rays = traced(scene);
  for (std::uint32_t i = 0; i < kSize * kSize; ++i) {
    ASSERT_EQ(raster.albedo.pixels[i], glm::vec3(1, 0, 0));
    ASSERT_EQ(rays.albedo.pixels[i], glm::vec3(1, 0, 0));
  }
}

// The number of textures exceeds the smallest limit that Vulkan allows for bound images.
TEST_F(TextureTest, MaterialsReadTheirOwnTexturesEvenIfThereAreMoreThanVulkanGuaranteesToBind) {
  constexpr std::uint32_t kCells = 12;  // cells of 2x2 pixels per axis
  Scene scene = plain_quad();
  const Mesh whole = scene.meshes[0];
  scene.meshes.clear();
  scene.materials.clear();
  const auto colour_of = [](std::uint32_t cell) {
    const std::uint32_t i = cell * 5 / 3;
    return glm::u8vec4(255 * (i & 1u), 255 * (i / 2 & 1u), 255 * (i / 4 & 1u), 255);
  };
  for (std::uint32_t i = 0; i < kCells * kCells; ++i) {
    Mesh cell = whole;
    cell.material = i;
    const glm::vec2 centre(glm::uvec2(i % kCells, i / kCells));
    for (glm::vec3& position : cell.positions) {
      position.x = (2.0f * centre.x + 1.0f + position.x) / kCells - 1.0f;
      position.y = 1.0f - (2.0f * centre.y + 1.0f - position.y) / kCells;
    }
    scene.meshes.push_back(cell);
    const glm::u8vec4 texel = colour_of(i);
    scene.images.push_back({"made", 1, 1, {texel.r, texel.g, texel.b, texel.a}});
    scene.materials.emplace_back();
    scene.materials.back().base_color_texture.image = static_cast<std::int32_t>(i);
  }
  const FrameImages raster = drawn(scene);
  for (std::uint32_t i = 0; i < kCells * kCells; ++i) {
    const glm::vec3 colour = glm::vec3(glm::u8vec3(colour_of(i))) / 255.0f;
    ASSERT_EQ(raster.albedo.at(i % kCells * 2, i / kCells * 2), colour) << "material " << i;
  }
}

TEST_F(TextureTest, AlphaThatEqualsTheCutoffOfAMaskIsDrawn) {
  Scene scene = plain_quad();
  Camera camera;
  camera.eye_ws = {0.37f, -0.61f, 1.7f};
  camera.target_ws = glm::vec3(0.0f);
  const std::vector<float> opaque = draw(scene, 64, camera).depth_ndc.pixels;
  scene.materials[0].alpha_mode = AlphaMode::mask;
  for (const float alpha : {0.1f, 0.35f, 0.5f, 0.7f, 1.0f}) {
    scene.materials[0].base_color.a = scene.materials[0].alpha_cutoff = alpha;
    EXPECT_EQ(draw(scene, 64, camera).depth_ndc.pixels, opaque) << alpha;
  }
}

TEST_F(TextureTest, AlphaMasksReadWithTheSecondUvSetAgreeWithTheRayTracerAndKeepTheirCoverage) {
  // One texel in four is opaque, so that the mean of any mip is below the cutoff. A pixel
  // covers 1.618 periods.
  Scene scene = quad_of(
      image_of(256, 256, [](auto x, auto y) { return x % 2 + y % 2 == 0 ? kWhite : kHole; }));
  scene.materials[0].alpha_mode = AlphaMode::mask;
  scene.materials[0].base_color_texture.uv_set = 1;
  Mesh& mesh = scene.meshes[0];
  for (const glm::vec2& uv : mesh.uvs) mesh.second_uvs.push_back(0.3034f * uv + 0.003f);
  std::ranges::fill(mesh.uvs, glm::vec2(0.0f));
  const Image<float> raster = drawn(scene).depth_ndc;
  const Image<float> rays = traced(scene).depth_vs;
  std::size_t solid = 0;
  for (std::size_t i = 0; i < raster.pixels.size(); ++i) {
    EXPECT_EQ(raster.pixels[i] < 1.0f, std::isfinite(rays.pixels[i])) << i;
    solid += raster.pixels[i] < 1.0f;
  }
  // The bilinear alpha is at least 0.5 on (1 - ln 2) / 2 of the surface.
  const double share = static_cast<double>(solid) / static_cast<double>(raster.pixels.size());
  EXPECT_NEAR(share, 0.153, 0.04);
}

}  // namespace
}  // namespace alcove::sample
