#!/usr/bin/env bash
# Boots the test guest (User Mode Linux: a user process, one CPU, nothing of it outlives the run), which runs
# FOLDER/run.sh as root, and exits with that script's status; 124: not done in time, 125: the guest died.
#   tests/vm/run-guest.sh FOLDER [SECONDS]
# FOLDER is /host in the guest. It leaves FOLDER/out: console.log, journal.log, serial.log, uptime-at-start.
# The image is only read: several guests can run at once.
set -euo pipefail
image=$(cd "$(dirname "$0")/../.." && pwd)/build/vm/rootfs.ext4
folder=$(cd "$1" && pwd)
seconds=${2:-240}
rm -rf "$folder/out"
mkdir -p "$folder/out"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

preload=
if grep -qw amx_tile /proc/cpuinfo; then
  preload=$work/whole_fp_state.so
  ${CC:-cc} -O2 -shared -fPIC -o "$preload" "$(dirname "$0")/whole_fp_state.c"
fi

# The guest's memory is a file in TMPDIR, which has to allow executing.
LD_PRELOAD=$preload TMPDIR=/dev/shm timeout -k 5 "$seconds" linux.uml mem=512M \
  ubd0="$work/changes,$image" root=/dev/ubda rootfstype=ext4 rw \
  con0=null,fd:1 con=null ssl=null uml_dir="$work" umid=guest \
  guest.share="$folder" guest.timeout=$((seconds - 20)) \
  quiet loglevel=3 systemd.show_status=0 audit=0 lsm= pty.legacy_count=0 \
  </dev/null >"$folder/out/serial.log" 2>&1 && ended=0 || ended=$?

if [ -s "$folder/out/status" ]; then exit "$(cat "$folder/out/status")"; fi
tail -n 40 "$folder/out/serial.log" >&2
case $ended in 124 | 137) exit 124 ;; *) exit 125 ;; esac
