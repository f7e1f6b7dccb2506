#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "cli/option_value.h"
#include "cli/options.h"

namespace alcove::sample {

// A row of the table of options.
struct OptionRow {
  std::uint32_t commands;  // those that take the option: a bit for each Command
  const char* heading;     // above the option in the help
  const char* name;
  const char* type;  // of the value, in the help; null: the option has no value
  // {size} and {spp} stand for the command's own defaults.
  const char* help;
  // Stores the value, or throws a Mistake.
  void (*read)(Options& options, const OptionValue& value);
  bool repeatable = false;  // every value is read, not the last one only
};

[[nodiscard]] std::span<const OptionRow> option_rows();

// Throws a Mistake if options that are valid alone contradict each other.
void check_together(const Options& options);

}  // namespace alcove::sample
