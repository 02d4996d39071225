#!/usr/bin/env python3
"""Runs a command and appends what it took to a log: `measure.py LOG COMMAND [ARGUMENT...]`.

The launcher of the compiler, the linker and the tests, see weight.py. A line of the log is a JSON array of the name (the output file
of a compiler, else the command with the GoogleTest variables that choose its cases) and the CPU seconds of the process and of all
that it started, orphans included. Ends as the command does.
"""
import ctypes
import json
import os
import resource
import signal
import sys

PR_SET_CHILD_SUBREAPER = 36


def name_of(command: list[str]) -> str:
    if "-o" in command:
        return command[command.index("-o") + 1]
    shard = os.environ.get("GTEST_SHARD_INDEX", "")
    cases = [word for word in command[1:] if word.startswith("--gtest_filter=")]
    return " ".join([os.path.basename(command[0]), *cases, *([f"shard={shard}"] if shard else [])])


def main() -> int:
    log, command = sys.argv[1], sys.argv[2:]
    ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    child = os.posix_spawnp(command[0], command, os.environ)
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda received, _: os.kill(child, received))
    status = None
    while status is None:
        pid, ended = os.wait()
        if pid == child:
            status = ended
    try:
        while os.waitpid(-1, os.WNOHANG)[0]:
            pass
    except ChildProcessError:
        pass
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    line = json.dumps([name_of(command), round(used.ru_utime + used.ru_stime, 3)]) + "\n"
    with open(log, "a", encoding="utf-8") as file:
        file.write(line)
    if os.WIFSIGNALED(status):
        signal.signal(os.WTERMSIG(status), signal.SIG_DFL)
        os.kill(os.getpid(), os.WTERMSIG(status))
    return os.waitstatus_to_exitcode(status)


if __name__ == "__main__":
    sys.exit(main())
