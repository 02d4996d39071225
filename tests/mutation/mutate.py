#!/usr/bin/env python3
"""Puts one-line mistakes into rooms, one at a time, and says which of them no unit test notices.

usage: ./dev mutate [ROOM...] [--sample N] [--seed S] [--redundant]

A room is one of swiftlet_add_room_test() in tests/unit/CMakeLists.txt. Works in a copy of the tree in build/mutation, and keeps what it has
found there: what was interrupted goes on, and mutants of files that have not changed are not judged again while their tests have
not changed either. A mutant is first shown to the tests of its room, then to those of the others. An endless loop is noticed by CTest's limit.
tests/mutation/equivalent.txt lists mutants that change nothing that can be observed, with the reason; they do not count.
"""

import argparse
import collections
import hashlib
import json
import pathlib
import random
import re
import shutil
import subprocess
import sys
import time

from mutants import Mutant, mutants_of

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "tests/unit"))
from rooms import room_of, rooms  # pylint: disable=wrong-import-position

HOME = ROOT / "build/mutation"
TREE = HOME / "tree"
BUILD = TREE / "build"
RESULTS = HOME / "results.jsonl"
EQUIVALENT = pathlib.Path(__file__).parent / "equivalent.txt"
ROOMS = list(rooms())
FAILED = re.compile(r"^\[  FAILED  \] ([\w/]+\.[\w/]+)", re.MULTILINE)


def tracked_files():
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, capture_output=True,
                            check=True)
    return {pathlib.Path(name): None for name in listed.stdout.decode().split("\0") if name and (ROOT / name).is_file()}


def copy_tree(files):
    """Touches only what differs, so that the copy is built incrementally."""
    for copy in TREE.rglob("*"):
        if copy.is_file() and BUILD not in copy.parents and copy.relative_to(TREE) not in files:
            copy.unlink()
    for file in files:
        copy = TREE / file
        if not copy.exists() or copy.read_bytes() != (ROOT / file).read_bytes():
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / file, copy)


def digest(*texts):
    return hashlib.sha256("\0".join(texts).encode()).hexdigest()[:16]


def digest_below(files, *folders):
    return digest(*[(ROOT / file).read_text(errors="replace") for file in files if str(file).startswith(folders)])


def tests_that_fail(tested):
    """Builds the unit tests of these rooms and runs them. Returns the names of those that fail; None: it does not compile."""
    built = subprocess.run(["ninja", "-C", BUILD, *[f"{room}_test" for room in tested]], capture_output=True, check=False)
    if built.returncode != 0:
        return None
    labels = "^room_(" + "|".join(tested) + ")$"
    ran = subprocess.run(["ctest", "--test-dir", BUILD, "-L", labels, "-L", "^unit$", "-LE", "wall_clock", "--parallel", "4",
                          "--output-on-failure"], capture_output=True, text=True, errors="replace", check=False)
    if ran.returncode == 0:
        return []
    return sorted(set(FAILED.findall(ran.stdout))) or ["(crashed or never ended)"]


def judge(mutant, room):
    """Returns the state of a mutant, and the tests that noticed it."""
    file = TREE / mutant.file
    original = file.read_text(encoding="utf-8")
    lines = original.splitlines()
    lines[mutant.line - 1] = mutant.after
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    try:
        noticed = tests_that_fail([room])
        if noticed == []:
            noticed = tests_that_fail([other for other in ROOMS if other != room])
        if noticed is None:
            return "invalid", []
        return ("noticed" if noticed else "survived"), noticed
    finally:
        file.write_text(original, encoding="utf-8")


def equivalent_mutants():
    """Those of the list: the file, the line before and the line after, with single blanks between words."""
    listed = set()
    for line in EQUIVALENT.read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            file, before, after, _reason = line.split("\t")
            listed.add((file, before, after))
    return listed


