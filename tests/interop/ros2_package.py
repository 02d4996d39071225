#!/usr/bin/env python3
"""Holds the ROS 2 package swiftlet_msgs to the project's IDL.

usage: ros2_package.py [--rosidl]

Its .msg files must be those that idl/ros2msg.py writes now. With --rosidl, ROS 2's own tools (Debian: python3-rosidl) read them too,
and must find the constants, members and types that they find in the IDL.
"""
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "ros2" / "swiftlet_msgs"
IDL = sorted((ROOT / "idl" / "swiftlet_msgs" / "msg").glob("*.idl"))


def require(holds, what):
    if not holds:
        sys.exit(f"ros2_package: {what}")


def check_files(work):
    script = ROOT / "idl" / "ros2msg.py"
    subprocess.run([sys.executable, "-B", script, "--package", work, *IDL], check=True)
    written = {file.name: file.read_text() for file in (work / "msg").iterdir()}
    stored = {file.name: file.read_text() for file in (PACKAGE / "msg").iterdir()}
    differ = sorted(name for name in written.keys() | stored.keys() if written.get(name) != stored.get(name))
    require(not differ, f"not as the IDL files say: {', '.join(differ)}; run 'idl/ros2msg.py --package ros2/swiftlet_msgs "
                        "idl/swiftlet_msgs/msg/*.idl'")


def contents(file, folder):
    """Constants and members, as rosidl reads them from an IDL file."""
    from rosidl_parser.definition import IdlLocator, Message
    from rosidl_parser.parser import parse_idl_file
    (message,) = parse_idl_file(IdlLocator(folder, file)).content.get_elements_of_type(Message)
    members = [(member.name, described(member.type)) for member in message.structure.members]
    return ([(constant.name, described(constant.type), constant.value) for constant in message.constants], members)


def described(kind):
    """A type as text. (rosidl's types compare by identity.)"""
    parts = [type(kind).__name__]
    for attribute in ("typename", "namespaces", "name", "size", "maximum_size"):
        if hasattr(kind, attribute):
            parts.append(f"{attribute}={getattr(kind, attribute)}")
    if hasattr(kind, "value_type"):
        parts.append(described(kind.value_type))
    return " ".join(parts)


def check_with_rosidl(work):
    from rosidl_adapter.msg import convert_msg_to_idl
    constants = members = 0
    for idl in IDL:
        written = convert_msg_to_idl(PACKAGE, "swiftlet_msgs", pathlib.Path("msg") / f"{idl.stem}.msg", work)
        of_msg = contents(pathlib.Path(written).name, pathlib.Path(written).parent)
        of_idl = contents(idl.relative_to(ROOT / "idl" / "swiftlet_msgs"), ROOT / "idl" / "swiftlet_msgs")
        require(of_msg == of_idl, f"{idl.stem}: the message file has\n{of_msg}\nthe IDL has\n{of_idl}")
        constants += len(of_msg[0])
        members += len(of_msg[1])
    print(f"ros2_package: rosidl finds the {constants} constants and {members} members of {len(IDL)} types in message files and IDL alike")


def main(options):
    with tempfile.TemporaryDirectory() as folder:
        check_files(pathlib.Path(folder))
        if options == ["--rosidl"]:
            check_with_rosidl(pathlib.Path(folder))


if __name__ == "__main__":
    if sys.argv[1:] not in ([], ["--rosidl"]):
        sys.exit(__doc__)
    main(sys.argv[1:])
