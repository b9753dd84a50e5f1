# A stage that turns the lidar, its encoder on the bus; can-utils send it.
awk 'BEGIN { for (i = 0; i < 3000; i++)
  printf "(%.6f) can0 181#3706%02X%02X0000\n", 1700000000 + i / 100, i % 256, int(i / 256) }' >/tmp/encoder.log
mark
start_daemon --set can.interface=vcan0 --set worker.latency_ms=90 --set mount.orientation=fixed \
  --set encoder.timeout_ms=500 --set encoder.use=orientation --set encoder.preset=cia402_position --set encoder.scale_deg=0.01
convexcut replay --lidar room/thin.pcap --loop >out/replay-lidar.log 2>&1 &
replay_lidar=$!
no_points() { is structure_hz ">=" 5 && is points_per_scan == 0; }
check "encoder: no points without an angle" within 20 no_points
canplayer vcan0=can0 -I /tmp/encoder.log &
player=$!
check "encoder: its angles turn the points" within 20 is points_per_scan ">" 500
kill $player
wait $player 2>/dev/null
check "encoder: silent, no points" within 20 no_points
canplayer vcan0=can0 -I /tmp/encoder.log &
player=$!
check "encoder: back, points again" within 20 is points_per_scan ">" 500
kill $player $replay_lidar
wait $player $replay_lidar 2>/dev/null
stop_daemon
check "encoder: the daemon ends with status 0" [ $stopped = 0 ]
kill -TERM $watch
wait $watch
ip link del dev vcan0
