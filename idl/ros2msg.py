#!/usr/bin/env python3
"""Writes the IDL types as ROS 2 message definitions, for recorded flights and as the files of a ROS 2 package.

usage: ros2msg.py OUTPUT.cpp FILE.idl...
       ros2msg.py --package FOLDER FILE.idl...

OUTPUT.cpp defines schema_of() of services/messages/schemas.hpp for each type. A definition holds the types that it
uses behind separator lines, as ros2msg schemas in MCAP files do. With --package, FOLDER/msg gets a file for each type.
"""
import re
import sys
from pathlib import Path

from type_hash import ARRAY, BOUNDED_SEQUENCE, field, type_hash

# IDL type: ROS 2's name, bytes in CDR
PRIMITIVES = {
    "boolean": ("bool", 1), "uint8": ("uint8", 1), "int8": ("int8", 1), "uint16": ("uint16", 2), "int16": ("int16", 2),
    "uint32": ("uint32", 4), "int32": ("int32", 4), "uint64": ("uint64", 8), "int64": ("int64", 8),
    "float": ("float32", 4), "double": ("float64", 8),
}
ENCAPSULATION_BYTES = 4
SEPARATOR = "=" * 80
LONGEST_LITERAL = 60000

CONSTANT = re.compile(r"const (\w+) (\w+) = ([^;]+);\s*(//.*)?$")
MEMBER = re.compile(r"([\w:<>, ]+?)\s+(\w+)(?:\[(\d+)\])?;\s*(//.*)?$")
SEQUENCE = re.compile(r"sequence<\s*([\w:]+)\s*,\s*(\d+)\s*>$")
STRING = re.compile(r"string(?:<(\d+)>)?$")
COMPOUND = re.compile(r"(\w+)::msg::(\w+)$")


class Refusal(Exception):
    pass


class Message:
    """A struct of an IDL file."""

    def __init__(self, name):
        self.name = name
        self.lines = []      # of the definition
        self.uses = []       # other types, in order
        self.fields = []     # for its hash
        self.stamp_offset = -1
        self.offset = ENCAPSULATION_BYTES  # of the next member; None behind one of variable size

    def comment(self, text):
        self.lines.append("# " + text)

    def member(self, idl_type, name, count, comment):
        if name == "stamp_ns" and idl_type == "int64" and self.offset is not None:
            self.stamp_offset = self.aligned(8)
        text = self.ros_type(idl_type)
        if count:
            text += f"[{count}]"
        self.advance(idl_type, int(count or 1))
        self.fields.append(described(name, idl_type, int(count or 0)))
        self.lines.append(f"{text} {name}" + (f"  # {comment}" if comment else ""))

    def ros_type(self, idl_type):
        if idl_type in PRIMITIVES:
            return PRIMITIVES[idl_type][0]
        if string := STRING.match(idl_type):
            return f"string<={string[1]}" if string[1] else "string"
        if sequence := SEQUENCE.match(idl_type):
            return f"{self.ros_type(sequence[1])}[<={sequence[2]}]"
        if compound := COMPOUND.match(idl_type):
            if compound[2] not in self.uses:
                self.uses.append(compound[2])
            return f"{compound[1]}/{compound[2]}"
        raise Refusal(f"type '{idl_type}' is not known")

    def aligned(self, size):
        at = self.offset - ENCAPSULATION_BYTES
        return ENCAPSULATION_BYTES + (at + size - 1) // size * size

    def advance(self, idl_type, count):
        if self.offset is None or idl_type not in PRIMITIVES:
            self.offset = None
            return
        size = PRIMITIVES[idl_type][1]
        self.offset = self.aligned(size) + count * size


