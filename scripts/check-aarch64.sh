#!/usr/bin/env bash
# Core and decoders for 64-bit ARM: cross-compiled with Debian's compiler, their tests under qemu-user.
#   scripts/check-aarch64.sh          builds and runs them
#   scripts/check-aarch64.sh build    only builds them
# Of the long random tests CONVEXCUT_TEST_PERCENT are run (CMakePresets.json): the emulator is slow.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install-packages.sh aarch64
cmake --preset aarch64 -DCONVEXCUT_UNITY=ON
cmake --build --preset aarch64 -j 2
[ "${1:-}" = build ] || ctest --preset aarch64 -j 2
