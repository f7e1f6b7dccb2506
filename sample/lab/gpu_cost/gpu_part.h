// The GPUs of the cost model.
#pragma once

#include <array>
#include <span>
#include <string_view>

namespace alcove::sample {

// The modelled time of a frame of another program.
struct PeerTime {
  std::string_view name;
  double milliseconds;
};

struct GpuPart {
  std::string_view family;  // as RADV_FORCE_FAMILY names it
  std::string_view title;
  bool rdna;  // true: RDNA2; false: GCN
  double compute_units;
  double simds;
  double hertz;
  double bytes_per_second;
  std::span<const PeerTime> peers;
};

// XeGTAO's own shaders (32-bit floats, one denoise pass) at 1920x1080 in this model.
inline constexpr std::array<PeerTime, 4> kXeGtaoOnGcn{
    {{"XeGTAO low", 1.56}, {"XeGTAO medium", 2.21}, {"XeGTAO high", 3.40}, {"XeGTAO ultra", 8.46}}};
inline constexpr std::array<PeerTime, 4> kXeGtaoOnRdna{{{"XeGTAO low", 0.123},
                                                        {"XeGTAO medium", 0.164},
                                                        {"XeGTAO high", 0.243},
                                                        {"XeGTAO ultra", 0.560}}};

inline constexpr std::array<GpuPart, 2> kGpuParts{
    {{"bonaire", "PS4-like GCN, 18 CUs, 800 MHz, 176 GB/s", false, 18, 72, 800e6, 176e9,
      kXeGtaoOnGcn},
     {"navi21", "RDNA2, 72 CUs, 2250 MHz, 512 GB/s", true, 72, 144, 2250e6, 512e9, kXeGtaoOnRdna}}};

}  // namespace alcove::sample
