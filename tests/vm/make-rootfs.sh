#!/usr/bin/env bash
# Makes the disk image of the test guest, build/vm/rootfs.ext4: Debian 12 with systemd, the CAN tools and the
# libraries that the programs of the release build link, nothing else.
#   tests/vm/make-rootfs.sh [--force]
# It is made once (about a minute) and kept: its key is a hash of what it is made from. --force makes it anew,
# which is how newer versions of the packages come in. Needs root, or sudo.
set -euo pipefail
cd "$(dirname "$0")"
../../scripts/install-packages.sh vm
cache=$(cd ../.. && pwd)/build/vm
mkdir -p "$cache"

packages=(systemd systemd-sysv udev dbus kmod iproute2 procps can-utils)
# Those of the libraries that our programs were linked with.
for library in $(objdump -p ../../build/release/bin/convexcut{,d} | awk '$1 == "NEEDED" { print $2 }' | sort -u); do
  packages+=("$(dpkg -S "*/$library" | head -n 1 | cut -d: -f1)")
done
# What the guest has no use for and would wait for at its start.
masked=(getty@tty1.service serial-getty@ttyS0.service console-getty.service
  apt-daily.timer apt-daily-upgrade.timer dpkg-db-backup.timer e2scrub_all.timer e2scrub_reap.service fstrim.timer
  systemd-hwdb-update.service systemd-journal-flush.service systemd-update-utmp.service
  systemd-random-seed.service systemd-binfmt.service systemd-pcrphase.service systemd-pcrphase-sysinit.service
  systemd-machine-id-commit.service modprobe@drm.service modprobe@configfs.service modprobe@fuse.service
  systemd-logind.service systemd-user-sessions.service systemd-timesyncd.service
  dev-hugepages.mount sys-kernel-debug.mount sys-kernel-tracing.mount)
modules=(can can-raw can-dev vcan vxcan)

kernel=$(dpkg-query -W -f '${Version}' user-mode-linux)
key=$({
  cat make-rootfs.sh
  find guest -type f -print0 | sort -z | xargs -0 cat
  echo "$kernel ${packages[*]}"
} | sha256sum | cut -c1-16)
if [ "${1:-}" != --force ] && [ -s "$cache/rootfs.ext4" ] && [ "$(cat "$cache/key" 2>/dev/null)" = "$key" ]; then
  echo "rootfs: kept ($key)"
  exit
fi
if [ "$(id -u)" != 0 ]; then
  command -v sudo >/dev/null || { echo "make-rootfs.sh: needs root or sudo" >&2; exit 1; }
  exec sudo ./make-rootfs.sh --force
fi

rm -f "$cache/key"
work=$(mktemp -d "$cache/making.XXXXXX")
trap 'rm -rf "$work"' EXIT
root=$work/root

sources=()
for list in /etc/apt/sources.list /etc/apt/sources.list.d/*.list /etc/apt/sources.list.d/*.sources; do
  [ -s "$list" ] && sources+=("$list")
done
mmdebstrap --mode=root --format=directory --quiet --variant=minbase \
  --include="$(IFS=,; echo "${packages[*]}")" \
  --aptopt='Acquire::Languages "none"' --aptopt='Acquire::Retries "3"' \
  --dpkgopt='path-exclude=/usr/share/man/*' --dpkgopt='path-exclude=/usr/share/locale/*' \
  --dpkgopt='path-exclude=/usr/share/doc/*' --dpkgopt='path-exclude=/usr/share/info/*' \
  --customize-hook='rm -rf "$1"/var/lib/apt/lists/* "$1"/var/cache/* "$1"/usr/share/i18n "$1"/usr/share/zoneinfo/[A-Z]*' \
  bookworm "$root" "${sources[@]}"
echo "rootfs: packages after $SECONDS s"

cp -a guest/. "$root/"
chown -R 0:0 "$root/usr/local/sbin" "$root/etc/systemd"
echo guest >"$root/etc/hostname"
printf '127.0.0.1 localhost guest\n::1 localhost\n' >"$root/etc/hosts"
echo '/dev/root / ext4 defaults,noatime 0 0' >"$root/etc/fstab"
rm -f "$root/etc/machine-id"
echo 0123456789abcdef0123456789abcdef >"$root/etc/machine-id"
ln -sf /etc/systemd/system/guest.target "$root/etc/systemd/system/default.target"
for unit in "${masked[@]}"; do ln -sf /dev/null "$root/etc/systemd/system/$unit"; done

# Of the kernel's modules those that are needed, with what they need.
version=$(ls /usr/lib/uml/modules | head -n 1)
mkdir -p "$work/all/lib/modules"
cp -a "/usr/lib/uml/modules/$version" "$work/all/lib/modules/"
depmod -b "$work/all" "$version"
for module in "${modules[@]}"; do
  modprobe -d "$work/all" -S "$version" -D "$module" | awk '$1 == "insmod" { print $2 }'
done | sort -u | while read -r file; do
  install -D -m 644 "$file" "$root${file#"$work/all"}"
done
cp "$work/all/lib/modules/$version"/modules.{builtin,builtin.modinfo,order} "$root/lib/modules/$version/"
depmod -b "$root" "$version"

kilobytes=$(($(du -sk "$root" | cut -f1) * 13 / 10 + 65536))
rm -f "$cache/rootfs.ext4"
mke2fs -q -t ext4 -O ^has_journal -m 0 -E root_owner=0:0 -d "$root" "$cache/rootfs.ext4" "${kilobytes}k"
chmod 644 "$cache/rootfs.ext4"
echo "$key" >"$cache/key"
echo "rootfs: made in $SECONDS s ($(du -h "$cache/rootfs.ext4" | cut -f1))"
