#!/usr/bin/env python3
"""config/missions/mission.schema.json, used by editors, agrees with the parser of `swiftlet mission check`.

usage: mission_schema_test.py SWIFTLET SOURCE_FOLDER
Both accept every example mission, refuse missions of invalid form, and know the same keys.
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

import jsonschema
import yaml

HEAD = "frame: ned\ntolerance_m: 0.1\n"
TAKEOFF = "  - {kind: takeoff, height_m: 1, speed_m_s: 0.5}\n"
WAYPOINT = "  - {kind: waypoint, position_m: [1, 0, -1], speed_m_s: 0.5}\n"
LAND = "  - {kind: land, speed_m_s: 0.5}\n"


def mission(*items, head=HEAD):
    return head + "items:\n" + TAKEOFF + "".join(f"  - {item}\n" for item in items) + LAND


POINTS = "[[0, 0, -1], [1, 0, -1]]"
VALID = {
    "all of a waypoint": mission(
        "{kind: waypoint, position_m: [1, 0, -1], yaw_rad: 1, speed_m_s: 1, acceptance_radius_m: 0.1, hold_s: 1}"),
    "yaws in degrees": mission(
        "{kind: set, yaw_deg: -180}", "{kind: waypoint, position_m: [1, 0, -1], yaw_deg: 90, speed_m_s: 1}",
        "{kind: path, speed_m_s: 1, yaw_deg: free, points: [[1, 0, -1], {position_m: [2, 0, -1], yaw_deg: 90}]}"),
    "free yaw": mission("{kind: waypoint, position_m: [1, 0, -1], yaw_rad: free, speed_m_s: 1}"),
    "all of a path": mission(
        f"{{kind: path, points: {POINTS}, yaw_rad: 1, speed_m_s: 1, acceptance_radius_m: 0.1, hold_s: 1,"
        " corridor_m: 0.1, smoothness: jerk}"),
    "points that say more": mission(
        "{kind: path, speed_m_s: 1, points: [[0, 0, -1], {position_m: [1, 0, -1], yaw_rad: 1, stop: true},"
        " [1, 1, -1]]}"),
    "a straight path": mission(f"{{kind: path, points: {POINTS}, speed_m_s: 1, straight: true}}"),
    "a path that is not straight": mission(
        f"{{kind: path, points: {POINTS}, speed_m_s: 1, straight: false, corridor_m: 0.1}}"),
    "set": mission("{kind: set, speed_m_s: 1, yaw_rad: free, acceptance_radius_m: 0.1, hold_s: 1}"),
    "wait": mission("{kind: wait, duration_s: 1}"),
    "limits and fence": mission(head=HEAD + "name: n\ndescription: d\nends: landed\nlimits: {speed_m_s: 1, "
                                "acceleration_m_s2: 1, jerk_m_s3: 6, yaw_rate_rad_s: 1}\n"
                                "geofence: {min_m: [-1, -1, -2], max_m: [1, 1, 0.2]}\n"),
}
INVALID_FORM = {
    "no frame": mission(head="tolerance_m: 0.1\n"),
    "another frame": mission(head="frame: body\ntolerance_m: 0.1\n"),
    "no tolerance": mission(head="frame: ned\n"),
    "tolerance of 0": mission(head="frame: ned\ntolerance_m: 0\n"),
    "no items": HEAD + "items: []\n",
    "an item that is a number": mission("3"),
    "unknown kind": mission("{kind: loop, speed_m_s: 1}"),
    "no kind": mission("{position_m: [1, 0, -1], speed_m_s: 1}"),
    "two numbers": mission("{kind: waypoint, position_m: [1, 0], speed_m_s: 1}"),
    "a text for a number": mission("{kind: waypoint, position_m: [1, 0, -1], speed_m_s: fast}"),
    "a quoted number": mission("{kind: waypoint, position_m: [1, 0, -1], speed_m_s: '1'}"),
    "speed of 0": mission("{kind: waypoint, position_m: [1, 0, -1], speed_m_s: 0}"),
    "yaw in degrees": mission("{kind: waypoint, position_m: [1, 0, -1], yaw_rad: 90, speed_m_s: 1}"),
    "two yaws": mission("{kind: waypoint, position_m: [1, 0, -1], yaw_rad: 1, yaw_deg: 57, speed_m_s: 1}"),
    "degrees beyond half a turn": mission("{kind: waypoint, position_m: [1, 0, -1], yaw_deg: 181, speed_m_s: 1}"),
    "yaw that is a word": mission("{kind: waypoint, position_m: [1, 0, -1], yaw_rad: north, speed_m_s: 1}"),
    "hold below 0": mission("{kind: waypoint, position_m: [1, 0, -1], speed_m_s: 1, hold_s: -1}"),
    "radius below 0": mission("{kind: waypoint, position_m: [1, 0, -1], speed_m_s: 1, acceptance_radius_m: -1}"),
    "one point": mission("{kind: path, points: [[1, 0, -1]], speed_m_s: 1}"),
    "straight in a corridor": mission(f"{{kind: path, points: {POINTS}, speed_m_s: 1, straight: true, corridor_m: 1}}"),
    "narrow corridor": mission(f"{{kind: path, points: {POINTS}, speed_m_s: 1, corridor_m: 0.0001}}"),
    "another smoothness": mission(f"{{kind: path, points: {POINTS}, speed_m_s: 1, smoothness: crackle}}"),
    "point without a place": mission("{kind: path, points: [[0, 0, -1], {yaw_rad: 1}], speed_m_s: 1}"),
    "trajectory without a file": mission("{kind: trajectory, speed_m_s: 1}"),
    "set of nothing": mission("{kind: set}"),
    "wait of 0": mission("{kind: wait, duration_s: 0}"),
    "limit of 0": mission(head=HEAD + "limits: {speed_m_s: 0}\n"),
    "fence of one corner": mission(head=HEAD + "geofence: {min_m: [-1, -1, -1]}\n"),
    "ends somewhere": mission(head=HEAD + "ends: somewhere\n"),
    "name with a folder": mission(head="name: ../m\n" + HEAD),
}
# Faults that a schema cannot detect.
INVALID_CONTENT = {
    "outside the fence": mission("{kind: waypoint, position_m: [9, 0, -1], speed_m_s: 1}"),
    "below the ground": mission("{kind: waypoint, position_m: [1, 0, 1], speed_m_s: 1}"),
    "below the minimum height": mission("{kind: waypoint, position_m: [1, 0, -0.05], speed_m_s: 1}"),
    "too fast": mission("{kind: waypoint, position_m: [1, 0, -1], speed_m_s: 9}"),
    "a second takeoff": mission("{kind: takeoff, height_m: 1, speed_m_s: 0.5}"),
    "an early land": mission("{kind: land, speed_m_s: 0.5}"),
    "cut short": HEAD + "items:\n" + TAKEOFF + WAYPOINT,
    "no speed anywhere": mission("{kind: waypoint, position_m: [1, 0, -1]}"),
    "a key that is given twice": mission("{kind: wait, duration_s: 1, duration_s: 2}"),
    "no file there": mission("{kind: trajectory, file: none.csv, speed_m_s: 1}"),
}

failures = []


def expect(holds, sentence):
    if not holds:
        failures.append(sentence)


class Checkers:
    def __init__(self, swiftlet, schema, folder):
        self.swiftlet = swiftlet
        self.validator = jsonschema.Draft7Validator(schema)
        self.folder = pathlib.Path(folder)

    def schema_fault(self, text):
        fault = next(self.validator.iter_errors(yaml.safe_load(text)), None)
        return fault.message if fault else ""

    def parser_fault(self, path):
        """The parser's message, or empty if it accepts the file; feasibility is not checked."""
        result = subprocess.run([self.swiftlet, "mission", "check", path], capture_output=True, text=True, check=False)
        expect(result.returncode in (0, 1, 2), f"{path}: exit code {result.returncode}: {result.stderr}")
        return result.stderr if result.returncode == 2 else ""

    def parser_fault_of_text(self, text):
        path = self.folder / "m.yaml"
        path.write_text(text)
        return self.parser_fault(path)


