# The kernel's CAN, our source's own tests on it, and can-utils as the other end.
check "kernel modules of virtual CAN" modprobe -a vcan can-raw
gtest drivers_socketcan_test

add_vcan() { ip link add dev vcan0 type vcan && ip link set dev vcan0 mtu 72; }
frames() { awk '{ print $3 }' "$1" | grep -v '^005#'; } # SampleTime goes on as the device's would
frames_are_there() { [ "$(frames /tmp/bus.log | wc -l)" -ge "$(frames /tmp/sent.log | wc -l)" ]; }
# How many of each identifier; not of Warning, which the recorder is woken with. Samples are not compared: frames
# of a group that come late on a busy host make two.
counts() { convexcut info --can "$1" --json | grep -o '"id": "[^}]*' | grep -v 0x002; }
counts_agree() { [ "$(counts "$1" | wc -l)" = 5 ] && diff <(counts /tmp/sent.log) <(counts "$1"); }

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
check "candump's log is read like the log" counts_agree /tmp/bus.log

convexcut record --out /run/drive --set can.interface=vcan0 >out/record.log 2>&1 &
record=$!
recording() { [ -e /run/drive/can_000.pcap ] && convexcut info --can /run/drive/can_000.pcap; }
heard_by_recorder() { cansend vcan0 002#00 && recording; }
check "convexcut record listens to the bus" within 15 heard_by_recorder
convexcut replay --can /tmp/sent.log --can-interface vcan0 >/dev/null
kill -TERM $record
wait $record
check "convexcut record holds all frames of the log" counts_agree /run/drive/can_000.pcap
ip link del dev vcan0
