#include "alcove/passes/spatial_filter.h"

#include <array>
#include <string>

#include "spatial_filter_parameters.h"
#include "view_parameters.h"

namespace alcove::passes {

using framegraph::Range;
using framegraph::RecordContext;
using framegraph::Texture;

namespace {

constexpr std::uint32_t kMaxReach = 3;

tl::expected<void, Error> check(const SpatialFilterSettings& settings) {
  if (!(settings.tolerance_px > 0.0f)) {
    return tl::unexpected(Error{"The spatial filter's tolerance is " +
                                std::to_string(settings.tolerance_px) +
                                " pixels; it must be over 0."});
  }
  if (settings.reach > kMaxReach) {
    return tl::unexpected(Error{"The spatial filter's reach is " + std::to_string(settings.reach) +
                                "; it must be 0 to 3 pixels."});
  }
  return {};
}

VkFormat visibility_format(Precision precision) {
  switch (precision) {
    case Precision::unorm8:
      return VK_FORMAT_R8_UNORM;
    case Precision::float16:
      return VK_FORMAT_R16_SFLOAT;
    default:
      return VK_FORMAT_R32_SFLOAT;
  }
}

VkFormat bent_normal_format(Precision precision) {
  switch (precision) {
    case Precision::unorm8:
      return VK_FORMAT_R8G8B8A8_SNORM;
    case Precision::float16:
      return VK_FORMAT_R16G16B16A16_SFLOAT;
    default:
      return VK_FORMAT_R32G32B32A32_SFLOAT;
  }
}

// The textures that the filter writes, made for the graph but not yet written.
Occlusion create_results(const Frame& frame, const OcclusionSignal& signal,
                         const SpatialFilterSettings& settings) {
  const auto size = framegraph::Extent::relative(signal.signal);
  Occlusion result;
  result.visibility =
      frame.graph.create_texture("visibility", {visibility_format(settings.precision), size});
  if (signal.bent) {
    result.bent_normal =
        frame.graph.create_texture("bent normal", {bent_normal_format(settings.precision), size});
  }
  return result;
}

}  // namespace

tl::expected<Occlusion, Error> add_spatial_filter(const Frame& frame,
                                                  const SpatialFilterInputs& inputs,
                                                  const SpatialFilterSettings& settings) {
  if (auto good = check(settings); !good) {
    return tl::unexpected(good.error());
  }
  const auto projection = projection_of(frame, inputs.depth);
  if (!projection) {
    return tl::unexpected(projection.error());
  }
  const std::array constants{settings.reach, static_cast<std::uint32_t>(bool(inputs.signal.bent))};
  const auto kernel = frame.kernels.get(Shader::spatial_filter, constants);
  if (!kernel) {
    return tl::unexpected(kernel.error());
  }

  Occlusion result = create_results(frame, inputs.signal, settings);
  auto pass = frame.graph.add_pass("spatial filter");
  const auto& sampled = framegraph::access::sampled_compute;
  const auto& stored = framegraph::access::storage_write_compute;
  pass.read(inputs.signal.signal, sampled);
  if (inputs.signal.bent) {
    pass.read(inputs.signal.bent, sampled);
  }
  pass.read(inputs.depth, sampled, Range::mip(0));
  pass.read(inputs.normals, sampled);
  result.visibility = pass.write(result.visibility, stored, {}, framegraph::Contents::discard);
  if (inputs.signal.bent) {
    result.bent_normal = pass.write(result.bent_normal, stored, {}, framegraph::Contents::discard);
  }
  const maths::SpatialFilterParameters parameters{
      *projection, view_from_normal(frame, inputs.normals_in_view_space), settings.tolerance_px};
  pass.record([&kernels = frame.kernels, kernel = *kernel, inputs, result,
               parameters](RecordContext& context) {
    const VkImageView visibility = context.view(result.visibility);
    const VkImageView signal = context.view(inputs.signal.signal);
    const std::array views{signal,
                           context.view(inputs.depth),
                           context.view(inputs.normals),
                           inputs.signal.bent ? context.view(inputs.signal.bent) : signal,
                           visibility,
                           result.bent_normal ? context.view(result.bent_normal) : visibility};
    kernels.dispatch(context, kernel, views, bytes_of(parameters),
                     context.extent(result.visibility));
  });
  return result;
}

}  // namespace alcove::passes
