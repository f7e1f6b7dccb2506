#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "alcove/passes/setting_table.h"
#include "cli/commands.h"
#include "cli/open_session.h"
#include "cli/settings.h"
#include "evaluate/situations.h"
#include "gpu_cost/cost_report.h"
#include "render/frame_renderer.h"
#include "spirv/empty.h"
#include "support/median.h"
#include "support/result.h"
#include "support/whole_file.h"

namespace alcove::sample {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kDispatches = 256;  // empty ones of a pass
constexpr std::uint32_t kRuns = 20;         // of these passes

// A pipeline that does nothing. Its handles are null until they are created.
struct EmptyPipeline {
  explicit EmptyPipeline(VkDevice of) : device(of) {}
  ~EmptyPipeline() {
    vkDestroyPipeline(device, pipeline, nullptr);
    vkDestroyPipelineLayout(device, layout, nullptr);
    vkDestroyShaderModule(device, module, nullptr);
  }
  EmptyPipeline(const EmptyPipeline&) = delete;
  EmptyPipeline& operator=(const EmptyPipeline&) = delete;

  VkResult create() {
    const VkShaderModuleCreateInfo code{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                        .codeSize = sizeof kEmpty,
                                        .pCode = kEmpty};
    const VkPipelineLayoutCreateInfo empty{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    VkResult result = vkCreateShaderModule(device, &code, nullptr, &module);
    if (result == VK_SUCCESS) result = vkCreatePipelineLayout(device, &empty, nullptr, &layout);
    if (result != VK_SUCCESS) return result;
    const VkComputePipelineCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = module,
                  .pName = "main"},
        .layout = layout};
    return vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline);
  }

  VkDevice device;
  VkShaderModule module = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkPipeline pipeline = VK_NULL_HANDLE;
};

void record(VkCommandBuffer commands, VkPipeline pipeline, bool barriers) {
  const VkMemoryBarrier2 written{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                 .srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                 .srcAccessMask = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                                 .dstStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                 .dstAccessMask = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};
  const VkDependencyInfo dependency{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                    .memoryBarrierCount = 1,
                                    .pMemoryBarriers = &written};
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  for (std::uint32_t i = 0; i < kDispatches; ++i) {
    if (barriers) vkCmdPipelineBarrier2(commands, &dependency);
    vkCmdDispatch(commands, 1, 1, 1);
  }
}

// The GPU time of dispatches of one workgroup that does nothing, in microseconds; medians.
struct DispatchCost {
  double alone_us = 0;           // of one in a row of dispatches without barriers
  double behind_barrier_us = 0;  // of one that waits for the memory writes of the one before
};

Result<DispatchCost> measure_dispatch_cost(Gpu& gpu) {
  EmptyPipeline empty(gpu.device().device());
  ALCOVE_TRY_VOID(check(empty.create(), "create an empty pipeline"));
  std::array<std::vector<double>, 2> microseconds;
  for (std::uint32_t run = 0; run < kRuns; ++run) {
    ALCOVE_TRY_VOID(gpu.run([&](Graph& graph) -> Result<void> {
      for (const bool barriers : {false, true}) {
        auto pass = graph.add_pass("empty dispatches");
        pass.side_effect();
        pass.record([pipeline = empty.pipeline, barriers](RecordContext& context) {
          record(context.commands, pipeline, barriers);
        });
      }
      return {};
    }));
    const auto timings = gpu.timings();
    for (std::size_t i = 0; i < timings.size(); ++i)
      microseconds.at(i).push_back(timings[i].milliseconds * 1e3 / kDispatches);
  }
  return DispatchCost{median(microseconds[0]), median(microseconds[1])};
}

// The median GPU times of the passes of one choice of settings at one size, in milliseconds.
struct MeasuredFrame {
  LabelledSettings settings;
  std::vector<PassTime> passes;
};

// Renders frames of a moving camera. The first ones, which compile shaders, are not counted.
Result<MeasuredFrame> measure(const Session& session, const Options& options,
                              const LabelledSettings& settings) {
  const CostInputs& inputs = settings.inputs;
  ALCOVE_TRY(const auto gpu, open_gpu(session.device));
  constexpr std::uint32_t kWarmUp = 4;
  const StaticSetup setup{
      {inputs.width, inputs.height, options.view.normals, kWarmUp + options.view.frames, kOrbit},
      session.camera};
  ALCOVE_TRY(const auto renderer, FrameRenderer::create(*gpu, session.scene, setup));
  std::vector<std::string> order;
  std::map<std::string, std::vector<double>> times;
  for (std::uint32_t i = 0; i < setup.frames; ++i) {
    FrameRequest request = frame_request(setup, inputs.settings, i);
    request.occlusion = inputs.settings;  // with specular occlusion
    ALCOVE_TRY(const auto cost, renderer->draw(request));
    for (const PassTime& pass : cost.gpu) {
      if (i == 0) order.push_back(pass.pass);
      if (i >= kWarmUp) times[pass.pass].push_back(pass.milliseconds);
    }
  }
  ALCOVE_TRY_VOID(check_validation(*gpu));
  MeasuredFrame frame{settings, {}};
  for (const std::string& name : order) frame.passes.push_back({name, median(times[name])});
  return frame;
}

