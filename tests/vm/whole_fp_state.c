// SPDX-License-Identifier: Apache-2.0
//
// For the guest on processors with tile registers (AMX): User Mode Linux keeps less of a process's
// floating-point registers than there are, and the kernel takes them back whole or not at all
// (xstateregs_set, EFAULT). Loaded before linux.uml, this adds what is missing, the tiles, which
// nothing in the guest uses.
#define _GNU_SOURCE
#include <sys/ptrace.h>
#include <sys/uio.h>

#include <dlfcn.h>
#include <elf.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>

typedef long (*Ptrace)(enum __ptrace_request, ...);

long ptrace(enum __ptrace_request request, ...) {
  static Ptrace real = NULL;
  static unsigned char whole[1 << 16];
  va_list arguments;
  va_start(arguments, request);
  const int pid = va_arg(arguments, int);
  void* const address = va_arg(arguments, void*);
  void* const data = va_arg(arguments, void*);
  va_end(arguments);
  if (real == NULL) real = (Ptrace)dlsym(RTLD_NEXT, "ptrace");
  if (request == PTRACE_SETREGSET && (uintptr_t)address == NT_X86_XSTATE) {
    const struct iovec* const kept = data;
    struct iovec all = {whole, sizeof(whole)};
    if (real(PTRACE_GETREGSET, pid, address, &all) == 0 && all.iov_len > kept->iov_len) {
      memcpy(whole, kept->iov_base, kept->iov_len);
      return real(request, pid, address, &all);
    }
  }
  return real(request, pid, address, data);
}
