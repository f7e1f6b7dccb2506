// Compares results of shaders/maths on the device and on the CPU.
#include <gtest/gtest.h>

#include <cstring>

#include "gpu/gpu.h"
#include "parity_case.h"
#include "parity_spirv.h"
#include "random_input.h"

namespace alcove::maths_test {
namespace {

constexpr std::uint32_t kValues = 1u << 16;

// Runs the shader over the values in `buffer`. The validation layers report calls that fail.
void run_on_device(sample::Gpu& gpu, const sample::HostBuffer& buffer) {
  VkDevice const device = gpu.device().device();
  const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1,
                                             VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
  const VkDescriptorSetLayoutCreateInfo set_info{
      VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, nullptr, 0, 1, &binding};
  VkDescriptorSetLayout set_layout{};
  vkCreateDescriptorSetLayout(device, &set_info, nullptr, &set_layout);
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
  const VkDescriptorPoolCreateInfo pool_info{
      VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, nullptr, 0, 1, 1, &size};
  VkDescriptorPool pool{};
  vkCreateDescriptorPool(device, &pool_info, nullptr, &pool);
  const VkDescriptorSetAllocateInfo allocation{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                               nullptr, pool, 1, &set_layout};
  VkDescriptorSet set{};
  vkAllocateDescriptorSets(device, &allocation, &set);
  const VkDescriptorBufferInfo range{buffer.buffer(), 0, VK_WHOLE_SIZE};
  const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = set,
                                   .descriptorCount = 1,
                                   .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                   .pBufferInfo = &range};
  vkUpdateDescriptorSets(device, 1, &write, 0, nullptr);
  const VkPipelineLayoutCreateInfo layout_info{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
      .setLayoutCount = 1,
      .pSetLayouts = &set_layout};
  VkPipelineLayout layout{};
  vkCreatePipelineLayout(device, &layout_info, nullptr, &layout);
  const VkShaderModuleCreateInfo module_info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, nullptr,
                                             0, sizeof kParitySpirv, kParitySpirv};
  VkShaderModule module{};
  vkCreateShaderModule(device, &module_info, nullptr, &module);
  const VkComputePipelineCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
      .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                .module = module,
                .pName = "main"},
      .layout = layout};
  VkPipeline pipeline{};
  vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline);
  const auto report = gpu.run([&](framegraph::Graph& graph) -> tl::expected<void, std::string> {
    auto pass = graph.add_pass("parity");
    (void)pass.write(
        graph.import_buffer("values", buffer.import()),
        framegraph::buffer_access::storage_read_write(VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT));
    pass.record([&](framegraph::RecordContext& context) {
      vkCmdBindPipeline(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
      vkCmdBindDescriptorSets(context.commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set,
                              0, nullptr);
      vkCmdDispatch(context.commands, kValues / 64, 1, 1);
    });
    return {};
  });
  EXPECT_TRUE(report) << report.error();
  vkDestroyPipeline(device, pipeline, nullptr);
  vkDestroyShaderModule(device, module, nullptr);
  vkDestroyPipelineLayout(device, layout, nullptr);
  vkDestroyDescriptorPool(device, pool, nullptr);
  vkDestroyDescriptorSetLayout(device, set_layout, nullptr);
}

TEST(Parity, ShaderFunctionsGiveTheSameValuesOnTheDeviceAndTheCpu) {
  auto gpu = sample::Gpu::create({.validation = true});
  ASSERT_TRUE(gpu) << gpu.error();
  auto buffer = sample::HostBuffer::create((*gpu)->device(), kValues * sizeof(glm::vec4),
                                           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  ASSERT_TRUE(buffer) << buffer.error();
  RandomInput random;
  std::vector<glm::vec4> values(kValues);
  for (glm::vec4& value : values)
    for (int k = 0; k < 4; ++k) value[k] = random.uniform(0.0f, 0.99999f);
  std::memcpy((*buffer)->bytes().data(), values.data(), (*buffer)->bytes().size());
  run_on_device(**gpu, **buffer);
  const auto* found = reinterpret_cast<const glm::vec4*>((*buffer)->bytes().data());
  for (std::uint32_t i = 0; i < kValues; ++i) {
    const glm::vec4 expected = maths::parity_case(i % 4, values[i]);
    for (int k = 0; k < 4; ++k)
      ASSERT_NEAR(found[i][k], expected[k], 1e-5f + 1e-5f * std::abs(expected[k]))
          << "case " << i % 4 << ", component " << k;
  }
  EXPECT_TRUE((*gpu)->device().validation_messages().empty());
}

}  // namespace
}  // namespace alcove::maths_test
