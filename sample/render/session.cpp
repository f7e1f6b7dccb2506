#include "render/session.h"

#include "alcove/framegraph/verify.h"

namespace alcove::sample {

Result<std::unique_ptr<Gpu>> open_gpu(const DeviceOptions& options) {
  framegraph::ExecutorOptions executor;
  if (options.validation) executor.verify = framegraph::verify;
  executor.check_uses = executor.check_uses || options.validation;
  return Gpu::create(options, executor);
}

Result<void> check_validation(const Gpu& gpu) {
  for (const std::string& message : gpu.device().validation_messages())
    return Failure("The validation layer says: " + message);
  return {};
}

}  // namespace alcove::sample
