#!/usr/bin/env python3
"""Runs the commands that a page of the manual shows.

usage: run_commands.py --bin FOLDER --source FOLDER [--deadline SECONDS] PAGE...
       run_commands.py --list PAGE...        prints the blocks and what would be done with them

The fences are described in docs/site/manual_text.py. The `sh` blocks of a page run in order in one folder, which is empty but
for links to config and tests of the project. Each block is a bash script that stops at the first command that fails. Files
that the page shows (`yaml file: hop.yaml`) are written when their turn comes. Processes that a block starts in the background
run until the page ends.

The page is isolated by a DDS domain of its own and by the loopback interface. So that a flight depends neither on the speed of
the machine nor takes its time, the processes fly in lockstep: plant, motion capture and controllers at twice real time,
flights of `swiftlet fly` as fast as they can. Blocks marked `realtime` fly by the wall clock. The commands are otherwise run
as they are shown: small scripts of the programs' names, which are the first in PATH, add these options.

Blocks marked `skip` do not run. As in all other blocks, their commands and options must be known to --help.
"""

import argparse
import ctypes
import fcntl
import json
import os
import pathlib
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "docs" / "site"))
from commands import help_of, subcommands_of  # noqa: E402
from manual_text import ManualError, fences  # noqa: E402

SERVICES = ("swiftlet-plant", "swiftlet-mocap", "swiftlet-control", "swiftlet-vehicle-template", "swiftlet-microcontroller", "swiftlet-px4", "swiftlet-ros")
PROGRAMS = ("swiftlet", "swiftlet-identify", *SERVICES)
FIRST_DOMAIN, LAST_DOMAIN = 20, 99  # as in services/dds/discovery/domain_lock.hpp


class Block:
    """What a fence's words say."""

    def __init__(self, fence, page):
        self.text, self.line, self.page = fence.text, fence.line, page
        self.file, self.skip, self.exit_code, self.realtime, self.prints = None, None, 0, False, False
        words = fence.words
        if named := re.fullmatch(r"file: ([\w.-]+)", words):
            self.file = named[1]
        elif fence.language == "text" and words == "printed":
            self.prints = True
        elif fence.language != "sh":
            if words:
                self.refuse(words)
        elif skipped := re.fullmatch(r"skip: (\S.*)", words):
            self.skip = skipped[1]
        elif ended := re.fullmatch(r"exit ([12]): \S.*", words):
            self.exit_code = int(ended[1])
        elif words == "realtime":
            self.realtime = True
        elif words:
            self.refuse(words)
        self.is_commands = fence.language == "sh" and self.file is None

    def refuse(self, words):
        raise ManualError(f"{self.page}:{self.line}: '{words}' says nothing, must be 'file: NAME', 'skip: REASON', "
                          "'exit 1: REASON', 'exit 2: REASON', 'realtime', or of a text 'printed'")

    def __str__(self):
        what = ("printed" if self.prints else f"file {self.file}" if self.file else f"skipped: {self.skip}" if self.skip
                else f"exit {self.exit_code}" + (", real time" if self.realtime else ""))
        return f"{self.page}:{self.line}: {what}"


def blocks_of(page):
    text = pathlib.Path(page).read_text()
    blocks = [Block(fence, page) for fence in fences(text, page)]
    return [block for block in blocks if block.is_commands or block.file or block.prints]


# ---- the options of all commands, by --help


class Help:
    """Compares commands with what the programs print with --help."""

    def __init__(self, bin_folder, source):
        self.bin_folder, self.source = bin_folder, source
        self.texts = {}

    def text(self, words):
        if tuple(words) not in self.texts:
            self.texts[tuple(words)] = help_of(self.bin_folder, list(words))
        return self.texts[tuple(words)]

    def check(self, block):
        for words in commands_of(block.text):
            name = words[0]
            if name in PROGRAMS:
                self.check_program(words, block)
            elif name == "./dev":
                self.check_dev(words, block)

    def check_program(self, words, block):
        command = [words[0]]
        for word in words[1:]:
            if word in subcommands_of(self.text(command)):
                command.append(word)
            elif not word.startswith("-") and len(command) == 1 and subcommands_of(self.text(command)):
                raise ManualError(f"{block.page}:{block.line}: '{' '.join(command)} {word}': not a command of {command[0]}")
            else:
                break
        known = set(re.findall(r"(?<![\w-])(--?[A-Za-z][\w-]*)", self.text(command)))
        for word in words[len(command):]:
            option = word.partition("=")[0]
            if re.fullmatch(r"--?[A-Za-z][\w-]*", option) and option not in known:
                raise ManualError(f"{block.page}:{block.line}: '{' '.join(command)}' has no option {option}")

    def check_dev(self, words, block):
        usage = subprocess.run([self.source / "dev", "help"], capture_output=True, text=True, check=True).stdout
        if len(words) > 1 and not re.search(rf"^  {re.escape(words[1])}\b", usage, re.MULTILINE):
            raise ManualError(f"{block.page}:{block.line}: './dev {words[1]}' is not listed by './dev help'")


