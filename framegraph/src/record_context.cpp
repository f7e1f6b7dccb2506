#include "alcove/framegraph/record_context.h"

#include "aspects.h"
#include "recorder.h"

namespace alcove::framegraph {

VkImageView RecordContext::view(Texture texture) const {
  const AccessRecord* access = recorder_.declared(pass_, texture.index);
  return access ? view(texture, access->range) : VkImageView{VK_NULL_HANDLE};
}

VkImageView RecordContext::view(Texture texture, Range range, VkImageViewType type,
                                VkFormat format) const {
  if (!recorder_.declared(pass_, texture.index)) return VK_NULL_HANDLE;
  Physical* physical = (*recorder_.frame_.physical)[texture.index];
  if (physical == nullptr || physical->image == VK_NULL_HANDLE) return VK_NULL_HANDLE;
  const GraphDescription& graph = recorder_.graph_->description();
  const ResourceRecord& record = graph.resources[texture.index];
  range = Graph::resolved_range(range, record);
  if (!recorder_.check_view(pass_, texture.index, range)) return VK_NULL_HANDLE;
  if (record.origin == Origin::imported && range.mips == record.mips && range.aspects == 0 &&
      range.layers == record.layers && type == kViewTypeByRange && format == VK_FORMAT_UNDEFINED) {
    const VkImageView given = recorder_.graph_->imports_[record.external].view;
    if (given != VK_NULL_HANDLE) {
      gave_imported_view_ = true;
      return given;
    }
  }
  const VkImageView view = recorder_.pool_.view(*physical, range, type, format);
  if (view == VK_NULL_HANDLE) {
    recorder_.errors_.push_back(
        {ErrorCode::vulkan,
         std::string("no view of '").append(graph.resource_name(texture.index)) +
             "' could be made: the device is out of memory",
         VK_ERROR_OUT_OF_DEVICE_MEMORY, pass_, texture.index, texture.version});
  }
  return view;
}

VkRenderingAttachmentInfo RecordContext::attachment(const Attachment& wanted) const {
  return attachment(wanted, recorder_.attachment_access(pass_, wanted.texture.index));
}

VkRenderingAttachmentInfo RecordContext::attachment(const Attachment& wanted,
                                                    std::uint32_t index) const {
  VkRenderingAttachmentInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
  if (index == kNone) return info;
  const AccessRecord& access = recorder_.graph_->description().accesses[index];
  const std::uint8_t contents = recorder_.plan_->contents[index];
  info.imageView = view(wanted.texture, access.range);
  info.imageLayout = access.layout;
  info.loadOp = (contents & kHasContents) != 0 ? VK_ATTACHMENT_LOAD_OP_LOAD
                : wanted.clear                 ? VK_ATTACHMENT_LOAD_OP_CLEAR
                                               : VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  // An attachment that is only tested against is not stored, because storing is a write.
  info.storeOp = !(access.flags & kWrite)      ? VK_ATTACHMENT_STORE_OP_NONE
                 : (contents & kIsNeeded) != 0 ? VK_ATTACHMENT_STORE_OP_STORE
                                               : VK_ATTACHMENT_STORE_OP_DONT_CARE;
  if (wanted.clear) info.clearValue = *wanted.clear;
  if (!wanted.resolve) return info;
  const std::uint32_t to = recorder_.attachment_access(pass_, wanted.resolve.index);
  if (to == kNone) return info;
  const AccessRecord& resolve = recorder_.graph_->description().accesses[to];
  info.resolveMode = wanted.resolve_mode;
  info.resolveImageView = view(wanted.resolve, resolve.range);
  info.resolveImageLayout = resolve.layout;
  return info;
}

bool RecordContext::begin_rendering(std::span<const Attachment> colors, const Attachment& depth,
                                    const Rendering& rendering) const {
  constexpr std::size_t kMost = 8;
  const auto refuse = [this](ErrorCode code, const char* why) {
    recorder_.errors_.push_back({code, std::string("pass '").append(pass_name()).append("' ") + why,
                                 VK_SUCCESS, pass_, kNone, 0});
    return false;
  };
  if (!vk.vkCmdBeginRendering || !vk.vkCmdEndRendering)
    return refuse(ErrorCode::misuse,
                  "begins a rendering, but the device has no vkCmdBeginRendering: create it for "
                  "Vulkan 1.3 or with VK_KHR_dynamic_rendering, and enable dynamicRendering");
  if (colors.size() > kMost)
    return refuse(ErrorCode::misuse, "begins a rendering with more than 8 color attachments");
  VkRenderingAttachmentInfo color_infos[kMost];
  VkRenderingAttachmentInfo depth_info{};
  VkRenderingAttachmentInfo stencil_info{};
  VkRenderingInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
  const GraphDescription& graph = recorder_.graph_->description();
  std::uint32_t samples = 0;
  bool alike = true;
  const auto add = [&](const Attachment& wanted, std::uint32_t index,
                       VkRenderingAttachmentInfo& to) {
    to = attachment(wanted, index);
    if (index == kNone || to.imageView == VK_NULL_HANDLE) return false;
    const ResourceRecord& record = graph.resources[wanted.texture.index];
    const Range& range = graph.accesses[index].range;
    const VkExtent3D size = extent(wanted.texture, range.base_mip);
    VkExtent2D& area = info.renderArea.extent;
    alike =
        alike && (samples == 0 || (area.width == size.width && area.height == size.height &&
                                   samples == record.samples && info.layerCount == range.layers));
    area = {size.width, size.height};
    samples = record.samples;
    info.layerCount = range.layers;
    return true;
  };
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const std::uint32_t index = recorder_.attachment_access(pass_, colors[i].texture.index);
    if (!add(colors[i], index, color_infos[i])) return false;
  }
  info.colorAttachmentCount = static_cast<std::uint32_t>(colors.size());
  info.pColorAttachments = color_infos;
  if (depth.texture) {
    const std::uint32_t resource = depth.texture.index;
    if (recorder_.attachment_access(pass_, resource) == kNone) return false;
    const VkImageAspectFlags all = aspects(format(depth.texture));
    const auto bind = [&](VkImageAspectFlags aspect, VkRenderingAttachmentInfo& to,
                          const VkRenderingAttachmentInfo*& bound) {
      const std::uint32_t index = recorder_.find_attachment(pass_, resource, aspect);
      if (!(all & aspect) || index == kNone) return true;
      bound = &to;
      return add(depth, index, to);
    };
    if (!bind(VK_IMAGE_ASPECT_DEPTH_BIT, depth_info, info.pDepthAttachment) ||
        !bind(VK_IMAGE_ASPECT_STENCIL_BIT, stencil_info, info.pStencilAttachment))
      return false;
    // Vulkan requires the same view for depth and stencil. The view's own aspects are ignored.
    if (info.pDepthAttachment) stencil_info.imageView = depth_info.imageView;
  }
  if (!alike)
    return refuse(
        ErrorCode::attachment_mismatch,
        "begins a rendering whose attachments differ in size, layers or samples: give them "
        "one of each");
  const VkRect2D& area = rendering.area;
  const VkExtent2D& whole = info.renderArea.extent;
  const bool is_inside = area.offset.x >= 0 && area.offset.y >= 0 &&
                         std::int64_t{area.offset.x} + area.extent.width <= whole.width &&
                         std::int64_t{area.offset.y} + area.extent.height <= whole.height;
  if (!is_inside || (info.layerCount < 32 && rendering.view_mask >> info.layerCount != 0))
    return refuse(ErrorCode::misuse,
                  "begins a rendering over texels or views that its attachments do not have: give "
                  "an area and a view mask within them");
  info.flags = rendering.flags;
  info.viewMask = rendering.view_mask;
  if (area.extent.width != 0) info.renderArea = area;
  vk.vkCmdBeginRendering(commands, &info);
  return true;
}

