#!/usr/bin/env python3
"""Writes the IDL types under the names that they have on the wire, for DDS implementations without ROS 2.

usage: wire_idl.py OUTPUT.idl FILE.idl...

ROS 2 calls the type swiftlet_msgs::msg::Imu `swiftlet_msgs::msg::dds_::Imu_` on the wire, and DDS matches topics by the names of
their types. OUTPUT.idl holds all types in one file without includes, each below the types that it uses, and the constants. Any
IDL compiler takes it; the members, and so the bytes, are those of FILE.idl.
"""
import re
import sys
from pathlib import Path

INCLUDE = re.compile(r'#include "(?:\w+/)*(\w+)\.idl"\n')
REFERENCE = re.compile(r"\b(\w+)::msg::(\w+)\b")
STRUCT = re.compile(r"^( *)struct (\w+) \{\n(.*?)^\1\};\n", re.MULTILINE | re.DOTALL)


def renamed(text):
    """The text of an IDL file without includes, its struct in a module dds_."""

    def in_module(struct):
        indent, name, members = struct.groups()
        lines = [f"struct {name}_ {{", *(line[len(indent):] for line in members.splitlines()), "};"]
        body = "".join(f"{indent}  {line}".rstrip() + "\n" for line in lines)
        return f"{indent}module dds_ {{\n{body}{indent}}};\n"

    text = REFERENCE.sub(r"\1::msg::dds_::\2_", INCLUDE.sub("", text))
    text, structs = STRUCT.subn(in_module, text)
    if structs != 1:
        sys.exit(f"wire_idl.py: {structs} structs in one file, must be 1:\n{text}")
    return text.strip() + "\n"


def main(output, files):
    texts = {path.stem: path.read_text() for path in map(Path, files)}
    order = []

    def add(name):
        for used in INCLUDE.findall(texts[name]):
            add(used)
        if name not in order:
            order.append(name)

    for name in sorted(texts):
        add(name)
    head = "// The types under their names on the wire, as ROS 2 forms them. Written by wire_idl.py.\n"
    Path(output).write_text(head + "".join("\n" + renamed(texts[name]) for name in order))


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2:])
