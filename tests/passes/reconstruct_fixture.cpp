#include "reconstruct_fixture.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <vector>

#include "maths/quantised_normal.h"
#include "maths/raw_occlusion.h"
#include "work/interleave_offset.h"
#include "work/view_parameters.h"

namespace alcove::passes {
namespace {

// Packs the raw occlusion as the pass gtao stores it, with the depth and the normal of the traced
// pixel of each tile.
HostImage packed_raw_occlusion(const View& view, const Drawing& drawing,
                               const HostImage& raw_occlusion, std::uint32_t tile_size,
                               std::uint32_t index) {
  const HostImage& depth = drawing.depth_ndc;
  const auto projection =
      maths::make_projection(to_mat4(view.clip_from_view), depth.width, depth.height);
  const maths::vec2 from_ndc = inverse_depth_from_ndc(projection.value());
  const InterleaveOffset interleave_offset = interleave_offset_of(tile_size, index);
  HostImage packed = raw_occlusion;
  for (std::uint32_t y = 0; y < packed.height; ++y) {
    for (std::uint32_t x = 0; x < packed.width; ++x) {
      const std::uint32_t px = std::min(x * tile_size + interleave_offset.x, depth.width - 1);
      const std::uint32_t py = std::min(y * tile_size + interleave_offset.y, depth.height - 1);
      const float ndc = depth.at(px, py);
      const maths::vec3 normal(drawing.normal_vs.at(px, py, 0), drawing.normal_vs.at(px, py, 1),
                               drawing.normal_vs.at(px, py, 2));
      float* texel = &packed.texels[(std::size_t{y} * packed.width + x) * 2];
      maths::RawOcclusion sums;
      sums.visible = texel[0];
      sums.open = texel[1];
      texel[0] =
          std::bit_cast<float>(maths::pack_raw_occlusion(sums, maths::quantise_normal(normal)));
      texel[1] = maths::inverse_depth_of_ndc(from_ndc, ndc, is_perspective(projection.value()),
                                             is_reversed(projection.value()));
    }
  }
  return packed;
}

// Returns the texels of R16_UNORM, two in the bits of each float.
HostImage with_16_bits(const HostImage& depth) {
  std::vector<std::uint16_t> values;
  for (const float texel : depth.texels)
    values.push_back(static_cast<std::uint16_t>(std::lround(texel * 65535.0f)));
  HostImage packed{depth.width, depth.height, std::vector<float>((values.size() + 1) / 2), 1};
  std::memcpy(packed.texels.data(), values.data(), values.size() * sizeof(values[0]));
  return packed;
}

}  // namespace

HostImage Reconstruct::reconstruct(const Input& input, const OcclusionSettings& settings) {
  run([&](framegraph::Graph& graph) {
    if (input.reset) graph.reset_history("occlusion");
    Frame frame{graph,       gpu().kernels(),     input.view,
                input.index, input.previous_view, input.static_frames};
    frame.previous_size = input.previous_size;
    frame.largest_size = input.largest_size;
    ReconstructInputs inputs{
        {.depth_ndc = input.coarse_depth ? upload(graph, with_16_bits(input.drawing.depth_ndc),
                                                  VK_FORMAT_R16_UNORM)
                                         : upload(graph, input.drawing.depth_ndc),
         .normals = upload(graph, input.drawing.normal_vs),
         .normal_convention = {.in_view_space = true}},
        {.raw_occlusion =
             upload(graph,
                    packed_raw_occlusion(input.view, input.drawing, input.raw_occlusion,
                                         input.tile_size, input.index),
                    VK_FORMAT_R32G32_UINT),
         .tile_size = input.tile_size,
         .slices = input.slices}};
    if (input.motion != nullptr) inputs.motion = upload(graph, *input.motion);
    const auto outputs = add_reconstruct(frame, inputs, settings);
    ASSERT_TRUE(outputs) << outputs.error().message;
    read_back(graph, outputs->visibility);
  });
  return result();
}

HostImage Reconstruct::noise_raw_occlusion(std::mt19937& random) {
  std::uniform_real_distribution<float> noise(0.2f, 0.8f);
  return raw_occlusion_of(kWidth, kHeight,
                          [&](std::uint32_t, std::uint32_t) { return noise(random); });
}

HostImage Reconstruct::no_motion() {
  return {kWidth, kHeight, std::vector<float>(std::size_t{kWidth} * kHeight * 2), 2};
}

OcclusionSettings precise(std::uint32_t history_frames) {
  OcclusionSettings settings;
  settings.history_frames = history_frames;
  settings.precision = Precision::float32;
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
