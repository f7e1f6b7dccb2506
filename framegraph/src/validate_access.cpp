#include <array>
#include <bit>

#include "print_names.h"
#include "validate.h"

namespace alcove::framegraph {
namespace {

using Stages = VkPipelineStageFlags2;
constexpr Stages kIndexInput =
    VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT | VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT;
constexpr Stages kAttributeInput =
    VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT | VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT;
constexpr Stages kGraphicsShaders =
    VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_TESSELLATION_CONTROL_SHADER_BIT |
    VK_PIPELINE_STAGE_2_TESSELLATION_EVALUATION_SHADER_BIT |
    VK_PIPELINE_STAGE_2_GEOMETRY_SHADER_BIT | VK_PIPELINE_STAGE_2_PRE_RASTERIZATION_SHADERS_BIT |
    VK_PIPELINE_STAGE_2_TASK_SHADER_BIT_EXT | VK_PIPELINE_STAGE_2_MESH_SHADER_BIT_EXT |
    VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
constexpr Stages kTests =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
constexpr Stages kColor = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
constexpr Stages kFeedback = VK_PIPELINE_STAGE_2_TRANSFORM_FEEDBACK_BIT_EXT;
constexpr Stages kShadingRate = VK_PIPELINE_STAGE_2_FRAGMENT_SHADING_RATE_ATTACHMENT_BIT_KHR;
// The pipeline stages that only a graphics queue supports.
constexpr Stages kGraphicsStages = kIndexInput | kAttributeInput | kGraphicsShaders | kTests |
                                   kColor | kFeedback | kShadingRate |
                                   VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT;
// The stages of acceleration structures.
constexpr Stages kBuilds = VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR |
                           VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_COPY_BIT_KHR;
constexpr Stages kDispatches =
    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_RAY_TRACING_SHADER_BIT_KHR;
constexpr Stages kComputeStages = kDispatches | kBuilds | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT;
// The stage of blits, which need a graphics queue although they are transfers.
constexpr Stages kBlitStages = VK_PIPELINE_STAGE_2_BLIT_BIT | VK_PIPELINE_STAGE_2_RESOLVE_BIT;

// By the number of a stage's bit: the accesses that the stage can make. Stages that the graph does
// not know, such as those of video, have none.
constexpr auto kAccessesByStage = [] {
  std::array<VkAccessFlags2, 64> table{};
  const auto add = [&table](Stages stages, VkAccessFlags2 access) {
    if ((stages & kGraphicsStages) != 0) stages |= VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT;
    for (stages |= VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT; stages != 0; stages &= stages - 1)
      table[static_cast<std::size_t>(std::countr_zero(stages))] |=
          access | VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
  };
  add(VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT | VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT,
      VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT | VK_ACCESS_2_TRANSFORM_FEEDBACK_COUNTER_READ_BIT_EXT);
  add(kIndexInput, VK_ACCESS_2_INDEX_READ_BIT);
  add(kAttributeInput, VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT);
  add(kGraphicsShaders | kDispatches,
      VK_ACCESS_2_UNIFORM_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT |
          VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT | VK_ACCESS_2_SHADER_WRITE_BIT);
  add(kGraphicsShaders | kDispatches | kBuilds,
      VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_READ_BIT |
          VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR);
  add(kBuilds, VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR);
  add(kColor, VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT);
  add(kTests, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT |
                  VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT);
  add(VK_PIPELINE_STAGE_2_COPY_BIT | VK_PIPELINE_STAGE_2_CLEAR_BIT | kBlitStages | kBuilds |
          VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
      VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT);
  add(kFeedback, VK_ACCESS_2_TRANSFORM_FEEDBACK_WRITE_BIT_EXT |
                     VK_ACCESS_2_TRANSFORM_FEEDBACK_COUNTER_READ_BIT_EXT |
                     VK_ACCESS_2_TRANSFORM_FEEDBACK_COUNTER_WRITE_BIT_EXT);
  add(VK_PIPELINE_STAGE_2_CONDITIONAL_RENDERING_BIT_EXT | VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT,
      VK_ACCESS_2_CONDITIONAL_RENDERING_READ_BIT_EXT);
  add(kShadingRate, VK_ACCESS_2_FRAGMENT_SHADING_RATE_ATTACHMENT_READ_BIT_KHR);
  return table;
}();

}  // namespace

bool can_make(VkPipelineStageFlags2 stages, VkAccessFlags2 access) {
  constexpr VkPipelineStageFlags2 kHost = VK_PIPELINE_STAGE_2_HOST_BIT;
  VkAccessFlags2 possible = 0;
  if ((stages & kHost) != 0) possible = VK_ACCESS_2_HOST_READ_BIT | VK_ACCESS_2_HOST_WRITE_BIT;
  stages &= ~(kHost | VK_PIPELINE_STAGE_2_TOP_OF_PIPE_BIT | VK_PIPELINE_STAGE_2_BOTTOM_OF_PIPE_BIT);
  for (; stages != 0; stages &= stages - 1) {
    const VkAccessFlags2 own = kAccessesByStage[static_cast<std::size_t>(std::countr_zero(stages))];
    if (own == 0) return false;
    possible |= own;
  }
  return (access & ~possible) == 0;
}

VkPipelineStageFlags2 forbidden_stages(QueueClass queue) {
  switch (queue) {
    case QueueClass::graphics:
      return 0;
    case QueueClass::compute:
      return kGraphicsStages | kBlitStages;
    case QueueClass::transfer:
      return kGraphicsStages | kBlitStages | kComputeStages | VK_PIPELINE_STAGE_2_CLEAR_BIT;
  }
  return 0;
}

namespace {

struct Checker {
  Validation& v;
  std::uint32_t pass;
  const AccessRecord& access;