VkImage RecordContext::image(Texture texture) const {
  if (!recorder_.declared(pass_, texture.index)) return VK_NULL_HANDLE;
  const Physical* physical = (*recorder_.frame_.physical)[texture.index];
  return physical ? physical->image : VK_NULL_HANDLE;
}

VkBuffer RecordContext::buffer(Buffer buffer) const {
  if (!recorder_.declared(pass_, buffer.index)) return VK_NULL_HANDLE;
  const Physical* physical = (*recorder_.frame_.physical)[buffer.index];
  return physical ? physical->buffer : VK_NULL_HANDLE;
}

VkExtent3D RecordContext::extent(Texture texture, std::uint32_t mip) const {
  const auto& resources = recorder_.graph_->description().resources;
  if (texture.index >= resources.size()) return {0, 0, 0};
  const ResourceRecord& record = resources[texture.index];
  const auto side = [mip](std::uint32_t size) {
    const std::uint32_t reduced = mip < 32 ? size >> mip : 0;
    return reduced != 0 ? reduced : 1u;
  };
  return {side(record.width), side(record.height), side(record.depth)};
}

VkDeviceSize RecordContext::size(Buffer buffer) const {
  const auto& resources = recorder_.graph_->description().resources;
  return buffer.index < resources.size() ? resources[buffer.index].size : 0;
}

VkFormat RecordContext::format(Texture texture) const {
  const auto& resources = recorder_.graph_->description().resources;
  return texture.index < resources.size() ? resources[texture.index].format : VK_FORMAT_UNDEFINED;
}

bool RecordContext::is_used(std::uint32_t resource, const Range& range) const {
  const GraphDescription& graph = recorder_.graph_->description();
  const auto accesses = graph.pass_accesses(pass_);
  const std::uint8_t* live =
      recorder_.plan_->live_accesses.data() + graph.passes[pass_].first_access;
  const auto meet = [](std::uint32_t a, std::uint32_t a_count, std::uint32_t b,
                       std::uint32_t b_count) { return a < b + b_count && b < a + a_count; };
  for (std::size_t i = 0; i < accesses.size(); ++i) {
    const Range& own = accesses[i].range;
    if (live[i] && accesses[i].resource == resource &&
        meet(own.base_mip, own.mips, range.base_mip, range.mips) &&
        meet(own.base_layer, own.layers, range.base_layer, range.layers) &&
        (own.aspects == 0 || range.aspects == 0 || (own.aspects & range.aspects) != 0))
      return true;
  }
  return false;
}

HistoryValidity RecordContext::validity(std::uint32_t resource) const {
  const GraphDescription& graph = recorder_.graph_->description();
  if (resource >= graph.resources.size()) return HistoryValidity::first_frame;
  const std::uint32_t external = graph.resources[resource].external;
  return external == kNone ? HistoryValidity::valid : graph.externals[external].validity;
}

void RecordContext::fail(std::string_view what, VkResult result) const {
  recorder_.errors_.push_back(
      {ErrorCode::vulkan,
       std::string("pass '").append(pass_name()).append("' cannot be recorded: no ").append(what) +
           " could be made",
       result, pass_, kNone, 0});
}

std::string_view RecordContext::pass_name() const {
  return recorder_.graph_->description().pass_name(pass_);
}

}  // namespace alcove::framegraph
