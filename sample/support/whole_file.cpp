#include "support/whole_file.h"

#if defined(__unix__) || defined(__APPLE__)
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>
#define ALCOVE_HAS_FILE_LOCKS 1
#endif

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <random>
#include <system_error>

namespace alcove::sample {
namespace {

namespace fs = std::filesystem;
using Outcome = tl::expected<void, std::string>;
using Failure = tl::unexpected<std::string>;

constexpr const char* kPart = ".part";

// Returns a temporary file name in the folder of the target, so that the final rename stays on one
// file system. The name is random, so that two processes that write the same file do not collide.
fs::path temporary_beside(const fs::path& file) {
  std::random_device random;
  fs::path temporary = file;
  temporary += fmt::format("{}{}", kPart, random());
  return temporary;
}

// Returns whether temporary_beside() made the name for the file `of` or, if `of` is empty, for any
// file.
bool is_temporary(const std::string& name, const std::string& of) {
  const size_t part = name.rfind(kPart);
  if (part == std::string::npos || (!of.empty() && name.compare(0, part, of) != 0)) return false;
  const size_t digits = part + std::strlen(kPart);
  return digits < name.size() && name.find_first_not_of("0123456789", digits) == std::string::npos;
}

bool is_old(const fs::path& file) {
  constexpr auto kAge = std::chrono::hours(1);
  std::error_code error;
  const auto written = fs::last_write_time(file, error);
  return !error && fs::file_time_type::clock::now() - written > kAge;
}

// A lock on a file that other processes respect, held until the object or its process ends.
class FileLock {
 public:
  FileLock() = default;
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;
#ifdef ALCOVE_HAS_FILE_LOCKS
  ~FileLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

  // Creates the file and locks it. A failure is detected when the file is written.
  void create(const fs::path& file) {
    descriptor_ = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ >= 0) (void)::flock(descriptor_, LOCK_EX | LOCK_NB);
  }

  enum class State { kHeld, kFree, kUnknown };
  // Takes the lock if it is free.
  State take(const fs::path& file) {
    descriptor_ = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC);
    if (descriptor_ < 0) return State::kUnknown;
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return State::kFree;
    return errno == EWOULDBLOCK ? State::kHeld : State::kUnknown;
  }

 private:
  int descriptor_ = -1;
#else
  void create(const fs::path&) {}
  enum class State { kHeld, kFree, kUnknown };
  State take(const fs::path&) { return State::kUnknown; }
#endif
};

void remove_if_abandoned(const fs::path& file) {
  FileLock lock;
  const FileLock::State state = lock.take(file);
  const bool abandoned =
      state == FileLock::State::kFree || (state == FileLock::State::kUnknown && is_old(file));
  std::error_code ignored;
  if (abandoned) fs::remove(file, ignored);
}

// Removes the abandoned temporary files in `folder` of the file named `of`; empty: of all files.
void remove_abandoned_of(const fs::path& folder, const std::string& of) {
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    std::error_code ignored;
    if (is_temporary(entry->path().filename().string(), of) && entry->is_regular_file(ignored)) {
      remove_if_abandoned(entry->path());
    }
  }
}

// Writes all bytes or returns an error. A full disk may only be detected by the flush.
Outcome fill(const fs::path& file, const void* bytes, size_t size) {
  std::FILE* stream = std::fopen(file.string().c_str(), "wb");
  if (!stream) return Failure(std::strerror(errno));
  errno = 0;
  const bool written = std::fwrite(bytes, 1, size, stream) == size && std::fflush(stream) == 0;
  const int reason = errno;
  const bool closed = std::fclose(stream) == 0;
  if (written && closed) return {};
  return Failure(std::strerror(written ? errno : reason));
}

}  // namespace

tl::expected<OutputFolder, std::string> OutputFolder::create(const fs::path& folder) {
  OutputFolder out;
  std::error_code error;
  fs::path part;
  for (const fs::path& name : folder) {
    part /= name;
    if (!name.empty() && fs::create_directory(part, error)) out.made_.push_back(part);
    if (error) break;
  }
  if (error || !fs::is_directory(folder, error)) {
    const std::string reason =
        error ? error.message() : std::make_error_code(std::errc::not_a_directory).message();
    return Failure(fmt::format("The folder {} could not be created: {}; choose another by --out.",
                               folder.string(), reason));
  }
  const fs::path probe = temporary_beside(folder / "probe");
  if (auto written = fill(probe, "", 0); !written) {
    return Failure(
        fmt::format("Nothing can be written to the folder {}: {}; choose another by --out.",
                    folder.string(), written.error()));
  }
  fs::remove(probe, error);
  return out;
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  for (auto folder = made_.rbegin(); folder != made_.rend(); ++folder) {
    fs::remove(*folder, ignored);  // fails if it is not empty
  }
}

Outcome write_whole(const fs::path& file, const std::function<Outcome(const fs::path&)>& write) {
  remove_abandoned_of(file.has_parent_path() ? file.parent_path() : fs::path("."),
                      file.filename().string());
  const fs::path temporary = temporary_beside(file);
  FileLock lock;
  lock.create(temporary);
  std::error_code reason;
  Outcome outcome = write(temporary);
  if (outcome) {
    fs::rename(temporary, file, reason);
    if (!reason) return {};
    outcome = Failure(reason.message());
  }
  fs::remove(temporary, reason);
  return Failure("cannot write " + file.string() + ": " + outcome.error());
}

Outcome write_bytes(const fs::path& file, const void* bytes, size_t size) {
  return write_whole(file, [&](const fs::path& temporary) { return fill(temporary, bytes, size); });
}

Outcome write_text(const fs::path& file, const std::string& text) {
  return write_bytes(file, text.data(), text.size());
}

void remove_abandoned(const fs::path& folder) { remove_abandoned_of(folder, ""); }

}  // namespace alcove::sample
