#!/usr/bin/env python3
"""config/rooms/room.schema.json, used by editors, agrees with the reader of room files.

usage: room_schema_test.py SWIFTLET SOURCE_FOLDER
Both accept every example and refuse what the other refuses. The reader is asked by `swiftlet mocap list` with a source that
is not there, so that a file that is read leads to another error than one that is not.
"""

import pathlib
import subprocess
import sys

from schema_comparison import disagreements, report

HEAD = "source: natnet\nframe: zup\n"
VEHICLES = "vehicles: {kl1: {body: a}}\n"

VALID = {
    "all keys": HEAD + "description: d\nserver: lab\ninterface: eth0\norigin_m: [0, 1, 2]\nnorth_rad: -3\nlatency_s: 0.5\n"
                "vehicles: {kl1: {body: a, id: 3, lever_arm_frd_m: [0, 0, 1], misalignment_rad: [0, 0, 3]}, kl2: {id: 0}}\n",
    "y up": "source: natnet\nframe: yup\n" + VEHICLES,
    "vrpn": "source: vrpn\nserver: lab:3883\nframe: zup\n" + VEHICLES,
    "vicon": "source: vicon\nframe: zup\n" + VEHICLES,
    "replay": "source: replay\nfile: f.pcap\nframe: zup\n" + VEHICLES,
}
INVALID = {
    "no source": "frame: zup\n" + VEHICLES,
    "another source": "source: qualisys\nframe: zup\n" + VEHICLES,
    "no frame": "source: natnet\n" + VEHICLES,
    "another frame": "source: natnet\nframe: ned\n" + VEHICLES,
    "no vehicles": HEAD,
    "no vehicle": HEAD + "vehicles: {}\n",
    "neither name nor number": HEAD + "vehicles: {kl1: {}}\n",
    "a negative number": HEAD + "vehicles: {kl1: {id: -1}}\n",
    "a long lever arm": HEAD + "vehicles: {kl1: {id: 1, lever_arm_frd_m: [0, 0, 2]}}\n",
    "two numbers": HEAD + "vehicles: {kl1: {id: 1, lever_arm_frd_m: [0, 0]}}\n",
    "an angle in degrees": HEAD + "north_rad: 90\n" + VEHICLES,
    "a long latency": HEAD + "latency_s: 5\n" + VEHICLES,
    "a far origin": HEAD + "origin_m: [0, 0, 5000]\n" + VEHICLES,
    "unknown key": HEAD + "north: 1\n" + VEHICLES,
    "unknown key of a vehicle": HEAD + "vehicles: {kl1: {id: 1, offset: 1}}\n",
    "vrpn without a server": "source: vrpn\nframe: zup\n" + VEHICLES,
    "replay without a file": "source: replay\nframe: zup\n" + VEHICLES,
    "a file without replay": HEAD + "file: f.pcap\n" + VEHICLES,
}


def main():
    swiftlet, source = sys.argv[1], pathlib.Path(sys.argv[2])

    def reader_fault(path):
        # The option is refused after the file has been read.
        result = subprocess.run([swiftlet, "mocap", "list", "--room", path, "--source", "vicon", "--mocap-interface",
                                 "none0"], capture_output=True, text=True, check=False)
        return "" if "interface: is 'none0'" in result.stderr else result.stderr

    return report(disagreements(source / "config/rooms/room.schema.json", reader_fault, VALID, INVALID))


if __name__ == "__main__":
    sys.exit(main())
