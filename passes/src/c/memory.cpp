// Estimates the memory of a view from its settings.
#include "alcove/alcove.h"
#include "c/failure.h"
#include "c/settings.h"
#include "work/view_work.h"

namespace alcove::passes {
namespace {

constexpr std::uint32_t kKnownOutputs = ALCOVE_OUTPUT_VISIBILITY | ALCOVE_OUTPUT_BENT_NORMAL |
                                        ALCOVE_OUTPUT_SPECULAR | ALCOVE_OUTPUT_MULTI_BOUNCE;
constexpr std::uint32_t kKnownInputs =
    ALCOVE_INPUT_NORMALS | ALCOVE_INPUT_MASK | ALCOVE_INPUT_SAMPLES;

// Any projection: sizes do not depend on it.
constexpr View kView{.clip_from_view = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0}};

// Describes the work of a view with these outputs and inputs, bits of AlcoveOutput and AlcoveInput.
bool describe(AlcoveWork& work, OcclusionSettings settings, VkExtent2D size, std::uint32_t outputs,
              std::uint32_t inputs) {
  WorkList list(work);
  // The formats of the engine's images make no difference.
  const auto image = [&](std::uint32_t wanted, VkFormat format = VK_FORMAT_R32_SFLOAT,
                         std::uint32_t samples = 1) {
    return wanted != 0 ? list.add(ALCOVE_RESOURCE_KIND_INPUT, "", format, size, 1, samples)
                       : framegraph::Texture{};
  };
  const std::uint32_t samples = (inputs & ALCOVE_INPUT_SAMPLES) != 0 ? 2 : 1;
  const std::uint32_t multi_bounce = outputs & ALCOVE_OUTPUT_MULTI_BOUNCE;
  const ViewInputs view{.occlusion = {.depth_ndc = image(1, VK_FORMAT_D32_SFLOAT, samples),
                                      .normals = image(inputs & ALCOVE_INPUT_NORMALS),
                                      .back_depth_ndc = image(1),
                                      .second_depth_ndc = image(1),
                                      .mask = image(inputs & ALCOVE_INPUT_MASK, VK_FORMAT_R8_UNORM),
                                      .not_receiving = 1,
                                      .into = {image(outputs & ALCOVE_OUTPUT_VISIBILITY),
                                               image(outputs & ALCOVE_OUTPUT_BENT_NORMAL),
                                               image(outputs & ALCOVE_OUTPUT_SPECULAR)}},
                        .albedo = image(multi_bounce),
                        .multi_bounce = image(multi_bounce)};
  const Occlusion& into = view.occlusion.into;
  settings.visibility = into.visibility || view.multi_bounce;
  settings.bent_normal = bool(into.bent_normal);
  if (!into.specular) settings.specular = Specular::none;
  return describe_view(list, {.view = kView}, view, settings).has_value();
}

}  // namespace
}  // namespace alcove::passes

using namespace alcove::passes;

AlcoveResult alcoveEstimateMemory(const AlcoveSettings* settings, uint32_t width, uint32_t height,
                                  uint32_t outputs, uint32_t inputs, AlcoveMemory* memory) {
  constexpr std::uint32_t kLargest = 1u << 16;
  if (memory == nullptr || memory->struct_size != sizeof *memory || width < 1 || height < 1 ||
      width > kLargest || height > kLargest || outputs == 0 || (outputs & ~kKnownOutputs) != 0 ||
      (inputs & ~kKnownInputs) != 0)
    return ALCOVE_ERROR_INVALID_INPUT;
  return guarded([&]() -> Result {
    const auto known = to_settings(settings);
    AlcoveWork work;
    if (!known || !describe(work, *known, {width, height}, outputs, inputs)) return invalid("");
    std::uint64_t transients = 0, history = 0;
    for (const AlcoveWorkResource& resource : std::span(work.resources).first(work.resource_count))
      if (resource.kind == ALCOVE_RESOURCE_KIND_TRANSIENT)
        transients += resource.size;
      else if (resource.kind != ALCOVE_RESOURCE_KIND_TABLE)
        history += resource.size;  // the engine's images have a size of 0
    *memory = {.struct_size = sizeof *memory,
               .transients = transients,
               .transients_unshared = transients,
               .history = history,
               .allocated = transients + history};
    return {};
  });
}
