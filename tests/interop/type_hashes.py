#!/usr/bin/env python3
"""The hashes of ROS 2's types: what ROS 2 publishes, and those of this project's types by another way than idl/ros2msg.py.

usage: type_hashes.py

Checks idl/type_hash.py by types of ROS 2 whose hashes are known. Other tests import published() and by_rosidl().
"""
import hashlib
import json
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
IDL = ROOT / "idl" / "swiftlet_msgs"
# As `ros2 topic info --verbose` of ROS 2 Jazzy prints them.
PUBLISHED = {
    "std_msgs/msg/String": "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18",
    "builtin_interfaces/msg/Time": "b106235e25a4c5ed35098aa0a61a3ee9c9b18d197f398b0e4206cea9acf9c197",
    "geometry_msgs/msg/PoseStamped": "10f3786d7d40fd2b54367835614bff85d4ad3b5dab62bf8bca0cc232d73b4cd8",
    "geometry_msgs/msg/Twist": "9c45bf16fe0983d80e3cfe750d6835843d265a9a6c46bd2e609fcddde6fb8d2a",
    "nav_msgs/msg/Odometry": "3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0",
    "nav_msgs/msg/Path": "1957a5bb3cee5da65c4e52e52b65a93df227efce4c20f8458b36e73066ca334b",
    "rmw_dds_common/msg/ParticipantEntitiesInfo": "91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e",
    "rosgraph_msgs/msg/Clock": "692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564",
    "sensor_msgs/msg/BatteryState": "4bee5dfce981c98faa6828b868307a0a73f992ed0789f374ee96c8f840e69741",
    "sensor_msgs/msg/Imu": "7d9a00ff131080897a5ec7e26e315954b8eae3353c3f995c55faf71574000b5b",
    "tf2_msgs/msg/TFMessage": "e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087",
}


def published():
    return {name: "RIHS01_" + digest for name, digest in PUBLISHED.items()}


def by_rosidl():
    """The hash of each type of swiftlet_msgs, from what ROS 2's own parser finds in the IDL."""
    from rosidl_parser.definition import IdlLocator, Message
    from rosidl_parser.parser import parse_idl_file

    types = {}
    for file in sorted((IDL / "msg").glob("*.idl")):
        (message,) = parse_idl_file(IdlLocator(IDL, file.relative_to(IDL))).content.get_elements_of_type(Message)
        types[f"swiftlet_msgs/msg/{message.structure.namespaced_type.name}"] = [
            {"name": member.name, "type": described(member.type)} for member in message.structure.members]

    def uses(name):
        found = {each["type"]["nested_type_name"] for each in types[name]} - {""}
        return found.union(*map(uses, found))

    hashes = {}
    for name in types:
        whole = {"type_description": {"type_name": name, "fields": types[name]},
                 "referenced_type_descriptions": [{"type_name": one, "fields": types[one]} for one in sorted(uses(name))]}
        text = json.dumps(whole, ensure_ascii=True, separators=(", ", ": "), sort_keys=False)
        hashes[name] = "RIHS01_" + hashlib.sha256(text.encode("utf-8")).hexdigest()
    return hashes


def described(kind):
    """A type of rosidl as type_description_interfaces/msg/FieldType."""
    from rosidl_parser import definition

    numbers = {"int8": 2, "uint8": 3, "int16": 4, "uint16": 5, "int32": 6, "uint32": 7, "int64": 8, "uint64": 9, "float": 10,
               "double": 11, "boolean": 15, "octet": 16}
    if isinstance(kind, definition.Array):
        return {**described(kind.value_type), "type_id": described(kind.value_type)["type_id"] + 48, "capacity": kind.size}
    if isinstance(kind, definition.BoundedSequence):
        return {**described(kind.value_type), "type_id": described(kind.value_type)["type_id"] + 96, "capacity": kind.maximum_size}
    one = {"type_id": 0, "capacity": 0, "string_capacity": 0, "nested_type_name": ""}
    if isinstance(kind, definition.NamespacedType):
        return {**one, "type_id": 1, "nested_type_name": "/".join([*kind.namespaces, kind.name])}
    if isinstance(kind, definition.BoundedString):
        return {**one, "type_id": 21, "string_capacity": kind.maximum_size}
    if isinstance(kind, definition.UnboundedString):
        return {**one, "type_id": 17}
    return {**one, "type_id": numbers[kind.typename]}


def main():
    sys.path.insert(0, str(ROOT / "idl"))
    from type_hash import UNBOUNDED_SEQUENCE, field, type_hash

    def nested(name, kind, container=0):
        return field(name, "nested", container, nested=kind)

    geometry = "geometry_msgs/msg/"
    fields = {
        "std_msgs/msg/String": [field("data", "string")],
        "builtin_interfaces/msg/Time": [field("sec", "int32"), field("nanosec", "uint32")],
        "std_msgs/msg/Header": [nested("stamp", "builtin_interfaces/msg/Time"), field("frame_id", "string")],
        **{geometry + name: [field(letter, "double") for letter in letters]
           for name, letters in (("Vector3", "xyz"), ("Point", "xyz"), ("Quaternion", "xyzw"))},
        geometry + "Pose": [nested("position", geometry + "Point"), nested("orientation", geometry + "Quaternion")],
        geometry + "PoseStamped": [nested("header", "std_msgs/msg/Header"), nested("pose", geometry + "Pose")],
        geometry + "Twist": [nested("linear", geometry + "Vector3"), nested("angular", geometry + "Vector3")],
        "nav_msgs/msg/Path": [nested("header", "std_msgs/msg/Header"), nested("poses", geometry + "PoseStamped", UNBOUNDED_SEQUENCE)],
    }
    known = [name for name in fields if name in PUBLISHED]
    wrong = [name for name in known if type_hash(name, fields) != published()[name]]
    if wrong:
        sys.exit(f"type_hashes: not what ROS 2 publishes: {', '.join(wrong)}")
    print(f"type_hashes: {len(known)} types have the hashes that ROS 2 publishes")


if __name__ == "__main__":
    main()
