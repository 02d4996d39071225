#!/usr/bin/env python3
"""Collects the pages of the manual for MkDocs: README.md, docs/, the README of each room, and the generated reference.

usage: stage.py --check
       stage.py --bin FOLDER --out FOLDER [--api]

--check  only checks that fences are complete and that links lead to files and headings that exist
--bin    folder of the built programs, which the reference is made from
--out    folder to write; its content is replaced
--api    the reference has a link to the API pages, which Doxygen writes into OUT/api

Links between pages stay links. Links to other files lead to a copy of the file, links to folders to a list of their files.
"""

import argparse
import os
import pathlib
import posixpath
import re
import shutil
import sys

import commands
import configuration
import messages
from manual_text import ManualError, anchors, fences, links, map_links, split

ROOT = pathlib.Path(__file__).resolve().parents[2]
LANGUAGES = {"sh", "yaml", "json", "csv", "cpp", "cmake", "text", "idl", "xml", "python"}
GENERATED = "<!-- generated pages -->"  # the place of their list, in docs/reference.md
IGNORED = re.compile(r"^(\.git|\.cache|build.*|flights)$")


def pages():
    """Source -> page, both as paths with slashes: the first from the root of the project, the second in the site."""
    found = {"README.md": "index.md", "CHANGELOG.md": "changelog.md", "CONTRIBUTING.md": "contributing.md"}
    for file in sorted((ROOT / "docs").glob("*.md")):
        found[f"docs/{file.name}"] = file.name
    for folder, folders, files in os.walk(ROOT):
        folders[:] = sorted(name for name in folders if not IGNORED.match(name))
        room = pathlib.Path(folder).relative_to(ROOT).as_posix()
        if "README.md" in files and room != ".":
            found[f"{room}/README.md"] = f"rooms/{room.replace('/', '-')}.md"
    return found


def is_elsewhere(target):
    return re.match(r"^[a-z][a-z0-9+.-]*:", target) is not None


def resolve(source, target):
    """(file or folder from the root, anchor) of a relative link in `source`."""
    path, _, anchor = target.partition("#")
    if not path:
        return source, anchor
    return posixpath.normpath(posixpath.join(posixpath.dirname(source), path)), anchor


def page_of(path, known):
    """The source of a page for a link to it or to its folder."""
    return path if path in known else f"{path}/README.md" if f"{path}/README.md" in known else None


def check(texts, known):
    """Throws for the first fence or link that is wrong."""
    headings = {source: anchors(text, source) for source, text in texts.items()}
    for source, text in texts.items():
        for fence in fences(text, source):
            if fence.language not in LANGUAGES:
                raise ManualError(f"{source}:{fence.line}: a fence in '{fence.language}', must be in one of "
                                  f"{', '.join(sorted(LANGUAGES))}")
        for target, line in links(text, source):
            if is_elsewhere(target):
                continue
            path, anchor = resolve(source, target)
            if path not in known and (path.startswith("../") or not (ROOT / path).exists()):
                raise ManualError(f"{source}:{line}: {target}: there is no {path}")
            page = page_of(path, known)
            if anchor and (page is None or anchor not in headings[page]):
                raise ManualError(f"{source}:{line}: {target}: {page or path} has no heading of which this is the anchor")


def loosen(text, name):
    """Inserts the empty line that Python-Markdown needs before lists and tables."""
    out, before = [], ""
    item = re.compile(r"^([-*]|\d+\.)\s")
    for _, line, fence in split(text, name):
        if fence is None and before.strip():
            begins_list = item.match(line) and not item.match(before) and not before.startswith("  ")
            begins_table = line.startswith("|") and not before.startswith("|")
            if begins_list or begins_table:
                out.append("")
        if fence is not None and not isinstance(fence, bool):
            line = line[: line.index(fence.language) + len(fence.language)]  # without the words for the test
        out.append(line)
        before = line
    return "\n".join(out)


class Site:
    def __init__(self, out, known):
        self.out, self.known = out, known
        self.copied = set()

    def write(self, page, text):
        file = self.out / page
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)

    def place(self, path):
        """Where a file or folder of the project is in the site; copies it there."""
        page = page_of(path, self.known)
        if page:
            return self.known[page]
        if (ROOT / path).is_dir():
            place = f"source/{path}.md"
            if place not in self.copied:
                self.copied.add(place)
                self.list_folder(path, place)
            return place
        picture = path.endswith((".png", ".svg"))
        place = path.removeprefix("docs/") if picture else f"source/{path}.txt"
        if place not in self.copied:
            self.copied.add(place)
            (self.out / place).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(ROOT / path, self.out / place)
        return place

    def list_folder(self, path, place):
        entries = sorted(entry for entry in (ROOT / path).iterdir() if not IGNORED.match(entry.name))
        lines = [f"- [{entry.name}]({self.link(place, f'{path}/{entry.name}')})" for entry in entries]
        self.write(place, f"# {path}\n\n" + "\n".join(lines) + "\n")

    def link(self, page, path):
        return posixpath.relpath(self.place(path), posixpath.dirname(page) or ".")

    def stage(self, source, text):
        page = self.known[source]

        def moved(target, _):
            if is_elsewhere(target) or target.startswith("#"):
                return target
            path, anchor = resolve(source, target)
            return self.link(page, path) + (f"#{anchor}" if anchor else "")

        self.write(page, map_links(loosen(text, source), source, moved))


def stage(texts, known, bin_folder, out, with_api):
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    site = Site(out, known)
    reference = {
        "commands.md": ("Commands", commands.page(bin_folder)),
        "messages.md": ("Messages", messages.page(ROOT)),
        "configuration.md": ("Configuration keys", configuration.page(ROOT, bin_folder)),
    }
    listed = [f"- [{title}](reference/{name})" for name, (title, _) in reference.items()]
    if with_api:
        listed.append("- [C++ API](api/index.html)")
    if GENERATED not in texts["docs/reference.md"]:
        raise ManualError(f"docs/reference.md: has no line '{GENERATED}'")
    for name, (_, text) in reference.items():
        site.write(f"reference/{name}", text)
    for source, text in texts.items():
        site.stage(source, text)
    shutil.copyfile(ROOT / "docs/site/site.css", out / "site.css")
    page = out / known["docs/reference.md"]
    page.write_text(page.read_text().replace(GENERATED, "\n".join(listed)))
    return len(texts) + len(reference)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--bin", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path)
    parser.add_argument("--api", action="store_true")
    options = parser.parse_args()
    if not options.check and not (options.bin and options.out):
        parser.error("--bin and --out are required, or --check")
    try:
        known = pages()
        texts = {source: (ROOT / source).read_text() for source in known}
        check(texts, known)
        if options.check:
            print(f"docs: {len(texts)} pages, all links lead somewhere")
        else:
            count = stage(texts, known, options.bin.resolve(), options.out.resolve(), options.api)
            print(f"docs: {count} pages in {options.out}")
    except (ManualError, OSError) as error:
        print(f"docs: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
