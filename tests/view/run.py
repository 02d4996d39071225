#!/usr/bin/env python3
"""Watches a flight of two vehicles with the Foxglove client of others and with the live page in headless Chromium.

usage: run.py BIN WORK

BIN holds the programs, WORK is a folder for files, also for pictures of the page; the packages of package-lock.json are
installed into it with npm.
"""
import contextlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
ASSETS = HERE.parent.parent / "analysis" / "pages" / "assets"
VEHICLES = "kl1,kl2"


def require(holds, what):
    if not holds:
        sys.exit(f"view: {what}")


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], text=True, capture_output=True, check=False, **options)
    require(done.returncode == 0, f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-3000:]}")
    return done.stdout


def install(work):
    work.mkdir(parents=True, exist_ok=True)
    for file in [*HERE.glob("*.*js*"), HERE.parent / "pages" / "browser.mjs", ASSETS / "cdr.js"]:
        shutil.copy(file, work)
    run("npm", "ci", "--omit=dev", "--no-audit", "--no-fund", "--ignore-scripts", cwd=work)


class Vehicles:
    """Running vehicles in real time, and the server of the live page."""

    def __init__(self, programs, work, names, stack):
        self.swiftlet, self.names = programs / "swiftlet", names
        self.network = ["--domain", str(20 + os.getpid() % 80), "--localhost-only"]
        self.named = [*self.network, "--vehicle-name", names]
        self.log = stack.enter_context((work / "processes.log").open("w", encoding="utf-8"))
        self.stack, self.work = stack, work
        for name in ("plant", "mocap", "control"):
            self.start(programs / f"swiftlet-{name}", *self.named, *(["--per-row", "3"] if name == "plant" else []))
        self.serve("--port", "0")

    def serve(self, *options):
        self.server = self.start(self.swiftlet, "view", *self.network, *options, stdout=subprocess.PIPE)
        self.url = self.server.stdout.readline().strip()
        require(self.url.startswith("http://127.0.0.1:"), f"the URL of the page is '{self.url}'")

    def stop_serving(self):
        self.server.terminate()
        self.server.wait()

    def start(self, *command, stdout=None):
        process = subprocess.Popen([str(word) for word in command], text=True, stdout=stdout or self.log, stderr=self.log)
        self.stack.callback(process.wait)
        self.stack.callback(process.terminate)
        return process

    def ask(self, *words):
        return run(self.swiftlet, *words, *self.named, cwd=self.work)

    def take_off(self):
        give_up = time.monotonic() + 30
        while (arm := subprocess.run([self.swiftlet, "arm", *self.named], text=True, capture_output=True, check=False)).returncode != 0:
            require(time.monotonic() < give_up, f"the vehicles cannot be armed: {arm.stderr}")
        self.ask("takeoff", "0.6")


def reconnect(vehicles, work):
    """The page stays open while its server ends, and another one takes its place that serves one vehicle less."""
    gone, stays = vehicles.names.split(",")
    with subprocess.Popen(["node", work / "reconnect.mjs", vehicles.url, gone, stays], cwd=work, text=True, stdin=subprocess.PIPE,
                          stdout=subprocess.PIPE) as page:
        def expect(word):
            said = page.stdout.readline().strip()
            require(said == word, f"reconnect: '{said}' instead of '{word}'")

        expect("shown")
        vehicles.stop_serving()
        print("ended", file=page.stdin, flush=True)
        expect("silent")
        vehicles.serve("--port", vehicles.url.rsplit(":", 1)[1].strip("/"), "--vehicle-name", stays)
        print("serves", file=page.stdin, flush=True)
        expect("back")


def main(programs, work):
    install(work)
    with contextlib.ExitStack() as stack:
        vehicles = Vehicles(programs, work, VEHICLES, stack)
        vehicles.take_off()
        run(vehicles.swiftlet, "goto", "1.5", "0", "--height", "1", "--speed", "0.02", "--no-wait", *vehicles.network,
            "--vehicle-name", "kl1", cwd=work)
        decoded = json.loads(run("node", work / "decode.mjs", vehicles.url, cwd=work))
        print(f"view: {decoded['messages']} messages of {len(decoded['topics'])} topics decoded by @foxglove/ws-protocol and "
              "@foxglove/rosmsg2-serialization, as by the page")
        seen = json.loads(run("node", work / "page.mjs", vehicles.url, work, cwd=work))
        require(0.0 < seen["held_at_m"] < 1.4, f"hold on the way to 1.5 m was at {seen['held_at_m']} m")
        require(seen["holding"] and seen["landed"], f"the page's requests: {seen}")
        print(f"view: the page showed {seen['charts']} charts of {seen['vehicles']} vehicles at {seen['rate_hz']} Hz; closed, opened again, hold "
              f"and land accepted, a second hold {seen['refusal']}; light and dark, 1280 and 390 px")
        require(vehicles.server.poll() is None, "the server has ended")
        reconnect(vehicles, work)
        print("view: a page whose server ended showed its vehicles as silent, and the one that the next server serves again")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve())