// The modelled times of the same passes on each GPU of the model; empty without its driver.
std::vector<std::pair<const GpuPart*, ModelledFrame>> modelled(const CostInputs& inputs) {
  std::vector<std::pair<const GpuPart*, ModelledFrame>> all;
  for (const GpuPart& part : kGpuParts) {
    const auto device = create_null_device(part.family);
    if (!device) continue;
    const auto frames = modelled_frames(part, *device, inputs);
    if (frames) {
      const auto moving = std::ranges::find(*frames, FrameState::moving, &ModelledFrame::state);
      all.emplace_back(&part, *moving);
    }
  }
  return all;
}

// Prints a measured frame beside its model and returns its part of the report. Times of a software
// device are not divided by those of GPUs.
Json print(const MeasuredFrame& frame, bool software) {
  const CostInputs& inputs = frame.settings.inputs;
  const auto models = modelled(inputs);
  std::cout << fmt::format("{}, {}x{}, moving camera\n  {:24}{:>10}", frame.settings.label,
                           inputs.width, inputs.height, "milliseconds", "measured");
  for (const auto& [part, model] : models)
    std::cout << fmt::format("{:>12}{:>8}", part->name, software ? "" : "ratio");
  std::cout << "\n";
  Json passes = Json::array();
  for (const PassTime& pass : frame.passes) {
    Json row{{"pass", pass.pass}, {"ms", pass.milliseconds}};
    std::cout << fmt::format("  {:24}{:10.4f}", pass.pass, pass.milliseconds);
    for (const auto& [part, model] : models) {
      const auto own = std::ranges::find(model.passes, pass.pass, &ModelledPass::pass);
      if (own != model.passes.end()) {
        const double ratio = pass.milliseconds / own->milliseconds();
        std::cout << fmt::format("{:12.4f}{:>8}", own->milliseconds(),
                                 software ? "" : fmt::format("{:.2f}", ratio));
        row["modelled"][std::string(part->name)] = {{"ms", own->milliseconds()},
                                                    {"quotient", ratio}};
      }
    }
    std::cout << "\n";
    passes.push_back(std::move(row));
  }
  std::cout << std::flush;
  return {{"settings", frame.settings.label},
          {"width", inputs.width},
          {"height", inputs.height},
          {"passes", std::move(passes)}};
}

}  // namespace

Result<void> run_measure(const Options& options) {
  ALCOVE_TRY_VOID(create_folder(options.out));
  ALCOVE_TRY(const auto session, open_session(options));
  const VulkanDevice& device = session.gpu->device();
  std::cout << device.properties().deviceName << ", " << device.driver() << "\n";
  ALCOVE_TRY(const DispatchCost dispatch, measure_dispatch_cost(*session.gpu));
  std::cout << fmt::format("An empty dispatch takes {:.2f} microseconds, behind a barrier {:.2f}\n",
                           dispatch.alone_us, dispatch.behind_barrier_us)
            << std::flush;
  Json report{{"device", device.properties().deviceName},
              {"driver", device.driver()},
              {"frames", options.view.frames},
              {"dispatch_us", dispatch.alone_us},
              {"dispatch_behind_barrier_us", dispatch.behind_barrier_us}};
  for (const auto& [width, height] : options.sizes) {
    for (const AlcoveQuality quality : chosen_presets(options.occlusion)) {
      OcclusionOptions one = options.occlusion;
      one.quality = quality;
      ALCOVE_TRY(const auto settings, occlusion_settings(one, session.settings.radius));
      const CostInputs inputs{.width = width, .height = height, .settings = settings};
      ALCOVE_TRY(
          const auto frame,
          measure(session, options, {std::string(passes::kQualityNames.at(quality)), inputs}));
      report["measured"].push_back(
          print(frame, device.properties().deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU));
    }
  }
  return write_text(options.out / "report.json", report.dump(2) + "\n").map([&] {
    std::cout << "report.json is in " << options.out.string() << "\n";
  });
}

}  // namespace alcove::sample
