# The daemon on a CAN bus that is missing, down, faulty and gone for a while, and through steps of the clock.
: >out/daemon.log
mark
# Orientations are held for long: on a busy host the guest's one CPU is late with them.
start_daemon --set can.interface=vcan0 --set worker.latency_ms=90 --set imu.max_age_ms=1000
check "daemon: starts without the interface, and says so" within 10 said "vcan0: No such device"
mark
add_vcan
check "daemon: an interface that is down" within 10 said "vcan0: Network is down"
check "daemon: says how to bring it up" said "ip link set vcan0 up type can bitrate 250000"
mark
ip link set dev vcan0 up
check "daemon: the interface has come up" within 10 said 'resolved="can: vcan0: Network is down'

start_watch
convexcut replay --can room/can.log --loop >out/replay-can.log 2>&1 &
replay_can=$!
check "daemon: publishes the IMU of the bus at 100 Hz" within 15 is imu_hz ">=" 90
check "daemon: no sample is lost" is lost_imu_samples == 0
check "daemon: results at 10 Hz without a lidar" within 10 is structure_hz ">=" 9

mark
kill -STOP $replay_can # frames from the bus would end the states that follow
sleep 0.5
cansend vcan0 20000004#0010000000000000
check "daemon: error-passive" within 10 said "the controller is error-passive"
cansend vcan0 20000040#0000000000000000
check "daemon: bus-off" within 10 said "the controller is off the bus"
cansend vcan0 20000100#0000000000000000
check "daemon: restarted" within 10 said 'resolved="can: vcan0: the controller is off the bus'
kill -CONT $replay_can
check "daemon: samples again" within 15 is imu_hz ">=" 90

mark
ip link set dev vcan0 down
check "daemon: the interface went down" within 10 said "vcan0: Network is down"
check "daemon: results go on at 10 Hz" within 10 is structure_hz ">=" 9
ip link set dev vcan0 up
check "daemon: and has come up" within 10 said 'resolved="can: vcan0: Network is down'
check "daemon: samples again at 100 Hz" within 15 is imu_hz ">=" 90

# Of the lidar every eighth packet: one emulated CPU does not take 1800 a second.
convexcut replay --lidar room/thin.pcap --loop >out/replay-lidar.log 2>&1 &
replay_lidar=$!
check "daemon: levels the lidar's points by the bus" within 20 is points_per_scan ">" 500

# The third second of watching that ends after the step began 2 s after it at the earliest. A result in the
# old time would be an hour late.
recovered() {
  awk -v imu="$(of $1 imu_hz)" -v points="$(of $1 points_per_scan)" -v latency="$(of $1 latency_p50_ms)" \
    'BEGIN { exit !(imu + 0 >= 50 && points + 0 > 500 && latency + 0 < 1000 && latency + 0 > 0) }' ||
    { sed -n "$(($1 - 3)),$1p" out/watch.log; return 1; }
}
for step in '+1 hour' '-1 hour'; do
  line=$(($(watched) + 3))
  date -s "$step" >/dev/null
  third_second() { [ "$(watched)" -ge $line ]; }
  within 10 third_second
  check "daemon: 2 s after a step of the clock by $step all goes on" recovered $line
done
kill $replay_lidar $replay_can
wait $replay_lidar $replay_can
mark
stop_daemon
check "daemon: ends at SIGTERM with status 0" [ $stopped = 0 ]
for thread in lidar can worker; do
  check "daemon: thread $thread allocated nothing" said "thread name=$thread allocations=0 "
done
