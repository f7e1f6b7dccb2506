// Checks that the device can create the textures of a plan. It runs after culling, because the
// usage of a texture depends on the passes that run.
#include "print_names.h"
#include "workspace.h"

namespace alcove::framegraph {
namespace {

// Returns whether the fields of Limits and the format's features alone show that the device can
// create the texture.
bool needs_no_query(const ResourceRecord& record) {
  return record.kind == ResourceKind::buffer || record.origin == Origin::imported ||
         (record.samples == 1 && record.layers == 1 && record.depth == 1 &&
          record.create_flags == 0);
}

std::string problem_with(const ResourceRecord& record, const ImageLimits& limits) {
  if (limits.samples == 0) return "the device does not support it";
  if ((limits.samples & record.samples) == 0) {
    std::string allowed;
    for (std::uint32_t count = 1; count <= 64; count *= 2)
      if (limits.samples & count) allowed += (allowed.empty() ? "" : ", ") + std::to_string(count);
    return "the device allows " + allowed + " sample(s) for it, not " +
           std::to_string(record.samples);
  }
  const struct {
    const char* what;
    std::uint32_t has;
    std::uint32_t most;
  } numbers[] = {{"layers", record.layers, limits.layers},
                 {"mips", record.mips, limits.mips},
                 {"texels of width", record.width, limits.extent.width},
                 {"texels of height", record.height, limits.extent.height},
                 {"slices", record.depth, limits.extent.depth}};
  for (const auto& [what, has, most] : numbers)
    if (has > most)
      return std::string("the device allows at most ") + std::to_string(most) + " " + what +
             " for it, not " + std::to_string(has);
  return {};
}

}  // namespace

VkFlags history_usage(const Limits& limits, const ResourceRecord& record) {
  VkFlags usage = limits.formats.query ? limits.formats.query(limits.formats.context, record.format)
                                       : ~VkFlags{0};
  // Few devices support storage usage for multisampled images. A history would get this usage too,
  // because it is created with every usage that it can have. The usage is therefore removed.
  if (record.samples > 1) usage &= ~VkFlags{VK_IMAGE_USAGE_STORAGE_BIT};
  return usage;
}

bool check_images(const GraphDescription& graph, const Limits& limits, const Plan& plan,
                  Errors& errors) {
  if (limits.images.query == nullptr) return true;
  for (std::uint32_t r = 0; r < graph.resources.size(); ++r) {
    const ResourceRecord& record = graph.resources[r];
    const Placement& placement = plan.placements[r];
    if (placement.first == kNone || needs_no_query(record)) continue;
    const bool history = record.origin == Origin::history;
    const VkFlags usage =
        history ? history_usage(limits, record) | placement.usage : placement.usage;
    const std::string problem =
        problem_with(record, limits.images.query(limits.images.context, record, usage));
    if (problem.empty()) continue;
    errors.push_back({ErrorCode::unsupported_format,
                      "texture '" + std::string(graph.resource_name(r)) + "' has format " +
                          std::to_string(static_cast<int>(record.format)) + " and usage " +
                          usage_names(record.kind, usage) + ": " + problem +
                          ": choose another format, use or number of samples",
                      VK_SUCCESS, kNone, r, 0});
    if (history) break;  // The other slots have the same description.
  }
  return errors.empty();
}

}  // namespace alcove::framegraph
