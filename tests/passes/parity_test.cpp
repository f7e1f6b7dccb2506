// Compares results of shaders/maths on the device and on the CPU.
#include <gtest/gtest.h>

#include "c_interface_fixture.h"
#include "parity_case.h"
#include "spirv/parity.h"
#include "work_executor.h"

namespace alcove::passes {
namespace {

TEST_F(CInterface, ShaderFunctionsGiveTheSameValuesOnTheDeviceAndTheCpu) {
  AlcoveImage image = output(VK_FORMAT_R32G32B32A32_SFLOAT, 256, 256);
  AlcoveWork work{.resource_count = 1, .dispatch_count = 1};
  work.resources[0] = {.name = "values",
                       .kind = ALCOVE_RESOURCE_KIND_OUTPUT,
                       .format = VK_FORMAT_R32G32B32A32_SFLOAT};
  work.dispatches[0] = {
      .label = "parity", .shader = "parity", .groups = {32, 32, 1}, .binding_count = 1};
  work.dispatches[0].bindings[0] = {.name = "values", .type = ALCOVE_BINDING_TYPE_STORAGE_IMAGE};
  WorkExecutor executor(engine(), {kParity, sizeof kParity});
  engine().submit(0, [&](VkCommandBuffer commands) {
    executor.record(commands, work, {&image.image, 1});
  });
  engine().wait();
  image.initial_state = kResting;
  const HostImage values = read(image);
  for (std::uint32_t i = 0; i < 256 * 256; ++i) {
    const glm::vec4 expected = maths::parity_case({i % 256, i / 256});
    for (int k = 0; k < 4; ++k)
      ASSERT_NEAR(values.texels[i * 4 + k], expected[k], 1e-5f + 1e-5f * std::abs(expected[k]))
          << "texel " << i << ", component " << k;
  }
}

}  // namespace
}  // namespace alcove::passes
