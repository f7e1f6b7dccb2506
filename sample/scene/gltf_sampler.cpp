#include "scene/gltf_sampler.h"

#include <optional>

namespace alcove::sample {
namespace {

constexpr int kNotGiven = -1;

std::optional<Wrap> wrap_of(int mode) {
  switch (mode) {
    case TINYGLTF_TEXTURE_WRAP_REPEAT:
      return Wrap::kRepeat;
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return Wrap::kClamp;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      return Wrap::kMirror;
    default:
      return std::nullopt;
  }
}

// Returns the filter within a mip level. In glTF the same number also selects the filter between
// mip levels.
std::optional<Filter> filter_of(int filter) {
  switch (filter) {
    case kNotGiven:
    case TINYGLTF_TEXTURE_FILTER_LINEAR:
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR:
      return Filter::kLinear;
    case TINYGLTF_TEXTURE_FILTER_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_LINEAR:
      return Filter::kNearest;
    default:
      return std::nullopt;
  }
}

MipFilter mip_filter_of(int filter) {
  switch (filter) {
    case TINYGLTF_TEXTURE_FILTER_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_LINEAR:
      return MipFilter::kNone;
    case TINYGLTF_TEXTURE_FILTER_NEAREST_MIPMAP_NEAREST:
    case TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_NEAREST:
      return MipFilter::kNearest;
    default:
      return MipFilter::kLinear;
  }
}

}  // namespace

tl::expected<Sampler, std::string> read_sampler(const tinygltf::Sampler& in) {
  const auto wrap_u = wrap_of(in.wrapS), wrap_v = wrap_of(in.wrapT);
  if (!wrap_u || !wrap_v) return tl::unexpected<std::string>("has a wrap mode unknown to glTF");
  const auto magnify = filter_of(in.magFilter), minify = filter_of(in.minFilter);
  // Magnification only reads mip level 0, so that a filter between mip levels is not valid for it.
  const bool magnifies =
      in.magFilter == kNotGiven || mip_filter_of(in.magFilter) == MipFilter::kNone;
  if (!magnify || !minify || !magnifies) {
    return tl::unexpected<std::string>("has a filter unknown to glTF");
  }
  return Sampler{*wrap_u, *wrap_v, *magnify, *minify, mip_filter_of(in.minFilter)};
}

}  // namespace alcove::sample
