"""The hash of a ROS 2 type by which ROS 2 tells its versions apart (REP 2016, RIHS01): SHA-256 of its description and those of
the types that it uses, in the JSON that rosidl writes."""
import hashlib
import json

# Numbers of type_description_interfaces/msg/FieldType, by the names of IDL.
NUMBERS = {"nested": 1, "int8": 2, "uint8": 3, "int16": 4, "uint16": 5, "int32": 6, "uint32": 7, "int64": 8, "uint64": 9, "float": 10,
           "double": 11, "boolean": 15, "string": 17, "bounded_string": 21}
ARRAY, BOUNDED_SEQUENCE, UNBOUNDED_SEQUENCE = 48, 96, 144  # added to the number of an element


def field(name, kind, container=0, capacity=0, string_capacity=0, nested=""):
    """kind: of NUMBERS. container: ARRAY ..., with its capacity; 0: one value. nested: 'geometry_msgs/msg/Pose'."""
    return {"name": name, "type": {"type_id": NUMBERS[kind] + container, "capacity": capacity, "string_capacity": string_capacity,
                                   "nested_type_name": nested}}


def type_hash(name, fields):
    """fields: of each type by its name, 'geometry_msgs/msg/Pose', of all that the type `name` uses and of itself."""
    found = [name]
    for one in found:
        found += {each["type"]["nested_type_name"] for each in fields[one]} - {"", *found}
    described = [{"type_name": one, "fields": fields[one]} for one in [name, *sorted(found[1:])]]
    text = json.dumps({"type_description": described[0], "referenced_type_descriptions": described[1:]})
    return "RIHS01_" + hashlib.sha256(text.encode()).hexdigest()
