#include "reconstruct_fixture.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <vector>

#include "maths/quantised_normal.h"
#include "maths/raw_occlusion.h"
#include "single_passes.h"
#include "work/interleave_offset.h"
#include "work/view_parameters.h"

namespace alcove::passes {
namespace {

// Packs the raw occlusion as the pass gtao stores it, with the depth and the normal of the traced
// pixel of each tile.
HostImage packed_raw_occlusion(const AlcoveCamera& view, const Drawing& drawing,
                               const HostImage& raw_occlusion, std::uint32_t tile_size,
                               std::uint32_t index) {
  const HostImage& depth = drawing.depth_ndc;
  const auto projection =
      maths::make_projection(to_mat4(view.clip_from_view), depth.width, depth.height);
  const maths::vec2 from_ndc = projection.value().inverse_depth_from_ndc;
  const InterleaveOffset interleave_offset = interleave_offset_of(tile_size, index);
  HostImage stored = raw_occlusion;
  for (std::uint32_t y = 0; y < stored.height; ++y) {
    for (std::uint32_t x = 0; x < stored.width; ++x) {
      const std::uint32_t px = std::min(x * tile_size + interleave_offset.x, depth.width - 1);
      const std::uint32_t py = std::min(y * tile_size + interleave_offset.y, depth.height - 1);
      const float ndc = depth.at(px, py);
      const maths::vec3 normal(drawing.normal_vs.at(px, py, 0), drawing.normal_vs.at(px, py, 1),
                               drawing.normal_vs.at(px, py, 2));
      float* texel = &stored.texels[(std::size_t{y} * stored.width + x) * 2];
      maths::RawOcclusion sums;
      sums.visible = texel[0];
      sums.open = texel[1];
      texel[0] =
          std::bit_cast<float>(maths::pack_raw_occlusion(sums, maths::quantise_normal(normal)));
      texel[1] = maths::inverse_depth_of_ndc(from_ndc, ndc, projection.value().perspective,
                                             projection.value().reversed);
    }
  }
  return stored;
}

}  // namespace

HostImage Reconstruct::reconstruct(const Input& input, const OcclusionSettings& settings) {
  run([&](framegraph::Graph& graph) {
    OcclusionSettings tile_settings = settings;
    tile_settings.tile_size = input.tile_size;
    tile_settings.slices = input.slices;
    if (input.reset) graph.reset_history("visibility history of view 0");
    AlcoveViewInfo info =
        view_info({.view = input.view,
                   .previous_view = input.previous_view,
                   .reset = input.reset,
                   .static_frames = input.static_frames,
                   .largest_size = input.largest_size,
                   .previous_size = input.previous_size,
                   .depth_format = input.coarse_depth ? VK_FORMAT_D16_UNORM : VK_FORMAT_UNDEFINED});
    info.settings = &tile_settings;
    ViewTextures textures{};
    textures[ALCOVE_IMAGE_DEPTH] =
        upload(graph, input.coarse_depth ? with_16_bits(input.drawing.depth_ndc)
                                         : input.drawing.depth_ndc);
    textures[ALCOVE_IMAGE_NORMALS] = upload(graph, input.drawing.normal_vs);
    if (input.motion != nullptr) textures[ALCOVE_IMAGE_MOTION] = upload(graph, *input.motion);
    textures[ALCOVE_IMAGE_VISIBILITY] = graph.create_texture(
        "visibility",
        {VK_FORMAT_R32_SFLOAT, sample::extent_of(graph, textures[ALCOVE_IMAGE_DEPTH])});
    const framegraph::Texture raw =
        upload(graph,
               packed_raw_occlusion(input.view, input.drawing, input.raw_occlusion, input.tile_size,
                                    input.index),
               VK_FORMAT_R32G32_UINT);
    add_passes(graph, gpu().pipelines(), info, input.index, textures,
               [&](GraphAdapter& work, const ViewInputs& view) {
                 const ResourceHandle raw_resource = work.list().add(
                     ALCOVE_RESOURCE_KIND_INPUT, "raw occlusion", VK_FORMAT_R32G32_UINT,
                     {input.raw_occlusion.width, input.raw_occlusion.height});
                 work.texture(raw_resource) = raw;
                 const auto outcome = describe_reconstruct(view, view.image(ALCOVE_IMAGE_DEPTH),
                                                           {.sums = raw_resource, .bent = {}});
                 ASSERT_TRUE(outcome) << outcome.error().message;
               });
    read_back(graph, textures[ALCOVE_IMAGE_VISIBILITY]);
  });
  return result();
}

HostImage Reconstruct::noise_raw_occlusion(std::mt19937& random) {
  std::uniform_real_distribution<float> noise(0.2f, 0.8f);
  return raw_occlusion_of(kWidth, kHeight,
                          [&](std::uint32_t, std::uint32_t) { return noise(random); });
}

HostImage Reconstruct::no_motion() { return uniform(kWidth, kHeight, {0.0f, 0.0f}); }

OcclusionSettings precise(std::uint32_t history_frames) {
  OcclusionSettings settings;
  settings.history_frames = history_frames;
  settings.precision = ALCOVE_PRECISION_FLOAT32;
  return settings;
}

HostImage constant_raw_occlusion(std::uint32_t width, std::uint32_t height, float visibility) {
  return raw_occlusion_of(width, height, [=](std::uint32_t, std::uint32_t) { return visibility; });
}

Drawing rotate_normals(const Drawing& drawing, double degrees, std::uint32_t first) {
  Drawing rotated = drawing;
  HostImage& normals = rotated.normal_vs;
  const float cosine = std::cos(glm::radians(static_cast<float>(degrees)));
  const float sine = std::sin(glm::radians(static_cast<float>(degrees)));
  for (std::size_t i = 0; i < normals.texels.size(); i += 4) {
    if (i / 4 % normals.width >= first) {
      const float x = normals.texels[i];
      const float z = normals.texels[i + 2];
      normals.texels[i] = cosine * x + sine * z;
      normals.texels[i + 2] = cosine * z - sine * x;
    }
  }
  return rotated;
}

double variance(const HostImage& image) {
  const double centre = mean(image);
  double sum = 0.0;
  for (const float texel : image.texels) sum += (texel - centre) * (texel - centre);
  return sum / static_cast<double>(image.texels.size());
}

}  // namespace alcove::passes
