#include "print_names.h"

#include <algorithm>
#include <cstddef>

namespace alcove::framegraph {
namespace {

// The name of a bit or of a value of an enum.
struct Name {
  std::uint64_t value;
  const char* text;
};

constexpr Name kStages[] = {
    {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, "indirect"},
    {VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, "index"},
    {VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT, "attributes"},
    {VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT, "vertex input"},
    {VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, "vertex"},
    {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, "fragment"},
    {VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT, "early tests"},
    {VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT, "late tests"},
    {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, "color output"},
    {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, "compute"},
    {VK_PIPELINE_STAGE_2_COPY_BIT, "copy"},
    {VK_PIPELINE_STAGE_2_BLIT_BIT, "blit"},
    {VK_PIPELINE_STAGE_2_RESOLVE_BIT, "resolve"},
    {VK_PIPELINE_STAGE_2_CLEAR_BIT, "clear"},
    {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, "transfer"},
    {VK_PIPELINE_STAGE_2_TRANSFORM_FEEDBACK_BIT_EXT, "transform feedback"},
    {VK_PIPELINE_STAGE_2_HOST_BIT, "host"},
    {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, "all commands"},
    {VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT, "all graphics"},
    {VK_PIPELINE_STAGE_2_BOTTOM_OF_PIPE_BIT, "bottom"},
};

// Vulkan's names without their common prefix and suffix, for example TRANSFER_SRC.
constexpr Name kImageUsages[] = {
    {VK_IMAGE_USAGE_TRANSFER_SRC_BIT, "TRANSFER_SRC"},
    {VK_IMAGE_USAGE_TRANSFER_DST_BIT, "TRANSFER_DST"},
    {VK_IMAGE_USAGE_SAMPLED_BIT, "SAMPLED"},
    {VK_IMAGE_USAGE_STORAGE_BIT, "STORAGE"},
    {VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, "COLOR_ATTACHMENT"},
    {VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, "DEPTH_STENCIL_ATTACHMENT"},
};

constexpr Name kBufferUsages[] = {
    {VK_BUFFER_USAGE_TRANSFER_SRC_BIT, "TRANSFER_SRC"},
    {VK_BUFFER_USAGE_TRANSFER_DST_BIT, "TRANSFER_DST"},
    {VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT, "UNIFORM_TEXEL_BUFFER"},
    {VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT, "STORAGE_TEXEL_BUFFER"},
    {VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, "UNIFORM_BUFFER"},
    {VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, "STORAGE_BUFFER"},
    {VK_BUFFER_USAGE_INDEX_BUFFER_BIT, "INDEX_BUFFER"},
    {VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, "VERTEX_BUFFER"},
    {VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, "INDIRECT_BUFFER"},
    {VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT, "SHADER_DEVICE_ADDRESS"},
};

template <std::size_t kCount>
std::string join(std::uint64_t bits, const Name (&names)[kCount]) {
  if (bits == 0) return "none";
  std::string text;
  const auto append = [&text](const std::string& part) {
    if (!text.empty()) text += '|';
    text += part;
  };
  for (const Name& name : names) {
    if (!(bits & name.value)) continue;
    append(name.text);
    bits &= ~name.value;
  }
  if (bits != 0) append(std::string("+").append(std::to_string(bits)));
  return text;
}

}  // namespace

std::string stage_names(VkPipelineStageFlags2 stages) { return join(stages, kStages); }

std::string usage_names(ResourceKind kind, VkFlags usage) {
  return kind == ResourceKind::texture ? join(usage, kImageUsages) : join(usage, kBufferUsages);
}

std::string layout_name(VkImageLayout layout) {
  constexpr Name kLayouts[] = {{VK_IMAGE_LAYOUT_UNDEFINED, "undefined"},
                               {VK_IMAGE_LAYOUT_GENERAL, "general"},
                               {VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, "color"},
                               {VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, "depth"},
                               {VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, "depth read"},
                               {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, "shader read"},
                               {VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, "transfer source"},
                               {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, "transfer destination"},
                               {VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, "present"}};
  for (const Name& name : kLayouts)
    if (name.value == static_cast<std::uint64_t>(layout)) return name.text;
  return std::string("layout ").append(std::to_string(layout));
}

std::string queue_name(QueueClass queue) {
  constexpr const char* kNames[kQueueClasses] = {"graphics", "compute", "transfer"};
  return kNames[static_cast<std::size_t>(queue)];
}

std::string byte_size(VkDeviceSize bytes) {
  // The text has one decimal, in the largest unit in which the number is at least 1.
  constexpr const char* kUnits[] = {"B", "KiB", "MiB", "GiB"};
  std::size_t unit = 0;
  VkDeviceSize scale = 1;
  while (unit + 1 < std::size(kUnits) && bytes / scale >= 1024) {
    scale *= 1024;
    ++unit;
  }
  std::string text = std::to_string(bytes / scale);
  if (unit > 0) text.append(".").append(std::to_string(bytes % scale * 10 / scale));
  return text.append(" ").append(kUnits[unit]);
}

std::string range_name(const Range& range, std::uint32_t mips, std::uint32_t layers) {
  const auto part = [](const char* what, std::uint32_t base, std::uint32_t count) {
    std::string text = std::string(" ").append(what).append(" ").append(std::to_string(base));
    if (count > 1) text.append("..").append(std::to_string(base + count - 1));
    return text;
  };
  std::string text;
  if (range.mips != mips) text += part("mip", range.base_mip, range.mips);
  if (range.layers != layers) text += part("layer", range.base_layer, range.layers);
  return text;
}

std::vector<std::string> resource_names(const GraphDescription& graph) {
  std::vector<std::string> names;
  for (std::uint32_t r = 0; r < graph.resources.size(); ++r)
    names.emplace_back(graph.resource_name(r));
  std::vector<std::string> sorted = names;
  std::sort(sorted.begin(), sorted.end());
  for (std::uint32_t r = 0; r < names.size(); ++r) {
    const auto [first, last] = std::equal_range(sorted.begin(), sorted.end(), names[r]);
    if (last - first < 2) continue;
    // The slots of a history have one name.
    const bool history = graph.resources[r].origin == Origin::history;
    names[r].append(history ? ", frames ago: " : "#");
    names[r].append(std::to_string(history ? graph.resources[r].slot : r));
  }
  return names;
}

std::string reason(const GraphDescription& graph, const PassCullReason& cull_reason) {
  std::string consumer = "for '";
  if (cull_reason.consumer != kNone)
    consumer.append(graph.pass_name(cull_reason.consumer)).append("'");
  switch (cull_reason.cull_reason) {
    case CullReason::side_effect:
      return "for its side effect";
    case CullReason::output:
      return "for what is wanted after the frame";
    case CullReason::feeds_pass:
      return consumer;
    case CullReason::feeds_history:
      return cull_reason.consumer != kNone ? consumer.append(" in later frames")
                                           : "for a history without contents";
    case CullReason::unread:
      return "nobody reads what it writes";
    case CullReason::writes_nothing:
      return "it writes nothing and has no side effect";
  }
  return "";
}

}  // namespace alcove::framegraph
