#!/usr/bin/env python3
"""Checks of the sources that clang-format does not make: './dev style' runs them.

- A namespace is its room: a file opens a namespace that has the name of one of its folders, and all files of a room of
  tests/rooms.txt the same one. Further namespaces in a file, for declarations and specialisations, are not checked.
- No file is longer than 450 lines, unless tests/style/long_files.txt gives the reason.
- No function is longer than 60 lines, unless that file gives the reason.
- No comment begins with words that leave out what they speak of, such as "// Of", "// That of" or "// As".

The lengths are those of the sources as clang-format leaves them.
"""
import pathlib
import re
import sys

MOST_LINES = 450
MOST_LINES_OF_A_FUNCTION = 60
NAMESPACE = re.compile(r"^namespace swiftlet::(\w+)", re.MULTILINE)
NO_FUNCTION = re.compile(r"\s*(?:namespace|class|struct|enum|union|extern|if|for|while|switch|else|do|try|case|default)\b")
OPENING = re.compile(r"^( {0,4})(?=[^\s/#*]).*\{$")
RIDDLE = re.compile(r"^\s*// (Of|That of|Those of|What it|What they|It is|For those)\b")
EXEMPT_ROOMS = {"tests"}


def rooms(root):
    lines = (root / "tests/rooms.txt").read_text().splitlines()
    return [line.split()[0] for line in lines if line and not line.startswith("#")]


def room_of(path, known):
    folder = path.parent
    while str(folder) != "." and str(folder) not in known:
        folder = folder.parent
    return str(folder)


def namespace_faults(files, known):
    """files: path -> text."""
    of_room = {}
    for path, text in files.items():
        room = room_of(path, known)
        found = NAMESPACE.findall(text)
        if room == "." or path.parts[0] in EXEMPT_ROOMS or not found:
            continue
        own = [name for name in found if name in path.parent.parts]
        if not own:
            yield f"{path}: opens namespace swiftlet::{found[0]}, which is none of its folders"
            continue
        first = of_room.setdefault(room, (own[0], path))
        if first[0] != own[0]:
            yield f"{path}: opens swiftlet::{own[0]}, but {first[1]} of the same room swiftlet::{first[0]}"


def statement_before(lines, last):
    """The lines of the statement that ends with line `last`, joined."""
    first = last
    while first > 0 and lines[first - 1].strip() and not re.search(r"[;{}:]$|^\s*(//|#)", lines[first - 1]):
        first -= 1
    return first, " ".join(line.strip() for line in lines[first : last + 1])


def functions(text):
    """(name, first line, number of lines) of each function that is defined in the text, lambdas excluded."""
    lines = text.split("\n")
    for i, line in enumerate(lines):
        opening = OPENING.match(line)
        if not opening:
            continue
        first, statement = statement_before(lines, i)
        if NO_FUNCTION.match(statement) or "(" not in statement or re.search(r"\[[^\]]*\]\s*(\(|\{$)|=\s*\{$|^\}", statement):
            continue
        indent = " " * (len(lines[first]) - len(lines[first].lstrip()))
        end = next((k for k in range(i + 1, len(lines)) if lines[k].startswith(indent + "}")), i)
        name = re.search(r"([~\w:]+)\s*\(", statement)
        yield name.group(1) if name else statement, first + 1, end - first + 1


def reasons(root):
    found = {}
    for line in (root / "tests/style/long_files.txt").read_text().splitlines():
        if line and not line.startswith("#"):
            path, reason = line.split(maxsplit=1)
            found[path] = reason
    return found


def size_faults(files, allowed):
    long = set()
    for path, text in files.items():
        count = text.count("\n")
        if count > MOST_LINES:
            long.add(str(path))
            if str(path) not in allowed:
                yield f"{path}: has {count} lines, must have at most {MOST_LINES}, or a reason in tests/style/long_files.txt"
        for name, line, length in functions(text):
            if length <= MOST_LINES_OF_A_FUNCTION:
                continue
            long.add(f"{path}:{name}")
            if f"{path}:{name}" not in allowed:
                yield f"{path}:{line}: {name} has {length} lines, must have at most {MOST_LINES_OF_A_FUNCTION}"
    for entry in allowed:
        if entry not in long:
            yield f"tests/style/long_files.txt: {entry} is not long, or not there: remove it from the list"


def comment_faults(files):
    for path, text in files.items():
        before = ""
        for number, line in enumerate(text.split("\n"), 1):
            if RIDDLE.match(line) and not before.lstrip().startswith("//"):
                yield f"{path}:{number}: a comment must say what it speaks of:{line}"
            before = line


def main():
    root = pathlib.Path(__file__).resolve().parents[2]
    files = {pathlib.Path(name): (root / name).read_text() for name in sys.stdin.read().split()}
    faults = [*namespace_faults(files, set(rooms(root))), *size_faults(files, reasons(root)), *comment_faults(files)]
    print("\n".join(faults), end="\n" if faults else "")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
