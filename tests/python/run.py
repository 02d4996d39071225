#!/usr/bin/env python3
"""Tests the Python package as it was built: its tests, its types, and the notebooks of the manual.

usage: run.py BUILD WORK [test...]

BUILD holds bin and python, WORK is a folder for files. Run it with the interpreter that the package was built for. With names of
tests (`test_models`, `test_models.Vehicles`, `notebooks`, `types`) only those.
"""
import concurrent.futures
import os
import pathlib
import signal
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
NOTEBOOKS = ROOT / "docs" / "notebooks"


def run(what, command, environment, folder):
    started = time.monotonic()
    done = subprocess.run([str(word) for word in command], env=environment, cwd=folder, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, check=False)
    return what, done.returncode, done.stdout, time.monotonic() - started


def steps(names, work):
    """The command of each step by its name."""
    suites = sorted(path.stem for path in HERE.glob("test_*.py"))
    wanted = names or [*suites, "types", "notebooks"]
    for name in wanted:
        if name == "types":
            yield "stubs", [sys.executable, "-B", "-m", "mypy.stubtest", "swiftlet._core", "--allowlist", HERE / "stubtest.txt",
                            "--ignore-unused-allowlist"]
            yield "types", [sys.executable, "-B", "-m", "mypy", "--strict", f"--cache-dir={work / 'mypy'}", "-p", "swiftlet"]
        elif name == "notebooks":
            for notebook in sorted(NOTEBOOKS.glob("*.ipynb")):
                yield notebook.name, [sys.executable, "-B", HERE / "run_notebook.py", notebook]
        else:
            yield name, [sys.executable, "-B", "-m", "unittest", name]


def main():
    # Tests interrupt themselves, also where the shell has let this process ignore SIGINT.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    build, work = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    work.mkdir(parents=True, exist_ok=True)
    environment = {**os.environ, "PYTHONPATH": f"{build / 'python'}:{HERE}", "MYPYPATH": str(build / "python"),
                   "SWIFTLET_BUILD": str(build), "MPLBACKEND": "agg", "PYTHONDONTWRITEBYTECODE": "1"}
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        running = [pool.submit(run, what, command, environment, work) for what, command in steps(sys.argv[3:], work)]
        for one in running:
            what, code, output, took_s = one.result()
            failed += code != 0
            lines = output.strip().splitlines() if code == 0 else []
            print(f"python: {what}: {'ok' if code == 0 else 'FAILED'}, {took_s:.1f} s"
                  + (f"\n{output}" if code else f" ({lines[-3] if 'OK' in lines[-1:] else lines[-1]})" if lines else ""), flush=True)
    sys.exit(1 if failed else 0)


main()
