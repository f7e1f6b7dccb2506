// An engine in C++14 that uses the C interface.
#include <alcove/alcove.h>

#include <cstdio>

static_assert(__cplusplus == 201402L, "linking the C interface must not change the standard");

int main() {
  AlcoveSettings settings{};
  settings.struct_size = sizeof settings;
  if (alcoveGetSettings(ALCOVE_QUALITY_HIGH, 2.0f, &settings) != ALCOVE_SUCCESS) return 1;
  AlcoveContextInfo info{};
  info.struct_size = sizeof info;
  AlcoveContext* context = nullptr;
  char message[ALCOVE_MAX_MESSAGE];
  const AlcoveResult result = alcoveCreateContext(&info, &context, message);
  std::printf("%s: %s\n", alcoveGetResultName(result), message);
  return result == ALCOVE_ERROR_INVALID_INPUT && context == nullptr ? 0 : 1;
}
