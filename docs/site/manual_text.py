"""The parts of Markdown that the manual's tools need: fenced blocks, headings, anchors and links.

A fence of the manual has a language and may have words after it. These are the words of `sh` fences:

    ```sh                      commands; the test of the manual runs them and expects exit code 0
    ```sh exit 1: REASON       commands; the block must end with this exit code
    ```sh realtime             commands; the processes run by the wall clock, not in lockstep
    ```sh skip: REASON         commands that the test does not run; it still compares them with `--help`

and of all others:

    ```yaml file: hop.yaml     the text of this file, which the commands below it use
    ```text printed            lines that the commands above it print
"""

import dataclasses
import re


class ManualError(Exception):
    """A sentence with file and line."""


@dataclasses.dataclass
class Fence:
    language: str
    words: str  # after the language
    text: str  # with a newline at the end
    line: int  # of the opening fence, from 1


_FENCE = re.compile(r"^( *)(`{3,}|~{3,})\s*([^\s`]*)[ \t]*([^`]*)$")
_LINK = re.compile(r"(!?\[(?:[^\]\[]|\[[^\]]*\])*\])\(\s*<?([^)\s>]*)>?((?:\s+\"[^\"]*\")?)\s*\)")
_HEADING = re.compile(r"^(#{1,6})\s+(.*?)\s*#*\s*$")


def split(text, name):
    """Yields (line number, line, fence) for every line. `fence` is the Fence that opens in this line, or True inside of it."""
    lines = text.split("\n")
    i = 0
    while i < len(lines):
        found = _FENCE.match(lines[i])
        if not found:
            yield i + 1, lines[i], None
            i += 1
            continue
        indent, mark, language, words = found.groups()
        end = i + 1
        while end < len(lines) and not re.match(rf"^ *{mark[0]}{{{len(mark)},}}\s*$", lines[end]):
            end += 1
        if end == len(lines):
            raise ManualError(f"{name}:{i + 1}: this fence does not end")
        body = [line[len(indent):] if line.startswith(indent) else line.lstrip() for line in lines[i + 1 : end]]
        yield i + 1, lines[i], Fence(language, words.strip(), "".join(line + "\n" for line in body), i + 1)
        for j in range(i + 1, end + 1):
            yield j + 1, lines[j], True
        i = end + 1


def fences(text, name):
    return [fence for _, _, fence in split(text, name) if isinstance(fence, Fence)]


def headings(text, name):
    """The texts of all headings, in order."""
    found = (_HEADING.match(line) for _, line, fence in split(text, name) if fence is None)
    return [heading.group(2) for heading in found if heading]


def _plain(heading):
    return re.sub(r"[`*]|\[([^\]]*)\]\([^)]*\)", r"\1", heading)


def anchors(text, name):
    """The anchors of the headings that GitHub and MkDocs agree on."""
    seen, found = {}, set()
    for heading in headings(text, name):
        plain = re.sub(r"[^\w\s-]", "", _plain(heading)).strip().lower()
        github, mkdocs = re.sub(r"\s", "-", plain), re.sub(r"[-\s]+", "-", plain)
        count = seen[github] = seen.get(github, -1) + 1
        if github == mkdocs and count == 0:  # they number repeated headings differently
            found.add(github)
    return found


def map_links(text, name, change):
    """Returns the text with each link target replaced by change(target, line number). Leaves code alone."""
    out = []
    for number, line, fence in split(text, name):
        if fence is None:
            # Odd parts are code between backquotes. A link's own text may hold code, so that code that does not hold
            # a whole link is put back before the search.
            code = []

            def hide(match):
                code.append(match.group(0))
                return f"\0{len(code) - 1}\0"

            hidden = re.sub(r"(`+)(?!`).*?(?<!`)\1(?!`)", hide, line)
            hidden = _LINK.sub(lambda m: f"{m.group(1)}({change(m.group(2), number)}{m.group(3)})", hidden)
            line = re.sub(r"\0(\d+)\0", lambda m: code[int(m.group(1))], hidden)
        out.append(line)
    return "\n".join(out)


def links(text, name):
    """All link targets with their lines."""
    found = []
    map_links(text, name, lambda target, line: found.append((target, line)) or target)
    return found


def plain(text):
    """The text as Markdown that shows it literally."""
    return re.sub(r"([*<`\\])", r"\\\1", text)


def table(columns, rows):
    """A table; cells are escaped."""
    def cells(row):
        return "| " + " | ".join(str(cell).replace("|", "\\|").replace("\n", " ") for cell in row) + " |\n"

    return cells(columns) + "|" + "---|" * len(columns) + "\n" + "".join(cells(row) for row in rows)
