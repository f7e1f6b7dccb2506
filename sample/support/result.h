// The results of functions that may fail with a sentence, and macros that pass errors on.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace alcove::sample {

template <class T>
using Result = tl::expected<T, std::string>;
using Failure = tl::unexpected<std::string>;

// Returns a function for map_error() that puts a text before the sentence of an error.
[[nodiscard]] inline auto with_prefix(std::string prefix) {
  return [prefix = std::move(prefix)](const std::string& error) { return prefix + error; };
}

}  // namespace alcove::sample

// Declares or assigns a variable with the value of a call, or returns its error:
//   ALCOVE_TRY(const auto scene, load_scene(name));
#define ALCOVE_TRY(declaration, ...) \
  ALCOVE_TRY_AS(ALCOVE_TRY_NAME(alcove_result_, __LINE__), declaration, __VA_ARGS__)

// Returns the error of a call without a value, if it fails.
#define ALCOVE_TRY_VOID(...)                                   \
  do {                                                         \
    if (auto alcove_result = (__VA_ARGS__); !alcove_result)    \
      return tl::unexpected(std::move(alcove_result.error())); \
  } while (false)

#define ALCOVE_TRY_AS(result, declaration, ...)                      \
  auto result = (__VA_ARGS__);                                       \
  if (!(result)) return tl::unexpected(std::move((result).error())); \
  declaration = *std::move(result) /* NOLINT(bugprone-macro-parentheses) */
#define ALCOVE_TRY_NAME(name, line) ALCOVE_TRY_JOIN(name, line)
#define ALCOVE_TRY_JOIN(name, line) name##line