def keys_named_by(fault):
    """The keys in a message such as "must be one of a, b or c; nearest is b"."""
    listed = re.search(r"must be one of ([^;\n]*)", fault)
    return set(re.split(r", | or ", listed.group(1))) if listed else set()


def check_keys(checkers, schema):
    definitions = schema["definitions"]
    kinds = definitions["item"]["properties"]["kind"]["enum"]
    every = set().union(*(definitions[kind]["properties"] for kind in kinds))
    expected = {
        "the mission": (mission(head="zzz: 1\n" + HEAD), set(schema["properties"])),
        "limits": (mission(head=HEAD + "limits: {zzz: 1}\n"), set(schema["properties"]["limits"]["properties"])),
        "the fence": (mission(head=HEAD + "geofence: {zzz: 1}\n"), set(schema["properties"]["geofence"]["properties"])),
        "any item": (mission("{zzz: 1}"), every),
        "a point": (mission("{kind: path, speed_m_s: 1, points: [[0, 0, -1], {zzz: 1}]}"),
                    set(definitions["point"]["anyOf"][1]["properties"])),
    }
    for kind in kinds:
        known = set(definitions[kind]["properties"])
        other = sorted(every - known)[0]
        text = HEAD + f"items:\n  - {{kind: {kind}, {other}: 1}}\n" + LAND
        expected[kind] = (text, known)
    for what, (text, known) in expected.items():
        fault = checkers.parser_fault_of_text(text)
        expect(keys_named_by(fault) == known, f"keys of {what}: the schema has {sorted(known)}, the parser says {fault}")
        expect(checkers.schema_fault(text), f"keys of {what}: the schema accepts an unknown key")


