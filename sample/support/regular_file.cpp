#include "support/regular_file.h"

#if defined(__unix__) || defined(__APPLE__)
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#endif

#include <cerrno>
#include <cstring>
#include <system_error>

namespace alcove::sample {
namespace {

using Failure = tl::unexpected<std::string>;

Failure system_failure() {
  return Failure(std::string("cannot be opened: ") + std::strerror(errno));
}

constexpr const char* kNotRegular = "is not a regular file";

}  // namespace

#if defined(__unix__) || defined(__APPLE__)

tl::expected<FilePointer, std::string> open_regular_file(const std::filesystem::path& file) {
  // O_NONBLOCK keeps open() from waiting for a pipe's other end; regular files ignore it.
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  if (descriptor < 0) return system_failure();
  struct stat status {};
  if (::fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
    ::close(descriptor);
    return Failure(kNotRegular);
  }
  FilePointer opened(::fdopen(descriptor, "rb"));
  if (!opened) {
    ::close(descriptor);
    return system_failure();
  }
  return opened;
}

#else

tl::expected<FilePointer, std::string> open_regular_file(const std::filesystem::path& file) {
  std::error_code ignored;
  const auto status = std::filesystem::status(file, ignored);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    return Failure(kNotRegular);
  }
  FilePointer opened(std::fopen(file.string().c_str(), "rb"));
  if (!opened) return system_failure();
  return opened;
}

#endif

}  // namespace alcove::sample