def described(name, idl_type, count):
    """A member for type_hash()."""
    container, capacity = (ARRAY, count) if count else (0, 0)
    if sequence := SEQUENCE.match(idl_type):
        idl_type, container, capacity = sequence[1], BOUNDED_SEQUENCE, int(sequence[2])
    if string := STRING.match(idl_type):
        return field(name, "bounded_string" if string[1] else "string", container, capacity, int(string[1] or 0))
    if compound := COMPOUND.match(idl_type):
        return field(name, "nested", container, capacity, nested=f"{compound[1]}/msg/{compound[2]}")
    return field(name, idl_type, container, capacity)


def without_slashes(comment):
    return comment.lstrip("/").strip() if comment else ""


def parse(path):
    """The package and the message of a file: constants in a module X_Constants, and one struct X."""
    package, message, constants, inside = None, None, [], None
    for number, line in enumerate(path.read_text().splitlines(), 1):
        text = line.strip()
        try:
            if not text or text in ("};", "}") or text.startswith("#include"):
                continue
            if module := re.match(r"module (\w+) {$", text):
                package = package or module[1]
            elif struct := re.match(r"struct (\w+) {$", text):
                message = Message(struct[1])
                message.lines = constants
                inside = message
            elif text.startswith("//"):
                (inside.comment if inside else lambda c: constants.append("# " + c))(without_slashes(text))
            elif constant := CONSTANT.match(text):
                comment = without_slashes(constant[4])
                constants.append(f"{PRIMITIVES[constant[1]][0]} {constant[2]}={constant[3]}" +
                                 (f"  # {comment}" if comment else ""))
            elif inside and (member := MEMBER.match(text)):
                inside.member(member[1].strip(), member[2], member[3], without_slashes(member[4]))
            else:
                raise Refusal("is not understood")
        except Refusal as fault:
            sys.exit(f"{path}:{number}: {text}: {fault}")
    if message is None:
        sys.exit(f"{path}: has no struct")
    return package, message


def definition(package, messages, name):
    """The definition with those of all used types."""
    parts, order = [], [name]
    for used in order:
        order += [other for other in messages[used].uses if other not in order]
    for used in order:
        head = [] if used == name else [SEPARATOR, f"MSG: {package}/{used}"]
        parts += head + messages[used].lines
    return "\n".join(parts) + "\n"


def parse_all(files):
    """The package of the files, and their messages by name."""
    parsed = [parse(Path(file)) for file in files]
    return parsed[0][0], {message.name: message for _, message in parsed}


def write_package(folder, files):
    package, messages = parse_all(files)
    (folder / "msg").mkdir(parents=True, exist_ok=True)
    for name, message in messages.items():
        head = f"# Written from idl/{package}/msg/{name}.idl by idl/ros2msg.py."
        (folder / "msg" / f"{name}.msg").write_text("\n".join([head, *message.lines]) + "\n")


def main(output, files):
    package, messages = parse_all(files)
    out = ['#include "swiftlet/services/messages/schemas.hpp"', "", f"namespace {package}::msg {{",
           *(f"class {name};" for name in sorted(messages)), f"}}  // namespace {package}::msg", "",
           "namespace swiftlet::messages {", ""]
    fields = {f"{package}/msg/{name}": message.fields for name, message in messages.items()}
    for name, message in sorted(messages.items()):
        text = definition(package, messages, name)
        assert len(text) < LONGEST_LITERAL
        out += ["template <>", f"const MessageSchema& schema_of<{package}::msg::{name}>() {{",
                f'  static constexpr MessageSchema kSchema{{"{package}/msg/{name}", R"ros2msg({text})ros2msg",',
                f"                                           {message.stamp_offset},",
                f'                                           "{type_hash(f"{package}/msg/{name}", fields)}"}};',
                "  return kSchema;", "}", ""]
    out += ["}  // namespace swiftlet::messages", ""]
    Path(output).write_text("\n".join(out))


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    if sys.argv[1] == "--package":
        write_package(Path(sys.argv[2]), sys.argv[3:])
        sys.exit()
    main(sys.argv[1], sys.argv[2:])
