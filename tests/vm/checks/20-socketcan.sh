# The kernel's CAN, our source's own tests on it, and can-utils as the other end.
check "kernel modules of virtual CAN" modprobe -a vcan can-raw
gtest drivers_socketcan_test

add_vcan() { ip link add dev vcan0 type vcan && ip link set dev vcan0 mtu 72; }
frames() { awk '{ print $3 }' "$1" | grep -v '^005#'; } # SampleTime goes on as the device's would
frames_are_there() { [ "$(frames /tmp/bus.log | wc -l)" -ge "$(frames /tmp/sent.log | wc -l)" ]; }
samples() { convexcut info --can "$1" --json | sed -n 's/.*"samples": \([0-9]*\).*/\1/p'; }
samples_agree() {
  local sent heard
  sent=$(samples /tmp/sent.log) heard=$(samples /tmp/bus.log)
  echo "sent $sent, heard $heard"
  [ "${sent:-0}" -gt 0 ] && [ "$sent" = "$heard" ]
}

check "a virtual CAN interface" add_vcan
ip link set dev vcan0 up
head -n 1000 room/can.log >/tmp/sent.log
candump -L vcan0 >/tmp/bus.log 2>/dev/null &
dump=$!
sleep 0.5
check "convexcut replay sends a log to the bus" convexcut replay --can /tmp/sent.log --can-interface vcan0
check "candump hears all of its frames" within 5 frames_are_there
check "each as it is in the log" diff <(frames /tmp/sent.log) <(frames /tmp/bus.log)
kill $dump
wait $dump 2>/dev/null
check "candump's log holds the samples of the log" samples_agree
ip link del dev vcan0
