#include "diagnose/pixel_observer.h"

#include <algorithm>
#include <cstring>

#include "c/view.h"
#include "inspect_parameters.h"
#include "work/view_parameters.h"

namespace alcove::passes {
namespace {

using framegraph::Buffer;
using framegraph::RecordContext;
using framegraph::Texture;
using maths::kInspectColumns;
using maths::kInspectRows;

using Texel = std::array<float, 4>;
constexpr std::uint32_t kTexelRows = 2 * kInspectRows + 1;
constexpr VkDeviceSize kTexelBytes = VkDeviceSize{kInspectColumns} * kTexelRows * sizeof(Texel);
// The serial number of the frame follows the texels.
constexpr VkDeviceSize kBytes = kTexelBytes + sizeof(std::uint32_t);
constexpr std::uint32_t kSureFrames = 3;

}  // namespace

tl::expected<void, Failure> PixelObserver::add(const Frame& frame, const AlcoveView& view,
                                               Texture depth, Texture normals, std::uint32_t slot) {
  Pending& pending = pending_.at(slot);
  if (!pending.buffer) {
    auto made = HostBuffer::create(vk_, device_, kBytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    if (!made) {
      return tl::unexpected(
          failure_of(Error{"The buffer for pixels could not be created.", made.error()}, "View"));
    }
    pending.buffer = std::move(*made);
  }
  const auto kernel = frame.kernels.get(Shader::inspect);
  if (!kernel) {
    return tl::unexpected(failure_of(kernel.error(), "View"));
  }
  ++serial_;
  pending.declared = true;
  pending.serial = serial_;
  pending.id = view.id;
  pending.view = {.view = frame.view,
                  .size = {view.depth.width, view.depth.height},
                  .depth_format = view.depth.format,
                  .has_normals = bool(normals),
                  .normals_in_view_space = view.normals_in_view_space != VK_FALSE,
                  .normals_forward_z = view.normals_forward_z != VK_FALSE,
                  .normal_encoding = static_cast<NormalEncoding>(view.normal_encoding),
                  .radius = view.settings->radius};
  framegraph::Graph& graph = frame.graph;
  Texture samples = graph.create_texture(
      "samples",
      {VK_FORMAT_R32G32B32A32_SFLOAT, framegraph::Extent::absolute(kInspectColumns, kTexelRows)});
  auto sampling = graph.add_pass("inspect");
  sampling.read(depth, framegraph::access::sampled_compute);
  if (normals) {
    sampling.read(normals, framegraph::access::sampled_compute);
  }
  samples = sampling.write(samples, framegraph::access::storage_write_compute, {},
                           framegraph::Contents::discard);
  const maths::InspectParameters parameters{
      {view.depth.width, view.depth.height}, normals ? 1u : 0u, 0};
  sampling.record([&kernels = frame.kernels, kernel = *kernel, depth, normals, samples,
                   parameters](RecordContext& context) {
    const auto views =
        std::to_array<NamedView>({{"depth_image", context.view(depth)},
                                  {"normal_image", context.view(normals ? normals : depth)},
                                  {"sample_image", context.view(samples)}});
    kernels.dispatch(context, kernel, views, bytes_of(parameters),
                     {kInspectColumns, kInspectRows + 1, 1});
  });
  Buffer buffer = graph.import_buffer("samples for the host",
                                      {.buffer = pending.buffer->buffer(),
                                       .desc = {kBytes},
                                       .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                       .has_contents = false,
                                       .final_state = framegraph::buffer_access::host_read});
  auto copying = graph.add_pass("read samples");
  copying.read(samples, framegraph::access::transfer_source);
  buffer = copying.write(buffer, framegraph::buffer_access::fill);
  copying.record([samples, buffer, serial = serial_](RecordContext& context) {
    const VkBufferImageCopy region{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                   .imageExtent = context.extent(samples)};
    context.vk.vkCmdCopyImageToBuffer(context.commands, context.image(samples),
                                      VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, context.buffer(buffer),
                                      1, &region);
    // The serial number of the frame is stored by a command, not by the host, so that the buffer
    // holds the number of the last frame that the device has finished, even if the next frame of
    // the slot has already been recorded.
    context.vk.vkCmdUpdateBuffer(context.commands, context.buffer(buffer), kTexelBytes,
                                 sizeof serial, &serial);
  });
  return {};
}

void PixelObserver::collect(std::uint32_t slot) {
  Pending& pending = pending_.at(slot);
  pending.declared = false;
  if (!std::exchange(pending.recorded, false)) {
    return;
  }
  const auto texel = [&](std::uint32_t x, std::uint32_t y) {
    Texel result;
    std::memcpy(result.data(),
                pending.buffer->bytes() + (std::size_t{y} * kInspectColumns + x) * sizeof result,
                sizeof result);
    return result;
  };
  std::uint32_t finished = 0;
  std::memcpy(&finished, pending.buffer->bytes() + kTexelBytes, sizeof finished);
  if (finished != pending.serial) {
    ++early_;
    return;
  }
  InspectedView& view = pending.view;
  const Texel sizes = texel(0, 2 * kInspectRows);
  const auto whole = [](float number) { return static_cast<std::uint32_t>(number); };
  view.depth_size = {whole(sizes[0]), whole(sizes[1])};
  view.normals_size = {whole(sizes[2]), whole(sizes[3])};
  std::vector<PixelSample> samples;
  samples.reserve(std::size_t{kInspectColumns} * kInspectRows);
  for (std::uint32_t y = 0; y < kInspectRows; ++y) {
    for (std::uint32_t x = 0; x < kInspectColumns; ++x) {
      const Texel a = texel(x, 2 * y), b = texel(x, 2 * y + 1);
      const auto pixel = [](std::uint32_t cell, std::uint32_t cells, std::uint32_t size) {
        return static_cast<std::uint32_t>((static_cast<float>(cell) + 0.5f) /
                                          static_cast<float>(cells) * static_cast<float>(size));
      };
      samples.push_back({pixel(x, kInspectColumns, view.size.width),
                         pixel(y, kInspectRows, view.size.height),
                         a[0],
                         a[1],
                         a[2],
                         a[3],
                         b[0],
                         {b[1], b[2], b[3]}});
    }
  }
  auto counts = std::ranges::find(counts_, pending.id, &Counts::id);
  if (counts == counts_.end()) {
    counts_.push_back({pending.id});
    counts = counts_.end() - 1;
  }
  const Mistakes mistakes = inspect(view, samples);
  ++counts->frames;
  for (std::size_t i = 0; i < mistakes.size(); ++i) {
    counts->seen.at(i) += mistakes.at(i) ? 1 : 0;
  }
}

std::string PixelObserver::describe() const {
  std::string text;
  if (early_ >= kSureFrames) {
    text +=
        "AlcoveFrame::slot was recorded again before the device had finished its last frame; wait "
        "for the fence of the slot.\n";
  }
  for (const Counts& counts : counts_) {
    for (std::size_t i = 0; i < counts.seen.size(); ++i) {
      if (counts.frames >= kSureFrames && counts.seen.at(i) == counts.frames) {
        text +=
            "View " + std::to_string(counts.id) + ": " + sentence(static_cast<Mistake>(i)) + "\n";
      }
    }
  }
  return text;
}

}  // namespace alcove::passes
