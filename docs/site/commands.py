"""The reference of the commands: the output of --help of every program and subcommand."""

import re
import subprocess

from manual_text import ManualError

PROGRAMS = ["swiftlet", "swiftlet-plant", "swiftlet-mocap", "swiftlet-control", "swiftlet-vehicle-template",
            "swiftlet-microcontroller", "swiftlet-px4", "swiftlet-ros"]


def help_of(folder, words):
    """What `words --help` prints."""
    command = [str(folder / words[0]), *words[1:], "--help"]
    try:
        result = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    except OSError as error:
        raise ManualError(f"{command[0]}: {error.strerror}: build the programs first, './dev build programs'") from error
    if result.returncode != 0:
        raise ManualError(f"{' '.join(words)} --help: exit code {result.returncode}: {result.stderr.strip()}")
    return result.stdout


def subcommands_of(text):
    """The names in the section `Subcommands:` of a help text."""
    section = re.search(r"^Subcommands:\n((?:[ \t]+.*\n)+)", text, re.MULTILINE)
    return re.findall(r"^  (\S+)", section.group(1), re.MULTILINE) if section else []


def walk(folder, words):
    """Yields (words, help text) of a program and of all its subcommands."""
    text = help_of(folder, words)
    yield words, text
    for name in subcommands_of(text):
        yield from walk(folder, [*words, name])


def page(folder):
    out = [
        "# Commands\n\n"
        "This page is generated: it is what each program prints with `--help`. "
        "`swiftlet man COMMAND | man -l -` shows the same as a manual page.\n\n"
        "Exit codes of all programs: 0 success, 1 the command failed or was refused, 2 wrong usage or bad input.\n"
    ]
    for program in PROGRAMS:
        for words, text in walk(folder, [program]):
            out.append(f"\n{'#' * min(len(words) + 1, 4)} {' '.join(words)}\n\n```text\n{text.strip()}\n```\n")
    return "".join(out)
