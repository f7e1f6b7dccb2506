// Compares the results of the functions of shaders/maths on the GPU and on the CPU.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "compute_run.h"
#include "gpu/vulkan_device.h"
#include "maths/make_projection.h"
#include "parity_cases.h"
#include "parity_spirv.h"
#include "random_input.h"

namespace alcove::maths_test {
namespace {

using glm::vec4;

constexpr std::size_t kInputs = 1u << 14;

struct Bound {
  const char* name;
  double absolute, relative;  // the tolerance is absolute + relative * |value|
};

// The largest allowed differences for inputs at which the functions are well-conditioned. They come
// from rounding, and from the precision of the GPU's own sine, arc tangent, power and square root.
constexpr Bound kBounds[] = {
    {"slice", 1e-4, 1e-5},
    {"visibility", 1e-4, 1e-5},
    {"bent normal", 1e-4, 1e-5},
    {"sectors", 5e-5, 1e-5},
    {"arc cosine and recent", 2e-5, 1e-5},
    {"position and depth", 1e-5, 1e-5},
    {"history weight and view direction", 2e-4, 1e-4},
    {"ggx normal", 2e-3, 1e-5},
    {"ggx densities", 1e-3, 2e-3},
    {"cone and angle", 1e-4, 1e-4},
    {"multi bounce", 1e-3, 1e-4},
    {"octahedral", 1e-5, 1e-5},
    {"packed numbers", 4.1e-3, 0.0},
    {"history weights", 5e-5, 1e-5},
    {"history", 3e-4, 1e-5},
    {"golden pattern", 0.0, 0.0},
    {"visible share", 1e-6, 0.0},
    {"slice angle", 1e-5, 1e-4},
    {"bent normal of sectors", 2e-4, 1e-5},
    {"lobe of slices", 1e-3, 1e-3},
    {"hidden occlusion", 1e-4, 1e-4},
    {"lobe raw_occlusion", 1e-4, 4e-3},
    {"unobserved parts", 1e-3, 1e-3},
};
static_assert(std::size(kBounds) == maths::kParityCases);

maths::Projection off_centre_projection() {
  glm::mat4 m(0.0f);
  m[0][0] = 0.9f;
  m[1][1] = -1.6f;
  m[2] = vec4(0.1f, -0.05f, -1.0f, -1.0f);
  m[3][2] = -0.1f;
  return maths::make_projection(m, 960, 540).value();
}

// Returns the change of each result if the inputs change by a few units in the last place. Rounding
// may cause a difference of this size if a function is ill-conditioned, for example in a slice that
// is nearly perpendicular to the normal.
vec4 sensitivity(std::uint32_t which, vec4 a, vec4 b, const maths::Projection& projection) {
  constexpr int kNudges = 32;
  constexpr float kNudge = 4.0f / float(1 << 23);
  const vec4 centre = maths::parity_case(which, a, b, projection);
  RandomInput random(1);
  vec4 most(0.0f);
  for (int i = 0; i < kNudges; ++i) {
    vec4 nudged[2] = {a, b};
    for (vec4& input : nudged)
      for (int k = 0; k < 4; ++k)
        input[k] = glm::clamp(input[k] + random.uniform(-kNudge, kNudge), 0.0f, 0.99999f);
    const vec4 result = maths::parity_case(which, nudged[0], nudged[1], projection);
    most = glm::max(most, glm::abs(result - centre));
  }
  return most;
}

class Parity : public ::testing::TestWithParam<std::uint32_t> {
 protected:
  static void SetUpTestSuite() {
    sample::DeviceOptions options;
    options.validation = true;
    auto device = sample::VulkanDevice::create(options);
    ASSERT_TRUE(device.has_value()) << device.error();
    shared_device = std::move(*device);
    shared_run = std::make_unique<ComputeRun>(
        *shared_device, kParitySpirv,
        std::vector<std::uint32_t>{sizeof(maths::Projection), kInputs * 32, kInputs * 16});
    const maths::Projection projection = off_centre_projection();
    std::memcpy(shared_run->data(0), &projection, sizeof projection);
  }
  static void TearDownTestSuite() {
    shared_run.reset();
    shared_device.reset();
  }

  static inline std::unique_ptr<sample::VulkanDevice> shared_device;
  static inline std::unique_ptr<ComputeRun> shared_run;
};

TEST_P(Parity, ShaderFunctionGivesTheSameValuesOnGpuAndCpu) {
  ASSERT_NE(shared_run, nullptr);
  RandomInput random;
  std::vector<vec4> inputs(2 * kInputs);
  for (vec4& input : inputs)
    for (int k = 0; k < 4; ++k) input[k] = random.uniform(0.0f, 0.99999f);
  std::memcpy(shared_run->data(1), inputs.data(), inputs.size() * sizeof(vec4));
  shared_run->dispatch(kInputs / 64, GetParam(), kInputs);
  std::vector<vec4> results(kInputs);
  std::memcpy(results.data(), shared_run->data(2), results.size() * sizeof(vec4));

  const maths::Projection projection = off_centre_projection();
  const Bound& bound = kBounds[GetParam()];
  int failures = 0;
  for (std::size_t i = 0; i < kInputs && failures < 4; ++i) {
    const vec4 expected =
        maths::parity_case(GetParam(), inputs[2 * i], inputs[2 * i + 1], projection);
    for (int k = 0; k < 4; ++k) {
      const double allowed = bound.absolute + bound.relative * std::abs(double(expected[k]));
      const double difference = std::abs(double(results[i][k]) - expected[k]);
      if (difference <= allowed) continue;
      const vec4 moved = sensitivity(GetParam(), inputs[2 * i], inputs[2 * i + 1], projection);
      if (difference <= allowed + 4.0 * moved[k]) continue;
      ADD_FAILURE() << bound.name << ": component " << k << " is " << results[i][k]
                    << " on the device and " << expected[k] << " on the CPU, input " << i;
      ++failures;
    }
  }
  EXPECT_TRUE(shared_device->validation_messages().empty())
      << shared_device->validation_messages().front();
}

INSTANTIATE_TEST_SUITE_P(Functions, Parity, ::testing::Range(0u, maths::kParityCases),
                         [](const auto& instance) {
                           std::string name = kBounds[instance.param].name;
                           for (char& c : name)
                             if (c == ' ') c = '_';
                           return name;
                         });

}  // namespace
}  // namespace alcove::maths_test
