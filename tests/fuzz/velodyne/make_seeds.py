#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the seeds of the two fuzz targets: small valid packets, built from the manuals.

Usage: make_seeds.py tests/fuzz/seeds
"""

import struct
import sys
from pathlib import Path


def data_packet(mode, product, step, repeat=1, first=35950):
    packet = b""
    for block in range(12):
        azimuth = (first + step * (block // repeat)) % 36000
        packet += b"\xff\xee" + struct.pack("<H", azimuth)
        for slot in range(32):
            distance = 0 if slot % 5 == 4 else 1000 + 500 * slot + 300 * (block % repeat)
            packet += struct.pack("<HB", distance, 3 * slot)
    return packet + struct.pack("<IBB", 835374683, mode, product)


def position_packet(sentence, pps, motion=(0,) * 12):
    packet = bytearray(512)
    struct.pack_into("<12H", packet, 14, *motion)
    struct.pack_into("<IB", packet, 198, 1082725066, pps)
    packet[206 : 206 + len(sentence)] = sentence
    return bytes(packet)


def main():
    root = Path(sys.argv[1])
    examples = (0x0FDE, 0x1055, 0x231B, 0x3009) * 3
    rmc = b"$GPRMC,081802.00,A,3649.7478558,N,00224.4542928,W,0.034,212.5,210116,0.0,E,A*2E\r\n"
    gga = b"$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n"
    seeds = {
        "fuzz_velodyne_data/hdl32e_single": data_packet(0x37, 0x21, 16),
        "fuzz_velodyne_data/hdl32e_dual": data_packet(0x39, 0x21, 16, repeat=2),
        "fuzz_velodyne_data/old_firmware_dual": data_packet(0, 0, 16, repeat=2),
        "fuzz_velodyne_data/vlp16_stopped": data_packet(0x38, 0x22, 0, first=36000),
        "fuzz_velodyne_position/hdl32e_motion": position_packet(b"", 0, examples),
        "fuzz_velodyne_position/vlp16_rmc": position_packet(rmc, 2),
        "fuzz_velodyne_position/gga": position_packet(gga, 1),
        "fuzz_velodyne_position/rmc_body": rmc[1:-5],
    }
    for name, content in seeds.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)


if __name__ == "__main__":
    main()
