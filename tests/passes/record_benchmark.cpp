// Prints how long the CPU takes to record a steady frame with the C interface.
//
//   c_record_benchmark
//
// Prints medians over many frames of one view. For "the library alone" the driver's recording
// functions are replaced by empty ones, because a software device spends more time in them than the
// library does.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "engine.h"
#include "views.h"

namespace alcove::passes {
namespace {

template <typename... Arguments>
VKAPI_ATTR void VKAPI_CALL nothing(Arguments...) {}

template <typename... Arguments>
PFN_vkVoidFunction empty(void(VKAPI_PTR*)(Arguments...)) {
  return untyped(&nothing<Arguments...>);
}

// Returns the median time of alcoveRecordFrame in microseconds, or a negative number if it fails.
double median_microseconds(const sample::VulkanDevice& device, bool library_alone,
                           bool all_outputs) {
  TestEngine engine(device);
  AlcoveContextInfo info = engine.context_info();
  info.timestamps = VK_FALSE;
  if (library_alone) info.get_instance_proc_addr = get_replaced_function;
  const Context context = create_context(info);
  if (!context) return -1.0;
  const AlcoveSettings settings = get_settings(ALCOVE_QUALITY_MEDIUM, 0.5f);
  AlcoveView view =
      engine.make_view(settings, 16, 16,
                       {ALCOVE_IMAGE_DEPTH, ALCOVE_IMAGE_NORMALS, ALCOVE_IMAGE_VISIBILITY,
                        ALCOVE_IMAGE_BENT_NORMAL, ALCOVE_IMAGE_SPECULAR});
  if (!all_outputs) view.images[ALCOVE_IMAGE_BENT_NORMAL] = view.images[ALCOVE_IMAGE_SPECULAR] = {};
  view.info.camera = test_views()[2].view;
  AlcoveFrame frame{.struct_size = sizeof frame, .view_count = 1, .views = &view};
  std::vector<double> times;
  bool good = true;
  for (frame.index = 0; good && frame.index < 2000; ++frame.index) {
    frame.slot = frame.index % TestEngine::kSlots;
    view.info.previous_camera = view.info.camera;
    view.info.camera.view_from_world[12] = 0.01f * static_cast<float>(frame.index % 100);
    engine.submit(frame.slot, [&](VkCommandBuffer commands) {
      const auto begin = std::chrono::steady_clock::now();
      good = alcoveRecordFrame(context.get(), commands, &frame) == ALCOVE_SUCCESS;
      const std::chrono::duration<double, std::micro> time =
          std::chrono::steady_clock::now() - begin;
      if (frame.index >= 100) times.push_back(time.count());
    });
  }
  engine.wait();
  std::ranges::nth_element(times, times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2));
  return good ? times[times.size() / 2] : -1.0;
}

}  // namespace
}  // namespace alcove::passes

int main() {
  using namespace alcove;
  passes::replaced_functions = {
      {"vkCmdPipelineBarrier2", passes::empty(PFN_vkCmdPipelineBarrier2{})},
      {"vkCmdBindPipeline", passes::empty(PFN_vkCmdBindPipeline{})},
      {"vkCmdBindDescriptorSets", passes::empty(PFN_vkCmdBindDescriptorSets{})},
      {"vkCmdDispatch", passes::empty(PFN_vkCmdDispatch{})}};
  const auto device = sample::VulkanDevice::create();
  if (!device) {
    std::fprintf(stderr, "%s\n", device.error().c_str());
    return 1;
  }
  std::printf("Median microseconds of alcoveRecordFrame, one view, steady frames, on %s.\n",
              (*device)->properties().deviceName);
  for (const bool all_outputs : {false, true}) {
    std::printf("%-48s with the driver %7.2f, the library alone %7.2f\n",
                all_outputs ? "visibility, bent normals, specular" : "visibility",
                passes::median_microseconds(**device, false, all_outputs),
                passes::median_microseconds(**device, true, all_outputs));
  }
  return 0;
}
