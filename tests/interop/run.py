#!/usr/bin/env python3
"""Lets programs of another DDS vendor, in C with Eclipse Cyclone DDS, fly and hear vehicles of the project's own processes.

usage: run.py BIN WORK

BIN holds the programs. WORK is a folder for the build of the C programs and for logs.
"""
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import time

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(ROOT / "tests" / "docs"))
sys.path.insert(0, str(ROOT / "docs" / "site"))
from manual_text import fences  # noqa: E402
from run_commands import lock_domain  # noqa: E402
from type_hashes import published  # noqa: E402

PATIENCE_S = 60
DEBIAN_PYTHON = "/usr/bin/python3"  # with Debian's python3-rosidl
PAGE = ROOT / "docs" / "interoperability.md"
HEARD_IN_FLIGHT = {
    "imu", "actuator_command", "controller_state", "mocap_pose", "rotor_speeds", "battery", "estimate", "reference", "ground_truth",
    "control_status", "mission_status", "vehicle_info", "flown_mission", "flown_trajectory", "flown_files", "command_ack"}
SENT_IN_FLIGHT = {"command", "mission", "trajectory", "setpoint", "simulation_clock", "ground_link"}
# By vehicle: the level at which it is commanded, and the topics that such a vehicle adds.
LEVELS = {"kl1": ("rates", {"rates_setpoint", "clock_request", "clock_reply", "clock_status", "control_settings"}),
          "kl2": ("attitude", {"attitude_setpoint"}),
          "kl3": ("trajectory", {"trajectory_setpoint"}),
          "kl4": ("attitude", {"vehicle_odometry"})}


class Processes:
    """Processes that end with this object."""

    def __init__(self, programs, work):
        self.programs, self.work, self.running = programs, work, []
        self.domain, self.lock = lock_domain()

    def start(self, name, *words, log=None):
        path = self.work / f"{log or name}.log"
        self.running.append(subprocess.Popen(
            [self.programs / name, *map(str, words), "--domain", str(self.domain), "--localhost-only"], cwd=self.work,
            stdout=path.open("w"), stderr=subprocess.STDOUT))
        return self.running[-1]

    def run(self, name, *words):
        done = subprocess.run([self.programs / name, *words, "--domain", str(self.domain), "--localhost-only"], cwd=self.work,
                              capture_output=True, text=True, timeout=PATIENCE_S, check=False)
        if done.returncode != 0:
            sys.exit(f"interop: {name} {' '.join(words)}: exit code {done.returncode}: {done.stderr}")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in self.running:
            process.send_signal(signal.SIGTERM)
        for process in self.running:
            process.wait(PATIENCE_S)
        os.close(self.lock)


