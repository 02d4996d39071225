#!/usr/bin/env python3
"""The walks of docs/architecture.md name what is in the sources.

Each "Class::function()" and "function()" must be declared or defined in a source, each "[Type]" be the name of a type there or of a message.
"""

import pathlib
import re
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[2]
ROOMS = ["math", "plant", "control", "record", "io", "simulation", "services", "ground", "analysis", "idl"]
MOST_LINES = 40  # one screen


def sources():
    files = [file for room in ROOMS for file in (SOURCE / room).rglob("*") if file.suffix in (".hpp", ".cpp", ".idl")]
    return [file.read_text() for file in files]


def class_text(texts, name):
    """The bodies of the classes and structs of this name, and the definitions of their functions outside of them."""
    text = "\n".join(text for text in texts if re.search(r"\b%s\b" % name, text))
    bodies = re.findall(r"\b(?:class|struct)(?: \[\[\w+\]\])? (?:\w+::)*%s\b[^;{]*\{.*?^(?: {2})?\};" % name, text, re.MULTILINE | re.DOTALL)
    return "\n".join(bodies + re.findall(r"\b%s::~?\w+\(" % name, text))


def faults(page, texts):
    text = "\n".join(texts)
    section = page.split("## Five walks", 1)[1]
    for title, walk in re.findall(r"^### (.*?)$(.*?)(?=^### |\Z)", section, re.MULTILINE | re.DOTALL):
        if walk.strip().count("\n") > MOST_LINES:
            yield f"{title}: has {walk.strip().count(chr(10))} lines, must fit a screen of {MOST_LINES}"
        for owner, name in set(re.findall(r"(?:(\w+)::)?(\w+)\(\)", walk)):
            where = class_text(texts, owner) if owner else text
            if not re.search(r"\b%s\(" % name, where):
                yield f"{title}: there is no {owner + '::' if owner else ''}{name}()"
        for form in set(re.findall(r"\[((?:\w+::)?\w+)\]", walk)):
            if not re.search(r"\b(?:class|struct|enum class|using) (?:\w+::)*%s\b" % form.split("::")[-1], text):
                yield f"{title}: there is no type {form}"


def main():
    found = sorted(faults((SOURCE / "docs/architecture.md").read_text(), sources()))
    print("\n".join(found))
    tried = list(faults("## Five walks\n### A\n`Supervisor::no_such()` [NoSuchType] no_such_function()\n", sources()))
    if len(tried) != 3:
        print(f"a walk with three wrong names has {len(tried)} faults")
        return 1
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
