#include "allocation_counter.h"

#include <cstdlib>
#include <new>

namespace {

thread_local std::size_t count = 0;
thread_local std::size_t left = 0;  // allocations until one fails; 0: none fails
thread_local bool failed = false;

void* allocate(std::size_t size) {
  ++count;
  return std::malloc(size == 0 ? 1 : size);
}

#ifdef __linux__
extern "C" const char __executable_start;  // NOLINT: the linker's names
extern "C" const char etext;
bool is_own(const void* caller) { return caller >= &__executable_start && caller < &etext; }
#define ALCOVE_CALLER() __builtin_return_address(0)
#elif defined(__MINGW32__)
extern "C" const char __ImageBase;  // NOLINT: the linker's names
extern "C" const char etext;
bool is_own(const void* caller) { return caller >= &__ImageBase && caller < &etext; }
#define ALCOVE_CALLER() __builtin_return_address(0)
#else
bool is_own(const void*) { return false; }
#define ALCOVE_CALLER() nullptr
#endif

}  // namespace

void* operator new(std::size_t size) {
  if (left != 0 && is_own(ALCOVE_CALLER()) && --left == 0) {
    failed = true;
    throw std::bad_alloc();
  }
  if (void* memory = allocate(size)) return memory;
  std::abort();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return allocate(size); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace alcove::framegraph {

std::size_t allocations() { return count; }

void fail_allocation(std::size_t which) {
  left = which;
  failed = false;
}
bool allocation_failed() { return failed; }

}  // namespace alcove::framegraph