class Results:
    """What was found, by the digest of mutant, file and tests."""

    def __init__(self):
        self.known = {}
        if RESULTS.exists():
            for line in RESULTS.read_text(encoding="utf-8").splitlines():
                entry = json.loads(line)
                self.known[entry["key"]] = entry

    def add(self, entry):
        self.known[entry["key"]] = entry
        with RESULTS.open("a", encoding="utf-8") as out:
            out.write(json.dumps(entry) + "\n")


def sample_of(room, files, arguments):
    """All mutants of a room in the order in which they are drawn."""
    mutants = []
    for file in files:
        if file.suffix in (".cpp", ".hpp") and file.parts[0] != "tests" and room_of(file) == room:
            mutants += mutants_of(str(file), (ROOT / file).read_text(encoding="utf-8"))
    random.Random(f"{arguments.seed} {room}").shuffle(mutants)
    return mutants


def score(room, files, results, arguments):
    """Judges the sample of a room. Returns its results."""
    tests = digest_below(files, "tests/unit/" + room.split("_", maxsplit=1)[0] + "/", "tests/support/")
    all_tests = digest_below(files, "tests/unit/", "tests/support/")
    listed = equivalent_mutants()
    judged = []
    for mutant in sample_of(room, files, arguments):
        if len(judged) == arguments.sample:
            break
        if (mutant.file, " ".join(mutant.before.split()), " ".join(mutant.after.split())) in listed:
            continue
        key = digest(str(mutant), (ROOT / mutant.file).read_text(encoding="utf-8"), tests)
        known = results.known.get(key)
        if not known or (known["state"] == "survived" and known["all_tests"] != all_tests):
            began = time.monotonic()
            state, by = judge(mutant, room)
            results.add({"key": key, "room": room, "file": mutant.file, "line": mutant.line, "kind": mutant.kind,
                         "before": mutant.before, "after": mutant.after, "state": state, "by": by, "all_tests": all_tests,
                         "seconds": round(time.monotonic() - began, 1)})
        entry = results.known[key]
        if entry["state"] != "invalid":
            judged.append(entry)
            if entry["state"] == "survived":
                print(Mutant(entry["file"], entry["line"], entry["kind"], entry["before"], entry["after"]), flush=True)
    return judged


def print_redundant(entries):
    """For each test what it alone has noticed."""
    alone = collections.Counter()
    noticed = collections.Counter()
    for entry in entries:
        noticed.update(entry["by"])
        if len(entry["by"]) == 1:
            alone.update(entry["by"])
    print(f"\n{'noticed':>8} {'alone':>8}  test")
    for test, count in sorted(noticed.items(), key=lambda item: (alone[item[0]], item[1])):
        print(f"{count:8} {alone[test]:8}  {test}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("rooms", nargs="*", metavar="ROOM", help="default: all of " + ", ".join(ROOMS))
    parser.add_argument("--sample", type=int, default=150, metavar="N", help="mutants of each room (default: 150)")
    parser.add_argument("--seed", default="1", metavar="S", help="of the sample (default: 1)")
    parser.add_argument("--redundant", action="store_true", help="also print, for each test, what it alone has noticed")
    arguments = parser.parse_args()
    rooms = arguments.rooms or ROOMS
    if unknown := [room for room in rooms if room not in ROOMS]:
        parser.error(f"there is no room {unknown[0]!r}: " + ", ".join(ROOMS))
    files = tracked_files()
    copy_tree(files)
    print("building the unit tests as they are", file=sys.stderr, flush=True)
    subprocess.run([TREE / "dev", "build", *[f"{room}_test" for room in rooms]], check=True)
    if broken := tests_that_fail(rooms):
        sys.exit("dev mutate: these fail without a mistake: " + ", ".join(broken))
    results = Results()
    entries, table = [], []
    for room in rooms:
        judged = score(room, files, results, arguments)
        noticed = sum(entry["state"] == "noticed" for entry in judged)
        table.append(f"{room:20} {noticed:5} of {len(judged):4}  {100.0 * noticed / max(len(judged), 1):5.1f} %")
        entries += judged
    print("\nnoticed by unit tests:\n" + "\n".join(table))
    if arguments.redundant:
        print_redundant(entries)


if __name__ == "__main__":
    main()
