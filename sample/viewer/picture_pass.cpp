#include "viewer/picture_pass.h"

#include <algorithm>
#include <array>
#include <limits>

#include "alcove/framegraph/access.h"
#include "spirv/picture_fragment.h"
#include "spirv/picture_vertex.h"

namespace alcove::sample {
namespace {

// The textures in the order of the bindings of picture.frag.
using Textures = std::array<Texture, 4>;

// Returns the textures of all bindings. A texture that is not given is replaced by the shown one,
// because every binding needs a texture.
Textures textures_of(const PictureInputs& inputs) {
  Textures textures{inputs.texture, inputs.other, inputs.linear_depth, inputs.environment};
  for (Texture& texture : textures) texture = texture ? texture : inputs.texture;
  return textures;
}

maths::PictureParameters parameters_of(const PictureInputs& inputs) {
  maths::PictureParameters parameters{};
  parameters.world_from_shown = glm::mat4(inputs.world_from_shown);
  parameters.show = inputs.show;
  parameters.split = inputs.other ? inputs.split : std::numeric_limits<float>::max();
  parameters.scale = inputs.scale;
  return parameters;
}

constexpr VkDescriptorType kImage = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;

}  // namespace

tl::expected<std::unique_ptr<PicturePass>, std::string> PicturePass::create(Gpu& gpu,
                                                                            VkFormat format) {
  const VkDevice device = gpu.device().device();
  std::unique_ptr<PicturePass> made(new PicturePass(device));
  // The linear filter is for the environment. The other textures are read with texelFetch.
  const VkSamplerCreateInfo sampler{.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
                                    .magFilter = VK_FILTER_LINEAR,
                                    .addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                    .addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE};
  VkResult result = vkCreateSampler(device, &sampler, nullptr, &made->sampler_);
  if (result == VK_SUCCESS) {
    const SetDescription set{{std::tuple_size_v<Textures>, {kImage, VK_SHADER_STAGE_FRAGMENT_BIT}},
                             gpu.frames_in_flight()};
    result = made->layout_.create(
        {&set, 1}, {VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(maths::PictureParameters)});
  }
  if (result == VK_SUCCESS) {
    result = create_pipeline(device,
                             {.vertex_code = kPictureVertex,
                              .fragment_code = kPictureFragment,
                              .colour_formats = {&format, 1},
                              .layout = made->layout_.handle()},
                             made->pipeline_);
  }
  if (result != VK_SUCCESS)
    return device_failure("create the pipeline of the window's picture", result);
  return made;
}

PicturePass::~PicturePass() {
  vkDestroyPipeline(device_, pipeline_, nullptr);
  vkDestroySampler(device_, sampler_, nullptr);
}

Texture PicturePass::add(Graph& graph, Texture target, const PictureInputs& inputs) {
  auto pass = graph.add_pass("picture");
  std::vector<Texture> read;
  for (const Texture texture : textures_of(inputs)) {
    if (std::ranges::find(read, texture) == read.end()) {
      pass.read(texture, framegraph::access::sampled_fragment);
      read.push_back(texture);
    }
  }
  const Texture drawn =
      pass.write(target, framegraph::access::color_attachment, {}, framegraph::Contents::discard);
  pass.record([this, drawn, inputs](RecordContext& context) { record(context, drawn, inputs); });
  return drawn;
}

void PicturePass::record(RecordContext& context, Texture target,
                         const PictureInputs& inputs) const {
  const VkDescriptorSet set = layout_.set(0, context.frame_slot);
  std::uint32_t binding = 0;
  for (const Texture texture : textures_of(inputs)) {
    const VkDescriptorImageInfo image{sampler_, context.view(texture),
                                      VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    layout_.write(set, binding++, kImage, {&image, 1});
  }
  const framegraph::Attachment colour{target};
  begin_rendering(context, {&colour, 1});
  vkCmdBindPipeline(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_);
  layout_.bind(context.commands, 0, set);
  const maths::PictureParameters parameters = parameters_of(inputs);
  vkCmdPushConstants(context.commands, layout_.handle(), VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                     sizeof(parameters), &parameters);
  vkCmdDraw(context.commands, 3, 1, 0, 0);
  vkCmdEndRendering(context.commands);
}

}  // namespace alcove::sample
