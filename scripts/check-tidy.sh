#!/usr/bin/env bash
# clang-tidy over every source of the product (not the tests), with the compile commands of the release
# build.
set -euo pipefail
cd "$(dirname "$0")/.."
git ls-files 'core/*.cpp' 'drivers/*.cpp' 'config/*.cpp' 'daemon/*.cpp' 'replay/*.cpp' 'apps/*.cpp' |
  xargs -P 2 -n 4 clang-tidy --quiet -p build/release
