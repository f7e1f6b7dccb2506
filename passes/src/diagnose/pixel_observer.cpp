#include "diagnose/pixel_observer.h"

#include <algorithm>
#include <cstring>

#include "inspect_parameters.h"
#include "vulkan/pipeline_state.h"
#include "work/describe_view.h"
#include "work/view_parameters.h"

namespace alcove::passes {
namespace {

using framegraph::Buffer;
using framegraph::RecordContext;
using framegraph::Texture;
using maths::kInspectColumns;
using maths::kInspectRows;

// The image that inspect.comp writes: the samples, row by row, and the sizes of the images.
constexpr std::uint32_t kTexelColumns = sizeof(PixelSample) / sizeof(float[4]) * kInspectColumns;
constexpr std::size_t kSampleBytes = sizeof(PixelSample) * kInspectColumns * kInspectRows;
constexpr std::size_t kTexelBytes = kSampleBytes + sizeof(PixelSample) * kInspectColumns;
// The serial number of the frame follows the texels.
constexpr VkDeviceSize kBytes = kTexelBytes + sizeof(std::uint32_t);
constexpr std::size_t kFrames = 3;  // that inspect() compares

}  // namespace

tl::expected<void, Error> PixelObserver::add(framegraph::Graph& graph, Pipelines& pipelines,
                                             const AlcoveView& view, const ViewTextures& inputs,
                                             std::uint32_t slot) {
  const AlcoveViewInfo& info = view.info;
  Pending& pending = pending_.at(slot);
  if (!pending.buffer) {
    auto made = HostBuffer::create(vk_, device_, "the buffer for pixels", kBytes,
                                   VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    if (!made) return tl::unexpected(std::move(made.error()));
    pending.buffer = std::move(*made);
  }
  const auto pipeline = pipelines.state().get(Shader::inspect);
  if (!pipeline) return tl::unexpected(pipeline.error());
  const Texture depth = inputs[ALCOVE_IMAGE_DEPTH], normals = inputs[ALCOVE_IMAGE_NORMALS];
  const Texture motion = info.static_frames == 0 ? inputs[ALCOVE_IMAGE_MOTION] : Texture{};
  const AlcoveImage& image = view.images[ALCOVE_IMAGE_DEPTH];
  const AlcoveArea read = read_area(info, {image.width, image.height});
  const VkExtent2D size =
      read.width > 0 ? VkExtent2D{read.width, read.height} : VkExtent2D{image.width, image.height};
  pending.declared = true;
  pending.frame = {.serial = serial_,
                   .info = info,
                   .settings = *info.settings,
                   .size = size,
                   .depth_format = image.format,
                   .has_normals = bool(normals),
                   .has_motion = bool(motion)};
  Texture samples = graph.create_texture(
      "samples", {VK_FORMAT_R32G32B32A32_SFLOAT,
                  framegraph::Extent::absolute(kTexelColumns, kInspectRows + 1)});
  auto sampling = graph.add_pass("inspect");
  sampling.read(depth, framegraph::access::sampled_compute);
  for (const Texture texture : {normals, motion})
    if (texture) sampling.read(texture, framegraph::access::sampled_compute);
  samples = sampling.write(samples, framegraph::access::storage_write_compute, {},
                           framegraph::Contents::discard);
  const maths::InspectParameters parameters{
      {read.x, read.y}, {size.width, size.height}, normals ? 1u : 0u, motion ? 1u : 0u};
  sampling.record([&state = pipelines.state(), pipeline = *pipeline, depth, normals, motion,
                   samples, parameters](RecordContext& context) {
    const std::array views{context.view(depth), context.view(normals ? normals : depth),
                           context.view(motion ? motion : depth), context.view(samples)};
    state.dispatch(context, pipeline, views, bytes_of(parameters),
                   {(kInspectColumns + 7) / 8, (kInspectRows + 8) / 8, 1});
  });
  Buffer buffer = graph.import_buffer("samples for the host",
                                      {.buffer = pending.buffer->buffer(),
                                       .desc = {kBytes},
                                       .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                       .has_contents = false,
                                       .final_state = framegraph::buffer_access::host_read});
  auto copying = graph.add_pass("read samples");
  copying.read(samples, framegraph::access::transfer_source);
  buffer = copying.write(buffer, framegraph::buffer_access::fill, framegraph::Contents::discard);
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

void PixelObserver::collect(std::uint32_t slot, MistakeFinder& finder) {
  ++serial_;
  Pending& pending = pending_.at(slot);
  pending.declared = false;
  if (!std::exchange(pending.recorded, false)) return;
  std::uint32_t finished = 0;
  std::memcpy(&finished, pending.buffer->bytes() + kTexelBytes, sizeof finished);
  InspectedFrame& frame = pending.frame;
  Sightings* const sightings = finder.sightings(frame.info.id);
  if (sightings == nullptr) return;
  sightings->note(mistakes::slot_reused, finished != frame.serial);
  if (finished != frame.serial) return;
  std::array<float, 4> sizes{};
  std::memcpy(sizes.data(), pending.buffer->bytes() + kSampleBytes, sizeof sizes);
  const auto extent = [](float width, float height) {
    return VkExtent2D{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
  };
  frame.depth_size = extent(sizes[0], sizes[1]);
  frame.normals_size = extent(sizes[2], sizes[3]);
  if (frame.info.read_area.width > 0) {  // the images are known to be larger
    frame.depth_size = {std::min(frame.depth_size.width, frame.size.width),
                        std::min(frame.depth_size.height, frame.size.height)};
  }
  frame.samples.resize(kInspectColumns * kInspectRows);
  std::memcpy(frame.samples.data(), pending.buffer->bytes(), kSampleBytes);
  if (!frames_.empty() &&
      (frame.info.id != frames_.front().info.id || frame.serial != frames_.front().serial + 1))
    frames_.clear();
  frames_.insert(frames_.begin(), std::move(frame));
  frames_.resize(std::min(frames_.size(), kFrames));
  inspect(frames_, *sightings);
}

}  // namespace alcove::passes