def commands_of(text):
    """The words of each command of a script. Loops and functions are not understood: the manual shows none."""
    text = re.sub(r"\\\n", " ", text)
    for line in text.splitlines():
        try:
            lexer = shlex.shlex(line, posix=True, punctuation_chars=";&|()<>")
            lexer.whitespace_split = True
            words = list(lexer)
        except ValueError:  # a quote that ends in another line
            continue
        command = []
        for word in [*words, ";"]:
            if set(word) <= set(";&|()<>"):
                if command:
                    yield command
                command = [] if set(word) & set(";&|(") else ["redirected to"]
            elif command or "=" not in word:  # not an assignment before a command
                command.append(word)


# ---- isolation


def lock_domain():
    """(domain, open lock file): the lock of DomainLock, so that tests and flights on this machine do not meet."""
    count = LAST_DOMAIN - FIRST_DOMAIN + 1
    for i in range(count):
        domain = FIRST_DOMAIN + (os.getpid() + i) % count
        path = os.path.join(tempfile.gettempdir(), f"swiftlet-domain-{domain}.lock")
        flags = os.O_RDONLY | os.O_NOFOLLOW | os.O_CLOEXEC
        try:
            # With O_CREAT, the lock of another user would be refused.
            lock = os.open(path, flags if os.path.exists(path) else flags | os.O_CREAT, 0o644)
        except OSError:
            continue
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return domain, lock
        except OSError:
            os.close(lock)
    raise ManualError(f"all DDS domains from {FIRST_DOMAIN} to {LAST_DOMAIN} are in use")


def adopt_orphans():
    """Processes that a block leaves in the background become children of this one when bash ends."""
    PR_SET_CHILD_SUBREAPER = 36
    if ctypes.CDLL(None, use_errno=True).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0) != 0:
        raise ManualError(f"prctl: {os.strerror(ctypes.get_errno())}")


def children():
    """The processes whose parent is this one."""
    found = []
    for entry in os.listdir("/proc"):
        if not entry.isdigit():
            continue
        try:
            stat = pathlib.Path("/proc", entry, "stat").read_text()
        except OSError:
            continue
        if int(stat.rpartition(")")[2].split()[1]) == os.getpid():
            found.append(int(entry))
    return found


def end_children(patience_s=10.0):
    """Asks all children to end, and ends those that do not. Grandchildren become children when their parent ends."""
    for number, until in ((signal.SIGTERM, time.monotonic() + patience_s), (signal.SIGKILL, time.monotonic() + 2 * patience_s)):
        told = set()
        while time.monotonic() < until:
            try:
                while os.waitpid(-1, os.WNOHANG)[0]:
                    pass
            except ChildProcessError:
                return
            for child in set(children()) - told:
                told.add(child)
                try:
                    os.kill(child, number)
                except ProcessLookupError:
                    pass
            time.sleep(0.02)


WRAPPER = r"""#!/usr/bin/env bash
# Runs the program of this name with the options that isolate the test, see tests/docs/run_commands.py.
name=$(basename "$0")
words=("$@")
has() { local word; for word in "${words[@]}"; do [[ $word == "$1" || $word == "$1="* ]] && return; done; return 1; }
add() { has "$1" || words+=("$@"); }
case "$name ${1-} ${2-}" in
  "swiftlet-plant "*) [[ $DOCS_CLOCK == realtime ]] || { add --clock lockstep; add --speed 2; } ;;
  "swiftlet-mocap "* | "swiftlet-control "*) [[ $DOCS_CLOCK == realtime ]] || add --clock lockstep ;;
  "swiftlet fly "*)
    if ! has --attach; then
      unset ROS_DOMAIN_ID  # it takes a free one
      [[ $DOCS_CLOCK == realtime ]] || has --speed || add --clock lockstep
    fi
    ;;
esac
exec "$DOCS_BIN/$name" "${words[@]}"
"""


