#!/usr/bin/env bash
# Measures paper, robust and three baselines on simulated, labelled scans and writes docs/accuracy.md.
#   ./accuracy.sh                   everything, with as many scans as the paper has (about half an hour)
#   ./accuracy.sh --quick           one seed, few scans (some minutes)
#   ./accuracy.sh --first-seed N    of the seeds; nothing was tuned on the default's
set -euo pipefail
cd "$(dirname "$0")"

options=()
while [ $# -gt 0 ]; do
  case "$1" in
    -h | --help) sed -n '2,5s/^# \{0,1\}//p' "$0"; exit 0 ;;
    --quick) options+=(--quick) ;;
    --first-seed) options+=(--first-seed "${2:?--first-seed needs a number}"); shift ;;
    *) echo "accuracy.sh: unknown option '$1': expected --quick or --first-seed N" >&2; exit 2 ;;
  esac
  shift
done

scripts/install-packages.sh test
mkdir -p build/logs
{ cmake --preset release && cmake --build --preset release --target convexcut_accuracy -j 2; } \
  >build/logs/accuracy-build.log 2>&1 || { tail -n 30 build/logs/accuracy-build.log >&2; exit 1; }

# One experiment after another: what was measured is not lost when a later one fails.
results=build/accuracy
rm -rf "$results" && mkdir -p "$results"
for experiment in scenes ghosts gravity dynamic mirror ablation office cafe moving; do
  build/release/bin/convexcut_accuracy "${options[@]}" --only "$experiment" >"$results/$experiment.json"
done
scripts/accuracy-report.py "$results" --write-docs
