#pragma once

#include <fcntl.h>
#include <unistd.h>

namespace alcove::sample {

// Discards the output on standard error during the object's lifetime, for drivers that print to it.
class SilentStandardError {
 public:
  SilentStandardError() : before_(dup(STDERR_FILENO)) {
    if (const int nowhere = open("/dev/null", O_WRONLY); nowhere >= 0) {
      dup2(nowhere, STDERR_FILENO);
      close(nowhere);
    }
  }
  ~SilentStandardError() {
    if (before_ >= 0) {
      dup2(before_, STDERR_FILENO);
      close(before_);
    }
  }
  SilentStandardError(const SilentStandardError&) = delete;
  SilentStandardError& operator=(const SilentStandardError&) = delete;

 private:
  int before_;
};

}  // namespace alcove::sample