class Page:
    """Runs the blocks of one page."""

    def __init__(self, page, bin_folder, source, deadline, folder):
        self.page, self.bin_folder, self.deadline = page, bin_folder, deadline
        self.work, self.logs, wrappers = folder / "work", folder / "logs", folder / "bin"
        for made in (self.work, self.logs, wrappers):
            made.mkdir(parents=True)
        for shown in ("config", "tests"):
            (self.work / shown).symlink_to(source / shown)
        for name in PROGRAMS:
            (wrappers / name).write_text(WRAPPER)
            (wrappers / name).chmod(0o755)
        self.domain, self.lock = lock_domain()
        self.environment = {
            **{name: value for name, value in os.environ.items() if name in ("HOME", "LANG", "LC_ALL", "TMPDIR", "USER")},
            "PATH": f"{wrappers}:/usr/local/bin:/usr/bin:/bin",
            "DOCS_BIN": str(bin_folder),
            "SWIFTLET_CONFIG_DIR": str(source / "config"),
            "ROS_DOMAIN_ID": str(self.domain),
            "TERM": "dumb",
        }

    def run(self, blocks):
        for number, block in enumerate(blocks, 1):
            if block.file:
                (self.work / block.file).write_text(block.text)
            elif block.prints:
                self.compare(block)
            elif not block.skip:
                self.run_block(number, block)

    def run_block(self, number, block):
        script, log = self.logs / f"{number}.sh", self.logs / f"{number}.log"
        script.write_text("set -euo pipefail\n" + block.text)
        environment = {**self.environment, "DOCS_CLOCK": "realtime" if block.realtime else "lockstep"}
        started = time.monotonic()
        with open(log, "wb") as output, open(os.devnull, "rb") as nothing:
            process = subprocess.Popen(["bash", str(script)], cwd=self.work, env=environment, stdin=nothing, stdout=output,
                                       stderr=subprocess.STDOUT)
            try:
                code = process.wait(max(0.1, self.deadline - started))
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
                self.fail(block, f"not done after {time.monotonic() - started:.0f} s", log)
        print(f"{block}: {time.monotonic() - started:.1f} s", flush=True)
        if code != block.exit_code:
            self.fail(block, f"exit code {code}, must be {block.exit_code}", log)
        if re.search(r"swiftlet-control\b[^\n]*&", block.text):
            for words in commands_of(block.text):
                if words[0] == "swiftlet-control":
                    named = words.index("--vehicle-name") + 1 if "--vehicle-name" in words else 0
                    for vehicle in (words[named] if named else "kl1").split(","):
                        self.await_pose(vehicle, block, log)

    def compare(self, block):
        """Every line of the text was printed by the block before it."""
        logs = sorted(self.logs.glob("*.log"), key=lambda file: int(file.stem))
        printed = {line.strip() for line in logs[-1].read_text(errors="replace").splitlines()} if logs else set()
        for line in block.text.splitlines():
            if line.strip() and line.strip() not in printed:
                self.fail(block, f"the commands before it do not print '{line.strip()}'", logs[-1] if logs else None)

    def await_pose(self, vehicle, block, log):
        """A reader of the manual types the next command seconds later; the test waits until the vehicle is ready for it."""
        while time.monotonic() < self.deadline:
            status = subprocess.run(
                [str(self.bin_folder / "swiftlet"), "status", "--json", "--watch", "0.1", "--domain",
                 str(self.domain), "--vehicle-name", vehicle],
                env=self.environment, capture_output=True, text=True, timeout=60, check=False)
            if status.returncode == 0 and json.loads(status.stdout).get("has_pose") is True:
                return
            time.sleep(0.1)
        self.fail(block, f"the vehicle {vehicle} that it starts has no pose", log)

    def fail(self, block, sentence, log):
        logs = sorted(self.logs.glob("*.log"), key=lambda file: int(file.stem))
        said = "".join(f"--- {file.name}\n{file.read_text(errors='replace')[-4000:]}" for file in logs)
        raise ManualError(f"{block.page}:{block.line}: {sentence}\n{block.text}{said}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=pathlib.Path)
    parser.add_argument("--source", type=pathlib.Path)
    parser.add_argument("--deadline", type=float, default=180.0, help="s for each page")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("pages", nargs="+", type=pathlib.Path)
    options = parser.parse_args()
    try:
        pages = {page: blocks_of(page) for page in options.pages}
        if options.list:
            for blocks in pages.values():
                print("".join(f"{block}\n" for block in blocks), end="")
            return 0
        if not (options.bin and options.source):
            parser.error("--bin and --source are required")
        bin_folder, source = options.bin.resolve(), options.source.resolve()
        adopt_orphans()
        helps = Help(bin_folder, source)
        for page, blocks in pages.items():
            for block in blocks:
                if block.is_commands:
                    helps.check(block)
            folder = pathlib.Path(tempfile.mkdtemp(prefix="swiftlet-docs-"))
            try:
                Page(page, bin_folder, source, time.monotonic() + options.deadline, folder).run(blocks)
            finally:
                end_children()
                shutil.rmtree(folder, ignore_errors=True)
            ran = sum(block.is_commands and not block.skip for block in blocks)
            print(f"{page}: {ran} blocks ran, {sum(bool(block.skip) for block in blocks)} skipped")
    except ManualError as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
