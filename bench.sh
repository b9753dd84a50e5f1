#!/usr/bin/env bash
# Measures Convex Cut beside Algorithm 1 with Qhull, CGAL and a monotone chain, and beside PCL's planes where
# libpcl-dev is installed, in one run.
#   ./bench.sh                       prints tables and writes docs/performance.md and its plots (about 10 minutes)
#   ./bench.sh --quick --json FILE   only the clouds of the promised ratios, as JSON (under a minute)
#   --simd PATH                      computes with that instruction set (convexcut info --cpu)
# Times depend on the machine and on what else it does; the ratios hardly do.
set -euo pipefail
cd "$(dirname "$0")"

quick=() json= simd=()
while [ $# -gt 0 ]; do
  case "$1" in
    -h | --help) sed -n '2,7s/^# \{0,1\}//p' "$0"; exit 0 ;;
    --quick) quick=(--quick) ;;
    --json) json=${2:?--json needs a file}; shift ;;
    --simd) simd=(--simd "${2:?--simd needs an instruction set}"); shift ;;
    *) echo "bench.sh: unknown option '$1': expected --quick, --json FILE or --simd PATH" >&2; exit 2 ;;
  esac
  shift
done

scripts/install-packages.sh test
mkdir -p build/logs
{ cmake --preset release && cmake --build --preset release --target convex_cut_compare stages_bench -j 2; } \
  >build/logs/bench-build.log 2>&1 || { tail -n 30 build/logs/bench-build.log >&2; exit 1; }

results=$(mktemp -d)
trap 'rm -rf "$results"' EXIT
build/release/bin/convex_cut_compare "${quick[@]}" "${simd[@]}" >"$results/compare.json"
if [ -n "$json" ]; then cp "$results/compare.json" "$json"; fi
if [ ${#quick[@]} = 0 ]; then
  # Every stage of the data's way, beside a plain decoder, as Google Benchmark reports it.
  build/release/bin/stages_bench --benchmark_out="$results/stages.json" --benchmark_out_format=json >/dev/null
  scripts/performance-report.py "$results/compare.json" "$results/stages.json"
else
  scripts/performance-report.py "$results/compare.json"
fi
