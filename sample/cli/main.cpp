// The program `alcove`.

#include <cerrno>
#include <cstring>
#include <exception>
#include <iostream>
#include <iterator>
#include <new>

#include "cli/commands.h"
#include "cli/options.h"
#include "support/printable.h"
#include "support/result.h"

namespace {

using namespace alcove::sample;

// In the order of the enumerators of Command.
constexpr Result<void> (*kRun[])(const Options&) = {
    run_render, run_view,   run_compare, run_recommend, run_report,
    run_graph,  run_doctor, run_motion,  run_cost,      run_measure};
static_assert(std::size(kRun) == static_cast<std::size_t>(Command::measure) + 1);

// Prints an error sentence. It is shortened, and bytes that are not printable are replaced, because
// it may repeat arguments and file names, which may contain any bytes.
int fail(const std::string& sentence) {
  constexpr std::size_t kLongest = 600;  // bytes
  std::cerr << "alcove: " << shortened(sentence, kLongest) << "\n";
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
    const auto options = parse_options(argc, argv);
    if (!options) return stop(options.error());
    const auto done = kRun[static_cast<std::size_t>(options->command)](*options);
    return done ? flush_output() : fail(done.error());
  } catch (const std::bad_alloc&) {
    return fail("There is not enough memory; try a smaller image or scene.");
  } catch (const std::exception& error) {
    return fail(error.what());
  }
}
