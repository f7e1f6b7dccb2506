#include "aspects.h"
#include "print_names.h"
#include "validate.h"

namespace alcove::framegraph {
namespace {

// The stages that a queue class cannot run.
constexpr VkPipelineStageFlags2 kGraphicsStages =
    VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT | VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT |
    VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT | VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT |
    VK_PIPELINE_STAGE_2_TESSELLATION_CONTROL_SHADER_BIT |
    VK_PIPELINE_STAGE_2_TESSELLATION_EVALUATION_SHADER_BIT |
    VK_PIPELINE_STAGE_2_GEOMETRY_SHADER_BIT | VK_PIPELINE_STAGE_2_PRE_RASTERIZATION_SHADERS_BIT |
    VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT |
    VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT |
    VK_PIPELINE_STAGE_2_ALL_GRAPHICS_BIT | VK_PIPELINE_STAGE_2_TASK_SHADER_BIT_EXT |
    VK_PIPELINE_STAGE_2_MESH_SHADER_BIT_EXT | VK_PIPELINE_STAGE_2_TRANSFORM_FEEDBACK_BIT_EXT |
    VK_PIPELINE_STAGE_2_FRAGMENT_SHADING_RATE_ATTACHMENT_BIT_KHR;
constexpr VkPipelineStageFlags2 kComputeStages =
    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT |
    VK_PIPELINE_STAGE_2_RAY_TRACING_SHADER_BIT_KHR |
    VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR |
    VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_COPY_BIT_KHR;
// Blits need a graphics queue, though they are transfers.
constexpr VkPipelineStageFlags2 kBlitStages =
    VK_PIPELINE_STAGE_2_BLIT_BIT | VK_PIPELINE_STAGE_2_RESOLVE_BIT;

VkPipelineStageFlags2 forbidden(QueueClass queue) {
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

struct Checker {
  Validation& v;
  std::uint32_t pass;
  const AccessRecord& access;

  bool bad(ErrorCode code, const std::string& what) {
    v.fail(code, v.pass_text(pass) + " " + what, pass, access.resource, access.version);
    return false;
  }
  std::string verb() const { return access.flags & kWrite ? "writes " : "reads "; }
  std::string subject() const { return verb() + v.resource_text(access.resource); }

  bool handle() {
    const char* kind = access.kind() == ResourceKind::texture ? "texture" : "buffer";
    if (access.flags & kNull)
      return bad(ErrorCode::null_handle, verb() + "a " + kind +
                                             " through a null handle: pass one that "
                                             "the graph gave in this frame");
    if (access.flags & kForeign)
      return bad(ErrorCode::foreign_handle,
                 verb() + "a " + kind +
                     " through a handle of another graph, or of a frame before reset: "
                     "declare or import it in this frame");
    if (access.kind() != v.graph.resources[access.resource].kind)
      return bad(ErrorCode::foreign_handle, verb() + "a " + kind + " through a handle that is of " +
                                                v.resource_text(access.resource));
    if (access.flags & kClosed)
      return bad(ErrorCode::closed_pass,
                 subject() +
                     " after the next pass was added: declare all accesses of a pass "
                     "before the next add_pass");
    return true;
  }

  bool range() {
    const ResourceRecord& r = v.graph.resources[access.resource];
    if (r.kind == ResourceKind::buffer) return true;
    const Range& range = access.range;
    if (range.aspects & ~aspects(r.format))
      return bad(ErrorCode::bad_range, subject() + " in an aspect that its format does not have");
    if (range.aspects != 0 && !v.limits.separate_depth_stencil)
      return bad(ErrorCode::bad_range,
                 subject() +
                     " in one of its aspects, but the device does not do that: enable "
                     "separateDepthStencilLayouts and set DeviceHandles::separate_depth_stencil");
    if (range.mips != 0 && range.layers != 0 && range.base_mip + range.mips <= r.mips &&
        range.base_layer + range.layers <= r.layers)
      return true;
    return bad(ErrorCode::bad_range,
               subject() + " from mip " + std::to_string(range.base_mip) + " and layer " +
                   std::to_string(range.base_layer) + " on (" + std::to_string(range.mips) + "x" +
                   std::to_string(range.layers) + "), but it has " + std::to_string(r.mips) +
                   " mips and " + std::to_string(r.layers) + " layers");
  }

  void masks() {
    const ResourceRecord& r = v.graph.resources[access.resource];
    if (access.stages == 0 || access.access == 0)
      bad(ErrorCode::bad_access,
          subject() + " in no stage or with no access bit: use one of access.h");
    const bool writes = (access.access & kWriteBits) != 0;
    if (writes != ((access.flags & kWrite) != 0))
      bad(ErrorCode::bad_access,
          subject() + (writes ? " with an access that writes: declare it with write()"
                              : " with an access that only reads: declare it with read()"));
    if (r.kind == ResourceKind::texture && !layout_is_usable(access.layout))
      bad(ErrorCode::bad_access, subject() +
                                     " in layout undefined or preinitialised, in which nothing "
                                     "can be used: give the layout of the use");
    if (access.stages & forbidden(v.graph.passes[pass].queue))
      bad(ErrorCode::bad_access, subject() +
                                     " in a stage that its queue class cannot run: put "
                                     "the pass on QueueClass::graphics");
  }

  void usage() {
    const ResourceRecord& r = v.graph.resources[access.resource];
    const auto names = [&](VkFlags usage) { return usage_names(r.kind, usage); };
    const bool imported = r.origin == Origin::imported;
    if (imported || (r.origin == Origin::history && r.kind == ResourceKind::buffer)) {
      const VkFlags has =
          imported ? v.graph.externals[r.external].usage : history_usage(v.limits, r);
      const VkFlags missing = access.usage & ~has;
      if (missing != 0)
        bad(ErrorCode::missing_usage,
            subject() + " with usage " + names(access.usage) + ", but it was " +
                (imported ? "imported" : "created") + " with " + names(has) + ": create it with " +
                names(missing) + (imported ? " too" : " in BufferDesc::usage too"));
    }
    if (r.kind != ResourceKind::texture || v.limits.formats.query == nullptr) return;
    const VkFlags missing =
        access.usage & ~v.limits.formats.query(v.limits.formats.context, r.format);
    if (missing != 0)
      bad(ErrorCode::unsupported_format,
          subject() + " with usage " + names(missing) + ", which format " +
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
