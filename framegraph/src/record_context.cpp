#include "alcove/framegraph/record_context.h"

#include "recorder.h"

namespace alcove::framegraph {

VkImageView RecordContext::view(Texture texture) const {
  const AccessRecord* access = recorder_.declared(pass_, texture.index);
  return access ? view(texture, access->range) : VkImageView{VK_NULL_HANDLE};
}

VkImageView RecordContext::view(Texture texture, Range range) const {
  if (!recorder_.declared(pass_, texture.index)) return VK_NULL_HANDLE;
  Physical* physical = (*recorder_.physical_)[texture.index];
  if (physical == nullptr || physical->image == VK_NULL_HANDLE) return VK_NULL_HANDLE;
  const GraphDescription& graph = recorder_.graph_->description();
  const ResourceRecord& record = graph.resources[texture.index];
  range = Graph::resolved_range(range, record);
  if (!recorder_.check_view(pass_, texture.index, range)) return VK_NULL_HANDLE;
  if (record.origin == Origin::imported && range.mips == record.mips &&
      range.layers == record.layers) {
    const VkImageView given = recorder_.graph_->imports_[record.external].view;
    if (given != VK_NULL_HANDLE) return given;
  }
  const VkImageView view = recorder_.pool_.view(*physical, range);
  if (view == VK_NULL_HANDLE) {
    recorder_.errors_.push_back(
        {ErrorCode::vulkan,
         std::string("no view of '").append(graph.resource_name(texture.index)) +
             "' could be made: the device is out of memory",
         VK_ERROR_OUT_OF_DEVICE_MEMORY, pass_, texture.index, texture.version});
  }
  return view;
}

VkImage RecordContext::image(Texture texture) const {
  if (!recorder_.declared(pass_, texture.index)) return VK_NULL_HANDLE;
  const Physical* physical = (*recorder_.physical_)[texture.index];
  return physical ? physical->image : VK_NULL_HANDLE;
}

VkBuffer RecordContext::buffer(Buffer buffer) const {
  if (!recorder_.declared(pass_, buffer.index)) return VK_NULL_HANDLE;
  const Physical* physical = (*recorder_.physical_)[buffer.index];
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

bool RecordContext::is_used(Texture texture) const {
  const GraphDescription& graph = recorder_.graph_->description();
  const auto accesses = graph.pass_accesses(pass_);
  const std::uint8_t* live =
      recorder_.plan_->live_accesses.data() + graph.passes[pass_].first_access;
  for (std::size_t i = 0; i < accesses.size(); ++i) {
    if (accesses[i].resource == texture.index && live[i]) return true;
  }
  return false;
}

bool RecordContext::is_used(Buffer buffer) const {
  return is_used(Texture{buffer.index, buffer.version, buffer.graph});
}

HistoryValidity RecordContext::validity(Texture texture) const {
  const GraphDescription& graph = recorder_.graph_->description();
  if (texture.index >= graph.resources.size()) return HistoryValidity::first_frame;
  const std::uint32_t external = graph.resources[texture.index].external;
  return external == kNone ? HistoryValidity::valid : graph.externals[external].validity;
}

HistoryValidity RecordContext::validity(Buffer buffer) const {
  return validity(Texture{buffer.index, buffer.version, buffer.graph});
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