  // Adds an error about the access and returns false.
  bool refuse(ErrorCode code, const std::string& sentence) {
    v.fail(code, pass, access, sentence);
    return false;
  }
  bool refuse_use(ErrorCode code, const char* how) { return refuse(code, subject() + how); }
  const char* verb() const { return access.flags & kWrite ? "writes " : "reads "; }
  std::string subject() const { return verb() + v.resource_text(access.resource); }

  bool handle() {
    if ((access.flags & (kNull | kForeign | kClosed)) == 0 &&
        access.kind() == v.graph.resources[access.resource].kind)
      return true;
    const std::string kind = std::string(verb()).append("a ").append(
        access.kind() == ResourceKind::texture ? "texture" : "buffer");
    if (access.flags & kNull)
      return refuse(ErrorCode::null_handle,
                    kind + " through a null handle: pass one that the graph gave in this frame");
    if (access.flags & kForeign)
      return refuse(ErrorCode::foreign_handle,
                    kind +
                        " through a handle of another graph, or of a frame before reset: declare "
                        "or import it in this frame");
    if (access.kind() != v.graph.resources[access.resource].kind)
      return refuse(ErrorCode::foreign_handle,
                    kind + " through a handle that is of " + v.resource_text(access.resource));
    return refuse_use(ErrorCode::closed_pass,
                      " after the next pass was added: declare all accesses of a pass before the "
                      "next add_pass");
  }

  bool range() {
    const ResourceRecord& r = v.graph.resources[access.resource];
    const Range& range = access.range;
    if (r.kind == ResourceKind::buffer) return true;
    if (range.mips != 0 && range.layers != 0 && range.base_mip + range.mips <= r.mips &&
        range.base_layer + range.layers <= r.layers)
      return true;
    return refuse(ErrorCode::bad_range,
                  subject() + " from mip " + std::to_string(range.base_mip) + " and layer " +
                      std::to_string(range.base_layer) + " on (" + std::to_string(range.mips) +
                      "x" + std::to_string(range.layers) + "), but it has " +
                      std::to_string(r.mips) + " mips and " + std::to_string(r.layers) + " layers");
  }

  void masks() {
    const ResourceRecord& r = v.graph.resources[access.resource];
    if (access.stages == 0 || access.access == 0)
      refuse_use(ErrorCode::bad_access, " in no stage or with no access bit: use one of access.h");
    const bool writes = (access.access & kWriteBits) != 0;
    if (writes != ((access.flags & kWrite) != 0))
      refuse_use(ErrorCode::bad_access,
                 writes ? " with an access that writes: declare it with write()"
                        : " with an access that only reads: declare it with read()");
    if (r.kind == ResourceKind::texture && !layout_is_usable(access.layout))
      refuse_use(ErrorCode::bad_access,
                 " in layout undefined or preinitialised, in which nothing can be used: give the "
                 "layout of the use");
    if (!can_make(access.stages, access.access))
      refuse_use(ErrorCode::bad_access,
                 " with an access that none of its stages can make, or in a stage that the graph "
                 "does not know: use one of access.h");
    if (access.stages & forbidden_stages(v.graph.passes[pass].queue))
      refuse_use(ErrorCode::bad_access,
                 " in a stage that its queue class cannot run: put the pass on "
                 "QueueClass::graphics");
  }

  void usage() {
    const ResourceRecord& r = v.graph.resources[access.resource];
    if (r.origin == Origin::imported) check_usage(v.graph.externals[r.external].usage);
    if (r.kind == ResourceKind::texture && v.limits.formats.query != nullptr) check_format(r);
  }
  void check_usage(VkFlags has) {
    const VkFlags missing = access.usage & ~has;
    if (missing == 0) return;
    const auto names = [&](VkFlags usage) { return usage_names(access.kind(), usage); };
    refuse(ErrorCode::missing_usage, subject() + " with usage " + names(access.usage) +
                                         ", but it was imported with " + names(has) +
                                         ": create it with " + names(missing) + " too");
  }
  void check_format(const ResourceRecord& r) {
    const VkFlags missing =
        access.usage & ~v.limits.formats.query(v.limits.formats.context, r.format);
    if (missing == 0) return;
    refuse(ErrorCode::unsupported_format,
           subject() + " with usage " + usage_names(r.kind, missing) + ", which format " +
               std::to_string(static_cast<int>(r.format)) +
               " does not support on this device: choose another format");
  }
};

}  // namespace

bool validate_access(Validation& validation, std::uint32_t pass, const AccessRecord& access) {
  Checker checker{validation, pass, access};
  if (!checker.handle() || !checker.range()) return false;
  checker.masks();
  checker.usage();
  return true;
}

}  // namespace alcove::framegraph
