#!/usr/bin/env python3
"""Which program tests a source file: the rooms of swiftlet_add_room_test() in CMakeLists.txt.

usage: rooms.py FILE
Prints the room of a file of the tree; fails if it has no unit tests.
"""

import pathlib
import re
import sys

ADDED = re.compile(r"^swiftlet_add_room_test\((\w+)(.*?)\)$", re.MULTILINE | re.DOTALL)
FOLDERS = re.compile(r"^\s*FOLDERS ([\w/ ]+)$", re.MULTILINE)


def rooms():
    """The folders that each room tests, in the order of the file; without FOLDERS it is the room."""
    text = (pathlib.Path(__file__).parent / "CMakeLists.txt").read_text(encoding="utf-8")
    found = {}
    for room, arguments in ADDED.findall(text):
        folders = FOLDERS.search(arguments)
        found[room] = folders.group(1).split() if folders else [room]
    return found


def room_of(file):
    """The room with the longest folder in which the file is; None: without unit tests."""
    matches = [(folder, room) for room, folders in rooms().items() for folder in folders if f"{file}".startswith(folder + "/")]
    return max(matches, key=lambda match: len(match[0]))[1] if matches else None


if __name__ == "__main__":
    if room := room_of(sys.argv[1]):
        print(room)
    else:
        sys.exit(1)
