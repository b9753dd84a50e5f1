// SPDX-License-Identifier: Apache-2.0
//
// Stands in for glibc's allocator to hear of every call of it, also from C libraries, and hands the
// call on. glibc keeps these names for that purpose ("Replacing malloc" in its manual;
// __libc_malloc and its relatives are exported since 2.2.5). A sanitizer has its own stand-ins:
// then there is nothing here.
#include <cstddef>

#include "daemon/realtime/allocation_watch.hpp"

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

using convexcut::daemon::note_allocation;

extern "C" {

// NOLINTBEGIN(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp): glibc's names
void* __libc_malloc(std::size_t size) noexcept;
void* __libc_calloc(std::size_t count, std::size_t size) noexcept;
void* __libc_realloc(void* memory, std::size_t size) noexcept;
void* __libc_memalign(std::size_t alignment, std::size_t size) noexcept;
void __libc_free(void* memory) noexcept;
// NOLINTEND(bugprone-reserved-identifier,cert-dcl37-c,cert-dcl51-cpp)

// NOLINTBEGIN(readability-inconsistent-declaration-parameter-name): glibc's are reserved

void* malloc(std::size_t size) noexcept {
  note_allocation();
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) noexcept {
  note_allocation();
  return __libc_calloc(count, size);
}

void* realloc(void* memory, std::size_t size) noexcept {
  note_allocation();
  return __libc_realloc(memory, size);
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
  note_allocation();
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  note_allocation();
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  note_allocation();
  constexpr int kInvalid = 22;   // EINVAL
  constexpr int kNoMemory = 12;  // ENOMEM
  if (alignment % sizeof(void*) != 0 || (alignment & (alignment - 1)) != 0 || alignment == 0) {
    return kInvalid;
  }
  void* const got = __libc_memalign(alignment, size);
  if (got == nullptr) return kNoMemory;
  *memory = got;
  return 0;
}

void free(void* memory) noexcept {
  note_allocation();
  __libc_free(memory);
}

// NOLINTEND(readability-inconsistent-declaration-parameter-name)

}  // extern "C"

#endif
