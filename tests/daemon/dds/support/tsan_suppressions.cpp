// SPDX-License-Identifier: Apache-2.0
//
// ThreadSanitizer asks the program for this function. Debian's libddsc is not instrumented: its
// atomics are invisible, so all it does through libc looks like a race.
extern "C" const char* __tsan_default_suppressions();  // NOLINT: the name is the sanitizer's

extern "C" const char* __tsan_default_suppressions() {  // NOLINT
  return "called_from_lib:libddsc.so\nrace:libddsc.so\n";
}
