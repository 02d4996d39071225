#!/usr/bin/env python3
"""Measures what a record costs a flight in real time: `./dev bench record-cost`.

usage: record_cost.py BIN [--flights N]

Flies a mission with the same plant, motion capture and control, in turn without and with a recorder of every message beside it, and prints
the late steps of the controller in each flight. `swiftlet fly` records with the same code, in its own process.
"""
import argparse
import json
import pathlib
import signal
import subprocess
import sys
import tempfile

MISSION = """name: laps
frame: ned
tolerance_m: 0.3
items:
  - {kind: takeoff, height_m: 1, speed_m_s: 0.5}
  - {kind: waypoint, position_m: [1, 0, -1], speed_m_s: 1}
  - {kind: waypoint, position_m: [1, 1, -1], speed_m_s: 1}
  - {kind: waypoint, position_m: [0, 0, -1], speed_m_s: 1}
  - {kind: land, speed_m_s: 0.5}
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("bin", type=pathlib.Path, help="the folder of the programs")
    parser.add_argument("--flights", type=int, default=5, help="of each kind")
    parser.add_argument("--domain", type=int, default=97)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        measure(options, pathlib.Path(folder))


def measure(options, folder):
    mission = folder / "laps.yaml"
    mission.write_text(MISSION, encoding="utf-8")
    domain = ["--domain", str(options.domain)]
    processes = [subprocess.Popen([options.bin / f"swiftlet-{name}", *domain], stderr=subprocess.DEVNULL)
                 for name in ("plant", "mocap", "control")]
    try:
        late = {"without": [], "with": []}
        for number in range(options.flights):
            for kind in late:
                recorder = None
                if kind == "with":
                    recorder = subprocess.Popen([options.bin / "swiftlet", "record", "-o", folder / f"{number}.mcap", *domain],
                                                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                swiftlet(options, "arm", *domain)
                swiftlet(options, "mission", "upload", mission, *domain)
                swiftlet(options, "mission", "start", *domain)
                flown = counts(options, domain)
                if recorder is not None:
                    recorder.send_signal(signal.SIGINT)
                    recorder.wait()
                late[kind].append(flown)
        print("late by more than half a period, of all steps")
        for kind, flights in late.items():
            sums = [sum(values) for values in zip(*flights)]
            print(f"  {kind + ' record':15} {sums[0]:5d} of {sums[1]:7d}, {100 * sums[0] / sums[1]:.3f} %   by flight: "
                  + " ".join(str(one[0]) for one in flights))
    finally:
        for process in processes:
            process.terminate()
        for process in processes:
            process.wait()


def swiftlet(options, *words):
    return subprocess.run([options.bin / "swiftlet", *words], check=True, capture_output=True, text=True, timeout=120).stdout


def counts(options, domain):
    """Late steps and steps of the controller since it was armed."""
    status = json.loads(swiftlet(options, "status", "--json", *domain))
    return status["control"]["deadline_misses"], status["control"]["cycles"]


if __name__ == "__main__":
    sys.exit(main())
