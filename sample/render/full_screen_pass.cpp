#include "render/full_screen_pass.h"

#include <algorithm>
#include <utility>

#include "spirv/full_screen.h"

namespace alcove::sample {
namespace {

constexpr VkDescriptorType kImage = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
constexpr VkDescriptorType kSampler = VK_DESCRIPTOR_TYPE_SAMPLER;

}  // namespace

Result<std::unique_ptr<FullScreenPass>> FullScreenPass::create(Gpu& gpu, Description description) {
  std::unique_ptr<FullScreenPass> made(new FullScreenPass(gpu, std::move(description)));
  if (const VkResult result = made->create_pipeline(); result != VK_SUCCESS)
    return device_failure(std::string("create the pipeline of the pass ") + made->description_.name,
                          result);
  return made;
}

VkResult FullScreenPass::create_pipeline() {
  const VkDevice device = gpu_.device().device();
  const VkSamplerCreateInfo sampler{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                    .magFilter = VK_FILTER_LINEAR,
                                    .minFilter = VK_FILTER_LINEAR,
                                    .mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR,
                                    .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                    .maxLod = VK_LOD_CLAMP_NONE};
  VkResult result = vkCreateSampler(device, &sampler, nullptr, &sampler_);
  if (result != VK_SUCCESS) return result;
  const SetDescription set{{{kImage, VK_SHADER_STAGE_FRAGMENT_BIT, description_.images},
                            {kSampler, VK_SHADER_STAGE_FRAGMENT_BIT}},
                           gpu_.frames_in_flight() * kCallsPerFrame};
  result =
      layout_.create({&set, 1}, {VK_SHADER_STAGE_FRAGMENT_BIT, 0, description_.parameter_bytes});
  if (result != VK_SUCCESS) return result;
  return sample::create_pipeline(device,
                                 {.vertex_code = kFullScreen,
                                  .fragment_code = description_.fragment_code,
                                  .colour_formats = description_.target_formats,
                                  .layout = layout_.handle()},
                                 pipeline_);
}

FullScreenPass::~FullScreenPass() {
  vkDestroyPipeline(gpu_.device().device(), pipeline_, nullptr);
  vkDestroySampler(gpu_.device().device(), sampler_, nullptr);
}

void FullScreenPass::add(Graph& graph, std::span<const Texture> images, std::span<Texture> targets,
                         std::vector<std::byte> parameters) {
  auto pass = graph.add_pass(description_.name);
  std::vector<Texture> bound, read;
  for (const Texture image : images) {
    bound.push_back(image ? image : images[0]);
    if (std::ranges::find(read, bound.back()) != read.end()) continue;
    read.push_back(bound.back());
    pass.read(bound.back(), framegraph::access::sampled_fragment);
  }
  std::vector<framegraph::Attachment> colours;
  for (Texture& target : targets) {
    target =
        pass.write(target, framegraph::access::color_attachment, {}, framegraph::Contents::discard);
    colours.push_back({target});
  }
  const VkDescriptorSet set = layout_.set(0, next_set_);
  next_set_ = (next_set_ + 1) % (gpu_.frames_in_flight() * kCallsPerFrame);
  pass.record([=, this, parameters = std::move(parameters)](RecordContext& context) {
    std::vector<VkDescriptorImageInfo> infos;
    for (const Texture image : bound)
      infos.push_back({{}, context.view(image), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
    layout_.write(set, 0, kImage, infos);
    const VkDescriptorImageInfo sampler{.sampler = sampler_};
    layout_.write(set, 1, kSampler, {&sampler, 1});
    begin_rendering(context, colours);
    vkCmdBindPipeline(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_);
    layout_.bind(context.commands, 0, set);
    vkCmdPushConstants(context.commands, layout_.handle(), VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                       description_.parameter_bytes, parameters.data());
    vkCmdDraw(context.commands, 3, 1, 0, 0);
    vkCmdEndRendering(context.commands);
  });
}

}  // namespace alcove::sample
