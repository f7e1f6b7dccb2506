#include "gpu_cost/compiled_shader.h"

#include <vector>

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

double value_of(const VkPipelineExecutableStatisticKHR& statistic) {
  switch (statistic.format) {
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_BOOL32_KHR:
      return statistic.value.b32 != 0 ? 1.0 : 0.0;
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR:
      return static_cast<double>(statistic.value.i64);
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR:
      return static_cast<double>(statistic.value.u64);
    default:
      return statistic.value.f64;
  }
}

}  // namespace

tl::expected<CompiledShader, std::string> read_compiled_shader(VkDevice device,
                                                               VkPipeline pipeline) {
  const auto load = [device](const char* name) { return vkGetDeviceProcAddr(device, name); };
  const auto get_properties = reinterpret_cast<PFN_vkGetPipelineExecutablePropertiesKHR>(
      load("vkGetPipelineExecutablePropertiesKHR"));
  const auto get_statistics = reinterpret_cast<PFN_vkGetPipelineExecutableStatisticsKHR>(
      load("vkGetPipelineExecutableStatisticsKHR"));
  const auto get_texts = reinterpret_cast<PFN_vkGetPipelineExecutableInternalRepresentationsKHR>(
      load("vkGetPipelineExecutableInternalRepresentationsKHR"));
  if (get_properties == nullptr || get_statistics == nullptr || get_texts == nullptr) {
    return Failure("The device lacks VK_KHR_pipeline_executable_properties.");
  }
  const VkPipelineInfoKHR info{.sType = VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR, .pipeline = pipeline};
  std::uint32_t count = 1;
  VkPipelineExecutablePropertiesKHR properties{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR};
  if (get_properties(device, &info, &count, &properties) < VK_SUCCESS || count == 0) {
    return Failure("The driver reports no executable for a pipeline that it compiled.");
  }
  CompiledShader shader;
  shader.wave = properties.subgroupSize;
  const VkPipelineExecutableInfoKHR executable{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR, .pipeline = pipeline};
  get_statistics(device, &executable, &count, nullptr);
  std::vector<VkPipelineExecutableStatisticKHR> statistics(
      count, {.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR});
  get_statistics(device, &executable, &count, statistics.data());
  for (const VkPipelineExecutableStatisticKHR& statistic : statistics) {
    shader.statistics[statistic.name] = value_of(statistic);
  }
  get_texts(device, &executable, &count, nullptr);
  std::vector<VkPipelineExecutableInternalRepresentationKHR> texts(
      count, {.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INTERNAL_REPRESENTATION_KHR});
  get_texts(device, &executable, &count, texts.data());
  std::vector<std::string> contents(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    contents[i].resize(texts[i].dataSize);
    texts[i].pData = contents[i].data();
  }
  get_texts(device, &executable, &count, texts.data());
  for (std::uint32_t i = 0; i < count; ++i) {
    shader.texts[texts[i].name] = contents[i].c_str();  // up to the null terminator
  }
  return shader;
}

}  // namespace alcove::sample
