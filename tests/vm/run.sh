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
cp build/release/tests/drivers_socketcan_test "$folder/"

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
