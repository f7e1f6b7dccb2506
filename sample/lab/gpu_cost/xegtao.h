// The modelled time of XeGTAO (Strugar and others, 2021), the peer that the tables compare with.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "gpu_cost/gpu_part.h"

namespace alcove::sample {

// A preset of XeGTAO. It traces every pixel.
struct XeGtao {
  std::string_view name;
  std::uint32_t slices;
  std::uint32_t steps;  // of a half-slice
};
inline constexpr std::array<XeGtao, 4> kXeGtao{
    {{"XeGTAO low", 1, 2}, {"XeGTAO medium", 2, 2}, {"XeGTAO high", 3, 3}, {"XeGTAO ultra", 9, 3}}};
inline constexpr const XeGtao& kXeGtaoHigh = kXeGtao[2];

// Returns the modelled time of a frame with one denoise pass, in milliseconds: the longer of
// arithmetic and of caches and memory for each pass, and the cost of its three dispatches.
[[nodiscard]] double xegtao_ms(const GpuPart& part, const XeGtao& preset, std::uint32_t width,
                               std::uint32_t height);

}  // namespace alcove::sample
