// What the C interface says of a call that failed.
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
// `where` begins the sentence: "View 3".
[[nodiscard]] Failure failure_of(const Error& error, std::string_view where);

// Whether `given` is the size of a struct of this header; the sentence names `type` where it is
// not. Sizes of earlier headers come here once there is another.
[[nodiscard]] inline tl::expected<void, Failure> check_size(std::uint32_t given, std::size_t known,
                                                            std::string_view type) {
  if (given == known) {
    return {};
  }
  return invalid(std::string(type) + "::struct_size is " + std::to_string(given) +
                 "; set it to sizeof(" + std::string(type) + "), which is " +
                 std::to_string(known) + " here.");
}

}  // namespace alcove::passes
