#!/usr/bin/env python3
"""Draws docs/view.png: the live page of a fleet in flight, in headless Chromium.

usage: picture.py BIN WORK OUT.png

BIN holds the programs, WORK is a folder for files.
"""
import pathlib
import re
import subprocess
import sys

from run import install, require, run


def main(programs, work, picture):
    install(work)
    flight = subprocess.Popen([programs / "swiftlet", "fleet", "fly", "swap6", "--view", "--record", work / "swap6", "--replace"], text=True,
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    try:
        url = next((found[0] for line in flight.stderr if (found := re.search(r"http://127\.0\.0\.1:\d+/", line))), None)
        require(url, "the flight prints no URL")
        run("node", work / "picture.mjs", url, picture, cwd=work)
    finally:
        flight.terminate()
        flight.communicate()


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*(pathlib.Path(argument).resolve() for argument in sys.argv[1:]))
