#include "reconstruct_fixture.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "alcove/passes/line_depth.h"
#include "maths/coarse_normal.h"
#include "maths/signal.h"
#include "search_phase.h"
#include "view_parameters.h"

namespace alcove::passes {
namespace {

// The signal as a search would store it, with depth and normal of the pixel that it searched.
HostImage packed_signal(const View& view, const Drawing& drawing, const HostImage& signal,
                        std::uint32_t divisor, std::uint32_t index) {
  const HostImage& depth = drawing.depth_ndc;
  const auto projection =
      maths::make_projection(to_mat4(view.clip_from_view), depth.width, depth.height);
  const maths::vec2 from_ndc = line_from_ndc(projection.value());
  const SearchPhase phase = search_phase(divisor, index);
  HostImage packed = signal;
  for (std::uint32_t y = 0; y < packed.height; ++y) {
    for (std::uint32_t x = 0; x < packed.width; ++x) {
      const std::uint32_t px = std::min(x * divisor + phase.x, depth.width - 1);
      const std::uint32_t py = std::min(y * divisor + phase.y, depth.height - 1);
      const float ndc = depth.at(px, py);
      const maths::vec3 normal(drawing.normal_vs.at(px, py, 0), drawing.normal_vs.at(px, py, 1),
                               drawing.normal_vs.at(px, py, 2));
      float* texel = &packed.texels[(std::size_t{y} * packed.width + x) * 2];
      maths::Signal sums;
      sums.visible = texel[0];
      sums.open = texel[1];
      texel[0] =
          std::bit_cast<float>(maths::pack_signal(sums, maths::make_coarse_normal(normal).bits));
      texel[1] = from_ndc.x * ndc + from_ndc.y;
    }
  }
  return packed;
}

}  // namespace

HostImage Reconstruct::reconstruct(const Input& input, const ReconstructSettings& settings) {
  run([&](framegraph::Graph& graph) {
    if (input.reset) {
      graph.reset_history("occlusion");
    }
    const Frame frame{graph,       gpu().kernels(),     input.view,
                      input.index, input.previous_view, input.still_frames};
    const auto line = add_line_depth(frame, upload(graph, input.drawing.depth_ndc));
    ASSERT_TRUE(line) << line.error().message;
    ReconstructInputs inputs{
        .signal = {.signal = upload(graph,
                                    packed_signal(input.view, input.drawing, input.signal,
                                                  input.divisor, input.index),
                                    VK_FORMAT_R32G32_UINT),
                   .divisor = input.divisor,
                   .slices = input.slices},
        .line_depth = *line,
        .normals = upload(graph, input.drawing.normal_vs),
        .normals_in_view_space = true};
    if (input.motion != nullptr) {
      inputs.motion = upload(graph, *input.motion);
    }
    const auto made = add_reconstruct(frame, inputs, settings);
    ASSERT_TRUE(made) << made.error().message;
    read_back(graph, made->visibility);
  });
  return result();
}

HostImage Reconstruct::noise_signal(std::mt19937& random) {
  std::uniform_real_distribution<float> noise(0.2f, 0.8f);
  return signal_of(kWidth, kHeight, [&](std::uint32_t, std::uint32_t) { return noise(random); });
}

HostImage Reconstruct::no_motion() {
  return {kWidth, kHeight, std::vector<float>(std::size_t{kWidth} * kHeight * 2), 2};
}

ReconstructSettings precise(std::uint32_t reach, std::uint32_t history_frames) {
  ReconstructSettings settings;
  settings.filter_reach = reach;
  settings.history_frames = history_frames;
  settings.precision = Precision::float32;
  return settings;
}

HostImage constant_signal(std::uint32_t width, std::uint32_t height, float visibility) {
  return signal_of(width, height, [=](std::uint32_t, std::uint32_t) { return visibility; });
}

Drawing with_turned_normals(const Drawing& drawing, double degrees, std::uint32_t first) {
  Drawing turned = drawing;
  HostImage& normals = turned.normal_vs;
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
  return turned;
}

double variance(const HostImage& image) {
  double sum = 0.0;
  double squares = 0.0;
  for (const float texel : image.texels) {
    sum += texel;
    squares += double{texel} * texel;
  }
  const double count = static_cast<double>(image.texels.size());
  return squares / count - sum / count * (sum / count);
}

}  // namespace alcove::passes
