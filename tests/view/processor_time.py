#!/usr/bin/env python3
"""Measures the processor time of `swiftlet view` beside 8 hovering vehicles, with no viewer, one viewer and eight.

usage: processor_time.py BIN WORK [--seconds S]

BIN holds the programs, WORK is a folder for files. Fails above the limit.
"""
import argparse
import contextlib
import json
import os
import pathlib
import time

from run import Vehicles, install, require, run

VEHICLES = 8
LIMIT = 0.15  # of a core, with eight viewers


def processor_time_s(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def share(vehicles, viewers, seconds, work):
    """Of a core, and what the viewers received."""
    before, started = processor_time_s(vehicles.server.pid), time.monotonic()
    seen = {}
    if viewers:
        seen = json.loads(run("node", work / "viewers.mjs", vehicles.url, viewers, seconds, cwd=work))
    else:
        time.sleep(seconds)
    used = processor_time_s(vehicles.server.pid) - before
    return used / (time.monotonic() - started), seen


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("work", type=pathlib.Path)
    parser.add_argument("--seconds", type=int, default=10)
    options = parser.parse_args()
    programs, work = options.programs.resolve(), options.work.resolve()
    install(work)
    shares = {}
    with contextlib.ExitStack() as stack:
        vehicles = Vehicles(programs, work, f"kl1..kl{VEHICLES}", stack)
        vehicles.take_off()
        for viewers in (0, 1, 8):
            shares[viewers], seen = share(vehicles, viewers, options.seconds, work)
            got = f": {seen['estimates_hz']:.0f} Hz of each vehicle, {seen['messages_hz']:.0f} messages a second to each" if seen else ""
            print(f"view: {VEHICLES} vehicles, {viewers} viewers: {100 * shares[viewers]:.1f} % of a core{got}", flush=True)
        vehicles.ask("land")
    require(shares[8] < LIMIT, f"more than {100 * LIMIT:.0f} % of a core with eight viewers")


if __name__ == "__main__":
    main()
