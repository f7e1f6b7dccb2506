#include "alcove/passes/linear_depth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "check_inputs.h"
#include "linear_depth_parameters.h"
#include "number_text.h"
#include "view_parameters.h"

namespace alcove::passes {

using framegraph::Range;
using framegraph::RecordContext;
using framegraph::Texture;

namespace {

constexpr std::uint32_t kMaxMips = 5;

std::uint32_t mips_that_fit(VkExtent3D extent, std::uint32_t wanted) {
  std::uint32_t mips = 1;
  while (mips < wanted && std::max(extent.width, extent.height) >> mips != 0) {
    ++mips;
  }
  return mips;
}

tl::expected<void, Error> check(const Frame& frame, Texture depth_ndc, std::uint32_t mips,
                                float reach) {
  if (mips < 1 || mips > kMaxMips) {
    return tl::unexpected(Error{"The depth pyramid was asked for " + std::to_string(mips) +
                                " mips; it must be 1 to " + std::to_string(kMaxMips) + "."});
  }
  if (mips > 1 && (!(reach > 0.0f) || !std::isfinite(reach))) {
    return tl::unexpected(Error{"The depth pyramid's reach is " + number_text(reach) +
                                "; it must be a length over 0 in the scene's units."});
  }
  const std::array<NamedInput, 1> needed{{{"depth", depth_ndc}}};
  return check_inputs(frame.graph, "depth pyramid", needed);
}

}  // namespace

tl::expected<Texture, Error> add_linear_depth(const Frame& frame, Texture depth_ndc,
                                              std::uint32_t mips, float reach) {
  if (auto good = check(frame, depth_ndc, mips, reach); !good) {
    return tl::unexpected(good.error());
  }
  const VkExtent3D extent = frame.graph.extent(depth_ndc);
  const auto projection = projection_of(frame, frame.view, depth_ndc);
  if (!projection) {
    return tl::unexpected(projection.error());
  }
  mips = mips_that_fit(extent, mips);
  const std::array constants{mips};
  const auto kernel = frame.kernels.get(Shader::linear_depth, constants);
  if (!kernel) {
    return tl::unexpected(kernel.error());
  }

  Texture depth = frame.graph.create_texture(
      "linear depth",
      {VK_FORMAT_R32_SFLOAT, framegraph::Extent::absolute(extent.width, extent.height), mips});
  auto pass = frame.graph.add_pass("depth pyramid");
  pass.read(depth_ndc, framegraph::access::sampled_compute);
  depth = pass.write(depth, framegraph::access::storage_write_compute, {},
                     framegraph::Contents::discard);
  const maths::LinearDepthParameters parameters{*projection, reach};
  pass.record([&kernels = frame.kernels, kernel = *kernel, depth_ndc, depth, mips, extent,
               parameters](RecordContext& context) {
    std::array<VkImageView, kMaxMips + 1> views;
    views[0] = context.view(depth_ndc);
    for (std::uint32_t mip = 0; mip < kMaxMips; ++mip) {
      views[mip + 1] = context.view(depth, Range::mip(std::min(mip, mips - 1)));
    }
    // One thread for two by two pixels.
    kernels.dispatch(context, kernel, views, bytes_of(parameters),
                     {(extent.width + 1) / 2, (extent.height + 1) / 2, 1});
  });
  return depth;
}

}  // namespace alcove::passes