def main():
    swiftlet, source = sys.argv[1], pathlib.Path(sys.argv[2])
    missions = source / "config" / "missions"
    schema = json.loads((missions / "mission.schema.json").read_text())
    jsonschema.Draft7Validator.check_schema(schema)
    with tempfile.TemporaryDirectory() as folder:
        checkers = Checkers(swiftlet, schema, folder)
        examples = sorted(missions.glob("*.yaml"))
        expect(len(examples) >= 3, f"{missions} holds {len(examples)} missions")
        for example in examples:
            text = example.read_text()
            expect(text.startswith("# yaml-language-server: $schema=mission.schema.json\n"),
                   f"{example.name} does not name its schema in its first line")
            expect(not checkers.schema_fault(text), f"{example.name}: the schema: {checkers.schema_fault(text)}")
            expect(not checkers.parser_fault(example), f"{example.name}: the parser: {checkers.parser_fault(example)}")
        for name, text in VALID.items():
            expect(not checkers.schema_fault(text), f"{name}: the schema: {checkers.schema_fault(text)}")
            expect(not checkers.parser_fault_of_text(text), f"{name}: the parser: {checkers.parser_fault_of_text(text)}")
        for name, text in INVALID_FORM.items():
            expect(checkers.schema_fault(text), f"{name}: the schema accepts it")
            expect(checkers.parser_fault_of_text(text), f"{name}: the parser accepts it")
        for name, text in INVALID_CONTENT.items():
            expect(not checkers.schema_fault(text), f"{name}: the schema: {checkers.schema_fault(text)}")
            expect(checkers.parser_fault_of_text(text), f"{name}: the parser accepts it")
        check_keys(checkers, schema)
    for failure in failures:
        print(failure)
    print(f"{len(failures)} disagree")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
