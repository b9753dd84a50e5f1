#!/usr/bin/env bash
# clang-tidy over sources of the product (not the tests). The path-sensitive analyzer takes as long again as all
# other checks together:
#   scripts/check-tidy.sh [FILE …]            without it; of all sources when none is named
#   scripts/check-tidy.sh analyze [FILE …]    with it
set -euo pipefail
cd "$(dirname "$0")/.."
checks=--checks=-clang-analyzer-*
if [ "${1:-}" = analyze ]; then
  checks=--checks=
  shift
fi
# Commands of its own: those of the builds have headers that another compiler precompiled.
cmake --preset release -B build/tidy -DCONVEXCUT_UNITY=OFF -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ >/dev/null
cmake --build build/tidy --target convexcut_ros2_idl_generate >/dev/null  # a header
if [ $# != 0 ]; then
  printf '%s\n' "$@"
else
  git ls-files 'core/*.cpp' 'drivers/*.cpp' 'config/*.cpp' 'daemon/*.cpp' 'replay/*.cpp' 'apps/*.cpp'
fi | xargs -P 2 -n 4 clang-tidy --quiet "$checks" -p build/tidy
