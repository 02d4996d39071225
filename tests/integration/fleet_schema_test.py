#!/usr/bin/env python3
"""config/fleets/fleet.schema.json, used by editors, agrees with the reader of fleet files.

usage: fleet_schema_test.py SWIFTLET SOURCE_FOLDER
Both accept every example and refuse what the other refuses. The reader is that of `swiftlet fleet check`: its exit status is 2
for a file that is refused, and 0 or 1 for one that is read.
"""

import pathlib
import subprocess
import sys

from schema_comparison import disagreements, report

HEAD = "frame: ned\nsafety: {radius_xy_m: 0.4, radius_z_m: 0.6}\n"
ONE = "vehicles:\n  - {name: a, start_m: [0, 0], mission: square}\n"

VALID = {
    "all keys": "name: n\ndescription: d\nvehicle: kaylion\ncontrol: motor_lag\nsimulation: default\n" + HEAD +
                "vehicles:\n  - {name: a, vehicle: crazyflie2, start_m: [0, 1], mission: square, origin: start, priority: 100}\n",
    "east, north, up": HEAD.replace("ned", "enu") + ONE,
    "in the common frame": HEAD + "vehicles: [{name: a_1, start_m: [0, 0], mission: square, origin: common}]\n",
}
INVALID = {
    "no frame": HEAD.replace("frame: ned\n", "") + ONE,
    "another frame": HEAD.replace("ned", "nwu") + ONE,
    "no safety": "frame: ned\n" + ONE,
    "no radius": "frame: ned\nsafety: {radius_xy_m: 1}\n" + ONE,
    "a radius of 0": "frame: ned\nsafety: {radius_xy_m: 1, radius_z_m: 0}\n" + ONE,
    "no vehicles": HEAD,
    "no vehicle": HEAD + "vehicles: []\n",
    "51 vehicles": HEAD + "vehicles:\n" + "".join(
        f"  - {{name: a{i}, start_m: [0, 0], mission: square}}\n" for i in range(51)),
    "no name": HEAD + "vehicles: [{start_m: [0, 0], mission: square}]\n",
    "a name that begins with a digit": HEAD + ONE.replace("name: a", "name: 1a"),
    "no place": HEAD + "vehicles: [{name: a, mission: square}]\n",
    "three numbers": HEAD + ONE.replace("[0, 0]", "[0, 0, 0]"),
    "a far place": HEAD + ONE.replace("[0, 0]", "[0, 1001]"),
    "no mission": HEAD + "vehicles: [{name: a, start_m: [0, 0]}]\n",
    "another origin": HEAD + ONE.replace("square", "square, origin: here"),
    "a priority of 0": HEAD + ONE.replace("square", "square, priority: 0"),
    "a high priority": HEAD + ONE.replace("square", "square, priority: 101"),
    "half a priority": HEAD + ONE.replace("square", "square, priority: 1.5"),
    "unknown key": HEAD + "speed: 1\n" + ONE,
    "unknown key of a vehicle": HEAD + ONE.replace("square", "square, speed: 1"),
    "a long name": "name: " + 65 * "n" + "\n" + HEAD + ONE,
}


def main():
    swiftlet, source = sys.argv[1], pathlib.Path(sys.argv[2])

    def reader_fault(path):
        result = subprocess.run([swiftlet, "fleet", "check", path], capture_output=True, text=True, check=False)
        return result.stderr if result.returncode not in (0, 1) else ""

    return report(disagreements(source / "config/fleets/fleet.schema.json", reader_fault, VALID, INVALID))


if __name__ == "__main__":
    sys.exit(main())
