#!/usr/bin/env bash
# clang-tidy over every source of the product (not the tests), with the compile commands of the release
# build. The path-sensitive analyzer takes as long again as all other checks together:
#   scripts/check-tidy.sh            without it, as continuous integration does
#   scripts/check-tidy.sh analyze    with it
set -euo pipefail
cd "$(dirname "$0")/.."
checks=--checks=-clang-analyzer-*
[ "${1:-}" != analyze ] || checks=--checks=
git ls-files 'core/*.cpp' 'drivers/*.cpp' 'config/*.cpp' 'daemon/*.cpp' 'replay/*.cpp' 'apps/*.cpp' |
  xargs -P 2 -n 4 clang-tidy --quiet "$checks" -p build/release
