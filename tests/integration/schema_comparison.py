"""Compares a JSON schema of files with their reader: both accept the same texts."""

import json
import pathlib
import tempfile

import jsonschema
import yaml


def disagreements(schema_file, reader_fault, valid, invalid):
    """Lists where schema and reader are wrong about the examples beside the schema, and the texts of `valid` and `invalid`.

    reader_fault(path) is the reader's message, or empty if it accepts the file.
    """
    schema = json.loads(schema_file.read_text())
    jsonschema.Draft7Validator.check_schema(schema)
    validator = jsonschema.Draft7Validator(schema)
    found = []

    def check(name, path, is_valid):
        schema_fault = next(validator.iter_errors(yaml.safe_load(path.read_text())), None)
        for who, fault in ("schema", schema_fault and schema_fault.message), ("reader", reader_fault(path)):
            if is_valid and fault:
                found.append(f"{name}: the {who}: {fault}")
            if not is_valid and not fault:
                found.append(f"{name}: the {who} accepts it")

    examples = sorted(schema_file.parent.glob("*.yaml"))
    if not examples:
        found.append(f"{schema_file.parent} holds no example")
    for example in examples:
        check(example.name, example, True)
    with tempfile.TemporaryDirectory() as folder:
        written = pathlib.Path(folder) / "f.yaml"
        for is_valid, texts in (True, valid), (False, invalid):
            for name, text in texts.items():
                written.write_text(text)
                check(name, written, is_valid)
    return found


def report(found):
    """Prints what disagrees. Returns the exit code."""
    for line in found:
        print(line)
    print(f"{len(found)} disagree")
    return 1 if found else 0
