#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Publish jitter of the live daemon beside cyclictest at the same priority in the same run: idle, then with stress-ng on
# every CPU. Prints one line each.
#   tests/latency.sh LIDAR IMU [SECONDS]     recordings as for tests/soak.sh; 60 seconds each
# Fails where the daemon's p99.9 exceeds twice cyclictest's + 100 us, or where realtime scheduling is not permitted.
set -euo pipefail

[ $# -ge 2 ] && [ $# -le 3 ] || { sed -n '3,6s/^# \{0,1\}//p' "$0" >&2; exit 2; }
lidar=$1 imu=$2 seconds=${3:-60}
here=$(cd "$(dirname "$0")" && pwd)
for program in cyclictest stress-ng; do
  command -v "$program" >/dev/null || { echo "latency.sh: $program is missing: scripts/install-packages.sh test" >&2; exit 2; }
done
chrt -f 60 true 2>/dev/null || { echo "latency.sh: SCHED_FIFO is not permitted: run as root or raise ulimit -r" >&2; exit 1; }

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0

# The PERCENTth percentile of cyclictest's histogram, in us: all threads together.
percentile() {
  grep -v '^#' "$work/cyclic" | awk -v percent="$1" '
    NF > 1 { n = 0; for (i = 2; i <= NF; ++i) n += $i; us[++rows] = $1 + 0; count[rows] = n; all += n }
    END { for (i = 1; i <= rows; ++i) { seen += count[i]; if (seen >= all * percent / 100) { print us[i]; exit } } }'
}

# run LOAD COMMAND…: one measurement beside COMMAND.
run() {
  local load=$1 pid=
  shift
  if [ $# -gt 0 ]; then "$@" >/dev/null 2>&1 & pid=$!; fi
  cyclictest --mlockall --smp --policy=fifo --priority=60 --interval=10000 --distance=0 \
    --duration="$seconds" --histogram=20000 --quiet >"$work/cyclic" 2>/dev/null &
  local cyclic=$!
  # Losses and lateness under load are soak.sh's to judge; here only the figures count.
  LOG=$work/daemon.log "$here/soak.sh" "$lidar" "$imu" "$seconds" >"$work/soak" 2>"$work/soak.err" || true
  wait "$cyclic"
  if [ -n "$pid" ]; then kill -TERM "$pid" 2>/dev/null && wait "$pid" || true; fi
  local timing
  timing=$(grep '^info timing' "$work/daemon.log") || { cat "$work/soak.err" >&2; exit 1; }
  figure() { grep -oE " $1=[0-9]+" <<<"$timing" | cut -d= -f2; }
  local cyclic_p999 ours limit
  cyclic_p999=$(percentile 99.9)
  ours=$(figure jitter_p999_us)
  limit=$((2 * cyclic_p999 + 100))
  echo "load=$load results=$(figure results) late=$(figure late)" \
    "jitter_p50_us=$(figure jitter_p50_us) jitter_p99_us=$(figure jitter_p99_us) jitter_p999_us=$ours" \
    "jitter_max_us=$(figure jitter_max_us) cyclictest_p50_us=$(percentile 50) cyclictest_p99_us=$(percentile 99)" \
    "cyclictest_p999_us=$cyclic_p999 cyclictest_max_us=$(percentile 100) limit_us=$limit"
  [ "$ours" -le "$limit" ] || failed=1
}

run idle
run stress stress-ng --cpu 0 --vm 1 --vm-bytes 64M --io 1 --timeout $((seconds + 30))
exit "$failed"
