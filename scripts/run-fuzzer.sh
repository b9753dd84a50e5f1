#!/usr/bin/env bash
# Runs one libFuzzer target, fuzz_convex_cut three times as long, those of a few bytes' input half as long:
#                                            scripts/run-fuzzer.sh SECONDS PROGRAM
# Shows how that went; fails on a finding:      scripts/run-fuzzer.sh --result PROGRAM
# Seeds come from tests/fuzz/seeds/NAME and, where real recordings are at hand, from those.
# Leaves build/logs/NAME.result (the output) and, when nothing was found, build/logs/NAME.ok.
set -uo pipefail
cd "$(dirname "$0")/.."
seconds=$1 program=$2
name=$(basename "$program")
corpus=build/fuzz-corpus/$name
result=build/logs/$name.result ok=build/logs/$name.ok
if [ "$seconds" = --result ]; then
  cat "$result" "$ok"
  exit
fi
# Searching for labels that differ takes longer than for bytes that crash.
case $name in
  fuzz_convex_cut) seconds=$((seconds * 3)) ;;
  fuzz_can_signal | fuzz_mt_configuration | fuzz_socketcan) seconds=$(((seconds + 1) / 2)) ;;
esac
mkdir -p "$corpus" build/fuzz-findings build/logs
rm -f "$ok"
seeds=()
[ -d "tests/fuzz/seeds/$name" ] && seeds+=("tests/fuzz/seeds/$name")
if python3 scripts/cut-seeds.py "$name" "build/fuzz-seeds/$name"; then
  seeds+=("build/fuzz-seeds/$name")
fi
if "$program" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 \
  -artifact_prefix="build/fuzz-findings/$name-" "$corpus" "${seeds[@]}" >"$result" 2>&1; then
  echo "no finding" >"$ok"
fi
exit 0
