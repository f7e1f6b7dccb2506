#include "c/failure.h"

#include <algorithm>
#include <cctype>

#include "vulkan/vulkan_error.h"

namespace alcove::passes {
namespace {

AlcoveResult error_code(const framegraph::Error& error) {
  switch (error.code) {
    case framegraph::ErrorCode::vulkan:
      return passes::error_code(error.result);
    case framegraph::ErrorCode::unsupported_format:
      return ALCOVE_ERROR_UNSUPPORTED;
    case framegraph::ErrorCode::missing_usage:
    case framegraph::ErrorCode::bad_description:
    case framegraph::ErrorCode::bad_import:
      return ALCOVE_ERROR_INVALID_INPUT;
    default:
      return ALCOVE_ERROR_INTERNAL;
  }
}

// Makes a sentence of an error of the graph, which begins with a small letter and has no full stop.
std::string as_sentence(std::string text) {
  if (!text.empty()) {
    text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
    if (text.back() != '.') text += '.';
  }
  return text;
}

}  // namespace

Error first_error(const framegraph::Errors& errors) {
  if (errors.empty()) return {"The frame failed without an error.", ALCOVE_ERROR_INTERNAL};
  const framegraph::Error& first = errors.front();
  return {as_sentence(first.message), error_code(first), first.result};
}

std::size_t copy_text(std::string_view from, char* text, std::size_t size) {
  if (text != nullptr && size > 0) {
    const std::size_t length = std::min(from.size(), size - 1);
    std::copy_n(from.data(), length, text);
    text[length] = '\0';
  }
  return from.size();
}

AlcoveResult keep(char* message, const Result& result) {
  copy_text(result ? "" : std::string_view(result.error().message), message, ALCOVE_MAX_MESSAGE);
  return result ? ALCOVE_SUCCESS : result.error().code;
}

}  // namespace alcove::passes

const char* alcoveGetResultName(AlcoveResult result) {
  switch (result) {
    case ALCOVE_SUCCESS:
      return "ALCOVE_SUCCESS";
    case ALCOVE_ERROR_INVALID_INPUT:
      return "ALCOVE_ERROR_INVALID_INPUT";
    case ALCOVE_ERROR_UNSUPPORTED:
      return "ALCOVE_ERROR_UNSUPPORTED";
    case ALCOVE_ERROR_OUT_OF_HOST_MEMORY:
      return "ALCOVE_ERROR_OUT_OF_HOST_MEMORY";
    case ALCOVE_ERROR_OUT_OF_DEVICE_MEMORY:
      return "ALCOVE_ERROR_OUT_OF_DEVICE_MEMORY";
    case ALCOVE_ERROR_DEVICE_LOST:
      return "ALCOVE_ERROR_DEVICE_LOST";
    case ALCOVE_ERROR_VULKAN:
      return "ALCOVE_ERROR_VULKAN";
    case ALCOVE_ERROR_INTERNAL:
      return "ALCOVE_ERROR_INTERNAL";
    default:
      return "unknown AlcoveResult";
  }
}
