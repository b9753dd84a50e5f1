# The same recording gives the same bytes here and on the host, another kernel and CPU model.
scans() { (cd "$1" && sha256sum -- * | sort -k 2); }
check "convexcut process runs" convexcut process --lidar room/lidar.pcap --can room/can.log --out /tmp/scans
check "its scans are those of the host, byte for byte" diff <(scans /tmp/scans) room/scans.sha256
rm -rf /tmp/scans
