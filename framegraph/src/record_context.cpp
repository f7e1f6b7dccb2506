#include "alcove/framegraph/record_context.h"

#include "aspects.h"
#include "recorder.h"

namespace alcove::framegraph {

Physical* RecordContext::physical(std::uint32_t resource, std::uint32_t version) const {
  const AccessRecord* const access = recorder_.declared(pass_, resource);
  if (access == nullptr) return nullptr;
  const GraphDescription& graph = recorder_.graph_->description();
  const ResourceRecord& record = graph.resources[resource];
  if (recorder_.frame_.check_uses && record.slot != 0 && version == 0 &&
      !(access->flags & kWrite) && !graph.externals[record.external].has_contents &&
      !(asked_ >> resource % 64 & 1)) {
    recorder_.fail(ErrorCode::undeclared_use, pass_,
                   "uses '" + std::string(graph.resource_name(resource)) + "' of " +
                       std::to_string(record.slot) +
                       " frame(s) ago, which has no contents: ask RecordContext::validity before",
                   resource, version);
    return nullptr;
  }
  return (*recorder_.frame_.physical)[resource];
}

VkImageView RecordContext::view(Texture texture) const {
  const AccessRecord* access = recorder_.declared(pass_, texture.index);
  return access ? view(texture, access->range) : VkImageView{VK_NULL_HANDLE};
}

VkImageView RecordContext::view(Texture texture, Range range, VkImageViewType type,
                                VkFormat format) const {
  Physical* const used = physical(texture.index, texture.version);
  if (used == nullptr || used->image == VK_NULL_HANDLE) return VK_NULL_HANDLE;
  const GraphDescription& graph = recorder_.graph_->description();
  const ResourceRecord& record = graph.resources[texture.index];
  range = Graph::resolved_range(range, record);
  if (!recorder_.check_view(pass_, texture.index, range)) return VK_NULL_HANDLE;
  if (record.origin == Origin::imported && range.mips == record.mips &&
      range.layers == record.layers && type == kViewTypeByRange && format == VK_FORMAT_UNDEFINED) {
    const VkImageView given = recorder_.graph_->imports_[record.external].view;
    if (given != VK_NULL_HANDLE) {
      gave_imported_view_ = true;
      return given;
    }
  }
  const VkImageView view = recorder_.pool_.view(*used, range, type, format);
  if (view == VK_NULL_HANDLE)
    recorder_.fail(ErrorCode::vulkan, pass_,
                   "gets no view of '" + std::string(graph.resource_name(texture.index)) +
                       "': the device is out of memory",
                   texture.index, texture.version, VK_ERROR_OUT_OF_DEVICE_MEMORY);
  return view;
}

VkRenderingAttachmentInfo RecordContext::attachment(const Attachment& target) const {
  return attachment(target, attachment_access(target));
}

// Returns the index of the access that declares the attachment, or adds an error and returns kNone.
std::uint32_t RecordContext::attachment_access(const Attachment& target) const {
  const auto& resources = recorder_.graph_->description().resources;
  const std::uint32_t index = target.texture.index;
  const bool is_part = target.range != Range{} && index < resources.size();
  return recorder_.attachment_access(
      pass_, index, is_part ? Graph::resolved_range(target.range, resources[index]) : Range{});
}

VkRenderingAttachmentInfo RecordContext::attachment(const Attachment& target,
                                                    std::uint32_t index) const {
  VkRenderingAttachmentInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
  if (index == kNone) return info;
  const AccessRecord& access = recorder_.graph_->description().accesses[index];
  const std::uint8_t contents = recorder_.plan_->contents[index];
  info.imageView = view(target.texture, target.range != Range{} ? target.range : access.range);
  info.imageLayout = access.layout;
  info.loadOp = (contents & kHasContents) != 0 ? VK_ATTACHMENT_LOAD_OP_LOAD
                : target.clear                 ? VK_ATTACHMENT_LOAD_OP_CLEAR
                                               : VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  // An attachment that is only tested against is not stored, because storing is a write.
  info.storeOp = !(access.flags & kWrite)      ? VK_ATTACHMENT_STORE_OP_NONE
                 : (contents & kIsNeeded) != 0 ? VK_ATTACHMENT_STORE_OP_STORE
                                               : VK_ATTACHMENT_STORE_OP_DONT_CARE;
  if (target.clear) info.clearValue = *target.clear;
  if (!target.resolve) return info;
  const std::uint32_t to = recorder_.attachment_access(pass_, target.resolve.index);
  if (to == kNone) return info;
  const AccessRecord& resolve = recorder_.graph_->description().accesses[to];
  info.resolveMode = target.resolve_mode != VK_RESOLVE_MODE_NONE ? target.resolve_mode
                     : aspects(format(target.texture)) & VK_IMAGE_ASPECT_COLOR_BIT
                         ? VK_RESOLVE_MODE_AVERAGE_BIT
                         : VK_RESOLVE_MODE_SAMPLE_ZERO_BIT;
  info.resolveImageView = view(target.resolve, resolve.range);
  info.resolveImageLayout = resolve.layout;
  return info;
}

bool RecordContext::begin_rendering(std::span<const Attachment> colors, const Attachment& depth,
                                    const Rendering& rendering) const {
  constexpr std::size_t kMost = 8;
  const auto refuse = [this](ErrorCode code, const char* why) {
    recorder_.fail(code, pass_, why);
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
  VkRenderingInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
  const GraphDescription& graph = recorder_.graph_->description();
  std::uint32_t samples = 0;
  bool alike = true;
  const auto add = [&](const Attachment& target, std::uint32_t index,
                       VkRenderingAttachmentInfo& to) {
    to = attachment(target, index);
    if (index == kNone || to.imageView == VK_NULL_HANDLE) return false;
    const ResourceRecord& record = graph.resources[target.texture.index];
    const Range range = target.range != Range{} ? Graph::resolved_range(target.range, record)
                                                : graph.accesses[index].range;
    const VkExtent3D size = extent(target.texture, range.base_mip);
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
    if (!add(colors[i], attachment_access(colors[i]), color_infos[i])) return false;
  }
  info.colorAttachmentCount = static_cast<std::uint32_t>(colors.size());
  info.pColorAttachments = color_infos;
  if (depth.texture) {
    // Depth and stencil have the same view, whose own aspects Vulkan ignores.
    if (!add(depth, attachment_access(depth), depth_info)) return false;
    const VkImageAspectFlags bound = aspects(format(depth.texture));
    if (bound & VK_IMAGE_ASPECT_DEPTH_BIT) info.pDepthAttachment = &depth_info;
    if (bound & VK_IMAGE_ASPECT_STENCIL_BIT) info.pStencilAttachment = &depth_info;
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
  const Physical* const used = physical(texture.index, texture.version);
  return used ? used->image : VK_NULL_HANDLE;
}

VkBuffer RecordContext::buffer(Buffer buffer) const {
  const Physical* const used = physical(buffer.index, buffer.version);
  return used ? used->buffer : VK_NULL_HANDLE;
}

VkImageLayout RecordContext::layout(Texture texture, Range range) const {
  const AccessRecord* const first = recorder_.declared(pass_, texture.index);
  if (first == nullptr) return VK_IMAGE_LAYOUT_UNDEFINED;
  const GraphDescription& graph = recorder_.graph_->description();
  if (range == Range{}) return first->layout;
  range = Graph::resolved_range(range, graph.resources[texture.index]);
  for (const AccessRecord& access : graph.pass_accesses(pass_))
    if (access.resource == texture.index && contains(access.range, range)) return access.layout;
  return first->layout;
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

HistoryValidity RecordContext::validity(Texture texture) const {
  const GraphDescription& graph = recorder_.graph_->description();
  if (texture.index >= graph.resources.size()) return HistoryValidity::first_frame;
  asked_ |= std::uint64_t{1} << texture.index % 64;
  const std::uint32_t external = graph.resources[texture.index].external;
  return external == kNone ? HistoryValidity::valid : graph.externals[external].validity;
}

void RecordContext::fail(std::string_view what, VkResult result) const {
  recorder_.fail(ErrorCode::vulkan, pass_,
                 "cannot be recorded: no " + std::string(what) + " could be made", kNone, 0,
                 result);
}

std::string_view RecordContext::pass_name() const {
  return recorder_.graph_->description().pass_name(pass_);
}

}  // namespace alcove::framegraph
