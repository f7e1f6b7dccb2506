#include "gpu_cost/accesses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "maths/sampling.h"

namespace alcove::sample {
namespace {

using Accesses = std::vector<ImageAccess>;

constexpr float kRadius = 96.0f / 1080.0f;  // length of a search over the height of the image
constexpr Texel kMotion{11, 5};             // of the image since the previous frame, in pixels
constexpr std::uint32_t kFrame = 3;         // any frame
constexpr std::uint32_t kGroup = 8;         // invocations along a side of a group

maths::SliceNoise noise_of(Texel tile, bool moves) {
  return maths::golden_pattern(
      {static_cast<std::uint32_t>(tile.x), static_cast<std::uint32_t>(tile.y)}, kFrame, moves);
}

bool is_one_of(const PassImage& image, std::initializer_list<std::string_view> names) {
  return std::ranges::find(names, image.name) != names.end();
}

// The depth sample `step` of `steps` of one half-slice, as in gtao_search_line.h.
ImageAccess depth_sample(const PassImage& image, const OcclusionSettings& settings, float radius_px,
                         std::uint32_t slice, float side, std::uint32_t step, std::uint32_t steps) {
  const auto tile_size = static_cast<std::int32_t>(settings.tile_size);
  const std::int32_t scale = image.name == names::kHalvedDepth ? 2 : 1;
  radius_px /= static_cast<float>(scale);
  const auto texel = [=, slices = settings.slices](Texel tile) {
    const maths::SliceNoise noise = noise_of(tile, tile_size > 1);
    const float angle = maths::slice_angle(slice, slices, noise.direction);
    const float part = (static_cast<float>(step) + noise.offset) / static_cast<float>(steps);
    const float px = side * (maths::kNearestStep + (radius_px - maths::kNearestStep) * part * part);
    const Texel traced{(tile.x * tile_size + tile_size / 2) / scale,
                       (tile.y * tile_size + tile_size / 4) / scale};
    return along_slice(traced, angle, px);
  };
  return {image, 1, texel};
}

// gtao.comp: each traced pixel reads its inputs, then depth along its slices, and writes its tile.
Accesses gtao_accesses(const PassWork& work) {
  const OcclusionSettings& settings = work.settings;
  const float radius_px = kRadius * static_cast<float>(work.height);
  const auto tile = static_cast<std::int32_t>(settings.tile_size);
  const Texel traced{tile / 2, tile / 4};
  Accesses accesses;
  std::array<std::vector<const PassImage*>, 2> layers;  // of depths that are sampled together
  for (const PassImage& image : work.images) {
    const bool halved = image.name == names::kHalvedDepth;
    const bool second = image.name == names::kSecondDepth;
    const bool back = image.name == names::kBackDepth;
    if (halved) layers[0].clear();
    if (halved || second || back || is_one_of(image, {names::kDepth, names::kOccluders}))
      layers.at(second ? 1 : 0).push_back(&image);
    if (back) layers[1].push_back(&image);
    // With a mask, the pixel's own depth is that of the receivers.
    const bool at_pixel = !halved && !second && image.name != names::kOccluders;
    if (image.direction == Direction::read && layers[0].size() < 2 && at_pixel)
      accesses.push_back(at_invocation(image, tile, traced));
  }
  const std::array<std::uint32_t, 2> steps{settings.steps, passes::second_layer_steps(settings)};
  for (std::uint32_t slice = 0; slice < settings.slices; ++slice) {
    for (const float side : {1.0f, -1.0f}) {
      for (std::size_t layer = 0; layer < layers.size(); ++layer)
        for (std::uint32_t step = 0; step < steps.at(layer); ++step)
          for (const PassImage* depth : layers.at(layer))
            accesses.push_back(
                depth_sample(*depth, settings, radius_px, slice, side, step, steps.at(layer)));
    }
  }
  for (const PassImage& image : work.images)
    if (image.direction == Direction::write) accesses.push_back(at_invocation(image));
  return accesses;
}

// The blocks of 8x8 texels that a group of reconstruct.comp computes, one below the other.
std::int32_t blocks_of(const OcclusionSettings& settings) {
  return settings.tile_size > (settings.half_resolution ? 2u : 1u) ? 4 : 1;
}

// load_tiles() of reconstruct.comp: a group loads the tiles around it, one per invocation.
void add_tiles(const PassImage& image, const PassWork& work, Accesses& accesses) {
  const OcclusionSettings& settings = work.settings;
  const std::uint32_t width = kGroup * (settings.half_resolution ? 2 : 1);
  const std::uint32_t height = width * static_cast<std::uint32_t>(blocks_of(settings));
  const bool fresh = settings.history_frames == 0 || work.state == FrameState::first;
  const std::uint32_t radius = std::min(passes::filter_radius(settings), fresh ? 3u : 1u);
  const std::uint32_t span = width / settings.tile_size + 2 * radius;
  const std::uint32_t tiles = span * (height / settings.tile_size + 2 * radius);
  for (std::uint32_t first = 0; first < tiles; first += kGroup * kGroup) {
    const auto texel = [=, tile_size = settings.tile_size](Texel invocation) {
      const auto x = static_cast<std::uint32_t>(invocation.x);
      const auto y = static_cast<std::uint32_t>(invocation.y);
      const std::uint32_t tile = std::min(first + y % kGroup * kGroup + x % kGroup, tiles - 1);
      return Texel{static_cast<std::int32_t>(x / kGroup * width / tile_size + tile % span) -
                       static_cast<std::int32_t>(radius),
                   static_cast<std::int32_t>(y / kGroup * height / tile_size + tile / span) -
                       static_cast<std::int32_t>(radius)};
    };
    accesses.push_back({image, 1, texel});
  }
}

// The gathers of an image: one for each channel that is read.
std::uint32_t gathers_of(const PassImage& image, std::uint32_t channels) {
  for (const std::string_view name :
       {names::kDepthHistory, names::kHalfTexelDepth, names::kLobeHistory, names::kHalfTexelLobe})
    if (image.name.ends_with(name)) return 1;
  return channels;
}

// Moves an access of the first of `blocks` blocks of a column to the block `block`.
ImageAccess in_block(ImageAccess access, std::int32_t block, std::int32_t blocks) {
  constexpr auto kRows = static_cast<std::int32_t>(kGroup);
  access.texel = [=, texel = std::move(access.texel)](Texel invocation) {
    const std::int32_t group = invocation.y / kRows;
    return texel({invocation.x, (group * blocks + block) * kRows + invocation.y % kRows});
  };
  return access;
}

// The normals of the pixels whose tangent plane does not come from depth, in a fifth of the blocks.
ImageAccess at_bent_depth(const PassImage& image) {
  return {image, 1,
          [](Texel invocation) {
            constexpr auto kSide = static_cast<std::int32_t>(kGroup);
            const bool reads = (invocation.x / kSide + 2 * (invocation.y / kSide)) % 5 == 0;
            return reads ? invocation : Texel{};
          },
          true, kBentDepth};
}

// The accesses of reconstruct.comp to an image for one block of texels.
Accesses block_accesses(const PassWork& work, const PassImage& image) {
  const bool half = work.settings.half_resolution;
  const bool is_depth = is_one_of(image, {names::kDepth, names::kReceivers});
  if (image.direction == Direction::write) return {at_invocation(image)};
  if (image.name.starts_with(names::kPrevious)) {
    if (work.state == FrameState::moving) {
      const Texel motion = half ? Texel{kMotion.x / 2, kMotion.y / 2} : kMotion;
      return Accesses(gathers_of(image, 2), at_invocation(image, 1, motion, 2));
    }
    return work.state == FrameState::first ? Accesses{} : Accesses{at_invocation(image)};
  }
  if (is_depth && half) {
    return {at_invocation(image, 2, {-1, -1}, 2), at_invocation(image, 2, {1, -1}, 2),
            at_invocation(image, 2, {-1, 1}, 2), at_invocation(image, 2, {1, 1}, 2)};
  }
  if (is_depth) return {at_invocation(image, 1, {-1, -1}, 2), at_invocation(image, 1, {}, 2)};
  if (image.name == names::kNormals && has_depth_planes(work) && !work.settings.bent_normal)
    return {at_bent_depth(image)};
  return {at_invocation(image, half ? 2 : 1)};
}

// reconstruct.comp, at full or at half resolution: the tiles around a column of blocks, then block
// by block.
Accesses reconstruct_accesses(const PassWork& work) {
  const auto is_raw = [](const PassImage& image) {
    return image.direction == Direction::read &&
           is_one_of(image, {names::kRawOcclusion, names::kResidual});
  };
  Accesses accesses;
  for (const PassImage& image : work.images)
    if (is_raw(image)) add_tiles(image, work, accesses);
  const std::int32_t blocks = blocks_of(work.settings);
  for (std::int32_t block = 0; block < blocks; ++block) {
    for (const PassImage& image : work.images) {
      if (!is_raw(image))
        for (ImageAccess& access : block_accesses(work, image))
          accesses.push_back(in_block(std::move(access), block, blocks));
    }
  }
  return accesses;
}

// upsample.comp: an invocation gathers four texels and computes four pixels.
Accesses upsample_accesses(const PassWork& work) {
  Accesses accesses;
  for (const PassImage& image : work.images) {
    if (image.direction == Direction::read &&
        is_one_of(image, {names::kDepth, names::kReceivers})) {
      accesses.push_back(at_invocation(image, 2, {-1, -1}, 2));
    } else if (image.direction == Direction::read && image.name != names::kNormals) {
      const std::uint32_t gathers = gathers_of(image, 3);
      accesses.insert(accesses.end(), gathers, at_invocation(image, 1, {-1, -1}, 2));
    } else {
      for (std::int32_t i = 0; i < 4; ++i)
        accesses.push_back(at_invocation(image, 2, {i % 2 - 1, i / 2 - 1}));
    }
  }
  return accesses;
}

// gtso.comp: without a texture of normals also depth of two neighbours on each side along both
// axes.
Accesses gtso_accesses(const PassWork& work) {
  const bool given =
      std::ranges::find(work.images, names::kNormals, &PassImage::name) != work.images.end();
  Accesses accesses;
  for (const PassImage& image : work.images) {
    accesses.push_back(at_invocation(image));
    if (given || image.name != names::kDepth) continue;
    for (const std::int32_t distance : {-1, 1, -2, 2}) {
      accesses.push_back(at_invocation(image, 1, {distance, 0}));
      accesses.push_back(at_invocation(image, 1, {0, distance}));
    }
  }
  return accesses;
}

// The passes that copy or convert every pixel, or every second one along x and y.
Accesses copy_accesses(const PassWork& work) {
  const int read_scale = work.pass == Pass::halve_depth ? 2 : 1;
  Accesses accesses;
  for (const PassImage& image : work.images)
    accesses.push_back(at_invocation(image, image.direction == Direction::read ? read_scale : 1));
  return accesses;
}

}  // namespace

Texel along_slice(Texel from, float phi, float distance) {
  // A table takes a fraction of the time of sine and cosine, of which a frame needs millions.
  constexpr std::size_t kDirections = 1024;  // in half a turn
  static const std::vector<maths::vec2> directions = [] {
    std::vector<maths::vec2> all;
    for (std::size_t i = 0; i <= kDirections; ++i) {
      const float angle = maths::kPi * static_cast<float>(i) / static_cast<float>(kDirections);
      all.emplace_back(std::cos(angle), std::sin(angle));
    }
    return all;
  }();
  const maths::vec2 direction =
      directions[static_cast<std::size_t>(phi * (static_cast<float>(kDirections) / maths::kPi)) %
                 kDirections];
  const auto rounded = [distance](float component) {
    constexpr float kBelow = 16384.0f;  // is below every distance, so that truncation rounds down
    return static_cast<std::int32_t>(component * distance + (kBelow + 0.5f)) -
           static_cast<std::int32_t>(kBelow);
  };
  return {from.x + rounded(direction.x), from.y + rounded(direction.y)};
}

ImageAccess at_invocation(const PassImage& image, std::int32_t scale, Texel offset,
                          std::uint32_t footprint) {
  return {image, footprint,
          [=](Texel invocation) {
            return Texel{invocation.x * scale + offset.x, invocation.y * scale + offset.y};
          },
          scale <= 2};
}

DispatchAccesses accesses_of(const PassWork& work) {
  DispatchAccesses dispatch{work.groups.x, work.groups.y * work.groups.z, {}};
  if (work.pass == Pass::gtao) dispatch.strip_columns = work.groups.y;
  dispatch.accesses = work.pass == Pass::gtao                 ? gtao_accesses(work)
                      : work.pass == Pass::reconstruct        ? reconstruct_accesses(work)
                      : work.pass == Pass::upsample           ? upsample_accesses(work)
                      : work.pass == Pass::specular_occlusion ? gtso_accesses(work)
                                                              : copy_accesses(work);
  return dispatch;
}

}  // namespace alcove::sample
