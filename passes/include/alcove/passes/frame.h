// The common arguments of all passes of a frame: the graph, the kernels, and the view.
//
//   once:   Executor::create and Kernels::create, for the same number of frames in flight
//   frame:  wait for the fence of frame slot s;  graph.reset(); kernels.begin_frame(s);
//           import textures, add passes;  executor.record(graph, commands, {s})
#pragma once

#include <array>
#include <cstdint>

#include "alcove/framegraph/graph.h"
#include "alcove/passes/kernels.h"

namespace alcove::passes {

// 4x4 matrices, column-major: element (row r, column c) at 4 * c + r.
using Matrix = std::array<float, 16>;

inline constexpr Matrix kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

// A camera. View space is right-handed with the camera looking along -Z. `clip_from_view` maps view
// space to Vulkan clip space. It may be any perspective or orthographic projection: finite or
// infinite, reversed, off-centre, jittered, flipped in Y, or with its near plane at 0. AlcoveCamera
// (alcove.h) says how to convert the matrices of engines with other conventions, and which rounding
// errors are accepted.
struct View {
  Matrix clip_from_view = kIdentity;
  // A rotation or a reflection, followed by a translation. The matrix must not scale.
  Matrix view_from_world = kIdentity;

  bool operator==(const View&) const = default;
};

// The formats of results, and of intermediate results that other passes read.
enum class Precision : std::uint8_t {
  unorm8,   // visibility R8_UNORM, bent normals RGBA8_SNORM
  float16,  // R16_SFLOAT, RGBA16_SFLOAT: visibility within 2^-12
  float32,  // R32_SFLOAT, RGBA32_SFLOAT
};

// How a texture holds normals: AlcoveNormalEncoding (alcove_settings.h).
enum class NormalEncoding : std::uint8_t {
  signed_xyz,
  unsigned_xyz,
  octahedral,
  unsigned_octahedral,
};

// How normals are meant. AlcoveView (alcove.h) describes the fields.
struct NormalConvention {
  NormalEncoding encoding = NormalEncoding::signed_xyz;
  bool in_view_space = false;  // else in world space
  bool forward_z = false;
};

// The parts of images that the occlusion passes read and write: AlcoveView::read_area,
// written_area, output_x and output_y (alcove.h). If the size of `read` is zero, images are read
// and written as a whole.
struct ImageAreas {
  AlcoveArea read{};
  AlcoveArea written{};
  std::uint32_t output_x = 0;
  std::uint32_t output_y = 0;
};

// The arguments of every function that adds a pass to a frame: the graph, the kernels and the view.
// The referenced objects must stay alive until the frame is recorded.
struct Frame {
  framegraph::Graph& graph;
  Kernels& kernels;
  View view;
  std::uint32_t index = 0;  // frame number: rotates the noise and selects the traced pixels
  // The view of the previous frame, with which history is reprojected. It is not read if there is
  // no history: in the first frame, after a reset, and if `prepare` is true.
  View previous_view = view;
  std::uint32_t static_frames = 0;  // as AlcoveView::static_frames
  // Two sizes for dynamic resolution. With them, the history continues while the size of the depth
  // texture, or of ImageAreas::read, changes. Zero means the current size.
  VkExtent2D largest_size{};   // size of the history textures; a change discards the history
  VkExtent2D previous_size{};  // of the depth in the previous frame; at most largest_size
  ImageAreas areas;
  // Whether adding the passes creates all pipelines that frames of this view can need: for a first
  // frame, after a camera cut, in motion and while static. Declare such a frame in a separate graph
  // that is never recorded, while loading or before settings change. No frame then has to wait for
  // a pipeline.
  bool prepare = false;
};

}  // namespace alcove::passes
