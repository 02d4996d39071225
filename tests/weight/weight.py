#!/usr/bin/env python3
"""What the project weighs, beside tests/weight/weight.json: `./dev weight`.

CPU seconds of a build come from build/weight/compile.log, those of the tests from build/weight/tests.log, which measure.py writes.
Since computers differ, both are also given in units of the reference: the median CPU seconds of the compiler for reference.cpp,
compiled several times in the same build. The file holds what the last change that added weight stated, in these units, and on which
processor; --check fails if a sum is more than 5 % above it, or more than the reference itself varied in this build, if that is more.
On another processor, or one that needs another time for the reference, the limit is 20 %: its caches weigh code otherwise. --write
states anew.
"""
import argparse
import json
import re
import statistics
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
STATED = Path(__file__).with_name("weight.json")
GROWTH = 0.05
GROWTH_ELSEWHERE = 0.20
SAME_SPEED = 0.1
LEAST_REFERENCE_S = 1.0
ROOMS = ["math", "plant", "control", "record", "identification", "io", "simulation", "idl", "services", "ground", "analysis", "python", "tests"]
TARGETS = {"first flight": "fly", "all programs": "programs", "quick tests": "quick_tests", "all tests": "tests"}


def log_of(file: Path) -> dict[str, float]:
    """The CPU seconds by name. A unit that the compiler cache had takes next to nothing: its largest value counts."""
    seconds: dict[str, float] = {}
    if file.exists():
        for line in file.read_text(encoding="utf-8").splitlines():
            name, cpu_s = json.loads(line)
            seconds[name] = max(cpu_s, seconds.get(name, 0.0))
    return seconds


def outputs_of(build: Path, target: str) -> set[str]:
    """What is compiled and linked for the target."""
    text = subprocess.run(["ninja", "-C", str(build), "-t", "inputs", target], capture_output=True, text=True, check=True).stdout
    return {line for line in text.splitlines() if not line.startswith("ninja:")}


def lines_of(rooms: list[str]) -> dict[str, int]:
    counts = {}
    for room in rooms:
        listed = subprocess.run(["git", "ls-files", "-z", room], cwd=ROOT, capture_output=True, text=True, check=True).stdout
        files = [name for name in listed.split("\0") if re.search(r"\.(cpp|hpp|c|h|py|js|mjs|idl|css)$", name)]
        counts[room] = sum((ROOT / name).read_bytes().count(b"\n") for name in files if (ROOT / name).exists())
    return counts


def processor() -> str:
    """The model of this computer's processor."""
    file = Path("/proc/cpuinfo")
    found = re.search(r"^model name\s*: (.+)$", file.read_text(encoding="utf-8"), re.MULTILINE) if file.exists() else None
    return found[1] if found else "unknown"


def program_of(test: str) -> str:
    return test.split()[0]


def table(title: str, rows: list[tuple[str, str]]) -> None:
    print(f"\n{title}")
    for name, value in rows:
        print(f"  {name:<58} {value}")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=Path)
    parser.add_argument("--check", action="store_true", help="fail if a sum has grown")
    parser.add_argument("--write", action="store_true", help="write what was measured to weight.json")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options = parser.parse_args()

    compiled = log_of(options.build / "weight" / "compile.log")
    tests = log_of(options.build / "weight" / "tests.log")
    references = [cpu_s for name, cpu_s in compiled.items() if "weight_reference" in name and cpu_s > LEAST_REFERENCE_S]
    if len(references) < 3:  # the compiler cache had them
        print("weight: not measured in this build: ./dev weight --rebuild compiles everything", file=sys.stderr)
        return 0 if options.check else 2
    reference_s = statistics.median(references)
    spread = (max(references) - min(references)) / 2 / reference_s

    sums: dict[str, float] = {}
    unmeasured = 0
    for name, target in TARGETS.items():
        outputs = outputs_of(options.build, target)
        measured = {output for output in outputs if output in compiled}
        unmeasured = max(unmeasured, sum(1 for output in outputs if output.endswith(".o") and output not in compiled))
        sums[f"build: {name}"] = sum(compiled[output] for output in measured)
    programs: dict[str, float] = {}
    for test, cpu_s in tests.items():
        programs[program_of(test)] = programs.get(program_of(test), 0.0) + cpu_s
    sums["tests"] = sum(programs.values())
    lines = lines_of(ROOMS)

    stated = json.loads(STATED.read_text(encoding="utf-8")) if STATED.exists() else {}
    here = stated.get("processor") == processor() and abs(stated["reference_s"] / reference_s - 1) < SAME_SPEED
    growth = GROWTH if here else GROWTH_ELSEWHERE
    limit = 1 + max(growth, spread)
    grown = []
    rows = []
    for name, cpu_s in sums.items():
        references_here = cpu_s / reference_s
        before = stated.get(name)
        mark = ""
        if before and references_here > before * limit:
            grown.append(f"{name}: {references_here:.1f} references, stated are {before:.1f}, limit {before * limit:.1f}")
            mark = "  HAS GROWN"
        rows.append((name, f"{cpu_s:8.1f} s  {references_here:7.1f}  stated {before if before else '-':>7}{mark}"))
    slowest = sorted(((cpu_s, name) for name, cpu_s in compiled.items() if name.endswith(".o")), reverse=True)[:10]

    if options.json:
        print(json.dumps({"reference_s": reference_s, "sums_s": sums, "tests_s": programs, "lines": lines}))
    else:
        print(f"CPU seconds, and in units of the reference: {reference_s:.2f} s, varied by {100 * spread:.1f} %")
        table("sums", rows)
        table("slowest units", [(name, f"{cpu_s:8.1f} s") for cpu_s, name in slowest])
        table("tests by program", [(name, f"{cpu_s:8.1f} s") for name, cpu_s in sorted(programs.items(), key=lambda one: -one[1])])
        table("lines", [(room, f"{count:8d}") for room, count in lines.items()])
        table("lines in all", [("code", f"{sum(lines.values()) - lines['tests']:8d}"), ("tests", f"{lines['tests']:8d}")])
    if unmeasured:
        print(f"weight: {unmeasured} units were not measured: ./dev weight --rebuild", file=sys.stderr)
    if options.write:
        weights = {name: round(cpu_s / reference_s, 1) for name, cpu_s in sums.items()}
        STATED.write_text(json.dumps({"processor": processor(), "reference_s": round(reference_s, 2), **weights}, indent=2) + "\n")
    if options.check and not stated:
        print("weight: nothing is stated yet: ./dev weight --write", file=sys.stderr)
    if options.check and grown:
        print("\nweight: " + "\nweight: ".join(grown), file=sys.stderr)
        print("weight: make it lighter, or state the new weight with ./dev weight --write and say in the commit what it buys", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
