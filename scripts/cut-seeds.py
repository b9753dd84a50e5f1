#!/usr/bin/env python3
"""Cuts fuzzing seeds for one target out of the real recordings, which are not part of the repository.

scripts/cut-seeds.py TARGET DIRECTORY: writes the seeds; exit status 1 when there is nothing to cut.
CONVEXCUT_RECORDINGS names the recordings' folder when it is not beside the checkout.
"""
import os
import pathlib
import struct
import sys

HERE = pathlib.Path(__file__).resolve().parent.parent
RECORDINGS = pathlib.Path(os.environ.get("CONVEXCUT_RECORDINGS", HERE.parent / "shared/data"))
NETWORK_HEADERS = 42  # Ethernet, IPv4, UDP


def datagrams(name):
    """UDP payloads of a little-endian microsecond pcap over plain Ethernet."""
    data = (RECORDINGS / name).read_bytes()
    at = 24
    while at + 16 <= len(data):
        length = struct.unpack_from("<I", data, at + 8)[0]
        yield data[at + 16 + NETWORK_HEADERS : at + 16 + length]
        at += 16 + length


def lidar(size, count):
    for name in ("lidar/hdl32e_courtyard_2011.pcap", "lidar/vlp16_gps_2016.pcap"):
        of_size = [d for d in datagrams(name) if len(d) == size]
        yield from of_size[:: max(1, len(of_size) // count)][:count]


def xbus(count):
    for i in (1, 2, 3):
        data = (RECORDINGS / f"imu/mti_g710_{i}.bin").read_bytes()
        at = 0
        for _ in range(count):
            end = at + data[at + 3] + 5
            yield data[at:end]
            at = end


def captures():
    for name in ("lidar/hdl32e_courtyard_2011.pcap", "lidar/vlp16_gps_2016.pcap"):
        yield (RECORDINGS / name).read_bytes()[:4000]


def seeds(target):
    if "position" in target:
        return lidar(512, 8)
    if "velodyne" in target:
        return lidar(1206, 8)
    if "xbus" in target or "mtdata2" in target:
        return xbus(12)
    if "capture" in target:
        return captures()
    return iter(())


def main():
    target, directory = sys.argv[1], pathlib.Path(sys.argv[2])
    if not RECORDINGS.is_dir():
        return 1
    cut = list(seeds(target))
    if not cut:
        return 1
    directory.mkdir(parents=True, exist_ok=True)
    for i, seed in enumerate(cut):
        (directory / f"real-{i:02d}").write_bytes(seed)
    return 0


if __name__ == "__main__":
    sys.exit(main())
