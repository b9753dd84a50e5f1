#!/usr/bin/env bash
# Installs the Debian 12 packages that are named as arguments' groups and missing here.
#   scripts/install-packages.sh build|test|aarch64|vm …
set -euo pipefail

build=(build-essential cmake ninja-build pkg-config ca-certificates
  libpcap-dev libeigen3-dev libhwy-dev cyclonedds-dev cyclonedds-tools libtomlplusplus-dev libcli11-dev
  libpng-dev libgtest-dev libgmock-dev libbenchmark-dev libboost-dev)
check=(libqhull-dev libcgal-dev clang clang-format clang-tidy libclang-rt-14-dev lld llvm python3 tshark git iproute2 bc rt-tests stress-ng valgrind)
# Libraries of another architecture: dpkg has to be told of it.
aarch64=(g++-aarch64-linux-gnu qemu-user libhwy-dev:arm64 libgtest-dev:arm64 libgmock-dev:arm64)
vm=(mmdebstrap e2fsprogs kmod user-mode-linux)

wanted=()
for group in "$@"; do
  case "$group" in
    build) wanted+=("${build[@]}") ;;
    test) wanted+=("${build[@]}" "${check[@]}") ;;
    aarch64) wanted+=("${build[@]}" "${aarch64[@]}") ;;
    vm) wanted+=("${vm[@]}") ;;
    *) echo "install-packages.sh: unknown group '$group': expected build, test, aarch64 or vm" >&2; exit 2 ;;
  esac
done

# A library may be here for another architecture only, or for both.
native=$(dpkg --print-architecture)
missing=()
for package in "${wanted[@]}"; do
  case "$package" in *:*) architecture=${package#*:} ;; *) architecture=$native ;; esac
  dpkg-query -W -f '${Architecture} ${db:Status-Status}\n' "${package%:*}" 2>/dev/null |
    grep -qxE "($architecture|all) installed" || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" != 0 ]; then
  command -v sudo >/dev/null || {
    echo "install-packages.sh: these packages are missing and there is no sudo: ${missing[*]}" >&2
    exit 1
  }
  as_root=(sudo)
fi
echo "Installing: ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
case " ${missing[*]} " in
  *:arm64*) "${as_root[@]}" dpkg --add-architecture arm64 ;;
esac
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -y -qq -o DPkg::Lock::Timeout=120 --no-install-recommends "${missing[@]}" >/dev/null
