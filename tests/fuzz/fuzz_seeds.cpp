// fuzz_seeds FOLDER: writes small valid files for the fuzzers to begin with, a folder for each.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "draco_maker.h"
#include "image_maker.h"

namespace alcove::sample {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& file, const std::vector<uint8_t>& bytes) {
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << std::string(bytes.begin(), bytes.end());
}

GltfMaker rich_scene() {
  GltfMaker maker = painted(transformed({{"offset", {0, 0.5}}, {"rotation", 1}}),
                            {{"index", 0}, {"texCoord", 1}, {"scale", 0.5}});
  auto& attributes = maker.primitive()["attributes"];
  attributes["NORMAL"] = maker.add<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  attributes["TANGENT"] = maker.add<float>("VEC4", {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, -1});
  maker.primitive()["indices"] = maker.add<uint16_t>("SCALAR", {0, 1, 2});
  maker.json["accessors"][0]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", maker.view<uint8_t>({2})}, {"componentType", 5121}}},
      {"values", {{"bufferView", maker.view<float>({0, 2, 0})}}}};
  maker.json["samplers"] = {{{"wrapS", 33071}, {"minFilter", 9985}}};
  maker.json["textures"][0]["sampler"] = 0;
  maker.json["materials"][0]["alphaMode"] = "MASK";
  maker.json["nodes"] = {{{"mesh", 0}, {"children", {1}}, {"scale", {1, -1, 2}}, {"skin", 0}},
                         {{"camera", 0}, {"translation", {0, 0, 5}}}};
  maker.json["skins"] = {{{"joints", {1}}}};
  maker.json["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.5}}}}};
  maker.json["animations"] = nlohmann::json::array();
  return maker;
}

void write_scenes(const fs::path& folder) {
  GltfMaker jpeg = painted({{"index", 0}}, {{"index", 0}});
  jpeg.json["images"][0] = {
      {"bufferView", jpeg.view(make_jpeg(8, 8, JCS_RGB, std::vector<uint8_t>(192, 90)))}};
  int i = 0;
  for (const GltfMaker& maker :
       {GltfMaker::triangle(), rich_scene(), jpeg, draco_square(0), draco_square(1)}) {
    const std::string name = std::to_string(i++);
    write(folder / "gltf" / (name + ".gltf"), maker.gltf());
    write(folder / "gltf" / (name + ".glb"), maker.glb());
    write(folder / "glb" / (name + ".glb"), maker.glb());
  }
}

void write_images(const fs::path& folder) {
  int i = 0;
  for (const int type : {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                         PNG_COLOR_TYPE_RGB_ALPHA, PNG_COLOR_TYPE_PALETTE}) {
    for (const bool interlaced : {false, true}) {
      PngRecipe recipe{9, 5, type, interlaced && type != PNG_COLOR_TYPE_PALETTE ? 16 : 8,
                       interlaced};
      if (type == PNG_COLOR_TYPE_PALETTE) {
        recipe.bits = 4;
        recipe.palette.assign(16, {10, 200, 90});
        recipe.alphas = {0, 128};
      }
      for (int s = 0; s < 9 * 5 * recipe.channels(); ++s)
        recipe.samples.push_back(static_cast<uint16_t>(s * 37 & ((1 << recipe.bits) - 1)));
      write(folder / "png" / (std::to_string(i++) + ".png"), make_png(recipe));
    }
  }
  for (const bool progressive : {false, true}) {
    for (const auto& [space, components] :
         {std::pair{JCS_GRAYSCALE, 1u}, {JCS_RGB, 3u}, {JCS_CMYK, 4u}}) {
      std::vector<uint8_t> pixels;
      for (uint32_t p = 0; p < 24 * 17 * components; ++p)
        pixels.push_back(static_cast<uint8_t>(p * p));
      write(folder / "jpeg" / (std::to_string(i++) + ".jpg"),
            make_jpeg(24, 17, space, pixels, progressive));
    }
  }
}

}  // namespace
}  // namespace alcove::sample

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: fuzz_seeds FOLDER\n";
    return 2;
  }
  alcove::sample::write_scenes(argv[1]);
  alcove::sample::write_images(argv[1]);
}
