#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The daemon live for a while, fed over UDP and a terminal, with a subscriber; closes with one line of figures.
#   tests/soak.sh LIDAR IMU [SECONDS]     recordings to feed it with; 600 seconds
# Fails when packets or samples are lost, when the realtime threads allocate or fetch pages, or when results are
# not ten a second (ROTOR_HZ a second where the recorded rotor turns at another speed), give or take one. Where
# realtime scheduling is permitted, late results (unless packets were sent 3 ms late or more) and jitter above JITTER_US
# (5000) at p99.9 fail it too. BUILD (build/release) has the programs, DDS_DOMAIN (a free one) is the domain,
# CONVEXCUTD_ARGS and REPLAY_ARGS go to the programs, LOG keeps the log.
# A recording is played again and again: where it ends at another place than a whole revolution, or lidar and IMU
# do not end together, cut it with REPLAY_ARGS="--from 1 --to 9", or packets are missing at the seam.
set -euo pipefail

[ $# -ge 2 ] && [ $# -le 3 ] || { sed -n '3,11s/^# \{0,1\}//p' "$0" >&2; exit 2; }
lidar=$1 imu=$2 seconds=${3:-600}
[[ $seconds =~ ^[0-9]+$ && $seconds -ge 3 ]] || { echo "soak.sh: expected at least 3 SECONDS, found \"$seconds\"" >&2; exit 2; }
for file in "$lidar" "$imu"; do
  [ -r "$file" ] || { echo "soak.sh: $file: cannot be read, expected a recording" >&2; exit 2; }
done
here=$(cd "$(dirname "$0")/.." && pwd)
bin=$(cd "${BUILD:-$here/build/release}" && pwd)/bin
for program in convexcutd convexcut; do
  [ -x "$bin/$program" ] || { echo "soak.sh: $bin/$program is not built" >&2; exit 2; }
done

work=$(mktemp -d)
log=${LOG:-$work/daemon.log}
declare -a started=()
stop() {
  local pid
  for pid in "${started[@]}"; do kill -TERM "$pid" 2>/dev/null || true; done
  wait 2>/dev/null || true
  rm -rf "$work"
}
trap stop EXIT

# Two free UDP ports, outside of what DDS takes.
read -r data_port position_port < <(python3 - <<'PORTS'
import socket
found = []
for port in range(21000, 22000):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        try:
            s.bind(('', port))
            found.append(port)
        except OSError:
            pass
    if len(found) == 2:
        break
print(*found)
PORTS
)
domain=${DDS_DOMAIN:-$((1 + $$ % 40))}

# Sensors do not wait for a CPU: late packets would be blamed on the daemon.
sensors=()
chrt -f 90 true 2>/dev/null && sensors=(chrt -f 90)
# shellcheck disable=SC2086 # arguments are meant to be split
"${sensors[@]}" "$bin/convexcut" replay --lidar "$lidar" --imu "$imu" --loop --port "$data_port" --position-port "$position_port" \
  --imu-link "$work/imu" --wait 30 --json ${REPLAY_ARGS:-} >"$work/replay.json" 2>"$work/replay.log" &
replay=$! && started+=("$replay")
for _ in $(seq 100); do [ -e "$work/imu" ] && break; sleep 0.05; done
[ -e "$work/imu" ] || { echo "soak.sh: convexcut replay did not start: $(cat "$work/replay.log")" >&2; exit 1; }

"$bin/convexcut" watch --domain "$domain" --json >"$work/watch.json" 2>&1 &
started+=("$!")
# shellcheck disable=SC2086 # arguments are meant to be split
"$bin/convexcutd" --set "dds.domain=$domain" --set "lidar.data_port=$data_port" \
  --set "lidar.position_port=$position_port" --set "imu.device=$work/imu" ${CONVEXCUTD_ARGS:-} >/dev/null 2>"$log" &
daemon=$! && started+=("$daemon")

sleep "$seconds"
kill -0 "$daemon" 2>/dev/null || { echo "soak.sh: the daemon ended: $(tail -n 3 "$log")" >&2; exit 1; }
rss_kb=$(awk '/^VmHWM/ {print $2}' "/proc/$daemon/status")
cpu_ticks=$(awk '{print $14 + $15}' "/proc/$daemon/stat")
stop_began=$(date +%s%N)
kill -TERM "$daemon"
status=0
wait "$daemon" || status=$?
stop_ms=$((($(date +%s%N) - stop_began) / 1000000))
kill -TERM "$replay" && wait "$replay" || true

# The number behind KEY= in the last line of the log that is about EVENT.
figure() { grep "^info $1 " "$log" | tail -n 1 | grep -oE " $2=[0-9]+" | tail -n 1 | cut -d= -f2; }
# The sum of KEY over the realtime threads.
of_threads() {
  grep -E '^info thread name=(lidar|imu|can|worker) ' "$log" | grep -oE " $1=[0-9]+" | cut -d= -f2 | paste -sd+ | bc
}
sent=$(python3 -c 'import json, sys
text = open(sys.argv[1]).read().strip().splitlines()
print(json.loads(text[-1])["data_packets"])' "$work/replay.json" 2>/dev/null || echo 0)
sensors_late_ms=$(python3 -c 'import json, sys
text = open(sys.argv[1]).read().strip().splitlines()
print(json.loads(text[-1])["max_lateness_ms"])' "$work/replay.json" 2>/dev/null || echo unknown)
run_ms=$(figure timing run_ms)
results=$(figure timing results)
late=$(figure timing late)
packets_lost=$(($(figure end lost_packets) + $(figure end kernel_drops) + $(figure end ring_overruns)))
imu_lost=$(figure end lost_imu_samples)
allocations=$(of_threads allocations)
major_faults=$(of_threads major_faults)
jitter=$(figure timing jitter_p999_us)
expected=$(python3 -c "print(round($run_ms / 1000 * ${ROTOR_HZ:-10}))")
echo "packets_sent=$sent packets_lost=$packets_lost imu_lost=$imu_lost results=$results late=$late" \
  "jitter_p999_us=$jitter rss_mb=$((rss_kb * 1024 / 1000000)) cpu_pct=$(python3 -c "print(round($cpu_ticks * 1e5 / $(getconf CLK_TCK) / $run_ms, 1))")" \
  "allocations=$allocations major_faults=$major_faults"

echo "packets were sent up to $sensors_late_ms ms late, the stop took $stop_ms ms: $(grep '^info timing' "$log" | cut -d' ' -f3-)" >&2

failures=()
[ "$status" = 0 ] || failures+=("the daemon's exit status is $status")
[ "$stop_ms" -lt 1000 ] || failures+=("the stop took $stop_ms ms")
[ "$(figure end packets)" -gt 0 ] || failures+=("no packet came")
[ "$(figure end imu_samples)" -gt 0 ] || failures+=("no IMU sample came")
[ "$packets_lost" = 0 ] || failures+=("packets were lost")
[ "$imu_lost" = 0 ] || failures+=("IMU samples were lost")
[ "$allocations" = 0 ] || failures+=("realtime threads called the allocator")
[ "$major_faults" = 0 ] || failures+=("realtime threads fetched pages")
[ $((results - expected)) -ge -1 ] && [ $((results - expected)) -le 1 ] || failures+=("expected $expected results")
if grep -q '^info start .*scheduling=fifo' "$log"; then
  # A scan whose packets were sent late is late without the daemon's doing.
  if [ "$(python3 -c "print(int($sensors_late_ms < 3))" 2>/dev/null)" = 1 ]; then
    [ "$late" = 0 ] || failures+=("results were late")
  fi
  [ "$jitter" -le "${JITTER_US:-5000}" ] || failures+=("jitter_p999_us is above ${JITTER_US:-5000}")
fi
[ ${#failures[@]} = 0 ] && exit 0
printf 'soak.sh: %s\n' "${failures[@]}" >&2
exit 1
