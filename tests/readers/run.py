#!/usr/bin/env python3
"""Reads recorded flights with the readers of others, and files of others with `swiftlet log`.

usage: run.py BIN WORK

BIN holds the programs, WORK is a folder for files; the readers' packages (package-lock.json) are installed into it with npm.
"""
import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
NUMPY_PYTHON = "/usr/bin/python3"  # with Debian's python3-numpy
LAYOUT = HERE.parent.parent / "config" / "foxglove" / "flight.json"
MISSION = HERE.parent.parent / "config" / "missions" / "square.yaml"


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], text=True, capture_output=True, check=False, **options)
    if done.returncode != 0:
        sys.exit(f"readers: {' '.join(map(str, command))}: exit code {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def require(holds, what):
    if not holds:
        sys.exit(f"readers: {what}")


class Readers:
    def __init__(self, programs, work):
        self.swiftlet = programs / "swiftlet"
        self.work = work
        for file in HERE.glob("*.*js*"):
            shutil.copy(file, work)
        run("npm", "ci", "--omit=dev", "--no-audit", "--no-fund", "--ignore-scripts", cwd=work)

    def node(self, script, *arguments):
        return run("node", self.work / script, *arguments, cwd=self.work)

    def fly_and_record(self, file, domain):
        """A flight in real time with a recorder beside it."""
        recorder = subprocess.Popen([self.swiftlet, "record", "--domain", str(domain), "--localhost-only", "-o", file, "--json"],
                                    text=True, stdout=subprocess.PIPE)
        run(self.swiftlet, "fly", MISSION, "--domain", domain, "--record", self.work / "record", "--replace", cwd=self.work)
        recorder.terminate()
        result = json.loads(recorder.communicate()[0])
        require(recorder.returncode == 0, f"the recorder ended with exit code {recorder.returncode}")
        return result

    def check(self, file):
        """What the readers of others find in the file is what `swiftlet log` finds."""
        info = json.loads(run(self.swiftlet, "log", "info", file, "--check", "--json"))
        read = json.loads(self.node("read.mjs", file))
        require(not read["faults"], f"{file}: {read['faults']}")
        counts = {row["topic"]: (row["type"], row["messages"]) for row in info["topics"] if row["messages"]}
        require(counts == {topic: (row["type"], row["messages"]) for topic, row in read["topics"].items()},
                f"{file}: the counts differ")
        require(info["metadata"] == read["metadata"], f"{file}: the metadata differ")
        for topic, row in read["topics"].items():
            self.check_last(file, topic, row["last"])
        print(f"readers: {file.name}: {read['messages']} messages of {len(counts)} topics decoded by @mcap/core and "
              f"@foxglove/rosmsg2-serialization, as by swiftlet log")
        return read

    def check_layout(self, layout, read):
        """Each topic and signal that the layout shows is in the flight."""
        panels = json.loads(layout.read_text())["configById"]
        shown = [path["value"] for panel in panels.values() for path in panel.get("paths", [])]
        for signal in shown:
            topic, _, name = signal.partition(".")
            require(topic in read["topics"] and name in dict(flat("", read["topics"][topic]["last"])),
                    f"{layout.name}: {signal} is not in the flight")
        topics = [topic for panel in panels.values() for topic in panel.get("topics", {})]
        for topic in topics:
            require(topic in read["topics"], f"{layout.name}: {topic} is not in the flight")
        print(f"readers: {layout.name}: {len(shown)} signals and {len(topics)} topics are in the flight")

    def check_last(self, file, topic, message):
        """The last message of a topic has the values of the last row of its CSV table."""
        table = self.work / "topic.csv"
        run(self.swiftlet, "log", "csv", file, topic, "-o", table, "--replace")
        with table.open(newline="") as rows:
            *_, last = csv.DictReader(rows)
        signals = {name: text for name, text in last.items() if name not in ("log_time_ns", "publish_time_ns")}
        found = dict(flat("", message))
        require(signals.keys() == found.keys(), f"{topic}: the signals differ: {signals.keys() ^ found.keys()}")
        for name, text in signals.items():
            value = found[name]
            same = text == value if isinstance(value, str) else float(text) == float(value or 0)
            require(same or value is None, f"{topic}: {name}: {text}, others read {value}")  # JSON has no NaN


def check_arrays(swiftlet, file, work):
    """NumPy reads the arrays, with the values of the CSV table."""
    arrays, table = work / "flight.npz", work / "topic.csv"
    run(swiftlet, "log", "npz", file, "-o", arrays, "--replace")
    run(swiftlet, "log", "csv", file, "/kl1/estimate", "-o", table, "--replace")
    with table.open(newline="") as text:
        rows = list(csv.DictReader(text))
    print(run(NUMPY_PYTHON, "-c", """
import json, sys, numpy
arrays = numpy.load(sys.argv[1])
rows = json.load(sys.stdin)
position = arrays["kl1/estimate/position_ned"]
assert position.dtype == numpy.float64 and position.shape == (len(rows), 3), position.shape
assert (position == [[float(row[f"position_ned[{i}]"]) for i in range(3)] for row in rows]).all()
assert arrays["kl1/estimate/log_time_ns"].tolist() == [int(row["log_time_ns"]) for row in rows]
assert arrays["kl1/vehicle_info/name"][0] == b"kaylion"
print("readers: flight.npz:", len(arrays.files), "arrays read by numpy", numpy.__version__)
""", arrays, input=json.dumps(rows)), end="")


def flat(prefix, value):
    """The signals of a message, named as in the CSV table: of a sequence only its length."""
    if isinstance(value, dict):
        for name, item in value.items():
            yield from flat(f"{prefix}.{name}" if prefix else name, item)
    elif isinstance(value, list) and prefix.split(".")[-1] in SEQUENCES:
        yield f"{prefix}.length", len(value)
    elif isinstance(value, list):
        for i, item in enumerate(value):
            yield from flat(f"{prefix}[{i}]", item)
    else:
        yield prefix, value


SEQUENCES = {"items", "segments", "requests", "fixed_settings", "transforms", "poses", "cell_voltage", "cell_temperature"}


def main(programs, work):
    work.mkdir(parents=True, exist_ok=True)
    readers = Readers(programs, work)
    domain = 20 + os.getpid() % 80
    file = work / "flight.mcap"
    file.unlink(missing_ok=True)
    result = readers.fly_and_record(file, domain)
    require(result["dropped"] == 0, f"the recorder dropped {result['dropped']} messages")
    readers.check_layout(LAYOUT, readers.check(file))
    check_arrays(readers.swiftlet, file, work)
    packed = work / "lz4.mcap"
    run(readers.swiftlet, "log", "cut", file, "--to", 5, "-o", packed, "--replace", "--compression", "lz4")
    readers.check(packed)
    foreign = work / "foreign.mcap"
    readers.node("write.mjs", foreign)
    info = json.loads(run(readers.swiftlet, "log", "info", foreign, "--check", "--json"))
    require(info["messages"] == 100 and info["metadata"] == {"who": {"name": "others"}}, f"the file of others: {info}")
    run(readers.swiftlet, "log", "csv", foreign, "/point", "-o", work / "foreign.csv", "--replace")
    rows = list(csv.DictReader((work / "foreign.csv").open(newline="")))
    require([float(row["x"]) for row in rows] == [0.5 * i for i in range(100)], "the values in the file of others")
    print("readers: a file written by @mcap/core is read")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve())
