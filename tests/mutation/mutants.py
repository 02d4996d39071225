"""One-line mistakes: what a typing error, a wrong sign or a forgotten line would make of a source file."""

import dataclasses
import re

# Strings, characters and comments are no code: the same number of other characters stands for them while a line is searched.
NOT_CODE = re.compile(r'"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])\'|//.*')
SKIPPED = re.compile(r"\s*(#|//|namespace\b|using\b|template\b|static_assert|friend\b|public:|private:|protected:|\[\[|})")
STATEMENT = re.compile(r"\s+(?!return\b|break\b|continue\b|throw\b|const\b|auto\b|case\b|else\b|delete\b|struct\b|class\b)"
                       r"[A-Za-z_][\w.:\[\]>()*-]*(\(.*\)|\s[-+*/|&]?=\s.*);$")
DECLARATION = re.compile(r"\s+(?:[A-Za-z_][\w:]*(?:<.*>)?[&*]?\s+)+[a-z_]\w*(?:\s=\s|;|\{|\()")
NUMBER = re.compile(r"(?<![\w.'])(\d+\.\d+(?:e-?\d+)?|\d+)(?![\w.'])")
ARGUMENTS = re.compile(r"\b[a-z_]\w*\(([\w.\[\]]+), ([\w.\[\]]+)\)")
TERM = re.compile(r" [-+] [\w.\[\]]+(?:\([\w.\[\], ]*\))?(?= [-+]|[;,)])")

# (kind, pattern, replacements). Binary operators have blanks around them, which templates and pointers have not.
OPERATORS = [
    ("boundary", r" < ", [" <= "]),
    ("boundary", r" <= ", [" < "]),
    ("boundary", r" > ", [" >= "]),
    ("boundary", r" >= ", [" > "]),
    ("comparison", r" == ", [" != "]),
    ("comparison", r" != ", [" == "]),
    ("logic", r" && ", [" || "]),
    ("logic", r" \|\| ", [" && "]),
    ("arithmetic", r" \+ ", [" - "]),
    ("arithmetic", r" - ", [" + "]),
    ("arithmetic", r" \* ", [" / "]),
    ("arithmetic", r" / ", [" * "]),
    ("assignment", r" \+= ", [" -= ", " = "]),
    ("assignment", r" -= ", [" += "]),
    ("assignment", r" \*= ", [" /= "]),
    ("sign", r"(?<=[=(,] )-(?=[\w(])", [""]),
    ("sign", r"(?<=\()-(?=[\w(])", [""]),
    ("negation", r"(?<=[ (])!(?=[\w(])", [""]),
    ("boolean", r"\btrue\b", ["false"]),
    ("boolean", r"\bfalse\b", ["true"]),
    ("transpose", r"\.(?:transpose|conjugate|inverse|cwiseAbs|normalized)\(\)", [""]),
    ("index", r"\[0\]", ["[1]"]),
    ("index", r"\[i\]", ["[i + 1]", "[0]"]),
    ("extremum", r"\bstd::min\(", ["std::max("]),
    ("extremum", r"\bstd::max\(", ["std::min("]),
]


@dataclasses.dataclass(frozen=True)
class Mutant:
    file: str  # below the root
    line: int  # from 1
    kind: str
    before: str
    after: str

    def __str__(self):
        return f"{self.file}:{self.line}: {self.kind}\n  - {self.before.strip()}\n  + {self.after.strip() or '(nothing)'}"


def masked(line):
    return NOT_CODE.sub(lambda found: "\0" * len(found.group()), line)


def argument_end(text, begin):
    """Index of the comma or bracket that ends the argument that begins there; None: on another line."""
    depth = 0
    for at in range(begin, len(text)):
        if text[at] in "([{":
            depth += 1
        elif text[at] in ")]}":
            if depth == 0:
                return at
            depth -= 1
        elif text[at] == "," and depth == 0:
            return at
    return None


def without_clamp(line, code):
    for found in re.finditer(r"\bstd::(?:clamp|min|max|abs)\(", code):
        first = argument_end(code, found.end())
        close = first
        while close is not None and code[close] == ",":
            close = argument_end(code, close + 1)
        if close is not None:
            yield "clamp", line[: found.start()] + "(" + line[found.end() : first] + ")" + line[close + 1 :]


def changed_numbers(line, code):
    for found in NUMBER.finditer(code):
        text = found.group()
        value = float(text) * 1.5 if "." in text else int(text) + 1
        if value == 0.0:
            value = 1.0
        yield "constant", line[: found.start()] + repr(value) + line[found.end() :]


def changed_line(line):
    """Yields (kind, changed line)."""
    code = masked(line)
    for kind, pattern, replacements in OPERATORS:
        for found in re.finditer(pattern, code):
            for replacement in replacements:
                yield kind, line[: found.start()] + replacement + line[found.end() :]
    yield from without_clamp(line, code)
    yield from changed_numbers(line, code)
    for found in ARGUMENTS.finditer(code):
        if found.group(1) != found.group(2):
            yield "arguments", line[: found.start(1)] + found.group(2) + ", " + found.group(1) + line[found.end(2) :]
    for found in TERM.finditer(code):
        yield "term", line[: found.start()] + line[found.end() :]
    if found := re.match(r"(\s*(?:\} else )?if \()(.*)(\)(?: \{|.*;)?)$", code):
        if found.group(2).count("(") == found.group(2).count(")") and ";" not in found.group(2):
            begin, end = found.span(2)
            yield "condition", f"{line[:begin]}!({line[begin:end]}){line[end:]}"
    if STATEMENT.match(code) and not DECLARATION.match(code) and code.count("(") == code.count(")"):
        yield "statement", re.match(r"\s*", line).group() + ";"
    if re.match(r"(inline |static )?void [\w:]+\(.*\)( const)? \{$", code):
        yield "return", line + " return;"


def mutants_of(file, text):
    mutants = []
    lines = text.splitlines()
    for number, line in enumerate(lines, 1):
        code = masked(line)
        if SKIPPED.match(code) or not code.strip("\0 {}();"):
            continue
        # A statement that began on a line before is not dropped alone.
        continues = number > 1 and not re.search(r"[;{}:]\s*$|^\s*$", masked(lines[number - 2]).rstrip("\0 "))
        for kind, after in changed_line(line):
            if after != line and not (continues and kind == "statement"):
                mutants.append(Mutant(file, number, kind, line, after))
    return mutants
