#include "alcove/framegraph/error.h"

namespace alcove::framegraph {

std::string to_string(const Errors& errors) {
  std::string text;
  for (const Error& error : errors) {
    if (!text.empty()) text += '\n';
    text += error.message;
  }
  return text;
}

}  // namespace alcove::framegraph
