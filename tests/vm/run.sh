#!/usr/bin/env bash
# Runs the checks that need a kernel with CAN, a system clock to step and systemd, on the release build in a
# guest; prints a line a check and closes with the counts. Exit status: 0 all passed, 1 not, 77 cannot run here.
#   tests/vm/run.sh
set -euo pipefail
cd "$(dirname "$0")/../.."

cannot_run() {
  echo "skipped: the guest cannot run here: $1"
  exit 77
}
for tool in linux.uml mmdebstrap mke2fs depmod; do
  command -v $tool >/dev/null || PATH=$PATH:/usr/sbin:/sbin command -v $tool >/dev/null ||
    cannot_run "no $tool: scripts/install-packages.sh vm"
done
PATH=$PATH:/usr/sbin:/sbin
[ "$(uname -m)" = x86_64 ] || cannot_run "User Mode Linux is for x86_64, this is $(uname -m)"
probe=$(mktemp /dev/shm/convexcut.XXXXXX) || cannot_run "/dev/shm cannot be written"
cp /bin/true "$probe" && chmod +x "$probe"
"$probe" 2>/dev/null && executable=yes || executable=no
rm -f "$probe"
[ $executable = yes ] || cannot_run "/dev/shm does not allow executing, which the guest's memory needs"
[ "$(df --output=avail -m /dev/shm | tail -n 1)" -ge 512 ] || cannot_run "/dev/shm has less than 512 MB"

tests/vm/make-rootfs.sh

folder=$(mktemp -d build/vm/run.XXXXXX)
trap 'rm -rf "$folder"' EXIT
cp -r tests/vm/checks "$folder/checks"
mv "$folder/checks/run.sh" "$folder/run.sh"
mkdir "$folder/bin"
cp build/release/bin/convexcut{,d} build/release/tests/drivers_socketcan_test "$folder/bin/"

# What the guest plays, and what it has to make of it.
build/release/bin/convexcut-demo-room --out "$folder/room" --seconds 6 >/dev/null
build/release/bin/convexcut process --lidar "$folder/room/lidar.pcap" --can "$folder/room/can.log" \
  --out "$folder/scans" >/dev/null
(cd "$folder/scans" && sha256sum -- * | sort -k 2) >"$folder/room/scans.sha256"
rm -r "$folder/scans"
python3 - "$folder/room/lidar.pcap" "$folder/room/thin.pcap" <<'P'
import struct, sys
capture = open(sys.argv[1], "rb").read()
at, number = 24, 0
with open(sys.argv[2], "wb") as thin:  # every eighth record
    thin.write(capture[:at])
    while at < len(capture):
        end = at + 16 + struct.unpack_from("<I", capture, at + 8)[0]
        if number % 8 == 0:
            thin.write(capture[at:end])
        at, number = end, number + 1
P

started=$SECONDS
tests/vm/run-guest.sh "$folder" && status=0 || status=$?
cat "$folder/out/console.log" 2>/dev/null || true
rm -rf build/vm/last
cp -r "$folder/out" build/vm/last
echo "guest: $((SECONDS - started)) s, $(cat "$folder/out/uptime-at-start" 2>/dev/null || echo '?') s of it to start; logs in build/vm/last"
case $status in
  124) echo "guest: not done in time" ;;
  125) echo "guest: died" ;;
esac
[ $status = 0 ]
