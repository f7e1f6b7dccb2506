#include "render/session.h"

#include "alcove/framegraph/verify.h"

namespace alcove::sample {

Result<std::unique_ptr<Gpu>> open_gpu(const DeviceRequest& request) {
  framegraph::ExecutorOptions executor;
  if (request.validation) executor.verify = framegraph::verify;
  executor.check_uses = executor.check_uses || request.validation;
  return Gpu::create({.validation = request.validation,
                      .index = request.index,
                      .surface_extensions = request.surface_extensions},
                     executor);
}

Result<void> check_validation(const Gpu& gpu) {
  for (const std::string& message : gpu.device().validation_messages())
    return Failure("The validation layer says: " + message);
  return {};
}

}  // namespace alcove::sample
