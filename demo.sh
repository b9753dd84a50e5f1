#!/usr/bin/env bash
# Shows the whole chain on this machine: recorded packets → convexcutd → DDS → convexcut watch, and a
# picture of the result.
#   ./demo.sh             a generated room; then the real courtyard recording, where it is at hand
# DEMO_SECONDS (8) is how long the room plays. CONVEXCUT_RECORDINGS names the folder of real recordings
# when it is not ../shared/data.
set -euo pipefail
cd "$(dirname "$0")"

case "${1:-}" in
  -h | --help) sed -n '2,6s/^# \{0,1\}//p' "$0"; exit 0 ;;
  "") ;;
  *) echo "demo.sh: unknown argument '$1': it takes none (see ./demo.sh --help)" >&2; exit 2 ;;
esac

say() { printf '\n== %s\n' "$*"; }

say "Installing what is missing and building"
scripts/install-packages.sh build
mkdir -p build demo-out
log=build/demo-build.log
if ! { cmake --preset release &&
  cmake --build --preset release --target convexcut convexcutd convexcut-demo-room; } >"$log" 2>&1; then
  tail -n 30 "$log" >&2
  echo "demo.sh: the build failed, see $log" >&2
  exit 1
fi
bin=build/release/bin
seconds=${DEMO_SECONDS:-8}
# A domain of its own, so that other DDS programs of this machine are not disturbed.
domain=$((1 + RANDOM % 99))

# play CONVEXCUTD-ARGUMENTS…: the daemon with `convexcut watch` beside it.
watching=
trap '[ -z "$watching" ] || kill "$watching" 2>/dev/null || true' EXIT
play() {
  "$bin/convexcut" watch --domain "$domain" &
  watching=$!
  "$bin/convexcutd" --set dds.domain="$domain" --wait-for-reader 10 "$@"
  kill -INT "$watching" 2>/dev/null || true
  wait "$watching" || true
  watching=
}

# picture SCANS-DIRECTORY INDEX PICTURE TITLE
picture() {
  "$bin/convexcut" picture "$1/scan_$(printf %06d "$2").pcd" --out "$3" --title "$4" --slice-deg 30 \
    >/dev/null
}

room=demo-out/room
say "Making $seconds s of a furnished room: HDL-32E packets, MTi frames, CAN frames"
"$bin/convexcut-demo-room" --out "$room" --seconds "$seconds"
"$bin/convexcut" info --lidar "$room/lidar.pcap" --imu "$room/imu.pcap"

say "Playing it through convexcutd, in real time; convexcut watch listens over DDS"
play --lidar "$room/lidar.pcap" --imu "$room/imu.pcap"

say "Drawing one scan of it"
"$bin/convexcut" process --lidar "$room/lidar.pcap" --imu "$room/imu.pcap" --out "$room/scans"
picture "$room/scans" 10 demo-out/room.png "Furnished room: structure and the rest"
pictures=(demo-out/room.png)

courtyard=${CONVEXCUT_RECORDINGS:-../shared/data}/lidar/hdl32e_courtyard_2011.pcap
if [ -f "$courtyard" ]; then
  say "A real HDL-32E in a courtyard (0.28 s, played 20 times slower)"
  play --lidar "$courtyard" --set mount.orientation=fixed --rate 0.05
  "$bin/convexcut" process --lidar "$courtyard" --set mount.orientation=fixed --out demo-out/courtyard
  picture demo-out/courtyard 1 demo-out/courtyard.png "Courtyard: structure and the rest"
  pictures+=(demo-out/courtyard.png)
fi

say "Done. Pictures:"
printf '   %s\n' "${pictures[@]}"
