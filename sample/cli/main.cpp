// The program `alcove`.

#include <cerrno>
#include <cstring>
#include <exception>
#include <iostream>
#include <new>

#include "cli/commands.h"
#include "cli/options.h"
#include "support/printable.h"
#include "support/result.h"

namespace {

using alcove::sample::Command;
using alcove::sample::Options;
using alcove::sample::Result;
using alcove::sample::Stop;

Result<void> run(const Options& options) {
  switch (options.command) {
    case Command::render:
      return alcove::sample::run_render(options);
    case Command::view:
      return alcove::sample::run_view(options);
    case Command::compare:
      return alcove::sample::run_compare(options);
    case Command::recommend:
      return alcove::sample::run_recommend(options);
    case Command::graph:
      return alcove::sample::run_graph(options);
    case Command::doctor:
      return alcove::sample::run_doctor(options);
    case Command::motion:
      return alcove::sample::run_motion(options);
    case Command::cost:
      return alcove::sample::run_cost(options);
    case Command::measure:
      return alcove::sample::run_measure(options);
    case Command::report:
      return alcove::sample::run_report(options);
  }
  return {};  // not reached: a missing command does not compile
}

// Prints an error sentence. It is shortened, and bytes that are not printable are replaced, because
// it may repeat arguments and file names, which may contain any bytes.
int fail(const std::string& sentence) {
  constexpr std::size_t kLongest = 600;  // bytes
  std::cerr << "alcove: " << alcove::sample::shortened(sentence, kLongest) << "\n";
  return 1;
}

// Flushes stdout and reports if it could not be written. A full disk causes an error only here.
int flush_output() {
  errno = 0;
  if (std::cout.flush()) return 0;
  const std::string reason = errno == 0 ? "" : std::string(": ") + std::strerror(errno);
  return fail("The output cannot be written" + reason + ".");
}

// Prints the help on stdout, or a mistake on stderr.
int stop(const Stop& stop) {
  if (stop.status != 0) {
    fail(stop.text);
    return stop.status;
  }
  std::cout << stop.text << "\n";
  return flush_output();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const auto options = alcove::sample::parse_options(argc, argv);
    if (!options) return stop(options.error());
    const auto done = run(*options);
    return done ? flush_output() : fail(done.error());
  } catch (const std::bad_alloc&) {
    return fail("There is not enough memory; try a smaller image or scene.");
  } catch (const std::exception& error) {
    return fail(error.what());
  }
}
