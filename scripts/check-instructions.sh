#!/usr/bin/env bash
# Instructions per point of each stage, as valgrind counts them with AVX2 (it knows no AVX-512): a
# loss of speed that no busy machine can hide or feign. The bounds are a seventh above what there was
# when they were set; after a change that is meant to cost more, or less, set them anew:
#   scripts/check-instructions.sh --set
set -euo pipefail
cd "$(dirname "$0")/.."
declare -A bound=(
  [decode]=53
  [level]=28
  [label]=335
  [stream]=799
  [robust]=1768
)

# instructions STAGE ROUNDS
instructions() {
  valgrind --tool=callgrind --callgrind-out-file=/dev/null build/release/bin/bench_instructions "$1" "$2" avx2 2>&1 |
    sed -n 's/.*Collected : \([0-9]*\).*/\1/p'
}

bad=0
for stage in decode level label stream robust; do
  points=$(build/release/bin/bench_instructions "$stage" 1 avx2)
  per_point=$((($(instructions "$stage" 3) - $(instructions "$stage" 1)) / (2 * points)))
  if [ "${1:-}" = --set ]; then
    sed -i "s/^  \[$stage\]=.*/  [$stage]=$(((per_point * 8 + 6) / 7))/" "$0"
  fi
  echo "figure: $stage: $per_point instructions a point (at most ${bound[$stage]})"
  [ "$per_point" -gt 0 ] && [ "$per_point" -le "${bound[$stage]}" ] || bad=1
done
[ "${1:-}" = --set ] || exit $bad
