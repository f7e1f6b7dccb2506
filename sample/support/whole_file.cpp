#include "support/whole_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <random>
#include <system_error>

namespace alcove::sample {
namespace {

namespace fs = std::filesystem;
constexpr const char* kPart = ".part";

// Returns a temporary file name in the folder of the target, so that the final rename stays on one
// file system. The name is random, so that two processes that write the same file do not collide.
fs::path temporary_beside(const fs::path& file) {
  std::random_device random;
  fs::path temporary = file;
  temporary += fmt::format("{}{}", kPart, random());
  return temporary;
}

// Writes all bytes or returns an error. A full disk may only be detected by the flush.
Result<void> fill(const fs::path& file, const void* bytes, size_t size) {
  std::FILE* stream = std::fopen(file.string().c_str(), "wb");
  if (!stream) return Failure(std::strerror(errno));
  errno = 0;
  const bool written = std::fwrite(bytes, 1, size, stream) == size && std::fflush(stream) == 0;
  const int reason = errno;
  const bool closed = std::fclose(stream) == 0;
  if (written && closed) return {};
  return Failure(std::strerror(written ? errno : reason));
}

// Writes a file of another name and gives it the name `file`, or removes it again unless `keeps`.
using Write = std::function<Result<void>(const fs::path& temporary)>;
Result<void> write(const fs::path& file, const Write& write_to, bool keeps) {
  std::error_code reason;
  if (fs::is_directory(file, reason))
    return Failure("cannot write " + file.string() + ": it is a folder; give the name of a file");
  const fs::path temporary = temporary_beside(file);
  Result<void> outcome = write_to(temporary);
  if (outcome && keeps) {
    fs::rename(temporary, file, reason);
    if (!reason) return {};
    outcome = Failure(reason.message());
  }
  fs::remove(temporary, reason);
  return outcome.map_error(with_prefix("cannot write " + file.string() + ": "));
}

}  // namespace

Result<void> create_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!error && !fs::is_directory(folder, error) && !error)
    error = std::make_error_code(std::errc::not_a_directory);
  if (!error) return {};
  return Failure(fmt::format("The folder {} could not be created: {}; choose another by --out.",
                             folder.string(), error.message()));
}

Result<void> check_writable(const fs::path& file) {
  return write(
      file, [](const fs::path& temporary) { return fill(temporary, "", 0); }, false);
}

Result<void> write_whole(const fs::path& file, const Write& write_to) {
  return write(file, write_to, true);
}

Result<void> write_bytes(const fs::path& file, const void* bytes, size_t size) {
  return write_whole(file, [&](const fs::path& temporary) { return fill(temporary, bytes, size); });
}

Result<void> write_text(const fs::path& file, const std::string& text) {
  return write_bytes(file, text.data(), text.size());
}

void remove_abandoned(const fs::path& folder) {
  constexpr auto kAge = std::chrono::hours(1);
  std::error_code error;
  for (fs::directory_iterator entry(folder, error); !error && entry != fs::directory_iterator();
       entry.increment(error)) {
    std::error_code unknown;
    const auto written = fs::last_write_time(entry->path(), unknown);
    const std::string ending = entry->path().extension().string();
    if (!unknown && ending.starts_with(kPart) && entry->is_regular_file(unknown) &&
        fs::file_time_type::clock::now() - written > kAge)
      fs::remove(entry->path(), unknown);
  }
}

}  // namespace alcove::sample
