// The modelled time of XeGTAO (Strugar and others, 2021), the peer that the tables compare with.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "gpu_cost/gpu_part.h"

namespace alcove::sample {

// A preset of XeGTAO. It traces every pixel.
struct XeGtao {
  std::string_view name;
  std::uint32_t slices;
  std::uint32_t steps;  // of a half-slice
  // At 1920x1080 on each of kGpuParts, without its three dispatches. XeGTAO's own shaders (32-bit
  // floats) went through this project's instruction model once, and a test runs its accesses
  // through the caches.
  std::array<double, kGpuParts.size()> milliseconds;
};
inline constexpr std::array<XeGtao, 4> kXeGtao{{{"XeGTAO low", 1, 2, {1.645, .248, .135}},
                                                {"XeGTAO medium", 2, 2, {2.21, .331, .164}},
                                                {"XeGTAO high", 3, 3, {3.40, .491, .243}},
                                                {"XeGTAO ultra", 9, 3, {8.38, 1.143, .566}}}};
inline constexpr const XeGtao& kXeGtaoHigh = kXeGtao[2];
// The compiler of these times (NullDevice::compiler). Times of another's code are not compared with
// them.
inline constexpr std::string_view kXeGtaoCompiler = "radv, Mesa 22.3.6";

// Returns the modelled time of a frame with one denoise pass, in milliseconds. It grows with the
// number of pixels.
[[nodiscard]] inline double xegtao_ms(const GpuPart& part, const XeGtao& preset,
                                      std::uint32_t width, std::uint32_t height) {
  const double size = width * static_cast<double>(height) / (1920.0 * 1080.0);
  const auto index = static_cast<std::size_t>(&part - kGpuParts.data());
  return preset.milliseconds.at(index) * size + 3e3 * part.dispatch_seconds;
}

}  // namespace alcove::sample
