"""The reference of the topics: every topic of services/messages/topic_table.hpp and every type of the IDL files."""

import re

from manual_text import ManualError, plain, table

_TOPIC = re.compile(r'^  TOPIC(?:_OF)?\((\w+), (?:\w+, )?"(\w+)", (\w+), ', re.MULTILINE)
_CONSTANT = re.compile(r"^const (\w+) (\w+) = ([^;]+);$")
_FIELD = re.compile(r"^([\w:]+(?:<.*>)?) (\w+)(\[\d+\])?;$")


def words_of(name):
    """LatchedLarge -> latched large"""
    return re.sub(r"(?<!^)(?=[A-Z])", " ", name).lower()


def read_topics(root):
    file = root / "services/messages/topic_table.hpp"
    topics = [(name, kind, words_of(profile))
              for kind, name, profile in _TOPIC.findall(file.read_text())]
    if not topics:
        raise ManualError(f"{file.relative_to(root)}: no topic found; docs/site/messages.py reads lines such as "
                          'TOPIC(Imu, "imu", Stream, roles::kVehicle)')
    return topics


def table_of_readme(root):
    """(name, type, profile) of each row of the table of topics in idl/README.md."""
    rows = set()
    for line in (root / "idl/README.md").read_text().splitlines():
        cells = [cell.strip().strip("`") for cell in line.strip("|").split("|")]
        if line.startswith("| `") and len(cells) == 5:
            rows.add((cells[0], cells[1], cells[4]))
    return rows


def check_readme(root, topics):
    code, document = set(topics), table_of_readme(root)
    for row in sorted(code ^ document):
        where = "services/messages/topic_table.hpp" if row in code else "idl/README.md"
        raise ManualError(f"idl/README.md: its table of topics and services/messages/topic_table.hpp differ: only {where} has "
                          f"{', '.join(row)}")


def read_type(file, root):
    """(comment of the struct, constants, fields). A constant or field is (type, name, value or '', comment)."""
    where = file.relative_to(root)
    about, constants, fields = [], [], []
    pending, inside, column = [], None, None  # column: of the comment behind the last field or constant
    for number, line in enumerate(file.read_text().splitlines(), 1):
        code, _, comment = line.partition("//")
        at = len(code)
        code, comment = code.strip(), comment.strip()
        if not code:
            if comment and at == column:  # goes on below
                last = list(inside[-1])
                inside[-1] = (*last[:3], f"{last[3]} {comment}")
            else:
                pending += [comment] if comment else []
            continue
        column = None
        if code.startswith("struct "):
            inside, about, pending = fields, about + pending, []
        elif re.match(r"module \w+_Constants", code):
            inside = constants
        elif constant := _CONSTANT.match(code):
            constants.append((constant[1], constant[2], constant[3], comment))
            column = at if comment else None
        elif (field := _FIELD.match(code)) and inside is fields:
            text = " ".join([*pending, comment]).strip()
            fields.append((field[1] + (field[3] or ""), field[2], "", text))
            pending, column = [], at if comment else None
        elif not re.match(r"^(module \w+ \{|\};?|#include .*)$", code):
            raise ManualError(f"{where}:{number}: docs/site/messages.py cannot read '{code}'")
    if not fields:
        raise ManualError(f"{where}: no struct with fields found")
    return " ".join(about), constants, fields


def short(kind):
    return kind.replace("swiftlet_msgs::msg::", "")


def page(root):
    topics = read_topics(root)
    check_readme(root, topics)
    out = [
        "# Messages\n\n"
        "This page is generated from the IDL files and from `services/messages/topic_table.hpp`. "
        "[Topics](../rooms/idl.md) explains rates, profiles and conventions.\n\n"
        "## All topics\n\n",
        table(["topic", "type", "profile"],
              [(f"`{name}`", f"[{kind}](#{kind.lower()})", profile) for name, kind, profile in topics]),
    ]
    for file in sorted((root / "idl/swiftlet_msgs/msg").glob("*.idl")):
        about, constants, fields = read_type(file, root)
        used = [f"`{name}`" for name, kind, _ in topics if kind == file.stem]
        out.append(f"\n## {file.stem}\n\n")
        out.append(f"Topic{'s' if len(used) > 1 else ''} {', '.join(used)}. " if used else "Part of other messages. ")
        out.append(plain(about) + "\n\n")
        out.append(table(["field", "type", "meaning"], [(f"`{name}`", f"`{short(kind)}`", plain(text))
                                                       for kind, name, _, text in fields]))
        if constants:
            out.append("\n" + table(["constant", "value", "meaning"], [(f"`{name}`", value, plain(text))
                                                                      for _, name, value, text in constants]))
    return "".join(out)
