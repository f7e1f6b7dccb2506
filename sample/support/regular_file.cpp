#include "support/regular_file.h"

#include <cerrno>
#include <cstring>
#include <system_error>

namespace alcove::sample {

Result<FilePointer> open_regular_file(const std::filesystem::path& file) {
  std::error_code ignored;
  const auto status = std::filesystem::status(file, ignored);
  if (std::filesystem::is_directory(status)) return Failure("is a folder");
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    return Failure("is not a regular file");
  FilePointer opened(std::fopen(file.string().c_str(), "rb"));
  if (!opened) return Failure(std::string("cannot be opened: ") + std::strerror(errno));
  return opened;
}

}  // namespace alcove::sample
