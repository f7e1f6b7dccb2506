// How functions of the C interface run calls that can fail, and return the errors of those that do.
#pragma once

#include <array>
#include <cstddef>
#include <new>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "alcove/alcove.h"
#include "alcove/framegraph/error.h"
#include "alcove/passes/error.h"

namespace alcove::passes {

using Message = std::array<char, ALCOVE_MAX_MESSAGE>;
using Result = tl::expected<void, Error>;

[[nodiscard]] inline tl::unexpected<Error> invalid(std::string message) {
  return tl::unexpected(Error{std::move(message)});
}

// Returns the first of the errors of a graph, as an error of the passes.
[[nodiscard]] Error first_error(const framegraph::Errors& errors);
// Returns a function for map_error() that puts a text, such as "View 3: ", before the sentence.
[[nodiscard]] inline auto with_prefix(std::string prefix) {
  return [prefix = std::move(prefix)](Error error) {
    error.message.insert(0, prefix);
    return error;
  };
}

// Checks that `given`, the struct_size of a struct of the C interface, is the struct's size in this
// version of the header. The message names `type`. When a later version of the header enlarges a
// struct, this function is the place to accept the earlier size.
[[nodiscard]] inline Result check_size(std::uint32_t given, std::size_t known,
                                       std::string_view type) {
  if (given == known) return {};
  return invalid(std::string(type) + "::struct_size is " + std::to_string(given) +
                 "; set it to sizeof(" + std::string(type) + "), which is " +
                 std::to_string(known) + " here.");
}

// Copies a text like snprintf: writes at most `size` bytes, including the terminating zero. Returns
// the number of bytes of the whole text without that zero. `text` may be null if `size` is 0.
std::size_t copy_text(std::string_view from, char* text, std::size_t size);

// Stores the message of a failure, or no text, in `message`, which is null or has room for
// ALCOVE_MAX_MESSAGE bytes. Returns the result.
AlcoveResult keep(char* message, const Result& result);

// Runs `call`, which returns a Result, and stores its message as keep() does. The library itself
// throws nothing, but operator new may: its exception becomes a failure. In a build without
// exceptions, the program ends instead.
template <typename Call>
AlcoveResult guarded(char* message, const Call& call) {
#ifdef __cpp_exceptions
  try {
    return keep(message, call());
  } catch (const std::bad_alloc&) {
    copy_text("The host is out of memory.", message, ALCOVE_MAX_MESSAGE);
    return ALCOVE_ERROR_OUT_OF_HOST_MEMORY;
  } catch (...) {
    copy_text("The library failed for a reason that it does not know.", message,
              ALCOVE_MAX_MESSAGE);
    return ALCOVE_ERROR_INTERNAL;
  }
#else
  return keep(message, call());
#endif
}

// Runs `call` without a place for its message.
template <typename Call>
AlcoveResult guarded(const Call& call) {
  return guarded(static_cast<char*>(nullptr), call);
}

}  // namespace alcove::passes
