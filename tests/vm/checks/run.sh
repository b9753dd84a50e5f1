# Runs in the guest as root, in /host: sources the checks one after another, closes with the counts.
PATH=/host/bin:$PATH
source checks/lib.sh
ip link set lo multicast on
# One CPU, on which those who publish go before those who read: whole scans wait in the readers' sockets.
sysctl -q net.core.rmem_max=16777216 net.core.rmem_default=4194304
programs_start() { convexcut --version && convexcutd --version && drivers_socketcan_test --gtest_list_tests; }
check "the programs start" programs_start || exit 1
for file in checks/[0-9]*.sh; do
  started=$(uptime_s)
  source "$file"
  echo "        $(basename "$file" .sh): $(($(uptime_s) - started)) s"
done
echo "guest: $passed passed, $failed failed"
[ $failed = 0 ]
