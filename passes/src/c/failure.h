// The result and the message of a call of the C interface that failed.
#pragma once

#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "alcove/alcove.h"
#include "alcove/framegraph/error.h"
#include "alcove/passes/kernels.h"

namespace alcove::passes {

struct Failure {
  AlcoveResult result = ALCOVE_ERROR_INVALID_INPUT;
  std::string message;
};

[[nodiscard]] inline tl::unexpected<Failure> invalid(std::string message) {
  return tl::unexpected(Failure{ALCOVE_ERROR_INVALID_INPUT, std::move(message)});
}

[[nodiscard]] Failure failure_of(const framegraph::Errors& errors);
// `where` begins the sentence, such as "View 3".
[[nodiscard]] Failure failure_of(const Error& error, std::string_view where);

// Checks that `given`, the struct_size of a struct of the C interface, is the struct's size in this
// version of the header. The message names `type`. When a later version of the header enlarges a
// struct, this function is the place to accept the earlier size.
[[nodiscard]] inline tl::expected<void, Failure> check_size(std::uint32_t given, std::size_t known,
                                                            std::string_view type) {
  if (given == known) return {};
  return invalid(std::string(type) + "::struct_size is " + std::to_string(given) +
                 "; set it to sizeof(" + std::string(type) + "), which is " +
                 std::to_string(known) + " here.");
}

}  // namespace alcove::passes
