#include "work/work_builder.h"

#include <algorithm>
#include <cstring>

#include "work/output_format.h"
#include "work/shader_table.h"

namespace alcove::passes {

namespace {

AlcoveBindingType binding_type(VkDescriptorType type) {
  switch (type) {
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
      return ALCOVE_BINDING_TYPE_PARAMETERS;
    case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER:
      return ALCOVE_BINDING_TYPE_TABLE;
    case VK_DESCRIPTOR_TYPE_SAMPLER:
      return ALCOVE_BINDING_TYPE_SAMPLER;
    case VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE:
      return ALCOVE_BINDING_TYPE_FETCHED_IMAGE;
    default:
      return ALCOVE_BINDING_TYPE_STORAGE_IMAGE;
  }
}

// Returns the size of the texels of an image that the passes create.
std::uint64_t image_bytes(VkFormat format, VkExtent2D size) {
  return std::uint64_t{size.width} * size.height * texel_bytes(format);
}

bool is_of_host(AlcoveResourceKind kind) {
  return kind == ALCOVE_RESOURCE_KIND_INPUT || kind == ALCOVE_RESOURCE_KIND_OUTPUT;
}

constexpr std::uint32_t kGroupSize = 8;

std::uint32_t groups(std::uint32_t invocations) {
  return (invocations + kGroupSize - 1) / kGroupSize;
}

}  // namespace

WorkBuilder::WorkBuilder(AlcoveWork& work, const AlcoveWork* previous) : work_(work) {
  for (std::uint32_t i = 0; previous != nullptr && i < previous->history_count; ++i) {
    const AlcoveWorkResource& slot = previous->resources[previous->histories[i].current];
    previous_[i] = {slot.name, slot.format, {slot.width, slot.height}};
  }
  work.history_valid = 0;
  work.resource_count = work.dispatch_count = work.history_count = 0;
}

ResourceHandle WorkBuilder::add(AlcoveResourceKind kind, const char* name, VkFormat format,
                                VkExtent2D size, std::uint32_t samples, std::uint32_t role) {
  if (work_.resource_count == ALCOVE_MAX_WORK_RESOURCES) return {};
  work_.resources[work_.resource_count] = {.name = name,
                                           .kind = kind,
                                           .role = role,
                                           .format = static_cast<std::uint32_t>(format),
                                           .width = size.width,
                                           .height = size.height,
                                           .samples = samples,
                                           .usage = 0,
                                           .first_dispatch = ALCOVE_WORK_NONE,
                                           .last_dispatch = ALCOVE_WORK_NONE,
                                           .size = is_of_host(kind) ? 0 : image_bytes(format, size),
                                           .data = nullptr};
  return {work_.resource_count++};
}

WorkBuilder::History WorkBuilder::add_history(HistoryRole role, VkFormat format, VkExtent2D size) {
  const char* const name = kHistoryNames.at(static_cast<std::size_t>(role));
  History history{add(ALCOVE_RESOURCE_KIND_HISTORY_PREVIOUS, name, format, size),
                  add(ALCOVE_RESOURCE_KIND_HISTORY_CURRENT, name, format, size)};
  if (!history.current || work_.history_count == ALCOVE_MAX_WORK_HISTORIES) return {};
  work_.histories[work_.history_count++] = {history.previous.index, history.current.index};
  history.valid = source_.is_valid != nullptr
                      ? source_.is_valid(source_.user, role, history)
                      : std::ranges::any_of(previous_, [&](const KnownHistory& known) {
                          return known.name == name &&
                                 known.format == static_cast<std::uint32_t>(format) &&
                                 known.size.width == size.width && known.size.height == size.height;
                        });
  return history;
}

std::uint32_t WorkBuilder::add_table(const char* name, std::span<const std::uint32_t> words) {
  const ResourceHandle table = add(ALCOVE_RESOURCE_KIND_TABLE, name, VK_FORMAT_UNDEFINED, {});
  if (table) {
    AlcoveWorkResource& added = work_.resources[table.index];
    added.size = words.size_bytes();
    added.data = words.data();
  }
  return table.index;
}

void WorkBuilder::dispatch(const DispatchRequest& info) {
  if (result_) result_ = add_dispatch(info);
}

tl::expected<void, Error> WorkBuilder::add_dispatch(const DispatchRequest& info) {
  const ShaderSource source = shader_source(info.shader);
  const auto fail = [&](std::string_view what) {
    return tl::unexpected(Error{std::string("The shader '").append(source.name).append("' ") +
                                std::string(what) + "."});
  };
  if (work_.dispatch_count == ALCOVE_MAX_WORK_DISPATCHES ||
      info.parameters.size() > ALCOVE_MAX_WORK_PARAMETER_BYTES)
    return fail("does not fit into the list of work");
  AlcoveWorkDispatch& entry = work_.dispatches[work_.dispatch_count];
  entry.label = info.label;
  entry.shader = source.name.data();
  entry.groups[0] = groups(info.size.width);
  entry.groups[1] = groups(info.size.height);
  entry.groups[2] = info.size.depth;
  const auto constants = resolve_constants(info.shader, info.constants, entry.constants);
  if (!constants) return tl::unexpected(constants.error());
  entry.constant_count = *constants;
  entry.binding_count = 0;
  std::size_t images = 0;
  for (const ShaderBinding& binding : shader_interface(info.shader).bindings) {
    const NamedImage* const image =
        binding.is_image() ? find_named(info.images, binding.name, images++) : nullptr;
    const ResourceHandle texture = image == nullptr ? ResourceHandle{} : image->texture;
    if (!bind(entry, binding, texture, source.table)) {
      return fail(std::string("has a binding '").append(binding.name) +
                  "', for which its pass gives no image; name it in the pass's list of images");
    }
  }
  entry.parameter_bytes = static_cast<std::uint32_t>(info.parameters.size());
  if (!info.parameters.empty())
    std::memcpy(entry.parameters, info.parameters.data(), info.parameters.size());
  ++work_.dispatch_count;
  return {};
}

// Adds a binding to the dispatch that is being added, and the use to its resource: the image that
// is given, or the table. Returns false if there is no resource.
bool WorkBuilder::bind(AlcoveWorkDispatch& dispatch, const ShaderBinding& binding,
                       ResourceHandle given, std::span<const std::uint32_t> table) {
  AlcoveWorkBinding& bound = dispatch.bindings[dispatch.binding_count++];
  bound = {.name = binding.name.data(),
           .number = binding.number,
           .type = binding_type(binding.type),
           .access = binding.access,
           .resource = ALCOVE_WORK_NONE};
  if (bound.type == ALCOVE_BINDING_TYPE_PARAMETERS || bound.type == ALCOVE_BINDING_TYPE_SAMPLER)
    return true;
  const ResourceHandle used =
      bound.type == ALCOVE_BINDING_TYPE_TABLE ? ResourceHandle{add_table("table", table)} : given;
  if (find(used) == nullptr) return false;
  AlcoveWorkResource& resource = work_.resources[used.index];
  bound.resource = used.index;
  resource.first_dispatch = std::min(resource.first_dispatch, work_.dispatch_count);
  resource.last_dispatch = work_.dispatch_count;
  if (binding.is_image()) {
    resource.usage |= bound.type == ALCOVE_BINDING_TYPE_STORAGE_IMAGE ? ALCOVE_WORK_USAGE_STORAGE
                                                                      : ALCOVE_WORK_USAGE_SAMPLED;
  }
  return true;
}

const AlcoveWorkResource* WorkBuilder::find(ResourceHandle texture) const {
  return texture.index < work_.resource_count ? &work_.resources[texture.index] : nullptr;
}

VkExtent2D WorkBuilder::size(ResourceHandle texture) const {
  const AlcoveWorkResource* const resource = find(texture);
  return resource == nullptr ? VkExtent2D{} : VkExtent2D{resource->width, resource->height};
}

VkFormat WorkBuilder::format(ResourceHandle texture) const {
  const AlcoveWorkResource* const resource = find(texture);
  return resource == nullptr ? VK_FORMAT_UNDEFINED : static_cast<VkFormat>(resource->format);
}

std::uint32_t WorkBuilder::samples(ResourceHandle texture) const {
  const AlcoveWorkResource* const resource = find(texture);
  return resource == nullptr ? 0 : resource->samples;
}

}  // namespace alcove::passes
