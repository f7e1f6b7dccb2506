#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "alcove/framegraph/verify.h"
#include "gpu/gpu.h"

// A device with validation layers for tests, which fail on any message of the layers.
namespace alcove::sample {

struct ReportAndClose {
  void operator()(Gpu* gpu) const {
    for (const std::string& message : gpu->device().validation_messages()) ADD_FAILURE() << message;
    delete gpu;
  }
};
using ValidatedGpu = std::unique_ptr<Gpu, ReportAndClose>;

// Null if there is no device; the test then fails.
inline ValidatedGpu open_validated() {
  auto made = Gpu::create({.validation = true}, {.verify = framegraph::verify, .check_uses = true});
  EXPECT_TRUE(made) << made.error();
  return ValidatedGpu(made ? made->release() : nullptr);
}

// For tests that need one device.
class GpuTest : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(gpu_); }
  Gpu& gpu() { return *gpu_; }

 private:
  const ValidatedGpu gpu_ = open_validated();
};

}  // namespace alcove::sample