class Interop:
    def __init__(self, programs, work):
        self.programs, self.work = programs, work
        work.mkdir(parents=True, exist_ok=True)
        os.environ["SWIFTLET_CONFIG_DIR"] = str(ROOT / "config")
        (os.environ["CYCLONEDDS_URI"],) = (fence.text for fence in fences(PAGE.read_text(), PAGE) if fence.words == "file: cyclonedds.xml")
        self.build = work / "cyclonedds"
        for command in (["cmake", "-S", HERE, "-B", self.build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release"],
                        ["cmake", "--build", self.build]):
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            if done.returncode != 0:
                sys.exit(f"interop: {done.stdout}{done.stderr}")

    def peer(self, program, domain, *words):
        return subprocess.Popen([self.build / program, str(domain), *map(str, words)], text=True, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT)

    def finish(self, peer, what):
        output = peer.communicate(timeout=2 * PATIENCE_S)[0]
        if peer.returncode != 0:
            logs = "".join(f"--- {log.name}\n{log.read_text()[-2000:]}" for log in sorted(self.work.glob("*.log")))
            sys.exit(f"interop: {what}: exit code {peer.returncode}\n{output}{logs}")
        return output

    def fly(self):
        """The flight of fly.c, in lockstep. Returns the topics that were decoded."""
        started = time.monotonic()
        with Processes(self.programs, self.work) as processes:
            processes.start("swiftlet-plant", "--clock", "lockstep", "--paused")
            processes.start("swiftlet-mocap", "--clock", "lockstep")
            processes.start("swiftlet-control", "--clock", "lockstep")
            # Sent once, before: a volatile reader does not hear it.
            everything = sorted((HEARD_IN_FLIGHT | SENT_IN_FLIGHT) - {"flown_files"})
            listener = self.peer("listen", processes.domain, "kl1", PATIENCE_S, *everything)
            output = self.finish(self.peer("fly", processes.domain, "kl1", PATIENCE_S), "the flight")
            self.finish(listener, "listening with the QoS of sensor data")
            print(f"interop: {len(everything)} topics heard with the QoS of sensor data")
        print("".join(f"interop: {line}\n" for line in output.splitlines()), end="")
        heard = set(re.findall(r"^decoded (\w+) \d+$", output, re.MULTILINE))
        if heard != HEARD_IN_FLIGHT | SENT_IN_FLIGHT:
            sys.exit(f"interop: other topics were decoded than expected: {sorted(heard ^ (HEARD_IN_FLIGHT | SENT_IN_FLIGHT))}")
        print(f"interop: a flight in {time.monotonic() - started:.1f} s")
        return heard

    def listen(self):
        """Vehicles at other levels, and a motion capture with a clock of its own. Returns the topics that were decoded."""
        vehicles = "kl1,kl2,kl3"
        with Processes(self.programs, self.work) as processes:
            listeners = {vehicle: self.peer("listen", processes.domain, vehicle, PATIENCE_S, *sorted(topics))
                         for vehicle, (_, topics) in LEVELS.items()}
            processes.start("swiftlet-plant", "--vehicle-name", vehicles, "--level", "rates,attitude,trajectory", "--no-realtime")
            processes.start("swiftlet-plant", "--vehicle-name", "kl4", "--level", "attitude", "--odometry", "own", "--no-realtime",
                            log="swiftlet-plant-kl4")
            processes.start("swiftlet-mocap", "--vehicle-name", vehicles, "--frame-clock", "host", "--no-realtime")
            for vehicle, (level, _) in LEVELS.items():
                processes.start("swiftlet-control", "--vehicle-name", vehicle, "--level", level, "--no-realtime",
                                log=f"swiftlet-control-{vehicle}")
            # Requests are volatile: a listener that meets the tool after its request does not hear it, and it sends only one.
            while listeners["kl1"].poll() is None:
                processes.start("swiftlet", "set", "control", "motor_lag").wait(PATIENCE_S)
            output = "".join(self.finish(listener, f"listening to {vehicle}") for vehicle, listener in listeners.items())
        return set(output.split())


    def join_ros(self):
        """A program of ROS 2, as it is on the wire, beside swiftlet-ros: standard types, nodes, a goal, velocities."""
        with Processes(self.programs, self.work) as processes:
            processes.start("swiftlet-plant", "--no-realtime")
            processes.start("swiftlet-mocap", "--no-realtime")
            processes.start("swiftlet-control", "--no-realtime")
            processes.start("swiftlet-ros", "--time", "vehicle", "--goal-speed", "1")
            for command in (["arm"], ["takeoff", "0.6"]):
                processes.run("swiftlet", *command)
            output = self.finish(self.peer("ros", processes.domain, "kl1", PATIENCE_S), "the program of ROS 2")
        endpoints = re.findall(r"^(writer|reader) (\S+) (\S+) (.*)$", output, re.MULTILINE)
        print("".join(f"interop: ROS 2: {line}\n" for line in output.splitlines() if not line.startswith(("writer", "reader"))), end="")
        return endpoints


def check_type_hashes(endpoints):
    """Each endpoint states the hash by which ROS 2 knows its type, in its user data."""
    shown = subprocess.run([DEBIAN_PYTHON, "-B", "-c", "import json, type_hashes; print(json.dumps(type_hashes.by_rosidl()))"],
                           cwd=HERE, text=True, stdout=subprocess.PIPE, check=True).stdout
    known = {**published(), **json.loads(shown.splitlines()[-1])}
    seen = set()
    for kind, topic, wire_type, user_data in endpoints:
        ros_type = wire_type.replace("::dds_::", "::").replace("::", "/").rstrip("_")
        if user_data != f"typehash={known[ros_type]};":
            sys.exit(f"interop: the {kind} of {topic} states '{user_data}', the hash of {ros_type} is {known[ros_type]}")
        seen.add((kind, ros_type))
    least = {("writer", "swiftlet_msgs/msg/ControlStatus"), ("reader", "swiftlet_msgs/msg/Command"), ("writer", "geometry_msgs/msg/PoseStamped"),
             ("reader", "geometry_msgs/msg/Twist"), ("writer", "tf2_msgs/msg/TFMessage"), ("writer", "rmw_dds_common/msg/ParticipantEntitiesInfo")}
    if least - seen:
        sys.exit(f"interop: not found: {sorted(least - seen)}")
    print(f"interop: {len(endpoints)} endpoints state the hashes of their {len({one for _, one in seen})} types as ROS 2 computes them")


def main(programs, work):
    interop = Interop(programs, work)
    topics = set(re.findall(r'^  TOPIC.*"(\w+)"', (ROOT / "services/messages/topic_table.hpp").read_text(), re.MULTILINE))
    missing = topics - interop.fly() - interop.listen()
    if missing:
        sys.exit(f"interop: never decoded: {', '.join(sorted(missing))}")
    print(f"interop: Cyclone DDS decoded all {len(topics)} topics", flush=True)
    check_type_hashes(interop.join_ros())
    package = subprocess.run([DEBIAN_PYTHON, "-B", HERE / "ros2_package.py", "--rosidl"], text=True, stdout=subprocess.PIPE, check=True)
    print(package.stdout.splitlines()[-1])  # rosidl names each file


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve())
